"""How fast a run is, beside bare Drake in the same process: a ratio, since machines differ and are shared.

The bare scene is the same plant with the same bodies, the robot held by its drives, and none of our systems; nothing
in it sleeps. Both are advanced in turns, half a second of the run and a tenth of the bare scene, in processor time.
"""

from __future__ import annotations

import time

import numpy as np
from pydrake.multibody.plant import AddMultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, DiagramBuilder

from benchmarks.acceptance.check import Check, Figures, Job, Worst, at_least
from canal.navigation.joystick import in_step
from diagrams.deformable.contact import prepare_for_cloth
from diagrams.scenario import Scenario, load_scenario, with_items
from diagrams.scene.scene import add_scene
from diagrams.shared_autonomy import build_shared_autonomy
from diagrams.station.lio_station import make_drive, plant_config, set_drives
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate

TURN_S, BARE_S = 0.5, 0.1
LEAST = 0.95
"""Times bare Drake: what our systems cost is to be won back, but for a twentieth, by letting sleep what lies still."""


def bare_scene(scenario: Scenario, q0: np.ndarray) -> Simulator:
    """The scene with the robot held where it is, items as they lie."""
    builder = DiagramBuilder()
    deformable = any(item.kind == "soft" for item in scenario.items)
    plant, scene_graph = AddMultibodyPlant(plant_config(scenario.contact.for_items(deformable)), builder)
    scene = add_scene(plant=plant, scene_graph=scene_graph, world=scenario, seed=0, filmed=False)
    set_drives(plant, scene.lio)
    plant.set_gravity_enabled(scene.lio, False)
    if scene.deformable_items:
        machine = scene.fixtures.get("machine", [])
        prepare_for_cloth(plant=plant, scene_graph=scene_graph, robot=scene.lio, fallen_into=machine)
    plant.Finalize()
    plant.SetDefaultPositions(
        scene.lio, make_drive(plant, q0, in_step(1.0 / scenario.control_rate_hz)).start_positions()
    )
    simulator = Simulator(builder.Build())
    context = plant.GetMyContextFromRoot(simulator.get_mutable_context())
    port = plant.get_desired_state_input_port(scene.lio)
    held = np.zeros(port.size())
    held[:6], held[6] = q0, 0.5
    port.FixValue(context, held)
    return simulator


class _Turns:
    """After each half second of the run, a tenth of the bare scene; the processor time of each."""

    def __init__(self, bare: Simulator) -> None:
        self._bare, self._next = bare, TURN_S
        self._since = time.process_time()
        self.of_run: list[float] = []
        self.of_bare: list[float] = []

    def __call__(self, root: Context) -> None:
        if root.get_time() < self._next - 1e-9:
            return
        self._next += TURN_S
        begin = time.process_time()
        self.of_run.append(begin - self._since)
        self._bare.AdvanceTo(self._bare.get_context().get_time() + BARE_S)
        self._since = time.process_time()
        self.of_bare.append(self._since - begin)


def ratio(scenario: str, items: str | None, duration: float) -> Figures:
    """Real-time factor of a run by that of the bare scene, over the first `duration` simulated seconds."""
    spec = load_scenario(scenario)
    if items:
        spec = with_items(spec, items)
    canal = prepare_canal(spec, RunOptions(headless=True))
    system = build_shared_autonomy(scenario=spec, canal=canal, seed=0)
    turns = _Turns(bare_scene(spec, system.start.q))
    names = [item.name for item in spec.items]
    simulate(system, task=spec.task, seed=0, item_names=names, duration=duration, watch=turns)
    of_run, of_bare = np.array(turns.of_run[2:]), np.array(turns.of_bare[2:])
    factor, bare = TURN_S * len(of_run) / of_run.sum(), BARE_S * len(of_bare) / of_bare.sum()
    return {"ratio": factor / bare, "factor": factor, "bare": bare, "worst": TURN_S / of_run.max() / bare}


def checks() -> list[Check]:
    """Rigid and soft laundry, and a relocation, a carry and a half each."""
    runs = {"rigid": ("laundry", "rigid"), "soft": ("laundry", "soft"), "relocation": ("relocation", None)}
    return [
        Check(
            f"speed, {name}",
            "5, 12 (kept)",
            [Job(ratio, (*run, 70.0), 0.8)],
            (Worst("times bare Drake", "ratio", at_least(LEAST)),),
            alone=True,
        )
        for name, run in runs.items()
    ]
