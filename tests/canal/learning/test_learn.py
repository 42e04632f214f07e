"""Learning: its laws under hard demonstrations, closed forms, and what it refuses."""

from itertools import permutations

import numpy as np
import pytest
from canals import DOCUMENTED, hard_canal
from hard_demonstrations import EASY, SHAPES, Hardness, hard_demonstrations
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from canal.demonstration import Demonstration
from canal.errors import InputError
from canal.learning.disk_normals import ROOM
from canal.learning.learn import disk_count, learn_canal, unit_tangents
from canal.learning_options import LearningOptions
from canal.quality import canal_quality, deviations, undershoot
from canal.support_planes import SupportPlane, dips

# A set of demonstrations is told by its arguments; shrinking them takes minutes and says no more.
NO_SHRINKING = (Phase.explicit, Phase.reuse, Phase.generate)

hardness = st.builds(
    Hardness,
    pauses=st.booleans(),
    repeats=st.sampled_from([0.0, 0.05]),
    jumps=st.integers(0, 4),
    noise=st.sampled_from([0.0, 1e-4]),
    tremor=st.floats(0.0, 0.01),
    hesitations=st.integers(0, 2),
    locked_axis=st.booleans(),
    spread=st.floats(0.0, 0.3),
    pinch=st.floats(0.0, 0.02),
    disagreement=st.floats(0.0, 40.0),
    sign_flips=st.integers(0, 3),
)
sets = st.builds(hard_demonstrations, st.integers(0, 10_000), st.integers(2, 10), st.sampled_from(SHAPES), hardness)


@given(sets)
@settings(max_examples=40, deadline=None, phases=NO_SHRINKING)
def test_laws_of_a_canal_from_any_hands(demonstrations):
    canal = learn_canal(demonstrations)
    quality = canal_quality(canal)
    for name in DOCUMENTED:
        assert np.isfinite(getattr(canal, name)).all(), name
    for name in ("tangents", "normals", "x_axes", "y_axes", "orientations"):
        assert np.abs(np.linalg.norm(getattr(canal, name), axis=-1) - 1).max() < 1e-12, name
    for a, b in (("x_axes", "y_axes"), ("x_axes", "normals"), ("y_axes", "normals")):
        assert np.abs(np.sum(getattr(canal, a) * getattr(canal, b), axis=1)).max() < 1e-12
    for name in ("normals", "x_axes", "y_axes", "orientations"):
        field = getattr(canal, name)
        assert (np.sum(field[1:] * field[:-1], axis=1) > 0).all(), name
    quaternions = canal.demonstration_orientations
    assert (np.sum(quaternions[:, 1:] * quaternions[:, :-1], axis=2) > 0).all()
    assert quality.outside_ball <= 1e-12
    assert np.abs(canal.directrix - canal.demonstrations.mean(axis=0)).max() == 0
    assert canal.n_disks % 2 == 1
    assert 200 <= canal.n_disks <= 1001
    assert (canal.orientation_weights > 0).all()
    assert canal.orientation_weights.max() <= np.exp(9 * 0.3)
    # Home is half of the arc of the curve; a chord across a cusp is shorter than its arc by up to a disk's spacing.
    assert canal.arc[canal.home_disk] == pytest.approx(canal.length / 2, abs=canal.length / (canal.n_disks - 1) / 2)
    assert quality.end_share_max <= 1.15
    # Ten natural cubics cut a full turn of 0.3 m short by up to 5 mm; tasks have no such turns at their lowest.
    allowed = 0.001 if demonstrations[0].name.startswith("pick_and_place") else 0.005
    assert undershoot(canal, [d.position for d in demonstrations]) <= allowed
    if canal.warnings == ():
        assert quality.n_crossing == 0
        assert quality.tilt_max <= 30
        assert quality.crossing <= ROOM


@pytest.mark.parametrize("seed", [*range(8), 24])  # the last is the worst of thirty
def test_pick_and_place_meets_the_figures(seed):
    demonstrations = hard_demonstrations(seed, 2 + seed % 4)
    canal = learn_canal(demonstrations)
    quality = canal_quality(canal)
    assert canal.warnings == ()
    assert quality.crossing <= ROOM
    assert quality.step_ratio_max <= 2.0
    assert quality.tangent_error_p99 <= 1.5
    assert quality.x_turn_max <= 8
    assert quality.y_turn_max <= 8
    rms = [np.sqrt(np.mean(deviations(canal, d.position) ** 2)) for d in demonstrations]
    assert max(rms) <= 0.008


@pytest.mark.parametrize("n", [2, 3, 4])
def test_the_order_of_demonstrations_changes_no_bit(n):
    demonstrations = hard_demonstrations(5, n)
    first = learn_canal(demonstrations)
    for order in permutations(demonstrations):
        again = learn_canal(list(order))
        assert all(np.array_equal(getattr(first, name), getattr(again, name)) for name in DOCUMENTED)
        assert first.moving_time_s == again.moving_time_s


@given(st.integers(0, 1000), st.integers(2, 5), st.sampled_from(SHAPES))
@settings(max_examples=20, deadline=None, phases=NO_SHRINKING)
def test_learning_commutes_with_rigid_motion(seed, n, shape):
    rng = np.random.default_rng(seed)
    turn, shift = Rotation.random(random_state=np.random.RandomState(seed)), rng.uniform(-1, 1, 3)
    demonstrations = hard_demonstrations(seed, n, shape)
    moved = [
        Demonstration(
            turn.apply(d.position) + shift,
            (turn * Rotation.from_quat(d.orientation, scalar_first=True)).as_quat(scalar_first=True),
            d.time,
            d.name,
        )
        for d in demonstrations
    ]
    canal = learn_canal(demonstrations)
    other = learn_canal(moved, LearningOptions(x_global=tuple(turn.apply([1.0, 0, 0]))))
    assert np.abs(turn.apply(canal.directrix) + shift - other.directrix).max() < 1e-9
    assert np.abs(canal.radii - other.radii).max() < 1e-9
    for name in ("tangents", "normals", "x_axes", "y_axes"):
        assert np.abs(turn.apply(getattr(canal, name)) - getattr(other, name)).max() < 1e-9, name
    back = (turn.inv() * Rotation.from_quat(other.orientations, scalar_first=True)).as_quat(scalar_first=True)
    assert np.abs(np.abs(np.sum(back * canal.orientations, axis=1)) - 1).max() < 1e-9
    assert np.abs(canal.orientation_sd - other.orientation_sd).max() < 1e-9


@pytest.mark.parametrize("seed", range(3))
def test_a_tenth_of_a_millimetre_of_noise_moves_the_directrix_by_less_than_one(seed):
    rng = np.random.default_rng(seed)
    demonstrations = hard_demonstrations(seed, 2 + seed)
    canal = learn_canal(demonstrations)
    noisy = [
        Demonstration(d.position + 1e-4 * rng.normal(size=d.position.shape), d.orientation, d.time, d.name)
        for d in demonstrations
    ]
    other = learn_canal(noisy, LearningOptions(n_disks=canal.n_disks))
    assert np.linalg.norm(other.directrix - canal.directrix, axis=1).max() < 1e-3


def test_identical_demonstrations_give_a_canal_without_width():
    one = hard_demonstrations(1, 2)[0]
    canal = learn_canal([one, one])
    assert canal.radii.max() < 1e-12
    assert np.array_equal(canal.tangents, canal.normals)
    assert canal.orientation_sd.max() < 1e-7
    assert canal.orientation_weights.max() == pytest.approx(np.exp(2.7))


def test_four_samples_are_enough():
    corners = np.array([[0.0, 0, 0.4], [0, 0.2, 0.6], [0, 0.5, 0.6], [0, 0.7, 0.4]])
    quaternion = np.tile([1.0, 0, 0, 0], (4, 1))
    canal = learn_canal([Demonstration(corners, quaternion), Demonstration(corners + [0.05, 0, 0], quaternion)])
    assert np.abs(canal.directrix[[0, -1]] - corners[[0, -1]] - [0.025, 0, 0]).max() < 1e-9
    assert canal.radii == pytest.approx(0.025, abs=1e-9)


def test_a_closed_loop_begins_and_ends_at_one_place():
    demonstrations = hard_demonstrations(2, 3, "loop", EASY)
    canal = learn_canal(demonstrations)
    assert np.linalg.norm(canal.directrix[0] - canal.directrix[-1]) < 0.01
    assert canal.length > 1


def test_repeats_pauses_and_sign_flips_hardly_matter():
    clean = hard_demonstrations(7, 2, hardness=EASY)
    dirty = []
    for d in clean:
        n = len(d) // 2
        rows = np.concatenate([[0] * 60, np.arange(n), [n] * 80, np.repeat(np.arange(n, len(d)), 1), [len(d) - 1] * 90])
        quaternion = d.orientation[rows].copy()
        quaternion[100:] *= -1
        dirty.append(Demonstration(d.position[rows], quaternion))
    a, b = (learn_canal(s, LearningOptions(n_disks=201)) for s in (clean, dirty))
    assert np.linalg.norm(a.directrix - b.directrix, axis=1).max() < 0.006
    assert a.moving_time_s == pytest.approx(b.moving_time_s, rel=0.1)


def test_what_is_refused():
    a, b = hard_demonstrations(1, 2)
    with pytest.raises(InputError, match="at least two"):
        learn_canal([a])
    with pytest.raises(InputError, match="at least two"):
        learn_canal([])
    still = Demonstration(np.tile([0.1, 0.2, 0.3], (50, 1)), np.tile([1.0, 0, 0, 0], (50, 1)), name="still")
    with pytest.raises(InputError, match="still: no motion"):
        learn_canal([a, still])
    lost = a.position.copy()
    lost[len(a) // 2] += 0.5
    with pytest.raises(InputError, match=rf"lost: jumps by 8\d\d mm at sample {len(a) // 2}"):
        learn_canal([b, Demonstration(lost, a.orientation, name="lost")])
    backwards = Demonstration(b.position[::-1], b.orientation[::-1], name="backwards")
    with pytest.raises(InputError, match="opposite direction"):
        learn_canal([a, backwards])
    with pytest.raises(InputError, match="beyond the support plane"):
        learn_canal([a, b], LearningOptions(support_planes=(SupportPlane((0, 0, 1), 2.0),)))


@pytest.mark.parametrize(
    "bad",
    [
        {"step": 0.0},
        {"step": 2.0},
        {"band": np.nan},
        {"margin": -0.01},
        {"margin": np.inf},
        {"n_disks": 200},
        {"y_window": 0},
        {"x_global": (0, 0, 0)},
    ],
)
def test_options_name_value_and_bound(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        LearningOptions(**bad)


def test_wide_disagreement_in_orientation_is_warned_of_with_where():
    wide = learn_canal(hard_demonstrations(3, 2, hardness=Hardness(disagreement=240.0)))
    assert any("disagree in orientation" in line and "at disk" in line for line in wide.warnings)


def test_margin_and_containing_every_raw_sample():
    demonstrations = hard_demonstrations(4, 2)
    plain = learn_canal(demonstrations)
    wider = learn_canal(demonstrations, LearningOptions(margin=0.01))
    assert wider.radii - plain.radii == pytest.approx(0.01, abs=1e-15)
    full = learn_canal(demonstrations, LearningOptions(contain_raw=True))
    raw = np.concatenate([d.position for d in demonstrations])
    inside = np.linalg.norm(raw[:, None] - full.directrix[None], axis=2) <= full.radii + 1e-12
    assert inside.any(axis=1).all()
    assert (full.radii >= plain.radii).all()


def test_interpolation_as_in_the_paper_is_an_option():
    demonstrations = hard_demonstrations(4, 2)
    squares = learn_canal(demonstrations)
    through = learn_canal(demonstrations, LearningOptions(interpolate=True))
    assert np.abs(through.directrix[[0, -1]] - squares.directrix[[0, -1]]).max() < 1e-9
    raw = demonstrations[0].position
    assert np.mean(deviations(squares, raw) ** 2) < np.mean(deviations(through, raw) ** 2)


def test_a_table_is_respected_by_disks_and_points():
    demonstrations = hard_demonstrations(10, 4)
    low = min(d.position[:, 2].min() for d in demonstrations) - 0.004
    plane = SupportPlane((0, 0, 1), low)
    before = learn_canal(demonstrations)
    assert dips(before.directrix, before.normals, before.radii, plane).max() > 0.001
    canal = learn_canal(demonstrations, LearningOptions(support_planes=(plane,)))
    quality = canal_quality(canal)
    assert dips(canal.directrix, canal.normals, canal.radii, plane).max() <= 1e-9
    assert quality.crossing <= ROOM
    assert quality.tilt_max <= 30
    assert np.array_equal(before.directrix, canal.directrix)
    assert np.array_equal(before.radii, canal.radii)
    lowest = min(
        canal.point(s, 1.0, phi)[2] for s in (0, 0.5, 3.7, canal.n_disks - 1) for phi in np.arange(0, 6.3, 0.1)
    )
    assert lowest >= low - 1e-9


def test_disks_are_even_and_home_is_one():
    assert disk_count(0.1) == 201
    assert disk_count(1.5) == 301
    assert disk_count(1.508) == 303
    assert disk_count(80.0) == 1001
    canal = hard_canal()
    steps = np.linalg.norm(np.diff(canal.directrix, axis=0), axis=1)
    assert np.ptp(steps) / steps.mean() < 1e-3


def test_a_derivative_that_vanishes_takes_its_neighbours_direction():
    found = unit_tangents(np.array([[0.0, 0, 0], [0, 2, 0], [0, 0, 0], [0, 0, 3]]))
    assert np.array_equal(found, [[0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 0, 1]])
