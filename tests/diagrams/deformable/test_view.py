"""The fine surface reaches Meshcat, and a recording keeps a frame a path."""

import numpy as np
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlant, MultibodyPlantConfig
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from diagrams.deformable.items import add_deformable_item
from diagrams.deformable.laundry import make_shape
from diagrams.deformable.view import DeformableView


class Canvas:
    """Stands in for Meshcat's three calls, and keeps what they were given."""

    def __init__(self):
        self.moves: list[tuple[str, RigidTransform, float]] = []
        self.meshes: dict[str, np.ndarray] = {}
        self.kept = np.empty((0, 3))
        """The surface that the view takes for drawn, at the end."""
        self.shown: list[tuple[str, bool, float]] = []

    def SetTriangleColorMesh(self, *, path, vertices, faces, colors):
        assert faces.max() < vertices.shape[1] == colors.shape[1]
        self.meshes[path] = vertices.T

    def SetProperty(self, path, name, value, time):
        assert name == "visible"
        self.shown.append((path, value, time))

    def SetTransform(self, path, X_ParentPath, time_in_recording):
        self.moves.append((path, X_ParentPath, time_in_recording))


def falling_sock(canvas, recording, until, spin=0.0):
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlant(MultibodyPlantConfig(time_step=0.005), builder)
    sock = add_deformable_item(plant=plant, name="sock", shape=make_shape("sock"), X_WP=RigidTransform([0, 0, 1.0]))
    plant.Finalize()
    view = builder.AddSystem(DeformableView(items=[sock], meshcat=canvas, recording=recording))
    builder.Connect(scene_graph.get_query_output_port(), view.GetInputPort("query_object"))
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    start = plant.deformable_model().GetPositions(context, sock.body_id)
    turning = spin * np.cross([0.0, 0.0, 1.0], (start - start.mean(axis=1, keepdims=True)).T)
    plant.deformable_model().SetPositionsAndVelocities(context, sock.body_id, start, turning.T)
    simulator.AdvanceTo(until)
    nodes = plant.deformable_model().GetPositions(plant.GetMyContextFromRoot(simulator.get_context()), sock.body_id).T
    if isinstance(canvas, Canvas):
        kept = view.GetMyContextFromRoot(simulator.get_context()).get_discrete_state(0).value().reshape(-1, 3)
        canvas.kept = sock.shape.surface.positions(kept)
    return sock.shape.surface.positions(nodes)


def test_the_surface_is_drawn_where_the_solid_is():
    canvas = Canvas()
    surface = falling_sock(canvas, recording=False, until=0.2)
    assert set(canvas.meshes) == {"deformable/sock"}
    np.testing.assert_allclose(canvas.meshes["deformable/sock"], surface, atol=5e-3 + 1e-3)


def test_what_it_takes_for_drawn_is_what_it_drew():
    canvas = Canvas()
    falling_sock(canvas, recording=True, until=0.25, spin=30.0)
    np.testing.assert_array_equal(canvas.kept, list(canvas.meshes.values())[-1])


def test_a_recording_moves_what_does_not_bend_and_redraws_what_does():
    falls, spins = Canvas(), Canvas()
    surface = falling_sock(falls, recording=True, until=0.5)
    assert set(falls.meshes) == {"deformable/sock/0"}
    path, X, time = falls.moves[-1]
    assert (path, time) == ("deformable/sock/0", 0.5)
    np.testing.assert_allclose(X.multiply(falls.meshes[path].T).T, surface, atol=3e-3)
    falling_sock(spins, recording=True, until=0.5, spin=30.0)
    assert len(spins.meshes) > 2


def test_a_recording_shows_one_surface_at_a_time():
    canvas = Canvas()
    falling_sock(canvas, recording=True, until=0.5, spin=30.0)
    visible: set[str] = set()
    times = sorted({t for _, _, t in canvas.shown if t > 0.0})
    for time in times:
        for path, shown, when in canvas.shown:
            if when == time:
                (visible.add if shown else visible.discard)(path)
        assert len(visible - {"deformable/sock/0"}) == 1
    hidden_at_start = {path for path, shown, when in canvas.shown if when == 0.0 and not shown}
    assert hidden_at_start == set(canvas.meshes) - {"deformable/sock/0"}


def test_meshcat_takes_it():
    meshcat = Meshcat(MeshcatParams(host="localhost"))
    falling_sock(meshcat, recording=False, until=0.05)
    assert meshcat.HasPath("deformable/sock")
