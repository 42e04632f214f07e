"""What the arm reaches of a canal.

A canal is shown by hand, and knows nothing of joints: whether the arm follows it everywhere, out to the rims, is
asked before anything moves. Each sampled disk is tried at its centre and on rings around it, in the branch of
postures that reaches most. Here the canal of the relocation, moved 0.18 m away from the robot, so that there is
something to see.
"""

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from style import BLACK, BLUE, RED, YELLOW, fit, new_figure, save, shipped_canal, solid

from canal.retargeting import retarget
from diagrams.ik.reachability import reach_report
from diagrams.ik.solver import IkSolver
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant
from geosacs_drake.results.plotting import rim_points

near = shipped_canal("relocation")
away = np.array([0.18, 0.0, 0.0])
canal = retarget(near, pick=near.directrix[0] + away, place=near.directrix[-1] + away)
report = reach_report(IkSolver(make_arm_plant(), TCP_FRAME), canal, rings=2, spokes=8, most_disks=31)

colors = LinearSegmentedColormap.from_list("reach", [RED, YELLOW, BLUE])
figure = new_figure(11, 4.2)
axes = solid(figure, (1, 2, 1), view=(24, -40))
drawn = np.linspace(0, canal.n_disks - 1, 60).astype(int)
rims = rim_points(canal, drawn)
for disk, rim in zip(drawn, rims, strict=True):
    axes.plot(*rim.T, color=colors(report.share[disk]), lw=1.2)
axes.plot(*canal.directrix.T, color=BLACK, ls=":", lw=1.2)
fit(axes, rims.reshape(-1, 3), zoom=1.4)
share = figure.add_subplot(1, 2, 2, xlabel="arc [m]", ylabel="reached of each disk [%]", ylim=(-4, 104))
share.plot(canal.arc, 100 * report.share, color=BLUE)
share.fill_between(canal.arc, 100 * report.share, color=BLUE, alpha=0.12)
for disk, name in ((0, "pick"), (canal.home_disk, "home"), (canal.n_disks - 1, "place")):
    share.text(canal.arc[disk], 8, name, ha="center")
print("\n".join(report.describe()))
save(figure)
