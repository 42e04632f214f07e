"""Triangles of the canal's pictures: closed where they should be, and where the canal is."""

from dataclasses import replace

import numpy as np
import pytest
from canal_examples import quarter_turn
from hypothesis import given
from hypothesis import strategies as st

from diagrams.view.canal_meshes import arrow, bead, canal_rings, canal_skin, dashes, disc, disk_rims, merge, ring, tube


def edges(mesh):
    """How many triangles share each edge."""
    pairs = np.sort(np.hstack([mesh.faces[[0, 1]], mesh.faces[[1, 2]], mesh.faces[[2, 0]]]), axis=0)
    return np.unique(pairs, axis=1, return_counts=True)[1]


def test_a_ring_is_a_closed_torus():
    mesh = ring(0.1, 32, 6)
    assert (edges(mesh) == 2).all()
    assert mesh.vertices.shape[1] - len(edges(mesh)) + mesh.faces.shape[1] == 0  # Euler's number of a torus
    radius = np.hypot(*mesh.vertices[:2])
    np.testing.assert_allclose(np.hypot(radius - 1, mesh.vertices[2]), 0.1, atol=1e-12)


def volume(mesh):
    """Enclosed by a closed mesh; positive when its faces look outwards."""
    a, b, c = (mesh.vertices[:, face].T for face in mesh.faces)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def test_closed_bodies_look_outwards():
    # Meshcat draws only the outer side of closed bodies.
    canal = quarter_turn()
    mirrored = replace(canal, y_axes=-canal.y_axes)
    line = np.stack([np.linspace(0, 1, 20)] * 3, axis=1)
    assert volume(tube(line, 0.1, 64)) == pytest.approx(np.pi * 0.01 * np.sqrt(3), rel=0.02)
    assert volume(ring(0.1)) == pytest.approx(2 * np.pi * np.pi * 0.01, rel=0.15)
    assert volume(bead(64)) == pytest.approx(4 / 3 * np.pi, rel=0.01)
    for closed in (arrow(), dashes(line, 0.01, 0.1, 0.1), *(canal_rings(c, [3, 50], 0.001) for c in (canal, mirrored))):
        assert volume(closed) > 0


def test_a_disc_covers_the_unit_circle():
    mesh = disc(128)
    a, b, c = (mesh.vertices[:, face] for face in mesh.faces)
    areas = 0.5 * np.cross((b - a).T, (c - a).T)
    assert (areas[:, 2] > 0).all()
    assert areas[:, 2].sum() == pytest.approx(np.pi, rel=1e-3)


def test_an_arrow_has_length_one():
    mesh = arrow()
    np.testing.assert_allclose([mesh.vertices[2].min(), mesh.vertices[2].max()], [0, 1])


@given(st.lists(st.tuples(*[st.floats(-1, 1)] * 3), min_size=2, max_size=12))
def test_a_tube_stays_at_its_radius_whatever_the_polyline(points):
    points = np.array(points)
    mesh = tube(points, 0.01, 6)
    assert np.isfinite(mesh.vertices).all()
    distance = np.linalg.norm(mesh.vertices.T.reshape(len(points) + 2, 6, 3)[1:-1] - points[:, None], axis=2)
    assert (distance <= 0.01 + 1e-9).all()


def test_dashes_lie_on_the_line_and_leave_gaps():
    line = np.stack([np.linspace(0, 1, 50), np.zeros(50), np.zeros(50)], axis=1)
    mesh = dashes(line, 0.01, 0.06, 0.04)
    distance = np.hypot(*mesh.vertices[1:])
    np.testing.assert_allclose(distance[distance > 1e-9], 0.01)
    assert not ((mesh.vertices[0] % 0.1 > 0.0601) & (mesh.vertices[0] % 0.1 < 0.0999)).any()


def test_merging_keeps_every_triangle():
    one, two = ring(0.1, 8, 3), disc(5)
    both = merge([one, two])
    n = one.faces.shape[1]
    np.testing.assert_array_equal(both.vertices[:, both.faces[0, n:]], two.vertices[:, two.faces[0]])
    assert both.faces.shape[1] == n + two.faces.shape[1]


def test_the_skin_lies_on_the_rims():
    canal = quarter_turn()
    disks = np.array([0, 50, 100])
    vertices = canal_skin(canal, disks, 16).vertices.T.reshape(3, 16, 3)
    offset = vertices - canal.directrix[disks][:, None]
    np.testing.assert_allclose(np.linalg.norm(offset, axis=2), np.broadcast_to(canal.radii[disks][:, None], (3, 16)))
    np.testing.assert_allclose(np.einsum("dij,dj->di", offset, canal.normals[disks]), 0, atol=1e-12)


def test_rings_of_a_canal_without_extent_are_finite():
    canal = replace(quarter_turn(), radii=np.zeros(101))
    assert np.isfinite(canal_rings(canal, np.array([0, 40]), 0.001).vertices).all()
    assert np.isfinite(canal_skin(canal, np.array([0, 40])).vertices).all()


def test_rims_end_where_an_ellipse_ends():
    canal = replace(quarter_turn(), ellipses=np.tile([0.05, 0.02, 0.3], (101, 1)))
    offset = np.linalg.norm(disk_rims(canal, np.array([10]), 256)[0] - canal.directrix[10], axis=1)
    np.testing.assert_allclose([offset.max(), offset.min()], [0.05, 0.02], rtol=1e-3)
