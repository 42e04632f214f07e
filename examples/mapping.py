"""Which way is up: the stick's directions from each seat, beside the paper's correction axes.

Along the laundry canal the disks turn from lying in the basket to standing in the door. The raw correction axes (grey,
dashed) turn with them: right on the stick is right for none but who sits at the robot's right, and up is down for
everybody. Mapped from a seat (red: right, green: up), each stays within 45° of what the person there calls right or up,
wherever the disk's plane holds such a direction (white; elsewhere shaded), and turns by no more than 20° from disk to
disk. On a lying disk up is away from the person.
"""

import numpy as np
from style import BLACK, GREY, X_AXIS, Y_AXIS, new_figure, save, shipped_canal

from canal.navigation.stick_directions import SEATS, stick_directions
from canal.quality import angles

canal = shipped_canal("laundry")
disks = np.arange(canal.n_disks)
normals = np.cross(canal.x_axes, canal.y_axes)
normals /= np.linalg.norm(normals, axis=1)[:, None]
raw = np.stack([canal.x_axes, canal.y_axes], axis=1)

figure = new_figure(12, 5.4)
panels = figure.subplots(2, len(SEATS), sharex=True, sharey=True)
for column, (seat, view) in zip(panels.T, SEATS.items(), strict=True):
    mapped = stick_directions(canal, view)
    turn = max(angles(mapped[1:, k], mapped[:-1, k]).max() for k in range(2))
    told = [f"turns by {turn:.0f}° from disk to disk at most"]
    for k, (axes, name, color) in enumerate(zip(column, ("right", "up"), (X_AXIS, Y_AXIS), strict=True)):
        wanted = np.broadcast_to(getattr(view, name), normals.shape)
        held = np.abs((normals * wanted).sum(axis=1)) <= np.sqrt(0.5)
        off, off_raw = angles(mapped[:, k], wanted), angles(raw[:, k], wanted)
        axes.fill_between(disks, 0, 180, where=~held, color="#E9ECEF", step="mid", linewidth=0)
        axes.axhline(45, color=BLACK, lw=0.7)
        axes.plot(disks, off_raw, color=GREY, lw=1.4, ls="--", label=f"correction axis {'xy'[k]}")
        axes.plot(disks, off, color=color, label=f"stick's {name}")
        told.append(f"{name} off by {off[held].max():.0f}° at most (raw: {off_raw[held].max():.0f}°)")
    column[0].set_title({"front": "facing the robot", "behind": "behind it"}.get(seat, f"at its {seat}"))
    print(f"{seat}: " + ", ".join(told))
for axes, name in zip(panels[:, 0], ("right", "up"), strict=True):
    axes.set(ylabel=f"angle to the person's {name} [°]", ylim=(0, 180), yticks=range(0, 181, 45))
    axes.legend(loc="upper left", fontsize=8)
for axes in panels[1]:
    axes.set_xticks([0, canal.home_disk, canal.n_disks - 1], ["pick", "home", "place"])
    axes.set_xlim(0, canal.n_disks - 1)
save(figure)
