"""Bad and odd inputs: each ends with status 2 and one line, within seconds, and leaves nothing behind."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from benchmarks.acceptance.check import Check, Count, Figures, Job, Worst, at_most
from benchmarks.acceptance.commands import Ended, command, empty_folder
from benchmarks.canal_quality import ROOT
from diagrams.scenario import RENAMED
from models import MODELS

CASES = ROOT.parent / "shared" / "cases"
"""Inputs that went wrong once, when they lie beside the project."""
SECONDS = 10.0
"""Of processor time."""
HOLDS_NOW = ("learn_n_disks_201.yaml",)
"""Was refused once; every field of learning can be given now."""
GOOD = MODELS / "demonstrations" / "relocation_1.npz"
RUN = ("run_relocation", "--headless", "--duration", "1")


def _refused(ended: Ended, folder: Path, before: set[str]) -> str:
    """What is wrong with how a command refused; empty where nothing is."""
    lines = [line for line in ended.errors.splitlines() if line.strip()]
    if ended.status != 2:
        return f"status {ended.status}"
    if len(lines) != 1 or "Traceback" in ended.errors:
        return f"{len(lines)} lines"
    if ended.output.strip():
        return "printed something else"
    if {path.name for path in folder.iterdir()} != before:
        return "left a file"
    return f"took {ended.seconds:.0f} s" if ended.seconds > SECONDS else ""


def _judged(cases: dict[str, tuple[object, ...]], folder: Path) -> Figures:
    """Try each command line, and count those that were refused as they must be."""
    before, bad = {path.name for path in folder.iterdir()}, {}
    slowest = 0.0
    for name, (module, *arguments) in cases.items():
        ended = command(str(module), *arguments, folder=folder, patience=60 * SECONDS)
        slowest = max(slowest, ended.seconds)
        if why := _refused(ended, folder, before):
            bad[name] = why
    print("not refused as they must be:", bad)
    return {
        "all refused": float(bool(cases) and not bad),
        "not refused": len(bad),
        "tried": len(cases),
        "slowest": slowest,
    }


def _renamed(scenario: str) -> str:
    """A scenario of an earlier version, in the words of this one."""
    for old, new in RENAMED.items():
        scenario = re.sub(rf"\b{old}(?=:)", new, scenario)
    return scenario


def shared_demonstrations() -> Figures:
    """Damaged demonstrations, and canals, and what Excel writes."""
    files = sorted((CASES / "demonstrations").iterdir())
    cases: dict[str, tuple[object, ...]] = {f.name: ("learn", f.resolve(), GOOD) for f in files}
    cases |= {f.name: (*RUN, "--canal", f.resolve()) for f in sorted((CASES / "canals").iterdir())}
    with empty_folder() as folder:
        figures = dict(_judged(cases, folder))
        recording = (CASES / "joystick" / "excel_bom.csv").resolve()
        read = command(*RUN, "--operator", recording, folder=folder)
        figures["all refused"] *= float(read.status == 1)  # it is read: the run is merely too short
    return figures


def shared_scenarios() -> Figures:
    """Scenarios that cannot be used."""
    with empty_folder() as folder:
        files = sorted((CASES / "scenarios").glob("*.yaml"))
        cases = {f.name: (*RUN, "--scenario", f.resolve()) for f in files}
        figures = dict(_judged({name: case for name, case in cases.items() if name not in HOLDS_NOW}, folder))
        runs = []
        for name in set(HOLDS_NOW) & set(cases):
            (folder / name).write_text(_renamed((CASES / "scenarios" / name).read_text()))
            runs.append(command(*RUN, "--scenario", name, folder=folder).status == 1)
        figures["all refused"] *= float(all(runs))  # they run: too short to be done
    return figures


def made_here() -> Figures:
    """Bad inputs of the same kinds, made on the spot."""
    with np.load(GOOD) as file:
        good = {name: file[name] for name in file.files}
    position, orientation = good["position"], good["orientation"]
    with empty_folder() as folder:
        nan, zero = position.copy(), orientation.copy()
        nan[40, 1], zero[30] = np.nan, 0.0
        np.savez(folder / "nan.npz", position=nan, orientation=orientation)
        np.savez(folder / "zero.npz", position=position, orientation=zero)
        np.savez(folder / "backwards.npz", position=position[::-1], orientation=orientation[::-1])
        np.savez(
            folder / "milliseconds.npz",
            position=position,
            orientation=orientation,
            time=50.0 * np.arange(len(position)),
        )
        np.savez(folder / "objects.npz", position=np.array([{}], dtype=object), orientation=orientation)
        (folder / "text.npz").write_text("no archive")
        (folder / "key.yaml").write_text("taks: laundry\n")
        (folder / "nan.yaml").write_text("task: relocation\nnavigation: {delta: .nan}\n")
        cases: dict[str, tuple[object, ...]] = {
            name: ("learn", f"{name}.npz", GOOD) for name in ("nan", "zero", "backwards", "objects", "text")
        }
        cases |= {
            "milliseconds": ("learn", "milliseconds.npz", "milliseconds.npz"),
            "one file": ("learn", GOOD),
            "no file": ("learn", "nowhere.npz", GOOD),
            "long name": ("learn", "n" * 300 + ".npz", GOOD),
            "its own input": ("learn", "nan.npz", GOOD, "-o", "nan.npz"),
            "canal": (*RUN, "--canal", GOOD),
            "key": (*RUN, "--scenario", "key.yaml"),
            "not a number": (*RUN, "--scenario", "nan.yaml"),
            "a folder": (*RUN, "--scenario", "."),
            "no folder": (*RUN, "--summary", "nowhere/s.json"),
            "ending": (*RUN, "--log", "l.csv"),
            "duration": ("run_relocation", "--headless", "--duration", "nan"),
            "option": (*RUN, "--colour", "blue"),
        }
        return _judged(cases, folder)


def checks() -> list[Check]:
    """Shared cases, and those made here."""
    lines = (
        Count("refused with status 2 and one line", "all refused"),
        Worst("inputs not refused so", "not refused", at_most(0)),
        Worst("slowest", "slowest", at_most(SECONDS, "s")),
    )
    absent = "" if CASES.is_dir() else f"no cases in {CASES}"
    shared = [Job(shared_demonstrations, (), 0.4), Job(shared_scenarios, (), 0.6)]
    return [
        Check("inputs that went wrong once", "12.7", shared, lines, quick=2, missing=absent),
        Check("inputs made here", "12.7, 12.8", [Job(made_here, (), 0.6)], lines),
    ]
