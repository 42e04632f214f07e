"""Travel a canal with a scripted thumb.

The way is home, pick, home, place, home, with four corrections.
Outwards a correction is kept (fixed ratio); towards home it fades (convergent). While the thumb pushes, the way stands
still and the point moves on its disk. See sections IV-C to IV-E of the paper.
"""

import sys

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.navigation.tour import Push, tour
from geosacs_drake.results.plotting import plot_canal
from models import MODELS

output = sys.argv[1] if len(sys.argv) > 1 else "navigate.png"
demonstrations = [load_demonstration(MODELS / "demonstrations" / f"relocation_{k}.npz") for k in (1, 2)]
canal = learn_canal(demonstrations)
travelled = tour(
    canal,
    pushes=[
        Push(start=0.12, duration=0.9, stick=(0.6, 0.6)),  # on the way to pick: kept
        Push(start=0.35, duration=0.5, stick=(-1.0, 0.0)),  # on the way home: fades
        Push(start=0.62, duration=0.9, stick=(0.5, -0.7)),
        Push(start=0.74, duration=2.0, stick=(-0.4, 0.9)),  # saturates at the rim
    ],
)
for k, correction in enumerate(travelled.corrections):
    print(f"correction {k + 1}: {1e3 * abs(correction[-1] - correction[0]).max():.0f} mm")
print(f"ratio at most {travelled.eta.max():.2f}, at the end {travelled.eta[-1]:.4f}")
plot_canal(
    output,
    canal,
    recorded=[d.position for d in demonstrations],
    path=travelled.position,
    corrections=travelled.corrections,
    title="A scripted thumb",
)
print(f"drawn to {output}")
