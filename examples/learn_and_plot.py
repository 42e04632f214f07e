"""Learn a canal from two demonstrations, and draw it.

Three calls: load the recordings, learn, draw. The picture shows the canal as Fig. 6 of the paper does, from three
sides.
"""

import sys

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from geosacs_drake.results.plotting import plot_canal
from models import MODELS

output = sys.argv[1] if len(sys.argv) > 1 else "learn_and_plot.png"
demonstrations = [load_demonstration(MODELS / "demonstrations" / f"laundry_{k}.npz") for k in (1, 2)]
canal = learn_canal(demonstrations)
print(f"{canal.n_disks} disks along {canal.length:.2f} m, radius {canal.radii.min():.3f} to {canal.radii.max():.3f} m")
plot_canal(output, canal, recorded=[d.position for d in demonstrations])
print(f"drawn to {output}")
