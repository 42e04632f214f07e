"""`python -m geosacs_drake.learn`: demonstrations in, a canal out, and what a person wants to know about it."""

from __future__ import annotations

import math
import webbrowser
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np
from tqdm import tqdm

from canal.demonstration import Demonstration, load_demonstration
from canal.errors import InputError
from canal.learning import learn_canal
from canal.quality import CanalQuality, canal_quality
from canal.surface import CanalSurface
from canal.surface_file import save_canal
from geosacs_drake.learn_options import PROG, LearnOptions, parse
from geosacs_drake.process.command_line import ExitStatus, end
from geosacs_drake.process.interrupts import Interrupts
from geosacs_drake.process.outputs import Output, check_outputs, say_failures, write_each

POINTS_UP = math.sin(math.radians(20.0))
"""Height of the gripper's axis from which on it is said; items are gripped from above or from the side."""
_N_STAGES = 4
PICTURES = (".png", ".pdf", ".svg")
"""Endings of the files that can be drawn."""


def main(options: LearnOptions) -> ExitStatus:
    """Learn, report, and write what was asked for.

    Raises:
        InputError: something that cannot be used.
    """
    if not options.demonstrations:
        raise InputError("no demonstrations; give two or more files, .npz or .csv")
    check_outputs(outputs_of(options), options.demonstrations)
    demonstrations = [load_demonstration(path, options.recorded) for path in options.demonstrations]
    with tqdm(total=_N_STAGES, desc="learning", delay=2.0, leave=False, disable=None) as bar:

        def progress(stage: str) -> None:
            bar.set_description(stage)
            bar.update()

        canal = learn_canal(demonstrations, options.learning, progress)
    said = [*_dropped(demonstrations), *report(canal, canal_quality(canal))]
    recorded = [d.position for d in demonstrations]
    failures = write_each(_writers(canal, recorded, options, said))
    print("\n".join(said), flush=True)
    say_failures(PROG, failures)
    if options.view:
        _view(_page(canal, recorded), options.port)
    return ExitStatus.BAD_INPUT if failures else ExitStatus.DONE


def _dropped(demonstrations: Sequence[Demonstration]) -> list[str]:
    """How many samples were left out of which recording."""
    return [
        f"{d.name}: {d.dropped} of {len(d) + d.dropped} samples could not be used and were dropped"
        for d in demonstrations
        if d.dropped
    ]


def outputs_of(options: LearnOptions) -> list[Output]:
    """The files that it will write, those beside the named ones included."""
    outputs = []
    if options.output is not None:
        outputs.append(Output("-o", options.output, (".npz",)))
    if options.html is not None:
        outputs.append(Output("--html", options.html, (".html", ".htm")))
    if options.plot is not None:
        from geosacs_drake.results.plotting import frames_path

        outputs.append(Output("--plot", options.plot, PICTURES))
        outputs.append(Output("--plot", frames_path(options.plot), PICTURES))
    if options.reach and (beside := _beside(options)) is not None:
        from geosacs_drake.results.reach_plot import reach_path

        outputs.append(Output("--reach", reach_path(beside), PICTURES))
    return outputs


def _beside(options: LearnOptions) -> Path | None:
    """What the picture of the reach lies beside."""
    return options.plot or (options.output and options.output.with_suffix(".png"))


def orientation_hint(canal: CanalSurface) -> list[str]:
    """A line where the gripper points up on the mean: read in the wrong order, quaternions turn its axis just so.

    The tool's x axis points out of the gripper; its height is 2 (xz - wy), and what x, y, z, w comes to if it is read
    as w, x, y, z is the negative of that.
    """
    w, x, y, z = canal.orientations.T
    height = float(np.mean(2.0 * (x * z - w * y)))
    if height < POINTS_UP:
        return []
    angle = math.degrees(math.asin(min(1.0, height)))
    return [
        f"the gripper points {angle:.0f}° up on the mean: if the quaternions are x, y, z, w, say so with "
        "--quaternion-order xyzw (and leave it out if they are w, x, y, z)"
    ]


def report(canal: CanalSurface, quality: CanalQuality) -> list[str]:
    """What a person wants to know about a canal, line by line.

    Args:
        canal: as learned.
        quality: its figures.
    """
    radii_mm, home = 1e3 * canal.radii, canal.home_disk
    narrow, wide = int(np.argmin(radii_mm)), int(np.argmax(radii_mm))
    x, y, z = canal.directrix[home]
    spread = np.degrees(4 * np.arcsin(np.minimum(1.0, canal.orientation_sd / 2)))
    weights, q = canal.orientation_weights, quality
    spacing_mm = 1e3 * canal.length / (canal.n_disks - 1)
    rows = [
        ("demonstrations", f"{len(canal.demonstrations)}, {canal.moving_time_s:.1f} s of motion each on the mean"),
        ("length", f"{canal.length:.3f} m, {canal.n_disks} disks every {spacing_mm:.1f} mm"),
        ("radius", f"{radii_mm[narrow]:.0f} mm at disk {narrow} to {radii_mm[wide]:.0f} mm at disk {wide}"),
        ("", f"pick {radii_mm[0]:.0f} mm, home {radii_mm[home]:.0f} mm, place {radii_mm[-1]:.0f} mm"),
        ("home", f"disk {home} at ({x:.3f}, {y:.3f}, {z:.3f}) m"),
        ("orientation", f"spread {spread.mean():.0f}° on the mean, {spread.max():.0f}° at disk {np.argmax(spread)}"),
        ("", f"weight {weights.min():.2f} to {weights.max():.2f}"),
        ("tilt of disks", f"at most {q.tilt_max:.1f}° against the path"),
        ("neighbours", f"use at most {100 * q.crossing:.0f} % of their gap (they cross at 100)"),
        ("correction x", f"{q.x_to_global_mean:.0f}° from x_G on the mean, {q.x_to_global_max:.0f}° at most"),
        ("", f"turns at most {q.x_turn_max:.1f}° from disk to disk"),
    ]
    if canal.ellipses is not None:
        a, b, _ = canal.ellipses.T
        area = float(np.mean(a * b) / np.mean(canal.radii**2))
        rows.append(("ellipses", f"{100 * area:.0f} % of the circles' area"))
    warnings = [f"warning: {line}" for line in (*canal.warnings, *orientation_hint(canal))]
    return [f"{name:16}{text}" for name, text in rows] + warnings


def _writers(
    canal: CanalSurface, recorded: Sequence[np.ndarray], options: LearnOptions, said: list[str]
) -> list[tuple[str, Callable[[], None]]]:
    """What writes each file; each adds to `said` what it has to say once it is done."""

    def save() -> None:
        assert options.output is not None
        save_canal(options.output, canal)
        said.append(f"canal written to {options.output}")

    def reach() -> None:
        from geosacs_drake.results.reach_plot import lio_reach, plot_reach, reach_path

        found = lio_reach(canal)
        said.extend(found.describe())
        if (beside := _beside(options)) is not None:
            plot_reach(reach_path(beside), canal, found)
            said.append(f"reach drawn to {reach_path(beside)}")

    def plot() -> None:
        from canal.navigation.tour import tour
        from geosacs_drake.results.plotting import frames_path, plot_canal, plot_frames

        assert options.plot is not None
        travelled = tour(canal)
        plot_canal(
            options.plot,
            canal,
            recorded=recorded,
            path=travelled.position,
            corrections=travelled.corrections,
            title="Canal, with a tour by a scripted thumb",
        )
        plot_frames(frames_path(options.plot), canal)
        said.append(f"pictures drawn to {options.plot} and {frames_path(options.plot)}")

    def html() -> None:
        from geosacs_drake.results.canal_html import write_html

        assert options.html is not None
        write_html(options.html, _page(canal, recorded))
        said.append(f"page written to {options.html}")

    wanted = (
        ("-o", save, options.output),
        ("--reach", reach, options.reach or None),
        ("--plot", plot, options.plot),
        ("--html", html, options.html),
    )
    return [(flag, write) for flag, write, output in wanted if output is not None]


def _page(canal: CanalSurface, recorded: Sequence[np.ndarray]) -> str:
    """The canal as a page, with a tour of it by a scripted thumb."""
    from canal.navigation.tour import tour
    from geosacs_drake.results.canal_html import canal_page

    travelled = tour(canal)
    return canal_page(canal, recorded=recorded, path=travelled.position, corrections=travelled.corrections)


def _view(page: str, port: int) -> None:
    """Show a page on localhost until Ctrl-C."""
    from geosacs_drake.results.canal_html import serve

    with serve(page, port) as server:
        address = f"http://127.0.0.1:{server.server_address[1]}/"
        print(f"the canal is shown at {address} (Ctrl-C ends)", flush=True)
        webbrowser.open(address)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            print()


def command(arguments: Sequence[str] | None = None, prog: str = PROG) -> NoReturn:
    """Learn as the command line says (or `arguments`), and leave with the exit status.

    Args:
        arguments: the command line; None: what the process was given.
        prog: the command's name, for messages.
    """
    with Interrupts():
        end(lambda: main(parse(arguments, prog)), prog)


if __name__ == "__main__":
    command()
