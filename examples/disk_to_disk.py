"""From one disk to the next: the ratio rule.

The robot is at $p_{s-1}$ on the disk $C_{s-1}$. Its distance from the centre, as a share of the radius, is the ratio
$\\eta$; its direction in the disk's frame is the angle $\\varphi$. On the next disk both are the same, and the radius
is that disk's own: $p_s = c_s + \\eta\\,r_s\\,(\\cos\\varphi\\,x_s + \\sin\\varphi\\,y_s)$ (Fig. 4 of the paper,
section IV-C).
"""

import numpy as np
from style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    SKY,
    X_AXIS,
    Y_AXIS,
    arrows,
    fit,
    new_figure,
    note,
    save,
    shipped_canal,
    solid,
)

from geosacs_drake.results.plotting import rim_points

ETA, PHI = 0.75, np.radians(130.0)
canal = shipped_canal("relocation")
disks = (80, 118)  # far enough apart to be seen as two; the robot's next disk is 5 mm on
way = np.linspace(*disks, 40)

figure = new_figure(7, 6)
axes = solid(figure, view=(28, -105))
skin = rim_points(canal, way)
axes.plot_surface(*np.moveaxis(skin, 2, 0), color=SKY, alpha=0.10, linewidth=0, shade=False, zorder=1)
fit(axes, skin.reshape(-1, 3), zoom=1.25)
for disk, s in zip(disks, ("s-1", "s"), strict=True):
    centre, radius, (x, y) = canal.center(disk), canal.radius(disk), canal.axes(disk)
    rim = rim_points(canal, np.array([float(disk)]))[0]
    p = canal.point(disk, ETA, PHI)
    axes.plot_trisurf(*rim.T, color=SKY, alpha=0.35, linewidth=0, shade=False, zorder=2)
    axes.plot(*rim.T, color=BLACK, lw=1.2, zorder=3)
    for vector, color, name in ((x, X_AXIS, "x"), (y, Y_AXIS, "y")):
        arrows(axes, centre, 0.85 * radius * vector, color, lw=2, arrow_length_ratio=0.12)
        note(axes, centre + radius * vector, f"${name}_{{{s}}}$", (14, -6), color)
    axes.plot(*np.array([centre, p]).T, color=BLUE, lw=2.2, zorder=6)
    axes.scatter(*centre, color=BLACK, s=22, zorder=7)
    axes.scatter(*p, color=GREEN, s=60, zorder=7)
    note(axes, centre, f"$c_{{{s}}}$", (12, 10))
    note(axes, p, f"$p_{{{s}}}$", (-16, -10), GREEN)
    note(axes, (centre + p) / 2, rf"$\eta\,r_{{{s}}}$", (-6, 13), BLUE)
    print(f"disk {disk}: r = {radius:.4f} m, |p - c| = {np.linalg.norm(p - centre):.4f} m, ratio {ETA}")
for eta, color, line in ((ETA, GREEN, "-"), (0.0, GREY, ":")):
    axes.plot(*np.array([canal.point(disk, eta, PHI) for disk in way]).T, color=color, ls=line, zorder=5)
save(figure)
