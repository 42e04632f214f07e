"""One look for all pictures of the gallery.

Colours are Okabe and Ito's, which colour-blind readers tell apart; what they mean is the same everywhere.
"""

import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import proj3d

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.surface import CanalSurface
from geosacs_drake.results.plotting import rim_points
from models import MODELS

RED, BLUE, GREEN, YELLOW = "#D55E00", "#0072B2", "#009E73", "#E69F00"
SKY, PINK, BLACK, GREY = "#56B4E9", "#CC79A7", "#222222", "#8A8F98"
DEMONSTRATION, DIRECTRIX, PATH, CORRECTION = RED, BLUE, GREEN, BLUE
X_AXIS, Y_AXIS, TANGENT = RED, GREEN, YELLOW

mpl.rcParams.update(
    {
        "font.size": 10,
        "axes.edgecolor": GREY,
        "axes.labelcolor": BLACK,
        "axes.titlesize": 11,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#E4E7EB",
        "grid.linewidth": 0.8,
        "legend.frameon": False,
        "lines.linewidth": 2.0,
        "lines.solid_capstyle": "round",
        "xtick.color": GREY,
        "ytick.color": GREY,
        "mathtext.fontset": "cm",
    }
)


def shipped_canal(task: str) -> CanalSurface:
    """The canal of `laundry` or `relocation`, learned from the demonstrations that ship."""
    return learn_canal([load_demonstration(MODELS / "demonstrations" / f"{task}_{k}.npz") for k in (1, 2)])


def new_figure(width: float = 9.0, height: float = 4.5) -> Figure:
    """An empty figure, sizes in inches."""
    return Figure(figsize=(width, height), layout="constrained")


def save(figure: Figure) -> None:
    """Draw the figure to the file that the command line names, else to the script's name with `.png`."""
    output = Path(sys.argv[1] if len(sys.argv) > 1 else Path(sys.argv[0]).with_suffix(".png").name)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # everything has its place now
    for artist in (artist for axes in figure.axes if axes.name == "3d" for artist in axes.get_children()):
        artist.set_clip_on(False)  # a solid may reach over the edge of its own axes
    figure.savefig(output, dpi=140, bbox_inches="tight", facecolor="white")
    print(f"drawn to {output}")


def solid(
    figure: Figure, place: Any = (1, 1, 1), view: tuple[float, ...] = (22.0, -60.0), axes_off: bool = True
) -> Any:
    """Axes in three dimensions, seen without perspective from an elevation, an azimuth, and with a roll [°]."""
    axes: Any = figure.add_subplot(*place, projection="3d", proj_type="ortho", computed_zorder=False)
    axes.view_init(*view)
    if axes_off:
        axes.set_axis_off()
    else:
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
            axis._axinfo["grid"].update(color="#E4E7EB", linewidth=0.6)
        axes.tick_params(labelsize=7)
        axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    return axes


def fit(axes: Any, points: np.ndarray, zoom: float = 1.3) -> None:
    """The same scale along all three axes, around points (N, 3)."""
    low, high = points.min(axis=0), points.max(axis=0)
    span = np.maximum(high - low, 0.08 * float((high - low).max()))
    middle = (low + high) / 2
    for limits, m, s in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), middle, span, strict=True):
        limits(m - s / 2, m + s / 2)
    axes.set_box_aspect(span, zoom=zoom)


def draw_canal(axes: Any, canal: CanalSurface, disks: int = 40, color: str = SKY, rim: str = BLACK) -> np.ndarray:
    """Draw the skin of a canal and the rims of some of its disks; returns the rims' points (N, 3)."""
    skin = rim_points(canal, np.linspace(0, canal.n_disks - 1, 120))
    axes.plot_surface(
        *np.moveaxis(skin, 2, 0), color=color, alpha=0.16, linewidth=0, rstride=1, cstride=1, shade=False, zorder=1
    )
    rims = rim_points(canal, np.linspace(0, canal.n_disks - 1, disks))
    for points in rims:
        axes.plot(*points.T, color=rim, lw=0.6, alpha=0.5, zorder=2)
    return rims.reshape(-1, 3)


def arrows(axes: Any, origins: np.ndarray, vectors: np.ndarray, color: str, **style: Any) -> None:
    """Draw vectors (N, 3) from origins (N, 3)."""
    style = {"lw": 1.4, "arrow_length_ratio": 0.22, "zorder": 5} | style
    axes.quiver(*np.atleast_2d(origins).T, *np.atleast_2d(vectors).T, color=color, **style)


def note(axes: Any, point: np.ndarray, text: str, offset: tuple[float, float], color: str = BLACK) -> None:
    """Write beside a point (3,), so many points of the page to the right and up; call it after `fit`."""
    x, y, _ = proj3d.proj_transform(*point, axes.get_proj())
    axes.annotate(
        text, (x, y), xytext=offset, textcoords="offset points", color=color, fontsize=14, ha="center", va="center"
    )
