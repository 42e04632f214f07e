"""What a lesson comes to: demonstrations in files, a canal learned from them, and the command that travels it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from canal.demonstration import Demonstration, save_demonstration
from canal.errors import InputError
from canal.learning import learn_canal
from canal.surface import CanalSurface
from canal.surface_file import save_canal
from diagrams.scenario import Scenario, load_scenario, with_items
from diagrams.teach.path import TaughtPath
from geosacs_drake.prepare_canal import prepare_task
from geosacs_drake.run_options import RunOptions
from geosacs_drake.teach.options import TeachOptions

SHORTEST_M = 0.10
"""[m] A demonstration is longer than this: no task of an arm is done within a hand's width."""


class Lesson:
    """What was taught so far.

    Attributes:
        demonstrations: that were saved, and can be learned from.
        files: theirs.
        canal: learned from them; None: not yet, or not since another one was saved.
        canal_file: its file.
    """

    def __init__(self, options: TeachOptions, scenario: Scenario) -> None:
        """A lesson with nothing taught yet.

        Args:
            options: of the command.
            scenario: that it takes place in.

        Raises:
            InputError: the folder for its files cannot be made.
        """
        self._options, self._scenario = options, scenario
        self.demonstrations: list[Demonstration] = []
        self.files: list[Path] = []
        self.canal: CanalSurface | None = None
        self.canal_file: Path | None = None
        try:
            options.output.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"--output {options.output}: {error.strerror}; choose another folder") from None

    def save(self, path: TaughtPath) -> str:
        """Write a demonstration to the next free file; what a person is told.

        Args:
            path: that was taught.

        Raises:
            InputError: it is too short, or cannot be written.
        """
        file = _free(self._options.output, "demonstration")
        if not path.enough:
            raise InputError("nothing was recorded yet: press Record, and move the gripper")
        demonstration = path.demonstration(file.name)
        if (ends := float(abs(demonstration.position - demonstration.position[0]).max())) < SHORTEST_M:
            raise InputError(f"it spans {1000 * ends:.0f} mm only: show the whole way from pick to place")
        save_demonstration(file, demonstration)
        self.demonstrations.append(demonstration)
        self.files.append(file)
        self.canal = self.canal_file = None
        return f"Demonstration {len(self.files)} saved to {file}: {path.duration_s:.0f} s of motion"

    def learn(self) -> str:
        """Learn the canal from all that was saved, and write it; what a person is told.

        Raises:
            InputError: there are fewer than two, or no canal comes of them.
        """
        if len(self.demonstrations) < 2:
            raise InputError("a canal needs at least two demonstrations: show it once more")
        # Tables and doors are laid under it when it is travelled; a loaded canal gets them, too.
        canal = learn_canal(self.demonstrations, replace(self._scenario.learning, support_planes=()))
        file = _free(self._options.output, "canal")
        save_canal(file, canal)
        self.canal, self.canal_file = canal, file
        widest, narrowest = 2000 * canal.radii.max(), 2000 * canal.radii.min()
        return f"Canal saved to {file}: {canal.length:.2f} m long, {narrowest:.0f} to {widest:.0f} mm wide" + "".join(
            f". {warning}" for warning in canal.warnings
        )

    def travel(self) -> list[str]:
        """The command that travels the canal, tried as far as to its start: arguments of the Python interpreter.

        Raises:
            InputError: none was learned, or the arm cannot travel it in this task.
        """
        if self.canal_file is None:
            raise InputError("nothing is learned yet: save two demonstrations, and press Learn")
        options, task = self._options, self._scenario.task
        own = options.scenario != task
        scenario = load_scenario(options.scenario)
        scenario = scenario if options.items is None else with_items(scenario, options.items)
        prepare_task(
            scenario,
            RunOptions(canal=self.canal_file, seed=options.seed, scenario=options.scenario if own else None),
        )
        words = ["-m", f"geosacs_drake.run_{task}", "--canal", str(self.canal_file), "--seed", str(options.seed)]
        words += ["--scenario", options.scenario] if own else []
        words += ["--items", options.items] if options.items else []
        words += ["--realtime-rate", str(options.realtime_rate)] if options.realtime_rate is not None else []
        return [*words, *(["--headless"] if options.headless else ["--host", options.host])]


def _free(folder: Path, name: str) -> Path:
    """The first file of that name and a number that is not there yet."""
    number = 1
    while (file := folder / f"{name}_{number}.npz").exists():
        number += 1
    return file


def attempt(what: Callable[[], str]) -> str:
    """What a person is told of something that may not be possible.

    Args:
        what: does it, and says so.
    """
    try:
        return what()
    except InputError as error:
        text = str(error)
        return f"{text[:1].upper()}{text[1:]}."
