"""From options to a finished run: what `run_laundry` and `run_relocation` share."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import NoReturn

from tqdm import tqdm

from canal.files import write_npz
from diagrams.joystick_recording import load_recording
from diagrams.layout import base_pose
from diagrams.meshcat_joystick import CONTROLS
from diagrams.meshcat_recording import Recording
from diagrams.meshcat_server import leave, start_meshcat
from diagrams.run_log import named_signals
from diagrams.scenario import load_scenario, with_items
from diagrams.shared_autonomy import build_shared_autonomy
from geosacs_drake.command_line import ExitStatus, end, parse_options
from geosacs_drake.options import PEOPLE, RunOptions
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.simulate import Progress, simulate
from geosacs_drake.summary import describe, summarize, write_summary


def main(task: str, arguments: Sequence[str] | None = None) -> NoReturn:
    """Run a task as the command line says (or `arguments`), and leave with its exit status."""
    prog = f"run_{task}"
    end(lambda: run(parse_options(RunOptions, prog, arguments), task), prog)


def run(options: RunOptions, task: str) -> ExitStatus:
    """Run a task as the options say.

    Raises:
        InputError: an option, a file or a scenario cannot be used.
    """
    scenario = load_scenario(options.scenario or task)
    if options.items is not None:
        scenario = with_items(scenario, options.items)
    canal = prepare_canal(scenario, options)
    meshcat = None
    if not options.headless or options.record is not None:
        meshcat = start_meshcat(port=options.port, X_WB=base_pose(scenario.robot))
    recording = None
    if meshcat is not None and options.record is not None:
        recording = Recording(meshcat, title=scenario.description or scenario.task)
    system = build_shared_autonomy(
        scenario=scenario,
        canal=canal,
        operator=operator_of(options),
        seed=options.seed,
        meshcat=meshcat,
        recording=options.record is not None,
        video=options.video,
    )
    if meshcat is not None and not options.headless:
        print(f"watch and steer at {meshcat.web_url()}\n{CONTROLS}", flush=True)
    with _Bar(options) as bar:
        result = simulate(
            system,
            task=scenario.task,
            seed=options.seed,
            item_names=[item.name for item in scenario.items],
            duration=options.duration,
            rate=options.rate,
            report=bar.show,
        )
    summary = summarize(result)
    print(describe(summary), flush=True)
    if options.summary is not None:
        write_summary(options.summary, summary)
    if options.log is not None:
        write_npz(options.log, **named_signals(result.signals))
    if recording is not None and options.record is not None:
        recording.save(options.record)
    if system.video is not None:
        system.video.save()
    status = ExitStatus.DONE if summary["success"] else ExitStatus.NOT_DONE
    leave(status, meshcat)


def operator_of(options: RunOptions):
    """Who holds the joystick: `simulated`, `person`, or a recording."""
    if options.operator == "simulated":
        return "simulated"
    if options.operator in PEOPLE:
        return "person"
    return load_recording(options.operator)


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
        self._bar.set_description_str(f"{progress.placed} of {progress.things} placed", refresh=False)
        self._bar.update(progress.time_s - self._bar.n)
