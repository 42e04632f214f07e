"""From recordings to a canal: pauses, tremor, alignment.

A person who shows a motion by hand hesitates, trembles, and is never twice equally fast. Here one of the recordings
is given a pause of two seconds and a tremor of half a millimetre. *Soft trimming* advances by how far the hand has
moved instead of by time, so that the pause vanishes; time warping then aligns what belongs together, and splines
smooth it (section V-A of the paper). Right: how far the directrix moves because of pause and tremor, with soft
trimming and without.
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d
from style import BLACK, BLUE, DEMONSTRATION, GREY, RED, new_figure, save

from canal.demonstration import Demonstration, load_demonstration
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from models import MODELS

first, second = (load_demonstration(MODELS / "demonstrations" / f"relocation_{k}.npz") for k in (1, 2))
rng = np.random.default_rng(1)
at = int(0.62 * len(second))
rows = np.concatenate([np.arange(at), np.full(40, at), np.arange(at, len(second))])
tremor = gaussian_filter1d(rng.normal(0.0, 1.0, (len(rows), 3)), 3.0, axis=0)
shaken = Demonstration(second.position[rows] + 0.0005 * tremor / tremor.std(), second.orientation[rows])

figure = new_figure(11, 4)
speed, height, moved = figure.subplots(1, 3)
for name, demonstration, color in (("second, shaken", shaken, RED), ("first", first, GREY)):
    v = np.linalg.norm(np.gradient(demonstration.position, 0.05, axis=0), axis=1)
    speed.plot(0.05 * np.arange(len(v)), v, color=color, lw=1.2, label=name)
speed.axvspan(0.05 * at, 0.05 * (at + 40), color="#F6DCCB", zorder=0)
speed.set(title="what was recorded", xlabel="time [s]", ylabel="speed [m/s]")
speed.legend()

canal = learn_canal([first, shaken])
for curve in canal.demonstrations:
    height.plot(canal.arc, curve[:, 2], color=DEMONSTRATION, lw=1.2)
height.plot(canal.arc, canal.directrix[:, 2], color=BLUE, ls=":")
height.set(title="aligned, and their mean", xlabel="arc [m]", ylabel="height [m]")

for name, soft, color in (("soft trimming", True, BLUE), ("none", False, BLACK)):
    options = LearningOptions(soft_trimming=soft)
    clean, rough = learn_canal([first, second], options), learn_canal([first, shaken], options)
    from_each = np.linalg.norm(rough.directrix[:, None] - clean.directrix[None], axis=2).min(axis=1)
    moved.plot(rough.arc, 1e3 * from_each, color=color, label=name)
    print(f"{name}: pause and tremor move the directrix by up to {1e3 * from_each.max():.1f} mm")
moved.set(title="what the pause does to the directrix", xlabel="arc [m]", ylabel="distance [mm]", ylim=(0, None))
moved.legend()
save(figure)
