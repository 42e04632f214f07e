"""Three canals along one directrix.

A canal is a curve with a disk at every point: the *directrix* $c(s)$, and the *radius* $r(s)$ that says how far a
person may correct there. Here one curve carries three radii: constant, growing, and wide only in the middle.
Cross-sections are circles throughout (Fig. 2 of the paper).
"""

import numpy as np
from style import DIRECTRIX, draw_canal, fit, new_figure, save, solid

from canal.learning.learn import build_surface, unit_tangents

u = np.linspace(0.0, 1.0, 201)
curve = np.column_stack([1.1 * u, 0.22 * np.sin(2 * np.pi * u), 0.16 * np.cos(1.4 * np.pi * u)])
tangents = unit_tangents(np.gradient(curve, axis=0))
across = np.cross(tangents, [0.0, 0.0, 1.0])
across /= np.linalg.norm(across, axis=1, keepdims=True)
upright = np.tile([1.0, 0.0, 0.0, 0.0], (2, len(u), 1))

figure = new_figure(11, 3.1)
for k, (name, radius) in enumerate(
    {
        "(a)  r constant": np.full_like(u, 0.08),
        "(b)  r grows": 0.03 + 0.11 * u,
        "(c)  r wide in the middle": 0.03 + 0.10 * np.sin(np.pi * u) ** 2,
    }.items()
):
    # Two "demonstrations" at the distance r on either side: their mean is the curve, and r their distance to it.
    demonstrations = np.stack([curve + radius[:, None] * across, curve - radius[:, None] * across])
    canal = build_surface(demonstrations, upright, tangents=tangents, moving_time_s=10.0)
    axes = solid(figure, (1, 3, k + 1), view=(24, -68))
    rims = draw_canal(axes, canal)
    axes.plot(*canal.directrix.T, color=DIRECTRIX, ls=":", zorder=4)
    axes.set_title(name)
    fit(axes, rims, zoom=1.15)
    print(f"{name}: {canal.radii.min():.3f} to {canal.radii.max():.3f} m")
save(figure)
