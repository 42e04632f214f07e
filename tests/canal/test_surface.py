from dataclasses import replace

import numpy as np
import pytest
from canals import DOCUMENTED, elliptic_canal, hard_canal
from hypothesis import given, settings
from hypothesis import strategies as st

from canal.errors import InputError
from canal.learning_options import LearningOptions
from canal.support_planes import SupportPlane
from canal.surface_file import load_canal, save_canal

disks = st.floats(0.0, 200.0)
ratios = st.floats(0.0, 1.0)
angles = st.floats(-3.1, 3.1)


@given(disks, st.floats(0.001, 1.0), angles)
@settings(max_examples=200, deadline=None)
@pytest.mark.parametrize("canal", [hard_canal(), elliptic_canal()], ids=["circles", "ellipses"])
def test_coordinates_invert_points(canal, disk, eta, phi):
    point = canal.point(disk, eta, phi)
    back = canal.disk_coordinates(disk, point)
    assert back == pytest.approx((eta, phi), abs=1e-9)
    x, y = canal.axes(disk)
    assert abs(np.linalg.norm(point - canal.center(disk)) - eta * canal.extent(disk, phi)) < 1e-12
    assert abs((point - canal.center(disk)) @ np.cross(x, y)) < 1e-12


@given(disks)
@settings(max_examples=100, deadline=None)
def test_between_disks_everything_is_unit_and_between(disk):
    canal = hard_canal()
    i, t = int(disk), disk - int(disk)
    x, y = canal.axes(disk)
    assert np.abs([x @ x - 1, y @ y - 1, x @ y]).max() < 1e-12
    assert np.abs(canal.center(disk) - (1 - t) * canal.directrix[i] - t * canal.directrix[i + 1]).max() < 1e-12
    assert canal.radius(disk) == pytest.approx((1 - t) * canal.radii[i] + t * canal.radii[i + 1], abs=1e-15)
    assert np.linalg.norm(canal.orientation(disk)) == pytest.approx(1, abs=1e-15)
    low, high = sorted(canal.orientation_weights[i : i + 2])
    assert low - 1e-12 <= canal.weight(disk) <= high + 1e-12


def test_at_a_disk_the_arrays_are_met_exactly_and_beyond_the_ends_clipped():
    canal = hard_canal()
    last = canal.n_disks - 1
    for s in (0, 7, canal.home_disk, last):
        assert np.array_equal(canal.center(s), canal.directrix[s])
        assert np.array_equal(canal.axes(s)[0], canal.x_axes[s])
        assert np.array_equal(canal.axes(s)[1], canal.y_axes[s])
        assert canal.weight(s) == canal.orientation_weights[s]
    assert np.array_equal(canal.center(-5.0), canal.directrix[0])
    assert np.array_equal(canal.center(last + 5.0), canal.directrix[-1])
    assert canal.home_disk == last // 2


@pytest.mark.parametrize("canal", [hard_canal(), elliptic_canal()], ids=["circles", "ellipses"])
def test_save_and_load_is_the_identity(canal, tmp_path):
    canal = replace(canal, warnings=("tief: 3°", "x"), support_planes=(SupportPlane((0, 0.6, 0.8), -1.5),))
    save_canal(tmp_path / "c.npz", canal)
    back = load_canal(tmp_path / "c.npz")
    for name in (*DOCUMENTED, "x_global", "ellipses"):
        a, b = getattr(canal, name), getattr(back, name)
        assert a is b is None or np.array_equal(a, b), name
    assert back.warnings == canal.warnings
    assert back.moving_time_s == canal.moving_time_s
    assert back.support_planes == canal.support_planes
    assert np.array_equal(back.point(3.3, 0.7, 1.0), canal.point(3.3, 0.7, 1.0))


def test_a_file_with_the_documented_keys_alone_is_a_canal(tmp_path):
    canal = hard_canal()
    arrays = {name: getattr(canal, name) for name in DOCUMENTED}
    np.savez(tmp_path / "c.npz", **arrays, moving_time_s=canal.moving_time_s, format_version=1)
    back = load_canal(tmp_path / "c.npz")
    assert np.array_equal(back.directrix, canal.directrix)
    assert back.warnings == ()
    assert np.array_equal(back.x_global, [1, 0, 0])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"radii": None}, "lacks radii"),
        ({"radii": np.ones(5)}, "radii has shape"),
        ({"x_axes": "NaN"}, "x_axes is not finite"),
        ({"format_version": 99}, "format 99"),
        ({"directrix": np.zeros((4, 3))}, "odd"),
        ({"directrix": np.array(3.0)}, "directrix has shape"),
        ({"demonstrations": np.zeros((0, 5, 3))}, "demonstrations has none"),
        ({"format_version": np.nan}, "format_version must be"),
        ({"format_version": np.zeros(2)}, "format_version must be"),
        ({"moving_time_s": np.inf}, "moving_time_s must be"),
        ({"moving_time_s": -1.0}, "moving_time_s must be"),
        ({"support_planes": np.zeros((1, 2))}, "support_planes has shape"),
        ({"support_planes": np.zeros((1, 4))}, "normal"),
        ({"x_global": np.zeros(3)}, "x_global is zero"),
        ({"x_axes": "doubled"}, "x_axes is not of unit length at disk 0"),
        ({"orientations": "zero"}, "orientations is not of unit length"),
        ({"demonstration_orientations": "zero"}, "demonstration_orientations is not of unit length"),
        ({"normals": "x_axes"}, "normals and x_axes are not at right angles"),
        ({"radii": "negative"}, "radii is -0"),
        ({"orientation_weights": "infinite"}, "orientation_weights is not finite"),
        ({"orientation_weights": "negative"}, "orientation_weights is -"),
        ({"orientation_weights": "huge"}, "must lie in"),
        ({"orientation_sd": "huge"}, "must lie in"),
        ({"directrix": "huge"}, "give metres"),
        ({"directrix": "zero"}, "mm long"),
        ({"radii": np.full(9, "wide")}, "give numbers"),
    ],
)
def test_a_file_that_is_no_canal_gives_one_line(tmp_path, change, says):
    canal = hard_canal()
    arrays = {name: getattr(canal, name) for name in DOCUMENTED} | {"moving_time_s": 3.0} | change
    spoil = {
        "NaN": lambda a: a * np.nan,
        "zero": lambda a: a * 0,
        "doubled": lambda a: a * 2,
        "negative": lambda a: -a - 0.01,
        "huge": lambda a: a * 1e9 + 1e7,
        "infinite": lambda a: a + np.inf,
        "x_axes": lambda a: canal.x_axes,
    }
    for key, value in change.items():
        if isinstance(value, str):
            arrays[key] = spoil[value](getattr(canal, key))
    np.savez(tmp_path / "c.npz", **{key: value for key, value in arrays.items() if value is not None})
    with pytest.raises(InputError, match=says):
        load_canal(tmp_path / "c.npz")


def test_quaternions_of_any_sign_are_read_continuously(tmp_path):
    canal = hard_canal()
    arrays = {name: getattr(canal, name) for name in DOCUMENTED} | {"moving_time_s": 3.0}
    signs = np.where(np.arange(canal.n_disks) % 3 == 0, -1.0, 1.0)[:, None]
    for key in ("orientations", "demonstration_orientations"):
        arrays[key] = arrays[key] * signs
    np.savez(tmp_path / "c.npz", **arrays)
    back = load_canal(tmp_path / "c.npz")
    assert np.sum(back.orientations[1:] * back.orientations[:-1], axis=1).min() > 0
    for s in (10.5, 30.5):
        assert abs(back.orientation(s) @ canal.orientation(s)) == pytest.approx(1.0, abs=1e-12)


def test_single_floats_are_precise_enough(tmp_path):
    canal = hard_canal()
    arrays = {name: getattr(canal, name).astype(np.float32) for name in DOCUMENTED}
    np.savez(tmp_path / "c.npz", **arrays, moving_time_s=np.float32(3.0))
    assert np.allclose(load_canal(tmp_path / "c.npz").directrix, canal.directrix, atol=1e-6)


def test_a_radius_of_zero_divides_nothing():
    canal = hard_canal()
    thin = replace(canal, radii=np.zeros(canal.n_disks))
    assert thin.disk_coordinates(5.5, thin.center(5.5) + [0.1, 0, 0]) == (0.0, 0.0)
    assert np.array_equal(thin.point(5.5, 1.0, 2.0), thin.center(5.5))


def test_points_are_clipped_at_planes_towards_the_centre():
    canal = hard_canal()
    s = canal.home_disk
    normal = -canal.x_axes[s]
    plane = SupportPlane(tuple(normal), float(normal @ canal.directrix[s]) - 0.3 * canal.radii[s])
    clipped = replace(canal, support_planes=(plane,))
    p = clipped.point(s, 1.0, 0.0)
    assert plane.height(p) == pytest.approx(0, abs=1e-12)
    assert clipped.disk_coordinates(s, p) == pytest.approx((0.3, 0.0), abs=1e-9)
    assert np.array_equal(clipped.point(s, 0.2, 0.0), canal.point(s, 0.2, 0.0))
    assert np.array_equal(clipped.point(s, 1.0, np.pi), canal.point(s, 1.0, np.pi))


def test_a_centre_beyond_a_plane_that_its_disk_is_level_with_divides_nothing():
    canal = hard_canal(3)
    up = tuple(canal.normals[0].tolist())
    below = SupportPlane(up, float(canal.directrix[0] @ canal.normals[0]) + 0.01)
    sunk = replace(canal, support_planes=(below,))
    assert np.isfinite([sunk.point(0, 1.0, phi) for phi in np.arange(0, 6.3, 0.1)]).all()


def test_arrays_cannot_be_written():
    with pytest.raises(ValueError, match="read-only"):
        hard_canal().radii[0] = 1


def test_options_default_to_the_papers_frame():
    assert LearningOptions().x_global == (1, 0, 0)
