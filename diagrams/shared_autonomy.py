"""The whole: joystick → navigator → IK → Lio station → monitor, wired into one Drake diagram."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context, Diagram, DiagramBuilder, OutputPort
from pydrake.systems.primitives import ZeroOrderHold

from canal.navigation.joystick import JOYSTICK_PERIOD, in_step
from canal.surface import CanalSurface
from diagrams.announcements import Announcement, Announcer
from diagrams.force_alarm import ForceAlarm
from diagrams.ik.joint_pace import at_joint_pace, unhurried
from diagrams.ik.reachability import reach_report
from diagrams.ik.start_posture import StartPosture, find_start_posture
from diagrams.ik.system import OrientationWeightedIk
from diagrams.monitor import Monitor
from diagrams.navigator import CanalNavigator
from diagrams.operator.system import SimulatedOperator
from diagrams.run_log import RunLog
from diagrams.scenario import Scenario
from diagrams.scene_view import show_scene
from diagrams.station.lio_arm import arm_speeds
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE, LioStation, arm_stops
from diagrams.station.peaks import Peaks
from diagrams.teleop.joystick_recording import JoystickRecording
from diagrams.teleop.joystick_selector import JoystickSelector, RecordedJoystick
from diagrams.teleop.live_joystick import LiveJoystick, LiveSample
from diagrams.teleop.meshcat_joystick import MeshcatJoystick
from diagrams.teleop.stick_mapping import StickMapping
from diagrams.view.cameras import VideoRecorder
from diagrams.view.canal_view import CanalView
from diagrams.view.meshcat_notice import MeshcatNotice


@dataclass(frozen=True)
class SharedAutonomy:
    """The diagram of a run, and the systems in it that a run asks about."""

    diagram: Diagram
    station: LioStation
    navigator: CanalNavigator
    ik: OrientationWeightedIk
    monitor: Monitor
    peaks: Peaks
    selector: JoystickSelector
    log: RunLog
    start: StartPosture
    holds: tuple[ZeroOrderHold, ...]
    video: VideoRecorder | None = None
    notices: tuple[str, ...] = ()
    """What a person should know before the start."""

    def take_first_measurements(self, root: Context) -> None:
        """Sample all measurements before the first tick, so that none of them starts as zeros."""
        for hold in self.holds:
            context = hold.GetMyMutableContextFromRoot(root)
            hold.SetVectorState(context, hold.get_input_port().Eval(context))


def build_shared_autonomy(
    *,
    scenario: Scenario,
    canal: CanalSurface,
    operator: Literal["simulated", "person"] | JoystickRecording = "simulated",
    seed: int = 0,
    meshcat: Meshcat | None = None,
    recording: Meshcat | None = None,
    video: Path | None = None,
    say: Callable[[Announcement], None] | None = None,
    show: Callable[[str, str, float], None] | None = None,
    hand: Callable[[], LiveSample] | None = None,
    directions: np.ndarray | None = None,
    choose_directions: Callable[[], tuple[int, np.ndarray | None]] | None = None,
) -> SharedAutonomy:
    """Wire a scenario and a canal into a diagram.

    ```
    joystick sources → selector → canal navigator → orientation-weighted IK → Lio station → monitor
                          ↑ simulated operator ←─────────────────────────────────┘    → Meshcat
    ```

    Args:
        scenario: task, world, options.
        canal: to travel, in the robot's base frame.
        operator: who holds the joystick; only `person` takes commands from the Meshcat page, which any program on this
            machine can reach.
        seed: of where the items lie and of the simulated operator's errors.
        meshcat: where to show it; None for no pictures.
        recording: a Meshcat of its own that records it; None for no recording.
        video: film the room and the gripper's view for this file; saved by `SharedAutonomy.video`.
        say: is told what a person is to be told: what presses, what is stopped, which press did nothing.
        show: shows what lasts of it, instead of a notice in `meshcat`; see `Announcer`.
        hand: a person's joystick, who may hand back to the simulated operator; instead of the Meshcat page, which then
            takes no commands.
        directions: of the stick's right and up on each disk, for whoever drives but a recording; None: the correction
            axes. Shape (N, 2, 3).
        choose_directions: tells of other ones while it runs; see `StickMapping`.

    Raises:
        InputError: the scenario's items overlap, or the arm cannot reach the canal's home.
    """
    period = in_step(1.0 / scenario.control_rate_hz)
    builder = DiagramBuilder()

    solver = make_lio_solver(scenario, scenario.ik)
    start = find_start_posture(solver, unhurried(canal), preferred=START_POSTURE)
    navigation, slower = at_joint_pace(solver, canal, start, scenario.navigation)
    station = LioStation.AddToBuilder(builder=builder, world=scenario, seed=seed, q0=start.q, filmed=video is not None)
    navigator = CanalNavigator.AddToBuilder(builder=builder, canal=canal, options=navigation, period=period)
    ik = OrientationWeightedIk.AddToBuilder(
        builder=builder,
        solver=solver,
        q_start=start.q,
        X_BT_desired=navigator.GetOutputPort("X_BT_desired"),
        orientation_weight=navigator.GetOutputPort("orientation_weight"),
        period=period,
    )
    monitor = Monitor.AddToBuilder(builder=builder, canal=canal, goals=station.goals, options=scenario.monitor)
    pairs, stops, speeds = len(station.contact_pairs), arm_stops(station.plant), arm_speeds(station.plant)
    peaks = Peaks.AddToBuilder(builder=builder, contact_pairs=pairs, stops=stops, speeds=speeds, period=period)
    alarm = ForceAlarm.AddToBuilder(
        builder=builder, contact_pairs=pairs, limit_n=scenario.monitor.force_limit_n, period=period
    )

    # Each measurement is taken once a tick, before the plant's step: whoever needs it reads the same sample.
    measured: dict[str, OutputPort] = {}
    holds: list[ZeroOrderHold] = []
    for name, every in (dict.fromkeys(MEASURED, period) | dict.fromkeys(ITEM_PORTS, JOYSTICK_PERIOD)).items():
        port = station.GetOutputPort(name)
        hold = builder.AddNamedSystem(f"measured_{name}", ZeroOrderHold(every, port.size()))
        builder.Connect(port, hold.get_input_port())
        holds.append(hold)
        measured[name] = hold.get_output_port()

    def mapped(port: OutputPort, name: str) -> tuple[OutputPort, OutputPort | None]:
        """A joystick along the correction axes, and the matrix that it was mapped by."""
        if directions is None and choose_directions is None:
            return port, None
        mapping = StickMapping.AddToBuilder(
            builder=builder,
            canal=canal,
            directions=directions,
            choose=choose_directions,
            joystick=port,
            navigation_state=navigator.GetOutputPort("navigation_state"),
            name=name,
        )
        return mapping.GetOutputPort("mapped_joystick"), mapping.GetOutputPort("matrix")

    person: LiveJoystick | MeshcatJoystick | None = None
    if hand is not None:
        person = LiveJoystick.AddToBuilder(builder=builder, read=hand)
    elif operator == "person" and meshcat is not None:
        person = MeshcatJoystick.AddToBuilder(builder=builder, meshcat=meshcat)
    if operator == "simulated" or (operator == "person" and hand is not None):
        source = SimulatedOperator.AddToBuilder(
            builder=builder,
            canal=canal,
            goals=station.goals,
            X_WB=station.X_WB,
            options=scenario.operator,
            navigation=navigation,
            seed=seed,
        )
        for name in ("item_poses", "item_bounds", "X_BT"):
            builder.Connect(measured[name], source.GetInputPort(name))
        builder.Connect(navigator.GetOutputPort("navigation_state"), source.GetInputPort("navigation_state"))
        if isinstance(person, LiveJoystick):
            builder.Connect(person.GetOutputPort("in_charge"), source.GetInputPort("person_in_charge"))
    elif operator == "person":
        source = None
    else:
        source = RecordedJoystick.AddToBuilder(builder=builder, recording=operator)
    simulated = None if source is None else source.GetOutputPort("joystick")
    if isinstance(source, SimulatedOperator):
        simulated, matrix = mapped(source.GetOutputPort("joystick"), "operator_mapping")
        if matrix is not None:
            builder.Connect(matrix, source.GetInputPort("stick_matrix"))
    selector = JoystickSelector.AddToBuilder(
        builder=builder,
        person=None if person is None else mapped(person.GetOutputPort("joystick"), "stick_mapping")[0],
        person_in_charge=person.GetOutputPort("in_charge") if isinstance(person, LiveJoystick) else None,
        simulated=simulated,
        simulated_person_in_charge=(
            source.GetOutputPort("person_in_charge") if isinstance(source, RecordedJoystick) else None
        ),
    )

    builder.Connect(selector.GetOutputPort("joystick"), navigator.GetInputPort("joystick"))
    builder.Connect(measured["gripper_state"], navigator.GetInputPort("gripper_state"))
    for name in ("contact_forces", "hand_force"):
        builder.Connect(measured[name], alarm.GetInputPort(name))
    builder.Connect(alarm.GetOutputPort("alarm"), navigator.GetInputPort("alarm"))
    builder.Connect(ik.GetOutputPort("desired_state"), station.GetInputPort("desired_state"))
    builder.Connect(navigator.GetOutputPort("gripper_command"), station.GetInputPort("gripper_command"))
    # Both judge by what is, not by a sample of it: they look when it has just been computed.
    for system, names in ((monitor, JUDGED), (peaks, EXTREMES)):
        for name in names:
            builder.Connect(station.GetOutputPort(name), system.GetInputPort(name))
    builder.Connect(navigator.GetOutputPort("navigation_state"), monitor.GetInputPort("navigation_state"))
    builder.Connect(selector.GetOutputPort("person_in_charge"), monitor.GetInputPort("person_in_charge"))

    canvases = [(canvas, name) for canvas, name in ((meshcat, "view"), (recording, "recording")) if canvas is not None]
    noticed = [canvas for canvas, _ in canvases if canvas is not meshcat or show is None]
    if say is not None or show is not None or canvases:
        announcer = Announcer.AddToBuilder(
            builder=builder,
            canal=canal,
            contact_pairs=station.contact_pairs,
            robot_bodies=station.robot_bodies,
            limit_n=scenario.monitor.force_limit_n,
            say=say,
            show=[MeshcatNotice(canvas, station.X_WB).show for canvas in noticed]
            + ([show] if show is not None else []),
        )
        builder.Connect(navigator.GetOutputPort("navigation_state"), announcer.GetInputPort("navigation_state"))
        for name in ("contact_forces", "touching_bodies"):
            builder.Connect(measured[name], announcer.GetInputPort(name))
    if canvases:
        colors = reach_report(solver, canal, start, rings=2, spokes=6, most_disks=61).colors()
    for canvas, name in canvases:
        show_scene(builder, station, canvas, name)
        CanalView.AddToBuilder(
            builder=builder,
            meshcat=canvas,
            canal=canal,
            navigation_state=navigator.GetOutputPort("navigation_state"),
            X_BT=measured["X_BT"],
            options=navigation,
            X_WB=station.X_WB,
            disk_colors=colors,
            name=f"canal_{name}",
        )
    log = RunLog(
        builder,
        {
            "navigation_state": navigator.GetOutputPort("navigation_state"),
            "joystick": selector.GetOutputPort("joystick"),
            "person_in_charge": selector.GetOutputPort("person_in_charge"),
            "X_BT_desired": navigator.GetOutputPort("X_BT_desired"),
            "orientation_weight": navigator.GetOutputPort("orientation_weight"),
            "desired_state": ik.GetOutputPort("desired_state"),
            "ik_status": ik.GetOutputPort("ik_status"),
        }
        | {name: station.GetOutputPort(name) for name in ("lio_state", "X_BT", "contact_forces", "item_poses")},
        period,
        samples={
            "joystick_samples": selector.GetOutputPort("joystick"),
            "in_charge_samples": selector.GetOutputPort("person_in_charge"),
        },
    )
    recorder = (
        None
        if video is None
        else VideoRecorder.AddToBuilder(builder=builder, station=station, task=scenario.task, path=video)
    )
    diagram = builder.Build()
    diagram.set_name("shared_autonomy")
    return SharedAutonomy(
        diagram,
        station,
        navigator,
        ik,
        monitor,
        peaks,
        selector,
        log,
        start,
        tuple(holds),
        recorder,
        (slower,) if slower else (),
    )


MEASURED = ("X_BT", "gripper_state", "contact_forces", "hand_force", "touching_bodies")
"""Ports of the station that are sampled at the control rate."""
ITEM_PORTS = ("item_poses", "item_bounds")
"""Ports of the station that a person looks at, 20 times a second."""
JUDGED = ("item_poses", "item_bounds", "item_speeds", "grip_forces")
"""Ports of the station that the monitor judges by."""
EXTREMES = ("contact_forces", "contact_results", "lio_state", "penetration")
"""Ports of the station of which the greatest values are kept."""
