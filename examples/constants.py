"""The constants of the paper, and where each lives in the code.

The table is made from the code itself (Table I of the paper, and section V-A for $h$). The curves show what four of
them do: the weight of orientation, the speed of a correction, the decay of a ratio, and the knots of the splines.
Constants that are not the paper's are listed with the
[deviations](../deviations.md#constants-that-are-not-the-papers).
"""

import math
import re

import numpy as np
from style import BLUE, GREEN, GREY, PINK, RED, new_figure, save

from canal.learning.frames import EPSILON
from canal.learning.orientation import orientation_weight
from canal.learning_options import LearningOptions
from canal.navigation import NavigationOptions
from diagrams.ik.options import IkOptions

learning, navigation, ik = LearningOptions(), NavigationOptions(), IkOptions()
b = math.exp(learning.alpha * learning.beta)
NAVIGATION, LEARNING = "canal.navigation.options.NavigationOptions", "canal.learning_options.LearningOptions"
ROWS = (
    ("ε", EPSILON, "canal.learning.frames.EPSILON", "below it two directions are taken for one"),
    ("λ", navigation.decay_lambda, f"{NAVIGATION}.decay_lambda", "the paper's decay of a ratio, per disk"),
    ("w_p", ik.position_weight, "diagrams.ik.options.IkOptions.position_weight", "weight of position"),
    ("α", learning.alpha, f"{LEARNING}.alpha", "how fast spread lowers the weight of orientation"),
    ("β", learning.beta, f"{LEARNING}.beta", "the spread at which that weight is 1"),
    ("b", f"{b:.1f}", "canal.learning.orientation.orientation_weight", "largest weight of orientation, exp(α β)"),
    ("δ", navigation.delta, f"{NAVIGATION}.delta", "sensitivity of the stick: full stick is 20/δ m/s"),
    ("h", f"{100 * learning.step:g} %", f"{LEARNING}.step", "distance of the splines' knots"),
)
print("| symbol | value | in the code | what it does |\n|---|---|---|---|")
for symbol, value, where, what in ROWS:
    shown = value if isinstance(value, str) else format(value, "g")
    short = ".".join(where.split(".")[-2:])
    field = re.sub(r"(Options)\.\w+$", r"\1", where)  # fields are described with their class
    print(f"| {symbol} | {shown} | [`{short}`][{field}] | {what} |")

figure = new_figure(11, 3)
weight, stick, decay, knots = figure.subplots(1, 4)
sd = np.linspace(0.0, 0.6, 100)
weight.plot(sd, orientation_weight(sd, learning.alpha, learning.beta), color=PINK)
weight.axvline(learning.beta, color=GREY, lw=1, ls=":")
weight.text(learning.beta, 12, " β", color=GREY)
weight.set(title="weight, α and β", xlabel="spread σ", ylabel="$w_o$", ylim=(0, 15.5))
k = np.linspace(-1.0, 1.0, 11)
stick.plot(k, 20 / navigation.delta * k, color=BLUE)
stick.set(title="stick, δ", xlabel="$k_x$", ylabel="speed on the disk [m/s]")
disks = np.arange(142)
decay.plot(disks, np.exp(-navigation.decay_a * (disks / disks[-1]) ** 2), color=GREEN, label="here, a")
decay.plot(disks, np.exp(-navigation.decay_lambda * disks), color=RED, label="paper, λ")
decay.set(title="decay of a ratio", xlabel="disks", ylabel="part that is left", ylim=(0, 1.05))
decay.legend()
u = np.linspace(0.0, 1.0, 300)
at = np.arange(0.0, 1.0 + 1e-9, learning.step)
knots.plot(u, np.sin(5 * u) + 0.06 * np.sin(90 * u), color=GREY, lw=1)
knots.plot(u, np.sin(5 * u), color=BLUE)
knots.plot(at, np.sin(5 * at), "o", color=BLUE, ms=5)
knots.set(title="knots, h", xlabel="along a demonstration", yticks=[])
save(figure)
