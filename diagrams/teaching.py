"""Teaching, as a whole: a hand that jogs → wanted pose → IK → Lio station, and the recorder, wired into one diagram."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort
from pydrake.systems.primitives import ZeroOrderHold

from canal.navigation.joystick import in_step
from diagrams.force_alarm import ForceAlarm
from diagrams.ik.solver import IkSolver
from diagrams.ik.system import OrientationWeightedIk
from diagrams.scenario import Scenario
from diagrams.scene_view import show_scene
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE, LioStation
from diagrams.teach.live_jog import LiveJog, TeachSample
from diagrams.teach.recorder import DemonstrationRecorder
from diagrams.teach.tool_jog import ToolJog


@dataclass(frozen=True)
class Teaching:
    """The diagram of a lesson, and the systems in it that one asks about.

    Attributes:
        diagram: the whole.
        station: the robot among fixtures and items.
        solver: of the inverse kinematics.
        hand: what the person does.
        jog: from it to a wanted pose.
        ik: from that to a joint command.
        alarm: whether the robot presses on something.
        recorder: of the path, and the way back.
    """

    diagram: Diagram
    station: LioStation
    solver: IkSolver
    hand: LiveJog
    jog: ToolJog
    ik: OrientationWeightedIk
    alarm: ForceAlarm
    recorder: DemonstrationRecorder


def build_teaching(
    *,
    scenario: Scenario,
    read: Callable[[], TeachSample],
    q_start: np.ndarray = START_POSTURE,
    seed: int = 0,
    meshcat: Meshcat | None = None,
) -> Teaching:
    """Wire a scenario's robot and items to a hand that teaches.

    ```
    hand → jog → orientation-weighted IK → Lio station → recorder → way back
             ↑────────────── alarm ←────────────┘            │
             └───────────────────────────────────────────────┘
    ```

    Args:
        scenario: what stands where.
        read: gives the hand's latest sample, and never waits.
        q_start: posture at the start, [rad]. Shape (6,).
        seed: of where the items lie.
        meshcat: where to show it; None for no pictures.

    Raises:
        InputError: the scenario's fixtures and items overlap.
    """
    period = in_step(1.0 / scenario.control_rate_hz)
    builder = DiagramBuilder()
    solver = make_lio_solver(scenario, scenario.ik)
    station = LioStation.AddToBuilder(builder=builder, world=scenario, seed=seed, q0=q_start)
    hand = LiveJog.AddToBuilder(builder=builder, read=read)
    jog = ToolJog.AddToBuilder(builder=builder, kinematics=solver.kinematics, q_start=q_start, period=period)
    ik = builder.AddNamedSystem("ik", OrientationWeightedIk(solver, q_start=q_start, period=period))
    alarm = ForceAlarm.AddToBuilder(
        builder=builder,
        contact_pairs=len(station.contact_pairs),
        limit_n=scenario.monitor.force_limit_n,
        period=period,
    )
    measured: dict[str, OutputPort] = {}
    for name in ("X_BT", "contact_forces", "hand_force"):
        port = station.GetOutputPort(name)
        hold = builder.AddNamedSystem(f"measured_{name}", ZeroOrderHold(period, port.size()))
        builder.Connect(port, hold.get_input_port())
        measured[name] = hold.get_output_port()
    recorder = DemonstrationRecorder.AddToBuilder(
        builder=builder, X_BT=measured["X_BT"], jog=hand.GetOutputPort("jog"), word=hand.GetOutputPort("word")
    )
    for name in ("contact_forces", "hand_force"):
        builder.Connect(measured[name], alarm.GetInputPort(name))
    builder.Connect(hand.GetOutputPort("jog"), jog.GetInputPort("jog"))
    builder.Connect(ik.GetOutputPort("desired_state"), jog.GetInputPort("desired_state"))
    builder.Connect(recorder.GetOutputPort("way_back"), jog.GetInputPort("way_back"))
    builder.Connect(alarm.GetOutputPort("alarm"), jog.GetInputPort("alarm"))
    for name in ("X_BT_desired", "orientation_weight"):
        builder.Connect(jog.GetOutputPort(name), ik.GetInputPort(name))
    builder.Connect(ik.GetOutputPort("desired_state"), station.GetInputPort("desired_state"))
    builder.Connect(hand.GetOutputPort("gripper_command"), station.GetInputPort("gripper_command"))
    if meshcat is not None:
        show_scene(builder, station, meshcat, "view")
    diagram = builder.Build()
    diagram.set_name("teaching")
    return Teaching(diagram, station, solver, hand, jog, ik, alarm, recorder)
