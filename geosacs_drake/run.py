"""From options to a finished run: what `run_laundry` and `run_relocation` share."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import NoReturn

from pydrake.geometry import Meshcat
from tqdm import tqdm

from canal.navigation.stick_directions import stick_directions
from diagrams.announcements import Announcement
from diagrams.scene.layout import base_pose
from diagrams.shared_autonomy import build_shared_autonomy
from diagrams.teleop.joystick_recording import load_recording
from diagrams.teleop.meshcat_joystick import CONTROLS
from diagrams.view.meshcat_page import leave, start_meshcat
from diagrams.view.meshcat_recording import Recording
from geosacs_drake.console.console import Console
from geosacs_drake.console.mapping_choice import chosen_view
from geosacs_drake.process.command_line import ExitStatus, end, parse_options, status_of
from geosacs_drake.process.interrupts import Interrupts, Phase
from geosacs_drake.process.run_again import run_again
from geosacs_drake.replay import make_origin
from geosacs_drake.run_files import finish
from geosacs_drake.run_options import PEOPLE, RunOptions
from geosacs_drake.run_task import RunTask, find_task
from geosacs_drake.simulate import Progress, simulate


def main(task: str, arguments: Sequence[str] | None = None, prog: str | None = None) -> NoReturn:
    """Run a task as the command line says (or `arguments`), and leave with its exit status.

    Args:
        task: `laundry` or `relocation`.
        arguments: what follows the command's name; None: what the process was given.
        prog: the command's name, for messages.
    """
    prog = prog or f"run_{task}"
    end(lambda: run(parse_options(RunOptions, prog, arguments), task, prog), prog)


def run(options: RunOptions, task: str, prog: str) -> ExitStatus:
    """Run a task as the options say.

    Args:
        options: what the command line says.
        task: whose scenario is taken where the options name none.
        prog: the command's name, for messages.

    Raises:
        InputError: an option, a file or a scenario cannot be used.
        SystemExit: at the end, with the status.
    """
    with Interrupts() as interrupts:
        found = find_task(options, task, prog)
        with_console = options.console and not options.headless
        page = None
        if not options.headless:
            # Behind the console, Meshcat has an address that nobody knows: it takes commands from whoever connects.
            port = None if with_console else options.port
            page = start_meshcat(port=port, X_WB=base_pose(found.scenario.robot), hidden=with_console)
        console = None
        if page is not None and with_console:
            person = options.operator in PEOPLE
            console = Console(page, person=person, host=options.host, port=options.port)
        # From here on a browser may be connected, for which Meshcat's destructor would wait.
        status = status_of(lambda: _run(options, found, page, console, interrupts, prog), prog)
        if console is not None:
            if not interrupts.asked and console.offers_again:
                interrupts.begin(Phase.RUNNING)
                if console.wait_for_again(lambda: interrupts.asked):
                    run_again(console.server.port, console.server.access.token)
            console.close()
        leave(status, page, at_once=console is not None)


def _run(
    options: RunOptions,
    found: RunTask,
    page: Meshcat | None,
    console: Console | None,
    interrupts: Interrupts,
    prog: str,
) -> ExitStatus:
    scenario = found.scenario
    recorded, recording = None, None
    if options.record is not None:
        recorded = start_meshcat(X_WB=base_pose(scenario.robot), hidden=True)
        recording = Recording(recorded, title=scenario.description or scenario.task)
    operator = operator_of(options)
    mapping = options.mapping or scenario.mapping or ("axes" if console is None else "view")
    seat = options.seat or scenario.seat
    view = chosen_view(mapping, seat)
    choice = None if console is None else console.choose_mapping(found.canal, mapping, seat)
    system = build_shared_autonomy(
        scenario=scenario,
        canal=found.canal,
        operator=operator,
        seed=found.seed,
        meshcat=page,
        recording=recorded,
        video=options.video,
        say=_tell_both(console),
        show=None if console is None else console.show_standing,
        hand=None if console is None else console.control.sample,
        directions=choice.current()[1] if choice else stick_directions(found.canal, view) if view else None,
        choose_directions=None if choice is None else choice.current,
    )
    for notice in system.notices:
        print(notice, file=sys.stderr, flush=True)
    if console is not None:
        console.report(system, found.canal, scenario)
        console.show_gripper(system.station, scenario, found.seed)
        print(f"steer, or watch, at {console.address}", flush=True)
        if outside := console.server.network_address:
            print(
                f"whoever knows this address steers the robot, from any machine of this network: {outside}", flush=True
            )
        console.open_browser()
    elif page is not None:
        steer = f" and steer at {page.web_url()}\n{CONTROLS}" if operator == "person" else f" at {page.web_url()}"
        print(f"watch{steer}", flush=True)
    interrupts.begin(Phase.RUNNING)
    with _Bar(options) as bar:
        result = simulate(
            system,
            task=scenario.task,
            scenario=found.name,
            operator=options.operator,
            seed=found.seed,
            item_names=[item.name for item in scenario.items],
            duration=found.duration,
            rate=options.rate,
            asked_to_end=lambda: interrupts.asked,
            report=bar.show,
            watch=(lambda root: None) if console is None else console.look,
            wait=lambda root: None if console is None else console.wait(root, lambda: interrupts.asked),
        )
    interrupts.begin(Phase.WRITING)
    return finish(
        options=options,
        result=result,
        origin=make_origin(options, result=result, scenario=scenario, canal=found.canal, duration=found.duration),
        recording=recording,
        film=system.video,
        prog=prog,
        show=None if console is None else console.end,
    )


def operator_of(options: RunOptions):
    """Who holds the joystick: `simulated`, `person`, or a recording."""
    if options.operator == "simulated":
        return "simulated"
    if options.operator in PEOPLE:
        return "person"
    return load_recording(options.operator)


def _tell_both(console: Console | None) -> Callable[[Announcement], None]:
    """Tell the terminal, and the console if there is one."""
    if console is None:
        return tell

    def say(announcement: Announcement) -> None:
        tell(announcement)
        console.say(announcement)

    return say


def tell(announcement: Announcement) -> None:
    """Print what a person is to be told, above the progress bar. What cannot be printed is not worth a run."""
    with suppress(OSError, ValueError):
        tqdm.write(f"{announcement.time_s:.1f} s: {announcement.text}", file=sys.stderr)


class _Bar:
    """A progress bar over simulated time, when there is no picture to watch."""

    def __init__(self, options: RunOptions) -> None:
        self._bar = tqdm(
            total=None,
            unit="s",
            disable=None if options.headless else True,  # None: no bar into a file
            file=sys.stderr,
            bar_format="{desc}: {n:.1f} simulated s in {elapsed}{postfix}",
        )

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()

    def show(self, progress: Progress) -> None:
        """Show how far the run is."""
        self._bar.set_description_str(f"{progress.placed} of {progress.items} placed", refresh=False)
        self._bar.update(progress.time_s - self._bar.n)
