"""Pictures of a canal: in the manner of the paper's Fig. 6, and Bishop against correction frames (its Fig. 4)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from canal.errors import InputError
from canal.files import write_and_rename
from canal.learning.frames import bishop_frames
from canal.quality import angles
from canal.surface import CanalSurface

_RIM = np.linspace(0.0, 2 * np.pi, 49)
_N_DISKS_DRAWN = 60
_N_FRAMES_DRAWN = 26


def plot_canal(
    output: str | os.PathLike,
    canal: CanalSurface,
    *,
    recorded: Sequence[np.ndarray] = (),
    path: np.ndarray | None = None,
    corrections: Sequence[np.ndarray] = (),
    title: str = "",
) -> None:
    """Draw a canal as the paper's Fig. 6 does, seen from three sides, into a `.png`, `.pdf` or `.svg`.

    Demonstrations red, directrix dotted blue, disks black, the travelled path green, corrections solid blue.

    Args:
        output: file to write.
        canal: the surface.
        recorded: positions of the demonstrations as recorded, each (N, 3), [m]; the aligned ones if empty.
        path: positions that were travelled, (T, 3), [m].
        corrections: parts of the path on which a thumb corrected, each (k, 3), [m].
        title: above the picture.

    Raises:
        InputError: the file's ending is none that can be drawn, or it cannot be written.
    """
    figure = Figure(figsize=(16, 7.5))
    curves = list(recorded) or list(canal.demonstrations)
    rims = rim_points(canal, _disks_to_draw(canal, _N_DISKS_DRAWN))
    styled: list[tuple[np.ndarray, dict[str, Any]]] = [
        (rim, {"color": "black", "lw": 0.5, "alpha": 0.55, "zorder": 1}) for rim in rims
    ]
    styled += [(curve, {"color": "red", "lw": 1.3, "zorder": 2}) for curve in curves]
    if path is not None:
        styled.append((path, {"color": "green", "lw": 1.8, "zorder": 3}))
    styled.append((canal.directrix, {"color": "blue", "ls": ":", "lw": 1.8, "zorder": 4}))
    styled += [(curve, {"color": "blue", "lw": 2.6, "zorder": 5}) for curve in corrections]

    solid: Any = figure.add_axes((0.0, 0.03, 0.5, 0.95), projection="3d", proj_type="ortho", computed_zorder=False)
    for curve, style in styled:
        solid.plot(*curve.T, **style)
    _equal_box(solid, np.concatenate([curve for curve, _ in styled]))
    solid.view_init(24, -52)
    # Left and right as someone at the robot sees them: y grows to the left.
    for name, (across, up), place in (
        ("from above", (1, 0), (0.55, 0.60, 0.43, 0.33)),
        ("from the robot", (1, 2), (0.55, 0.14, 0.43, 0.33)),
    ):
        flat = figure.add_axes(place, aspect="equal", title=name)
        for curve, style in styled:
            flat.plot(curve[:, across], curve[:, up], **style)
        flat.set(xlabel=f"{'xyz'[across]} [m]", ylabel=f"{'xyz'[up]} [m]")
        flat.invert_xaxis()
        flat.grid(alpha=0.3)
    handles = [
        Line2D([], [], color="red", label="demonstrations"),
        Line2D([], [], color="blue", ls=":", label="directrix"),
        Line2D([], [], color="black", lw=0.8, label="disks"),
    ]
    if path is not None:
        handles.append(Line2D([], [], color="green", label="path"))
    if len(corrections):
        handles.append(Line2D([], [], color="blue", lw=2.6, label="corrections"))
    figure.legend(handles=handles, loc="lower center", ncols=5, frameon=False)
    if title:
        figure.suptitle(title)
    save_figure(figure, output)


def plot_frames(output: str | os.PathLike, canal: CanalSurface) -> None:
    """Draw Bishop frames and correction frames along the directrix, and their angles, side by side (paper Fig. 4).

    Args:
        output: file to write.
        canal: the surface.
    """
    bishop = bishop_frames(canal.directrix, canal.tangents, canal.x_axes[0])
    correction = (canal.x_axes, canal.y_axes)
    figure = Figure(figsize=(15, 10))
    top, bottom = np.asarray(figure.subfigures(2, 1, height_ratios=(2, 1)))
    disks = _disks_to_draw(canal, _N_FRAMES_DRAWN)
    size = 0.06 * max(0.3, float(np.ptp(canal.directrix, axis=0).max()))
    for k, (name, (x, y)) in enumerate((("Bishop frames", bishop), ("correction frames", correction))):
        axes: Any = top.add_axes((0.5 * k, 0.0, 0.5, 0.95), projection="3d", proj_type="ortho")
        axes.plot(*canal.directrix.T, color="black", lw=0.8)
        points = canal.directrix[disks]
        for vectors, color in ((canal.tangents, "goldenrod"), (x, "red"), (y, "green")):
            axes.quiver(*points.T, *(size * vectors[disks]).T, color=color, lw=1.4, arrow_length_ratio=0.25)
        _equal_box(axes, canal.directrix, room=size)
        axes.view_init(22, -58)
        axes.set_title(f"{name}: e_T yellow, x red, y green", fontsize=10)
    arc = canal.arc
    panels = bottom.subplots(1, 2, gridspec_kw={"left": 0.06, "right": 0.98, "bottom": 0.16, "top": 0.96})
    x_global = np.broadcast_to(canal.x_global, canal.directrix.shape)
    for (name, (x, y)), style in ((("Bishop", bishop), "--"), (("correction", correction), "-")):
        panels[0].plot(arc, angles(x, x_global), color="red", ls=style, label=f"{name} x to x_G")
        panels[1].plot(arc[1:], angles(x[1:], x[:-1]), color="red", ls=style, lw=1, label=f"{name} x")
        panels[1].plot(arc[1:], angles(y[1:], y[:-1]), color="green", ls=style, lw=1, label=f"{name} y")
    panels[0].set_ylabel("angle to x_G [°]")
    panels[1].set_ylabel("turn from disk to disk [°]")
    for panel in panels:
        panel.set_xlabel("arc [m]")
        panel.grid(alpha=0.3)
        panel.legend(frameon=False)
    save_figure(figure, output)


def rim_points(canal: CanalSurface, disks: np.ndarray) -> np.ndarray:
    """Points around the rims of some disks, closed, clipped at support planes, [m]. Shape (len(disks), 49, 3).

    Args:
        canal: the surface.
        disks: continuous indices. Shape (P,).
    """
    return np.array([[canal.point(disk, 1.0, phi) for phi in _RIM] for disk in disks.tolist()])


def frames_path(output: str | os.PathLike) -> Path:
    """Where the second picture goes: `c.png` has `c-frames.png` beside it."""
    path = Path(output)
    return path.with_name(f"{path.stem}-frames{path.suffix}")


def save_figure(figure: Figure, output: str | os.PathLike) -> None:
    """Write a figure by way of a temporary file.

    Args:
        figure: drawn.
        output: file to write: `.png`, `.pdf` or `.svg`.

    Raises:
        InputError: the file's ending is none that can be drawn.
    """
    path = Path(output)
    ending = path.suffix.lower().lstrip(".")
    if ending not in ("png", "pdf", "svg"):
        raise InputError(f"{path}: cannot draw into '.{ending}'; give a name that ends in .png, .pdf or .svg")
    canvas = FigureCanvasAgg(figure)
    with matplotlib.rc_context({"svg.hashsalt": "geosacs"}):
        write_and_rename(path, lambda stream: canvas.print_figure(stream, format=ending, dpi=130))


def _disks_to_draw(canal: CanalSurface, n: int) -> np.ndarray:
    return np.unique(np.linspace(0, canal.n_disks - 1, n).round().astype(int))


def _equal_box(axes, points: np.ndarray, room: float = 0.0) -> None:
    """The same scale along all three axes, in metres."""
    low, high = points.min(axis=0) - room, points.max(axis=0) + room
    span = np.maximum(high - low, 0.15 * float((high - low).max()))
    middle = 0.5 * (low + high)
    for set_limits, centre, width in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), middle, span, strict=True):
        set_limits(centre - width / 2, centre + width / 2)
    axes.set_box_aspect(span, zoom=1.0)
    axes.locator_params(nbins=5)
    axes.tick_params(labelsize=7)
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
