"""The picture of a reach report, and the words that go with it, for `learn --reach`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from tqdm import tqdm

from canal.surface import CanalSurface
from diagrams.ik.options import IkOptions
from diagrams.ik.reachability import ReachReport, reach_report
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import find_start_posture
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant
from diagrams.station.lio_station import START_POSTURE
from geosacs_drake.results.plotting import save_figure

_COLORS = LinearSegmentedColormap.from_list("reach", [(0.84, 0.19, 0.15), (0.99, 0.88, 0.56), (0.27, 0.46, 0.71)])


def lio_reach(canal: CanalSurface, options: IkOptions | None = None) -> ReachReport:
    """What the Lio reaches of a canal, with a progress bar when it takes long.

    Args:
        canal: in the robot's base frame.
        options: of the inverse kinematics; None for the defaults.

    Raises:
        InputError: the canal's home is out of reach.
    """
    solver = IkSolver(make_arm_plant(), TCP_FRAME, options)
    start = find_start_posture(solver, canal, preferred=START_POSTURE)
    with tqdm(desc="reach", delay=2.0, leave=False) as bar:

        def progress(done: int, whole: int) -> None:
            bar.total = whole
            bar.update(done - bar.n)

        return reach_report(solver, canal, start, progress=progress)


def reach_path(plot: Path) -> Path:
    """NAME-reach beside the canal's picture."""
    return plot.with_name(f"{plot.stem}-reach{plot.suffix}")


def plot_reach(path: Path, canal: CanalSurface, report: ReachReport) -> None:
    """Draw the canal coloured by reach, the share of each disk, and where on the rim it ends; png, pdf or svg.

    Args:
        path: file to write.
        canal: the surface.
        report: what the arm reaches of it.
    """
    figure = Figure(figsize=(12, 6.5), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.15, 1.0))
    space = figure.add_subplot(grid[:, 0], projection="3d")
    _draw_canal(space, canal, report)
    share = figure.add_subplot(grid[0, 1])
    disks = np.arange(canal.n_disks)
    share.fill_between(disks, 100 * report.share, color=_COLORS(1.0), alpha=0.35, linewidth=0)
    share.plot(disks, 100 * report.share, color=_COLORS(1.0))
    missed = report.disks[~report.center_reached]
    share.plot(missed, np.zeros(len(missed)), "|", color=_COLORS(0.0), markersize=14, label="centre out of reach")
    share.set(xlim=(0, canal.n_disks - 1), ylim=(-4, 104), ylabel="reached of the disk [%]")
    share.set_title(f"within 1 mm and one standard deviation: {100 * float(report.share.mean()):.0f} % of the canal")
    if len(missed):
        share.legend(loc="center")
    rim = figure.add_subplot(grid[1, 1], sharex=share)
    # Reached part of each spoke: the rings stand for equal areas.
    part = report.reached.mean(axis=1)
    edges = np.append(np.degrees(report.phis), 360.0)
    borders = np.concatenate(([0], (report.disks[1:] + report.disks[:-1]) / 2, [canal.n_disks - 1]))
    mesh = rim.pcolormesh(borders, edges, part.T, cmap=_COLORS, vmin=0, vmax=1)
    rim.set(xlabel="disk", ylabel="φ on the disk [°]", yticks=range(0, 361, 90))
    figure.colorbar(mesh, ax=rim, label="reached of the spoke")
    for axes in (share, rim):
        for disk, name in ((0, "pick"), (canal.home_disk, "home"), (canal.n_disks - 1, "place")):
            axes.axvline(disk, color="0.4", linewidth=0.8, linestyle=":")
            if axes is share:
                axes.text(disk, 50, f" {name} ", ha="right" if disk else "left", color="0.3")
    save_figure(figure, path)


def _draw_canal(axes, canal: CanalSurface, report: ReachReport) -> None:
    """Rims of disks coloured by share, the directrix, and dots where a point is out of reach."""
    angles = np.linspace(0, 2 * np.pi, 37)
    colors = _COLORS(report.share)
    for disk in np.linspace(0, canal.n_disks - 1, 80).astype(int).tolist():
        axes.plot(*np.array([canal.point(disk, 1.0, phi) for phi in angles]).T, color=colors[disk], linewidth=0.9)
    out = [
        canal.point(float(report.disks[row]), float(report.etas[ring]), float(report.phis[spoke]))
        for row, ring, spoke in zip(*np.nonzero(~report.reached), strict=True)
    ]
    if out:
        axes.scatter(*np.array(out).T, s=3, color=_COLORS(0.0), alpha=0.5, label="out of reach")
        axes.legend(loc="upper left")
    axes.plot(*canal.directrix.T, ":", color="0.1", linewidth=1.4)
    for disk, name in ((0, "pick"), (canal.home_disk, "home"), (canal.n_disks - 1, "place")):
        axes.text(*canal.directrix[disk], f" {name}", va="bottom" if name == "home" else "top")
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    axes.set_aspect("equal")
