"""Laws of the solids and of the surfaces that hang on them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from canal.errors import InputError
from diagrams.deformable.items import node_masses
from diagrams.deformable.laundry import DEFORMABLE_KINDS, make_shape
from diagrams.deformable.tet_mesh import TetBuilder, Tube, embed

KINDS = sorted(DEFORMABLE_KINDS)


def edges_seen_once_each_way(triangles: np.ndarray) -> bool:
    """Whether a surface is closed and consistently oriented: each directed edge once, and its reverse once."""
    directed = {(int(t[i]), int(t[(i + 1) % 3])) for t in triangles for i in range(3)}
    return len(directed) == 3 * len(triangles) and all((b, a) in directed for a, b in directed)


def enclosed_volume(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


@pytest.mark.parametrize("kind", KINDS)
def test_tetrahedra_are_positive_sound_and_few(kind):
    mesh = make_shape(kind).mesh
    volumes = mesh.volumes()
    assert 60 <= len(mesh.tetrahedra) <= 300
    assert volumes.min() > 0.15 * volumes.mean()
    assert len(np.unique(mesh.tetrahedra)) == len(mesh.vertices)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("segments", [0, 9])
def test_boundary_is_a_closed_sphere_around_the_volume(kind, segments):
    mesh = make_shape(kind, segments=segments).mesh
    boundary = mesh.boundary()
    assert edges_seen_once_each_way(boundary)
    assert len(np.unique(boundary)) - 3 * len(boundary) // 2 + len(boundary) == 2  # V - E + F
    assert enclosed_volume(mesh.vertices, boundary) == pytest.approx(mesh.volumes().sum(), rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_there_are_nodes_inside(kind):
    """Without depth below the surface Drake cannot tell how deep two deformable bodies overlap."""
    mesh = make_shape(kind).mesh
    assert len(np.unique(mesh.boundary())) <= len(mesh.vertices) - 4


@pytest.mark.parametrize("kind", KINDS)
def test_drawn_surface_is_closed_and_fills_the_solid(kind):
    shape = make_shape(kind)
    surface = shape.surface
    points = surface.positions(shape.mesh.vertices)
    assert edges_seen_once_each_way(surface.triangles)
    assert enclosed_volume(points, surface.triangles) == pytest.approx(shape.mesh.volumes().sum(), rel=0.3)
    assert surface.colors.min() >= 0.0
    assert surface.colors.max() <= 1.0


@pytest.mark.parametrize("kind", KINDS)
def test_drawn_surface_moves_as_the_solid_does(kind):
    shape = make_shape(kind)
    rest = shape.surface.positions(shape.mesh.vertices)
    np.testing.assert_allclose(shape.surface.weights.sum(axis=1), 1.0, atol=1e-12)
    rng = np.random.default_rng(1)
    linear, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    moved = shape.surface.positions(shape.mesh.vertices @ linear.T + shift)
    np.testing.assert_allclose(moved, rest @ linear.T + shift, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_embedding_is_exact(seed):
    mesh = make_shape("towel").mesh
    rng = np.random.default_rng(seed)
    inside = np.einsum(
        "nk,nki->ni",
        rng.dirichlet(np.ones(4), 20),
        mesh.vertices[mesh.tetrahedra[rng.integers(0, len(mesh.tetrahedra), 20)]],
    )
    outside = rng.uniform(-0.2, 0.2, (5, 3))
    points = np.vstack([inside, outside])
    corners, weights = embed(mesh, points)
    np.testing.assert_allclose(np.einsum("nk,nki->ni", weights, mesh.vertices[corners]), points, atol=1e-12)
    assert weights[:20].min() > -1e-9


def test_a_straight_tube_has_the_volume_of_its_box_and_blunt_ends():
    tube = Tube.bent(np.zeros(3), 0.3, lambda s: 0.0 * s, lambda s: 0.04 + 0.0 * s, lambda s: 0.03 + 0.0 * s)
    builder = TetBuilder()
    builder.add_tube(tube, 5)
    frustum = (1.0 + 0.6 + 0.6**2) / 3.0  # of the box that it is cut from
    assert builder.mesh().volumes().sum() == pytest.approx(0.06 * 0.886**2 * 0.08 * 0.06 * (3 + 2 * frustum), rel=1e-9)


def test_kinds_differ_in_size_and_weigh_like_laundry():
    shapes = [make_shape(kind) for kind in ("sock", "tshirt", "towel")]
    assert np.all(np.diff([s.mesh.volumes().sum() for s in shapes[:2]]) > 0)
    for shape in shapes:
        assert 0.04 < shape.mass < 0.5
        assert node_masses(shape).sum() == pytest.approx(shape.mass, rel=1e-12)
        assert 80.0 < shape.density() < 300.0


def test_vtk_text_counts_what_it_lists():
    mesh = make_shape("sock").mesh
    lines = mesh.to_vtk().splitlines()
    n, m = len(mesh.vertices), len(mesh.tetrahedra)
    assert lines[4] == f"POINTS {n} double"
    assert lines[5 + n] == f"CELLS {m} {5 * m}"
    assert lines[-m:] == ["10"] * m


def test_unknown_kind_names_those_that_are():
    with pytest.raises(InputError, match="'hat' does not exist; use one of sock, tshirt, towel"):
        make_shape("hat")
