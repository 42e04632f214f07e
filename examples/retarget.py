"""A canal bent to new ends.

The machine stands 0.25 m further on, turned by 20°, and the basket is 0.1 m lower. The canal is bent to where they
are now, not taught anew: its steps are turned by a rotation that passes smoothly from the pick's to the place's.
"""

import sys

import numpy as np
from scipy.spatial.transform import Rotation

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.retargeting import retarget, shape_cost
from geosacs_drake.results.plotting import plot_canal
from models import MODELS

output = sys.argv[1] if len(sys.argv) > 1 else "retarget.png"
demonstrations = [load_demonstration(MODELS / "demonstrations" / f"laundry_{k}.npz") for k in (1, 2)]
canal = learn_canal(demonstrations)

turn = Rotation.from_rotvec([0.0, 0.0, np.radians(20.0)])
place = canal.directrix[-1] + [-0.2, 0.15, 0.0]
orientation = turn * Rotation.from_quat(canal.orientations[-1], scalar_first=True)
bent = retarget(
    canal,
    pick=canal.directrix[0] + [0.0, 0.0, -0.1],  # a position alone keeps the orientation
    place=(place, orientation.as_quat(scalar_first=True)),
)
print(f"cost: {shape_cost(canal, bent)}")
plot_canal(
    output,
    bent,
    recorded=[d.position for d in demonstrations],
    path=canal.directrix,
    title="Bent to a new machine and basket; green: the canal as it was taught",
)
print(f"drawn to {output}")
