"""The files of a run: what it reads, what it will write, and how that is written at its end."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from canal.errors import InputError
from canal.files import write_npz
from diagrams.run_log import named_signals
from diagrams.scenario import Scenario
from diagrams.view.cameras import VideoRecorder, film_kind
from diagrams.view.meshcat_recording import Recording
from geosacs_drake.process.command_line import ExitStatus
from geosacs_drake.process.outputs import Output, check_outputs, say_failures, write_each
from geosacs_drake.replay import Origin
from geosacs_drake.results.summary import RunResult, describe, summarize, write_summary
from geosacs_drake.run_options import PEOPLE, RunOptions
from models import MODELS, SCENARIOS

ENDINGS = {"summary": (".json",), "log": (".npz",), "record": (".html", ".htm"), "video": (".gif", ".mp4")}
"""Of the outputs, by the option that names them."""


def check_run_files(options: RunOptions, scenario: Scenario) -> None:
    """Refuse outputs that could not be written, or that would destroy something, before anything is computed.

    Args:
        options: of the run: which files are to be written.
        scenario: names files that are read.

    Raises:
        InputError: with the option, the file and the remedy.
    """
    paths = {name: getattr(options, name) for name in ENDINGS}
    outputs = [Output(f"--{name}", path, ENDINGS[name]) for name, path in paths.items() if path is not None]
    check_outputs(outputs, inputs_of(options, scenario))
    if options.video is not None:
        film_kind(options.video)


def inputs_of(options: RunOptions, scenario: Scenario) -> Iterator[Path]:
    """What a run reads: scenario, demonstrations, canal, operator, models.

    Args:
        options: of the run.
        scenario: of the run.
    """
    yield from options.demos
    if options.canal is not None:
        yield options.canal
    if options.operator not in ("simulated", *PEOPLE):
        yield Path(options.operator)
    name = options.scenario or scenario.task
    yield from (Path(name), SCENARIOS / f"{name}.yaml")
    for name in (*scenario.demonstrations, *([] if scenario.canal is None else [scenario.canal])):
        with suppress(InputError):  # of a log that is replayed: it needs them no more
            yield scenario.resolve(name, MODELS / "demonstrations")
    for models, folder in ((scenario.fixtures, "world"), (scenario.items, "items")):
        for model in models:
            yield scenario.resolve(model.model, MODELS / folder, ".sdf")


def finish(
    *,
    options: RunOptions,
    result: RunResult,
    origin: Origin,
    recording: Recording | None,
    film: VideoRecorder | None,
    prog: str,
    show: Callable[[dict[str, Any]], None] | None = None,
) -> ExitStatus:
    """Write each file, then say how the run went.

    Args:
        options: name the files.
        result: what happened.
        origin: what the run was made from, for its log.
        recording: what a page has recorded, if it was asked for.
        film: what the cameras have seen, likewise.
        prog: the command's name, for messages.
        show: is given the summary before files are written.

    Returns:
        Whether the task was done, or that a file is missing or something inside ended the run.
    """
    if result.failure and not len(result.signals["time"]):
        print(f"{prog}: {result.reason}; nothing was measured before", file=sys.stderr)
        return ExitStatus.BAD_INPUT
    summary: dict[str, Any] = {}
    failures = write_each([("measures", lambda: summary.update(summarize(result)))])
    if show is not None:
        show(summary or {"success": False, "reason": result.reason})
    writers: list[tuple[str, Callable[[], object]]] = []
    if options.summary is not None and summary:
        writers.append(("--summary", partial(write_summary, options.summary, summary)))
    if options.log is not None:
        writers.append(("--log", partial(_write_log, options.log, result, origin)))
    if recording is not None and options.record is not None:
        writers.append(("--record", partial(recording.save, options.record)))
    if film is not None:
        writers.append(("--video", film.save))
    failures += write_each(writers)
    if summary:
        print(describe(summary), flush=True)
    if result.failure:
        kept = "; its files hold what was measured until then" if writers and not failures else ""
        print(f"{prog}: {result.reason}{kept}", file=sys.stderr)
    say_failures(prog, failures)
    if failures or result.failure:
        return ExitStatus.BAD_INPUT
    return ExitStatus.DONE if summary["success"] else ExitStatus.NOT_DONE


def _write_log(path: Path, result: RunResult, origin: Origin) -> None:
    write_npz(path, **named_signals(result.signals), **origin.arrays())
