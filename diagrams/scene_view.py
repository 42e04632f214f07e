"""A station in Meshcat: robot, fixtures and rigid items by Drake, deformable ones by our own finer surface."""

from __future__ import annotations

from pydrake.geometry import Meshcat, MeshcatVisualizer, MeshcatVisualizerParams
from pydrake.systems.framework import DiagramBuilder

from diagrams.deformable.view import DeformableView
from diagrams.station.lio_station import LioStation


def show_scene(builder: DiagramBuilder, station: LioStation, meshcat: Meshcat, name: str) -> None:
    """Draw robot, fixtures and items.

    Args:
        builder: of the diagram that it is added to.
        station: that is shown.
        meshcat: where.
        name: of what it is for: `view` or `recording`.
    """
    query = station.GetOutputPort("geometry_query")
    visualizer = builder.AddNamedSystem(f"scene_{name}", MeshcatVisualizer(meshcat, MeshcatVisualizerParams()))
    builder.Connect(query, visualizer.query_object_input_port())
    deformable = station.scene.deformable_items
    if deformable:
        deformable_view = DeformableView(items=deformable, meshcat=meshcat, recording=name == "recording")
        view = builder.AddNamedSystem(f"deformable_{name}", deformable_view)
        builder.Connect(query, view.GetInputPort("query_object"))
