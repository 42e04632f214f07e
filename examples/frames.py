"""Bishop frames beside correction frames, along one curve.

A Bishop frame turns as little as it can from one point to the next, and so drifts away from any direction that a
person knows. The *correction frame* keeps its x axis as near to the global $x_G$ as continuity allows, so that the
same thumb does the same thing all along the canal. Tangents are yellow, x axes red, y axes green; the circles mark
where the Bishop frame's x axis has turned furthest from $x_G$. Below: the angle to $x_G$, and the angle between
neighbours (Fig. 3 of the paper, section IV-B).
"""

import numpy as np
from style import BLACK, GREY, RED, TANGENT, X_AXIS, Y_AXIS, arrows, fit, new_figure, save, solid

from canal.learning.frames import bishop_frames, correction_frames
from canal.learning.learn import unit_tangents
from canal.quality import angles

u = np.linspace(0.0, 1.0, 301)
curve = np.column_stack([0.16 * np.cos(3 * np.pi * u), 1.2 * u, 0.30 * np.sin(3 * np.pi * u)])
tangents = unit_tangents(np.gradient(curve, axis=0))
arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
x_global = np.array([1.0, 0.0, 0.0])
frames = {"correction": correction_frames(curve, tangents, np.zeros(len(u)), x_global, start=x_global)}
frames = {"Bishop": bishop_frames(curve, tangents, start=frames["correction"][0][0])} | frames

everywhere = np.broadcast_to(x_global, curve.shape)
astray = angles(frames["Bishop"][0], everywhere)
marked = np.argsort(astray)[-40::13]

figure = new_figure(11, 6.6)
top, bottom = figure.subfigures(2, 1, height_ratios=(1.5, 1))
drawn, size = np.arange(0, len(u), 11), 0.11
for k, (name, (x, y)) in enumerate(frames.items()):
    axes = solid(top, (1, 2, k + 1), view=(24, -28))
    axes.plot(*curve.T, color=BLACK, lw=1, zorder=3)
    for vectors, color in ((tangents, TANGENT), (x, X_AXIS), (y, Y_AXIS)):
        arrows(axes, curve[drawn], size * vectors[drawn], color)
    axes.scatter(*curve[marked].T, s=320, facecolor="none", edgecolor=GREY, linewidth=1.6, zorder=6, depthshade=False)
    fit(axes, curve, zoom=1.15)
    axes.set_title(f"{name} frames")

to_global, between = bottom.subplots(1, 2)
for (name, (x, y)), line in zip(frames.items(), ("--", "-"), strict=True):
    to_global.plot(arc, angles(x, everywhere), color=RED, ls=line, label=f"{name} x")
    between.plot(arc[1:], angles(x[1:], x[:-1]), color=X_AXIS, ls=line, lw=1.4, label=f"{name} x")
    between.plot(arc[1:], angles(y[1:], y[:-1]), color=Y_AXIS, ls=line, lw=1.4, label=f"{name} y")
    far, turn = angles(x, everywhere).max(), angles(y[1:], y[:-1]).max()
    print(f"{name} frames: x is up to {far:.0f}° from x_G, y turns by {turn:.1f}° from disk to disk at most")
to_global.set(xlabel="arc [m]", ylabel="angle of x to $x_G$ [°]", ylim=(0, None))
between.set(xlabel="arc [m]", ylabel="from disk to disk [°]", ylim=(0, None))
to_global.legend()
between.legend(ncols=2, fontsize=8, loc="upper right", bbox_to_anchor=(1.0, 1.12))
save(figure)
