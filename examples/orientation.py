"""How much orientation is worth, disk by disk.

Each disk carries the demonstrations' mean orientation $\\bar q_s$ and their spread $\\sigma_q(s)$. Where they agree the
tool has to be held like this, and the weight $w_o = e^{-\\alpha(\\sigma_q - \\beta)}$ of orientation in the inverse
kinematics is large; where they do not, the arm may choose (sections IV-A and V-C of the paper). Above: the mean tool
frame along the canal of the laundry, x (red) out of the gripper. Below: spread and weight.
"""

import numpy as np
from scipy.spatial.transform import Rotation
from style import BLUE, GREEN, PINK, RED, arrows, draw_canal, fit, new_figure, save, shipped_canal, solid

canal = shipped_canal("laundry")
figure = new_figure(10, 6.4)
top, bottom = figure.subfigures(2, 1, height_ratios=(1.5, 1))
axes = solid(top, view=(24, -142))
rims = draw_canal(axes, canal, disks=26)
axes.plot(*canal.directrix.T, color=BLUE, ls=":", lw=1.6, zorder=4)
drawn = np.linspace(0, canal.n_disks - 1, 16).astype(int)
turns = Rotation.from_quat(canal.orientations[drawn], scalar_first=True).as_matrix()
for k, color in enumerate((RED, GREEN, PINK)):
    arrows(axes, canal.directrix[drawn], 0.09 * turns[:, :, k], color)
fit(axes, rims, zoom=1.9)

spread = bottom.subplots()
weight = spread.twinx()
weight.grid(False)
weight.spines["right"].set_visible(True)
spread.plot(canal.arc, np.degrees(4 * np.arcsin(canal.orientation_sd / 2)), color=PINK)
weight.plot(canal.arc, canal.orientation_weights, color=BLUE)
spread.set(xlabel="arc [m]", ylim=(0, None))
spread.set_ylabel("spread, as an angle [°]", color=PINK)
weight.set(ylim=(0, 15.5))
weight.set_ylabel("weight $w_o$", color=BLUE)
least, most = canal.orientation_weights.min(), canal.orientation_weights.max()
print(
    f"σ from {canal.orientation_sd.min():.3f} to {canal.orientation_sd.max():.3f}, w_o from {most:.1f} to {least:.1f}"
)
save(figure)
