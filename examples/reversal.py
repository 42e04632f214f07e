"""Where the path turns back: the y axis that would flip.

A gripper goes down to pick, and up again. The tangent $e_T$ turns over at the bottom, the correction axis $x_s$ does
not, and so their product $e_T \\times x_s$ points the other way: a thumb that pushed to the right would push to the
left from one disk to the next. The disks here retrace their way instead, and $y_s$ is negated where it would point
more than 90° away from its predecessor. What looks like a left-handed frame is no fault (section IV-B of the paper).
"""

import numpy as np
from style import BLACK, GREY, TANGENT, X_AXIS, Y_AXIS, arrows, fit, new_figure, save, solid

from canal.learning.learn import build_surface, unit_tangents
from canal.quality import angles

u = np.linspace(0.0, 1.0, 241)
turn = np.clip((u - 0.4) / 0.2, 0.0, 1.0)  # a bend of 180° in a fifth of the way
heading = np.pi * turn * turn * (3 - 2 * turn)
speed = 0.4 * np.column_stack([0 * u + 0.04, np.sin(heading), -np.cos(heading)])
curve = np.cumsum(speed / len(u), axis=0)
tangents = unit_tangents(speed)
aside = np.array([[0.04, 0.0, 0.0]])
upright = np.tile([1.0, 0.0, 0.0, 0.0], (2, len(u), 1))
canal = build_surface(np.stack([curve + aside, curve - aside]), upright, tangents=tangents, moving_time_s=10.0)
flipping = np.cross(canal.tangents, canal.x_axes)

figure = new_figure(11, 4.4)
left, right = figure.subfigures(1, 2, width_ratios=(1.3, 1))
drawn, size = np.arange(4, len(u), 10), 0.03
for k, (name, y) in enumerate({"$e_T \\times x_s$ flips": flipping, "$y_s$ goes on": canal.y_axes}.items()):
    axes = solid(left, (1, 2, k + 1), view=(16, 20))
    axes.plot(*canal.directrix.T, color=BLACK, lw=1, zorder=3)
    for vectors, color in ((canal.tangents, TANGENT), (canal.x_axes, X_AXIS), (y, Y_AXIS)):
        arrows(axes, canal.directrix[drawn], size * vectors[drawn], color)
    fit(axes, canal.directrix, zoom=0.95)
    axes.set_title(name)
panel = right.subplots()
panel.plot(canal.arc, angles(flipping, flipping[:1]), color=GREY, ls="--", label="$e_T \\times x_s$")
panel.plot(canal.arc, angles(canal.y_axes, canal.y_axes[:1]), color=Y_AXIS, label="$y_s$")
panel.plot(canal.arc, angles(canal.x_axes, canal.x_axes[:1]), color=X_AXIS, label="$x_s$")
panel.set(xlabel="arc [m]", ylabel="angle to the first disk's [°]", ylim=(-5, 190))
panel.legend(loc="center left")
for name, y in (("e_T × x_s", flipping), ("y_s", canal.y_axes)):
    print(f"{name:9} ends {angles(y[-1:], y[:1]).item():.0f}° from where it began")
save(figure)
