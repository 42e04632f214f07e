"""From options to the end of a lesson: the simulation, the page beside it, and what the person asks for."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NoReturn

from pydrake.systems.analysis import Simulator

from canal.navigation.joystick import JOYSTICK_PERIOD
from diagrams.ik.joint_pace import unhurried
from diagrams.ik.start_posture import find_start_posture
from diagrams.scenario import load_scenario, with_items
from diagrams.scene.layout import base_pose
from diagrams.scene.world import World
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE
from diagrams.station.sleep import sleep_manager
from diagrams.teaching import Teaching, build_teaching
from diagrams.view.meshcat_page import leave, start_meshcat
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.process.command_line import ExitStatus, end, parse_options, status_of
from geosacs_drake.process.interrupts import Interrupts, Phase
from geosacs_drake.process.run_again import run_instead
from geosacs_drake.run_options import RunOptions
from geosacs_drake.teach.hand import ScriptedHand, TeachControl, load_script
from geosacs_drake.teach.lesson import Lesson, attempt
from geosacs_drake.teach.options import TeachOptions
from geosacs_drake.teach.page import TeachPage

PROG = "run_teach"
BUSY = {"learn": "Learning the canal", "travel": "Making ready to travel"}
"""By request: what is shown meanwhile."""


def main(arguments: Sequence[str] | None = None, prog: str = PROG) -> NoReturn:
    """Teach as the command line says (or `arguments`), and leave with the exit status.

    Args:
        arguments: what follows the command's name; None: what the process was given.
        prog: the command's name, for messages.
    """
    end(lambda: run(parse_options(TeachOptions, prog, arguments), prog), prog)


def run(options: TeachOptions, prog: str = PROG) -> ExitStatus:
    """Teach as the options say.

    Args:
        options: what the command line says.
        prog: the command's name, for messages.

    Raises:
        InputError: an option, a file or a scenario cannot be used.
        SystemExit: at the end, with the status.
    """
    with Interrupts() as interrupts:
        scenario = load_scenario(options.scenario)
        scenario = scenario if options.items is None else with_items(scenario, options.items)
        lesson = Lesson(options, scenario)
        if options.script is not None:
            hand: ScriptedHand | TeachControl = load_script(options.script)
            meshcat, page = None, None
        else:
            hand = TeachControl(person_asked=True)
            meshcat = start_meshcat(X_WB=base_pose(scenario.robot), hidden=True)
            page = TeachPage(hand, meshcat, host=options.host, port=options.port)
        # Begin where the task's own canal has its home, in a posture from which the arm reaches both ends.
        solver, own = make_lio_solver(scenario, scenario.ik), prepare_canal(scenario, RunOptions())
        start = find_start_posture(solver, unhurried(own), preferred=START_POSTURE)
        teaching = build_teaching(
            scenario=scenario,
            read=hand.jog_sample,
            q_start=start.q,
            seed=options.seed,
            meshcat=meshcat,
        )
        going = _Going(teaching, lesson, hand, page, lambda: interrupts.asked, options.rate, scenario, options.seed)
        status = status_of(lambda: _go(going, interrupts), prog)
        if page is not None:
            page.close()
        if going.travel:
            run_instead(going.travel, None if page is None else page.port_and_token)
        leave(status, meshcat, at_once=page is not None)


@dataclass
class _Going:
    """A lesson that goes on."""

    teaching: Teaching
    lesson: Lesson
    hand: ScriptedHand | TeachControl
    page: TeachPage | None
    asked_to_end: Callable[[], bool]
    rate: float
    world: World
    seed: int
    travel: list[str] = field(default_factory=list)
    """The command that comes next."""


def _go(going: _Going, interrupts: Interrupts) -> ExitStatus:
    teaching, page = going.teaching, going.page
    simulator = Simulator(teaching.diagram)
    simulator.set_target_realtime_rate(going.rate)
    simulator.set_monitor(sleep_manager(teaching.station))
    simulator.Initialize()
    root = simulator.get_mutable_context()
    beginning = root.Clone()
    if page is not None:
        page.begin(teaching, going.lesson, going.world, going.seed)
        print(f"teach at {page.address}", flush=True)
        if outside := page.server.network_address:
            print(
                f"whoever knows this address moves the robot, from any machine of this network: {outside}", flush=True
            )
        page.open_browser()
    interrupts.begin(Phase.RUNNING)
    simulator.ResetStatistics()
    try:
        while not going.asked_to_end() and not going.travel:
            simulator.AdvanceTo(root.get_time() + JOYSTICK_PERIOD)
            if page is not None:
                page.show(root)
            for request in going.hand.requests():
                if page is not None and request in BUSY:
                    page.show(root, busy=BUSY[request])
                _say(going, attempt(partial(_do, going, request, simulator, beginning)), root)
                simulator.ResetStatistics()  # what it took is not caught up with
            if isinstance(going.hand, ScriptedHand) and going.hand.done:
                break
    finally:
        simulator.clear_monitor()
    return ExitStatus.DONE if going.lesson.files else ExitStatus.NOT_DONE


def _do(going: _Going, request: str, simulator: Simulator, beginning: Any) -> str:
    """Do what was asked for; what a person is told."""
    recorder, lesson, root = going.teaching.recorder, going.lesson, simulator.get_mutable_context()
    if request == "save":
        told = lesson.save(recorder.path(root))
        recorder.forget(root)
        return told
    if request == "discard":
        recorder.forget(root)
        return "Thrown away: it can be shown anew"
    if request == "reset":
        if recorder.path(root).kept:
            return "Save the recording or throw it away first."
        root.SetTimeStateAndParametersFrom(beginning)
        simulator.Initialize()
        return "Everything is where it was at the beginning"
    if request == "learn":
        return lesson.learn()
    going.travel = lesson.travel()
    return "The robot travels the canal next"


def _say(going: _Going, text: str, root: Any) -> None:
    print(text, file=sys.stderr, flush=True)
    if going.page is not None:
        going.page.tell(text, root.get_time())
