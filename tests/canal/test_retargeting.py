from dataclasses import replace

import numpy as np
import pytest
from canals import elliptic_canal, hard_canal
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from canal.errors import InputError
from canal.quality import canal_quality
from canal.retargeting import retarget, shape_cost
from canal.support_planes import SupportPlane


def moved(canal, disk, shift, turn):
    """The pose at an end, shifted in B and turned by a rotation vector [rad]."""
    turned = Rotation.from_rotvec(turn) * Rotation.from_quat(canal.orientations[disk], scalar_first=True)
    return np.concatenate([canal.directrix[disk] + shift, turned.as_quat(scalar_first=True)])


def same_rotation(a, b):
    return np.abs(np.abs(np.sum(a * b, axis=-1)) - 1).max()


def test_to_where_it_is_changes_nothing():
    canal = hard_canal()
    same = retarget(canal, moved(canal, 0, 0, [0, 0, 0]), moved(canal, -1, 0, [0, 0, 0]))
    assert same.n_disks == canal.n_disks
    assert np.abs(same.directrix - canal.directrix).max() < 1e-6
    assert np.abs(same.radii - canal.radii).max() < 1e-6
    assert shape_cost(canal, same).curvature_ratio == pytest.approx(1, abs=1e-3)


directions = st.integers(0, 10_000)


@given(directions, st.floats(0.0, 0.3), st.floats(0.0, 30.0), st.sampled_from(["pick", "place", "both"]))
@settings(max_examples=25, deadline=None)
def test_ends_are_met_and_shape_is_kept(seed, far, angle, which):
    canal = hard_canal()
    rng = np.random.default_rng(seed)
    ends = {}
    for name, disk in (("pick", 0), ("place", -1)):
        shift, turn = rng.normal(size=3), rng.normal(size=3)
        if which in (name, "both"):
            scale = 1 if which == name else 0.5  # both: 0.3 m and 30° between them
            ends[name] = moved(
                canal,
                disk,
                scale * far * shift / np.linalg.norm(shift),
                scale * np.radians(angle) * turn / np.linalg.norm(turn),
            )
    bent = retarget(canal, **ends)
    for name, disk in (("pick", 0), ("place", -1)):
        pose = ends.get(name, np.concatenate([canal.directrix[disk], canal.orientations[disk]]))
        assert np.abs(bent.directrix[disk] - pose[:3]).max() < 1e-9
        assert same_rotation(bent.orientations[disk], pose[3:]) < 1e-9
        # The path comes in along the same direction of the tool.
        turn = (
            Rotation.from_quat(pose[3:], scalar_first=True)
            * Rotation.from_quat(canal.orientations[disk], scalar_first=True).inv()
        )
        assert turn.apply(canal.tangents[disk]) @ bent.tangents[disk] > np.cos(np.radians(2))
        assert bent.radii[disk] == pytest.approx(canal.radii[disk], abs=1e-9)
    cost = shape_cost(canal, bent)
    assert cost.curvature_ratio <= 1.5
    assert cost.n_crossing == 0
    quality = canal_quality(bent)
    assert quality.outside_ball <= 1e-12
    assert quality.tilt_max <= 30
    assert sorted(bent.radii)[-1] == pytest.approx(sorted(canal.radii)[-1], rel=1e-3)
    assert bent.orientation_sd.max() == pytest.approx(canal.orientation_sd.max(), abs=1e-3)


def test_both_ends_as_one_body_move_the_canal_as_that_body():
    canal = hard_canal()
    turn, shift = Rotation.from_rotvec([0.1, -0.2, 0.45]), np.array([0.1, -0.2, 0.05])
    poses = [
        (
            turn.apply(canal.directrix[disk]) + shift,
            (turn * Rotation.from_quat(canal.orientations[disk], scalar_first=True)).as_quat(scalar_first=True),
        )
        for disk in (0, -1)
    ]
    bent = retarget(canal, *poses)
    assert np.abs(turn.apply(canal.directrix) + shift - bent.directrix).max() < 1e-6
    assert np.abs(canal.radii - bent.radii).max() < 1e-6


def test_a_position_alone_keeps_the_orientation():
    canal = hard_canal()
    bent = retarget(canal, place=canal.directrix[-1] + [0.0, 0.1, -0.1])
    assert same_rotation(bent.orientations[[0, -1]], canal.orientations[[0, -1]]) < 1e-9


def test_ellipses_and_wider_radii_are_carried():
    canal = elliptic_canal()
    bent = retarget(canal, place=canal.directrix[-1] + [0.0, 0.1, -0.1])
    assert bent.ellipses is not None
    for disk in (0, -1):
        assert bent.ellipses[disk, 0] == pytest.approx(canal.ellipses[disk, 0], abs=1e-4)
    area = np.mean(canal.ellipses[:, 0] * canal.ellipses[:, 1])
    assert np.mean(bent.ellipses[:, 0] * bent.ellipses[:, 1]) == pytest.approx(area, rel=0.05)
    wide = replace(hard_canal(), radii=hard_canal().radii + 0.02)
    bent = retarget(wide, pick=wide.directrix[0] + [0.05, 0, 0])
    assert bent.radii[0] == pytest.approx(wide.radii[0], abs=1e-9)


def test_planes_move_with_the_tables():
    canal = hard_canal()
    low = SupportPlane((0, 0, 1), canal.directrix[-1, 2] - 0.1 - 0.02)
    bent = retarget(canal, place=canal.directrix[-1] + [0, 0, -0.1], support_planes=(low,))
    assert bent.support_planes == (low,)
    high = SupportPlane((0, 0, 1), canal.directrix[-1, 2])
    with pytest.raises(InputError, match="beyond the support plane"):
        retarget(canal, place=canal.directrix[-1] + [0, 0, -0.1], support_planes=(high,))


@pytest.mark.parametrize("pose", [np.zeros(5), np.full(7, np.nan), np.zeros(7), "here", ([0, 0, 0], [1, 0])])
def test_a_pose_that_is_none_gives_one_line(pose):
    with pytest.raises(InputError, match="place pose"):
        retarget(hard_canal(), place=pose)


def test_too_far_is_met_and_warned_of():
    canal = hard_canal()
    pose = moved(canal, -1, canal.directrix[0] - canal.directrix[-1], [2.8, 0, 0])
    for end in (pose, canal.directrix[-1] + [2.0, 2, 2]):
        bent = retarget(canal, place=end)
        assert np.abs(bent.directrix[-1] - end[:3]).max() < 1e-9
        assert any("at a cost" in line for line in bent.warnings)
