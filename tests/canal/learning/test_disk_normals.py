import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from canal.errors import InputError
from canal.learning.disk_normals import ROOM, continuous_directions, crossings, relax_normals, reversals, tilts
from canal.support_planes import SupportPlane, dips, hold_at_planes


def elbow(bend_radius, step=0.005, straight=60, angle=np.pi / 2):
    turn = np.cumsum(np.full(int(angle * bend_radius / step), step / bend_radius))
    theta = np.concatenate([np.zeros(straight), turn, np.full(straight, angle)])
    tangents = np.column_stack([np.cos(theta), np.sin(theta), 0 * theta])
    points = np.concatenate([np.zeros((1, 3)), np.cumsum(step * 0.5 * (tangents[1:] + tangents[:-1]), axis=0)])
    return points, tangents


def test_disks_that_do_not_cross_keep_the_tangents():
    points, tangents = elbow(0.2)
    assert np.array_equal(relax_normals(points, tangents, np.full(len(points), 0.15)), tangents)


@given(st.floats(0.05, 0.15), st.floats(0.3, 2.3))
@settings(max_examples=30, deadline=None)
def test_an_elbow_is_relaxed_locally_and_crosses_no_more(bend, ratio):
    points, tangents = elbow(bend)
    radii = np.full(len(points), bend * ratio)
    normals = relax_normals(points, tangents, radii)
    assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-12
    assert (np.sum(normals[1:] * normals[:-1], axis=1) > 0).all()
    assert crossings(points, normals, radii).max() <= ROOM
    assert np.degrees(tilts(normals, tangents).max()) < 30
    far = np.abs(np.arange(len(points)) - len(points) / 2) > len(points) / 2 - 5
    if ratio < 1.5:
        assert np.degrees(tilts(normals, tangents)[far].max()) < 1


def test_a_reversal_retraces_its_disks():
    x = np.concatenate([np.linspace(0, 0.5, 50), np.linspace(0.495, 0, 50)])
    points = np.column_stack([x, 0 * x, 0 * x])
    tangents = np.tile([1.0, 0, 0], (100, 1))
    tangents[50:] *= -1
    normals = relax_normals(points, tangents, np.full(100, 0.1))
    assert np.array_equal(normals, np.tile([1.0, 0, 0], (100, 1)))


@pytest.mark.parametrize("bend", [0.005, 0.01, 0.03])
@pytest.mark.parametrize("angle", [2.4, np.pi, 3.6])
def test_disks_retrace_their_way_in_a_hairpin_tighter_than_the_radius(bend, angle):
    points, tangents = elbow(bend, angle=angle, straight=40)
    radii = np.full(len(points), 0.1)
    assert len(reversals(points, tangents, radii)) == 1
    normals = relax_normals(points, tangents, radii)
    assert (np.sum(normals[1:] * normals[:-1], axis=1) > np.cos(np.radians(8))).all()
    assert crossings(points, normals, radii).max() <= ROOM
    assert normals[0] @ tangents[0] > 0.9
    assert normals[-1] @ tangents[-1] < -0.9


def test_an_elbow_tighter_than_the_radius_stays_crossed_and_its_disks_within_30_degrees():
    points, tangents = elbow(0.02)
    radii = np.full(len(points), 0.15)
    assert reversals(points, tangents, radii) == []
    normals = relax_normals(points, tangents, radii)
    assert np.degrees(tilts(normals, tangents).max()) < 30.001
    assert crossings(points, normals, radii).max() > 1


def test_signs_are_continuous():
    vectors = np.array([[1.0, 0, 0], [-1, 0.1, 0], [1, 0.2, 0], [1, 0.3, 0]])
    signed = continuous_directions(vectors)
    assert (signed[:, 0] > 0).all()


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, -1, 0), (1, 0, 0)])
def test_disks_near_a_plane_lie_on_it_and_neighbours_blend(axis):
    # A path that comes down on the plane slantwise, 25° off its normal, in any direction of space.
    m = np.array(axis, dtype=float)
    side = np.roll(m, 1)
    slope = np.radians(25)
    tangent = -np.cos(slope) * m + np.sin(slope) * side
    points = 0.01 * m - np.linspace(0.6, 0, 121)[:, None] * tangent
    tangents = np.tile(tangent, (121, 1))
    radii = np.full(121, 0.12)
    plane = SupportPlane(axis, 0.0)
    assert dips(points, tangents, radii, plane).max() > 0.03
    held: dict = {}
    normals = tangents
    for _ in range(100):
        more = hold_at_planes(points, tangents, normals, radii, (plane,))
        if set(more) <= set(held):
            break
        held |= {s: n for s, n in more.items() if s not in held}
        normals = relax_normals(points, tangents, radii, held)
    assert dips(points, normals, radii, plane).max() <= 1e-9
    assert np.abs(np.abs(normals[-1] @ m) - 1) < 1e-9
    assert crossings(points, normals, radii).max() <= ROOM
    assert np.degrees(tilts(normals, tangents).max()) < 30
    assert tilts(normals, tangents)[0] < 1e-3


def test_a_wall_alongside_leaves_the_disks_as_they_are():
    points = np.column_stack([np.linspace(0, 1, 50), np.zeros(50), np.full(50, 0.05)])
    tangents = np.tile([1.0, 0, 0], (50, 1))
    assert hold_at_planes(points, tangents, tangents, np.full(50, 0.1), (SupportPlane((0, 0, 1), 0.0),)) == {}


def test_a_centre_beyond_a_plane_is_refused():
    points = np.column_stack([np.zeros(5), np.zeros(5), np.linspace(0.1, -0.02, 5)])
    tangents = np.tile([0, 0, -1.0], (5, 1))
    with pytest.raises(InputError, match=r"disk 4 .* 20\.0 mm beyond"):
        hold_at_planes(points, tangents, tangents, np.full(5, 0.01), (SupportPlane((0, 0, 1), 0.0),))


@pytest.mark.parametrize("normal", [(0, 0, 0), (np.nan, 0, 1), (1, 2)])
def test_a_plane_needs_a_direction(normal):
    with pytest.raises(InputError, match="normal"):
        SupportPlane(normal, 0.0)


def test_a_planes_normal_is_made_unit_and_its_offset_with_it():
    plane = SupportPlane((0, 0, 2), 0.9)
    assert plane.normal == (0, 0, 1)
    assert plane.offset == pytest.approx(0.45)
    assert plane.height(np.array([0, 0, 0.5])) == pytest.approx(0.05)
