"""A canal that ends on a table.

A hand that demonstrates does not come down exactly upright, so that the last disks are tilted and dip into the table.
A *support plane* mends this: a disk that dips where the path goes towards the plane takes the plane's normal, and its
neighbours blend over by the same relaxation that keeps disks from crossing (section V-B of the paper, *cross section
refinements*). Beside a plane that runs along the path, points are clipped instead. Left: as learned; right: with the
table as a support plane.
"""

import numpy as np
from style import BLUE, GREY, RED, fit, new_figure, save, solid

from canal.demonstration import Demonstration, load_demonstration
from canal.editing import with_support_planes
from canal.learning import learn_canal
from canal.support_planes import SupportPlane
from models import MODELS

askew = []
for k in (1, 2):
    shown = load_demonstration(MODELS / "demonstrations" / f"relocation_{k}.npz")
    position = shown.position.copy()
    placing = position[:, 1] > 0
    position[placing, 0] += 0.45 * np.maximum(0.62 - position[placing, 2], 0.0)  # the hand comes down askew
    askew.append(Demonstration(position, shown.orientation, shown.time))
canal = learn_canal(askew)
table = SupportPlane(normal=(0.0, 0.0, 1.0), offset=canal.directrix[-1, 2] - 0.002)
canals = {"as learned": canal, "with a support plane": with_support_planes(canal, (table,))}

figure = new_figure(10, 3.6)
for k, (name, shown) in enumerate(canals.items()):
    axes = solid(figure, (1, 2, k + 1), view=(5, -88))
    last = np.arange(shown.n_disks - 34, shown.n_disks, 3)
    circle = np.linspace(0.0, 2 * np.pi, 49)
    # The circle itself; a point of the canal is clipped at its support planes.
    rims = np.array(
        [
            shown.directrix[s] + shown.radii[s] * (np.outer(np.cos(circle), x) + np.outer(np.sin(circle), y))
            for s, x, y in ((s, *shown.axes(s)) for s in last)
        ]
    )
    for points in rims:
        below = points[:, 2] < table.offset
        axes.plot(*points.T, color=GREY, lw=1.2, zorder=3)
        axes.plot(*np.where(below[:, None], points, np.nan).T, color=RED, lw=2.2, zorder=6)
    axes.plot(*shown.directrix[last[0] :].T, color=BLUE, ls=":", zorder=5)
    centre, half = shown.directrix[-1], 0.22
    corners = np.array([[-half, -half], [half, -half], [half, half], [-half, half]]) + centre[:2]
    plane = np.column_stack([corners, np.full(4, table.offset)])
    axes.plot_trisurf(*plane.T, color="#C9B79C", alpha=0.55, shade=False, zorder=2)
    fit(axes, np.vstack([plane - [0.0, 0.0, 0.05], plane + [0.0, 0.0, 0.2]]), zoom=1.5)
    axes.set_title(name)
    depth = 1e3 * max(0.0, table.offset - rims[:, :, 2].min())
    print(f"{name}: the rims dip by up to {depth:.0f} mm; the plane is at {table.offset:.3f} m")
save(figure)
