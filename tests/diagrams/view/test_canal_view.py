"""The canal in a real Meshcat page: drawn once, the markers where we are, the beads where we shall go."""

import numpy as np
import pytest
from canal_examples import NUDGE, NUDGE_AND_STOP, START, quarter_turn, simulate_view
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from waiting import wait_until

from canal.navigation import NavigationState
from diagrams.view.canal_view import CanalView
from diagrams.view.trail_view import POINTS, SEGMENTS, STEP, TrailView

DISTANCE = 1e-6  # [m] the page computes in single precision


class Seen:
    """What the page shows, by path below /drake."""

    def __init__(self, page):
        self._page = page

    def ask(self, path, question):
        return self._page.evaluate(
            f"(path => {{const node = viewer.scene_tree.find(path); return {question}}})", ["drake", *path.split("/")]
        )

    def position(self, path):
        return np.array(self.ask(path, "node.object.position.toArray()"))

    def scale(self, path):
        return np.array(self.ask(path, "node.object.scale.toArray()"))

    def z_axis(self, path):
        """The z axis of a node in its parent."""
        return np.array(
            self.ask(
                path, "(q => [2*(q.x*q.z+q.w*q.y), 2*(q.y*q.z-q.w*q.x), 1-2*(q.x*q.x+q.y*q.y)])(node.object.quaternion)"
            )
        )

    def children(self, path):
        return self.ask(path, "Object.keys(node.children)")

    def visible(self, path):
        return self.ask(path, "Object.keys(node.children).filter(name => node.children[name].object.visible)")

    def geometry(self, path):
        """Identity of what is drawn there: another one after it was sent again."""
        return self.ask(path, "node.children['<object>'].object.uuid")

    def material(self, path, name):
        return self.ask(path, f"node.children['<object>'].object.material.{name}")


def state_of(navigator, simulator) -> NavigationState:
    return navigator.state(navigator.GetMyContextFromRoot(simulator.get_context()))


@pytest.mark.browser
def test_the_page_shows_the_canal_and_the_markers_where_we_are(meshcat_page):
    meshcat, page = meshcat_page
    canal, seen = quarter_turn(), Seen(page)
    simulator, navigator = simulate_view(meshcat, canal, NUDGE_AND_STOP)
    simulator.AdvanceTo(0.05)
    meshcat.Flush()
    wait_until(lambda: len(seen.visible("canal/ahead")) > 5, "the canal")
    drawn = {part: seen.geometry(f"canal/{part}") for part in ("surface", "rings", "directrix", "demonstrations")}
    assert seen.material("canal/surface", "opacity") < 0.5
    assert seen.material("canal/surface", "depthWrite") is False

    simulator.AdvanceTo(1.8)
    meshcat.Flush()
    state = state_of(navigator, simulator)
    assert state.eta > 0.1
    p = canal.point(state.disk, state.eta, state.phi)
    wait_until(lambda: np.allclose(seen.position("canal/point"), p, rtol=0, atol=DISTANCE), "the point in its place")
    x, y = canal.axes(state.disk)
    np.testing.assert_allclose(seen.position("canal/disk"), canal.center(state.disk), atol=DISTANCE)
    np.testing.assert_allclose(seen.scale("canal/disk/size"), np.full(3, canal.radius(state.disk)), atol=DISTANCE)
    np.testing.assert_allclose(seen.z_axis("canal/disk"), np.cross(x, y), atol=1e-6)
    np.testing.assert_allclose(seen.z_axis("canal/x"), x, atol=1e-6)
    np.testing.assert_allclose(seen.z_axis("canal/y"), y, atol=1e-6)
    # Only markers moved.
    assert drawn == {part: seen.geometry(f"canal/{part}") for part in drawn}


@pytest.mark.browser
def test_the_beads_lie_on_the_path_that_is_then_travelled(meshcat_page):
    meshcat, page = meshcat_page
    canal, seen = quarter_turn(), Seen(page)
    simulator, navigator = simulate_view(meshcat, canal, NUDGE)
    simulator.AdvanceTo(1.6)
    meshcat.Flush()
    wait_until(lambda: len(seen.visible("canal/ahead")) > 5, "the beads")
    beads = np.array([seen.position(f"canal/ahead/{name}") for name in seen.visible("canal/ahead")])
    travelled = []

    def keep(root):
        state = state_of(navigator, simulator)
        travelled.append(canal.point(state.disk, state.eta, state.phi))

    simulator.set_monitor(keep)
    simulator.AdvanceTo(8.0)  # to pick, where it waits
    travelled = np.array(travelled)
    steps = np.linalg.norm(np.diff(travelled, axis=0), axis=1).max()
    nearest = np.linalg.norm(beads[:, None] - travelled[None], axis=2).min(axis=1)
    assert nearest.max() < steps
    wait_until(lambda: not seen.visible("canal/ahead"), "the last bead to be passed")


@pytest.mark.browser
def test_colours_of_the_disks_and_a_base_that_stands_elsewhere(meshcat_page):
    meshcat, page = meshcat_page
    canal, seen = quarter_turn(), Seen(page)
    colors = np.stack([np.linspace(0, 1, 101), np.zeros(101), np.ones(101)], axis=1)
    simulator, _ = simulate_view(meshcat, canal, START, disk_colors=colors, X_WB=RigidTransform([1.0, 2.0, 0.0]))
    simulator.AdvanceTo(0.1)
    meshcat.Flush()
    wait_until(lambda: len(seen.visible("canal/ahead")) > 5, "the canal")
    assert seen.material("canal/surface", "vertexColors") is True
    np.testing.assert_allclose(seen.position("canal"), [1, 2, 0])
    assert 0 < seen.material("canal/surface", "opacity") < 1
    casting = "(() => {let n = 0; node.object.traverse(one => n += one.isMesh && one.castShadow ? 1 : 0); return n})()"
    assert seen.ask("canal", casting) == 0


def test_a_state_that_is_not_finite_moves_nothing(meshcat):
    canal = quarter_turn()
    view = CanalView(meshcat, canal)
    context = view.CreateDefaultContext()
    view.GetInputPort("navigation_state").FixValue(
        context, np.full(view.GetInputPort("navigation_state").size(), np.nan)
    )
    before = context.get_discrete_state(0).value().copy()
    discrete = view.AllocateDiscreteVariables()
    view.CalcForcedDiscreteVariableUpdate(context, discrete)
    np.testing.assert_array_equal(discrete.value(0), before)


@pytest.mark.browser
def test_the_trail_follows_the_tool_and_forgets_its_beginning(meshcat_page):
    meshcat, page = meshcat_page
    seen = Seen(page)
    view = TrailView(meshcat)
    simulator = Simulator(view)
    position = np.array([0.0, 0, 1])

    def run(seconds):
        view.GetInputPort("X_BT").FixValue(simulator.get_mutable_context(), [*position, 1, 0, 0, 0])
        simulator.AdvanceTo(simulator.get_context().get_time() + seconds)

    for _ in range((SEGMENTS + 3) * POINTS):
        position[0] += 1.2 * STEP
        run(1 / 16)
    segment = simulator.get_context().get_discrete_state(0).value().copy()
    position[:] = np.nan
    run(0.5)
    np.testing.assert_array_equal(simulator.get_context().get_discrete_state(0).value(), segment)
    position[:] = 0, 0, 3
    run(0.5)
    begun, count = simulator.get_context().get_discrete_state(0).value()[:2]
    assert (begun, count) == (segment[0] + 1, 1)  # a jump is not joined to what was
    meshcat.Flush()
    wait_until(lambda: len(seen.children("trail")) > SEGMENTS, "the trail")
    wait_until(lambda: len(seen.visible("trail")) == SEGMENTS, "the oldest segments to be hidden")
