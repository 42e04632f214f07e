"""Ratio strategies: what becomes of a correction.

On the way out a correction is kept (*fixed*). On the way home it fades: $\\eta = \\eta_f + (\\eta_0 -
\\eta_f)\\,e^{-a u^2}$, $u$ being the part of the leg that has been travelled. With $\\eta_f = 0$ the path *converges*
to the directrix; with $\\eta_f = 1$ it *diverges* to the wall. The paper's formula, $e^{-\\lambda(s-1)}$ with
$\\lambda = 5\\cdot10^{-4}$, would leave most of a correction after half a canal (section IV-C; see the deviations).
"""

import numpy as np
from style import BLUE, GREEN, GREY, PINK, RED, draw_canal, fit, new_figure, save, shipped_canal, solid

from canal.navigation import Leg, NavigationOptions, NavigationState, strategy_ratio

canal = shipped_canal("relocation")
ETA_0, PHI = 0.8, np.radians(60.0)
out = NavigationState(disk=canal.home_disk, leg=Leg.HOME_TO_PLACE, anchor_disk=canal.home_disk, anchor_eta=ETA_0)
home = NavigationState(disk=0, leg=Leg.PICK_TO_HOME, anchor_disk=0, anchor_eta=ETA_0)
strategies = {
    "fixed (outwards)": (out, NavigationOptions(), GREY),
    "convergent, a = 11.7": (home, NavigationOptions(), GREEN),
    "divergent, a = 11.7": (home, NavigationOptions(eta_f=1.0), RED),
    "convergent, the paper's λ": (home, NavigationOptions(decay="paper"), PINK),
}

figure = new_figure(11, 3.8)
ratio = figure.add_subplot(1, 2, 1, xlabel="disks travelled", ylabel="ratio η", ylim=(-0.03, 1.05))
axes = solid(figure, (1, 2, 2), view=(20, -35))
rims = draw_canal(axes, canal, disks=30)
axes.plot(*canal.directrix.T, color=BLUE, ls=":", lw=1.6, zorder=4)
for name, (state, options, color) in strategies.items():
    travelled = np.arange(canal.home_disk + 1.0)
    disks = state.anchor_disk + Leg(state.leg).direction * travelled
    etas = [strategy_ratio(canal, state, disk, options) for disk in disks]
    ratio.plot(travelled, etas, color=color, label=name)
    path = [canal.point(disk, eta, PHI) for disk, eta in zip(disks, etas, strict=True)]
    axes.plot(*np.array(path).T, color=color, zorder=5)
    print(f"{name:26} η from {etas[0]:.2f} to {etas[-1]:.4f}")
ratio.legend()
fit(axes, rims, zoom=1.5)
save(figure)
