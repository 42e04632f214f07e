"""What cameras see of a deformable item: fine, coloured, within the solid that carries it, and carried along."""

import numpy as np
import pytest
from pydrake.geometry import ReadObjToTriangleSurfaceMesh
from pydrake.systems.framework import DiagramBuilder

from diagrams.deformable.laundry import DEFORMABLE_KINDS, make_shape
from diagrams.deformable.render_mesh import write_render_mesh
from diagrams.deformable.tet_mesh import embed
from diagrams.scenario import load_scenario, with_items
from diagrams.station.lio_station import LioStation
from diagrams.view.cameras import add_camera, look_at


@pytest.mark.parametrize("kind", DEFORMABLE_KINDS)
def test_the_surface_lies_within_the_solid(kind, tmp_path):
    shape = make_shape(kind)
    write_render_mesh(shape, tmp_path / "garment.obj")
    mesh = ReadObjToTriangleSurfaceMesh(str(tmp_path / "garment.obj"))
    assert mesh.num_triangles() == len(shape.surface.triangles) > 3 * len(shape.mesh.tetrahedra)
    points = np.array([mesh.vertex(i) for i in range(mesh.num_vertices())])
    assert embed(shape.mesh, points)[1].min() > 0
    colors = {line for line in (tmp_path / "garment.mtl").read_text().splitlines() if line[:2] == "Kd"}
    assert len(colors) > 2


def test_a_filmed_item_shows_more_than_one_colour():
    pictures = []
    for filmed in (False, True):
        builder = DiagramBuilder()
        station = LioStation.AddToBuilder(
            builder=builder, world=with_items(load_scenario("laundry"), "soft"), filmed=filmed
        )
        x, y, z = station.X_WB.multiply([0.475, 0.15, 0.33])  # the sock
        camera = add_camera(
            builder=builder, station=station, X=look_at((x, y - 0.05, z + 0.2), (x, y, z)), size=(64, 48), fov_deg=30
        )
        diagram = builder.Build()
        context = camera.GetMyContextFromRoot(diagram.CreateDefaultContext())
        pictures.append(np.array(camera.GetOutputPort("color_image").Eval(context).data[:, :, :3], dtype=int))
    plain, fine = pictures
    # In its mean colour a sock in red and white is pink all over.
    red, white = ((fine[:, :, 0] - fine[:, :, 1] > 120).sum(), (fine.min(axis=2) > 140).sum())
    assert red > 20
    assert white > 20
    assert (plain[:, :, 0] - plain[:, :, 1] > 120).sum() == 0
