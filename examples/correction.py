"""A correction: the thumb on the pad, and the point on the disk.

While the stick is off centre the robot stays on its disk, and the point moves by $(k_x x_s + k_y y_s)\\cdot 20/\\delta$
metres a second, no further than the rim. Let go, and the path goes on from $p'_s$ with the ratio and the angle that it
has then (Fig. 5 of the paper, sections IV-D and V-D). The stick was held for 0.35 s.
"""

import math
from dataclasses import replace

import numpy as np
from matplotlib.patches import Circle, FancyBboxPatch
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

from canal.navigation import initial_state, step
from canal.navigation.joystick import JOYSTICK_SIZE
from geosacs_drake.results.plotting import rim_points

canal = shipped_canal("relocation")
stick = np.zeros(JOYSTICK_SIZE)
stick[:2] = 0.55, 0.75
before = replace(initial_state(canal), disk=60.0, eta=0.35, phi=np.radians(200.0), running=1.0)
after, path = before, [canal.point(before.disk, before.eta, before.phi)]
for _ in range(35):
    after = step(canal, after, stick, 0.01)
    path.append(canal.point(after.disk, after.eta, after.phi))
p, p_new = path[0], path[-1]

figure = new_figure(10, 4.6)
pad = figure.add_subplot(1, 2, 1, aspect="equal", title="the pad")
pad.set_axis_off()
pad.set(xlim=(-1.5, 1.5), ylim=(-1.5, 1.5))
pad.add_patch(FancyBboxPatch((-1.1, -1.1), 2.2, 2.2, boxstyle="round,pad=0.15", facecolor="#F3F4F6", edgecolor=GREY))
pad.add_patch(Circle((0, 0), 1.0, facecolor="white", edgecolor=GREY, lw=1.2))
for (x, y), color, name in (((1, 0), X_AXIS, "$k_x$"), ((0, 1), Y_AXIS, "$k_y$")):
    pad.annotate("", (x, y), (0, 0), arrowprops={"arrowstyle": "->", "color": color, "lw": 1.6})
    pad.text(1.12 * x, 1.12 * y, name, color=color, fontsize=14, ha="center", va="center")
pad.annotate("", stick[:2], (0, 0), arrowprops={"arrowstyle": "-|>", "color": BLUE, "lw": 3, "mutation_scale": 22})
pad.text(0.62, 0.55, f"({stick[0]}, {stick[1]})", color=BLUE, ha="left", fontsize=11)

(x, y), centre, radius = canal.axes(before.disk), canal.center(before.disk), canal.radius(before.disk)
eye = np.cross(x, y) - 0.75 * y - 0.3 * x  # where we look from: above the disk, somewhat from below y and left of x
elevation, azimuth = math.asin(eye[2] / np.linalg.norm(eye)), math.atan2(eye[1], eye[0])
disk = solid(figure, (1, 2, 2), view=(math.degrees(elevation), math.degrees(azimuth), 180.0))
disk.set_title("the disk")
rim = rim_points(canal, np.array([before.disk]))[0]
fit(disk, np.vstack([rim, centre + 1.05 * radius * np.array([x, y])]), zoom=1.05)
skin = rim_points(canal, np.linspace(before.disk - 12, before.disk + 12, 25))
disk.plot_surface(*np.moveaxis(skin, 2, 0), color=SKY, alpha=0.10, linewidth=0, shade=False, zorder=1)
disk.plot_trisurf(*rim.T, color=SKY, alpha=0.3, linewidth=0, shade=False, zorder=2)
disk.plot(*rim.T, color=BLACK, lw=1.2, zorder=3)
for vector, color, name in ((x, X_AXIS, "$x_s$"), (y, Y_AXIS, "$y_s$")):
    arrows(disk, centre, 0.95 * radius * vector, color, lw=1.6, arrow_length_ratio=0.1)
    note(disk, centre + 1.1 * radius * vector, name, (0, 0), color)
moved = p_new - p
for origin, part in ((p, (moved @ x) * x), (p + (moved @ x) * x, (moved @ y) * y)):
    disk.plot(*np.array([origin, origin + part]).T, color=BLUE, lw=1.2, ls="--", zorder=5)
arrows(disk, p, moved, BLUE, lw=3, arrow_length_ratio=0.18)
for point, name, offset in ((p, "$p_s$", (-16, -8)), (p_new, "$p'_s$", (18, 8))):
    disk.scatter(*point, color=GREEN, s=50, zorder=7)
    note(disk, point, name, offset, GREEN)
length = after.correction_distance_m
print(f"moved by {1e3 * length:.1f} mm: ratio {before.eta:.2f} to {after.eta:.2f} on a disk of {1e3 * radius:.0f} mm")
save(figure)
