"""The inverse kinematics with a cost and a bound of one's own.

An elbow that stays bent, and a forearm that hardly turns. Each tick solves Drake's quadratic programs over the
posture `ik.posture` at its end and the step `ik.step` to it. What is added to `ik.program` is part of every tick from
then on, beside the limits of position and speed. Orientation weighs little here, as where demonstrations disagree, so
that there is something left to choose.
"""

import sys

import numpy as np
from matplotlib.figure import Figure

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from diagrams.ik.solver import IkSolver
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant
from models import MODELS

DT, ORIENTATION_WEIGHT = 0.05, 0.02
HOME = np.radians([-88.0, -20.0, 65.0, -2.0, 96.0, 2.0])
ELBOW, FOREARM = 2, 3
"""Joints 3 and 4."""
BENT, MOST = np.radians(80.0), np.radians(6.0)
"""Where the elbow is drawn to, and how far the forearm may turn either way [rad]."""

output = sys.argv[1] if len(sys.argv) > 1 else "own_constraints.png"
demonstrations = [load_demonstration(MODELS / "demonstrations" / f"relocation_{k}.npz") for k in (1, 2)]
canal = learn_canal(demonstrations)
way = [*range(canal.home_disk, canal.n_disks), *range(canal.n_disks - 1, -1, -1)]


def travel(ik: IkSolver) -> tuple[np.ndarray, float]:
    """Postures (T, 6) [rad] from home to place and on to pick, and the largest miss [m]."""
    q, v, postures, missed = HOME, np.zeros(6), [], 0.0
    for disk in way:
        result = ik.solve(canal.pose(disk), ORIENTATION_WEIGHT, q, DT, v)
        q, v = result.q, (result.q - q) / DT
        postures.append(q)
        missed = max(missed, result.position_error)
    return np.array(postures), missed


plain, bent, bounded = (IkSolver(make_arm_plant(), TCP_FRAME) for _ in range(3))
bent.program.AddQuadraticErrorCost(np.diag([0.5]), [BENT], bent.posture[[ELBOW]])
bounded.program.AddBoundingBoxConstraint(-MOST, MOST, bounded.posture[FOREARM])

figure = Figure(figsize=(8, 5), layout="constrained")
axes = figure.subplots(2, 1, sharex=True)
for name, ik, color in (
    ("as it is", plain, "black"),
    ("own cost", bent, "tab:red"),
    ("own bound", bounded, "tab:blue"),
):
    postures, missed = travel(ik)
    elbow, forearm = np.degrees(postures[:, ELBOW]), np.degrees(postures[:, FOREARM])
    print(
        f"{name}: elbow {elbow.min():.2f} to {elbow.max():.2f}°, forearm {forearm.min():.2f} to {forearm.max():.2f}°, "
        f"position missed by {1e3 * missed:.2f} mm"
    )
    for axis, angle in zip(axes, (elbow, forearm), strict=True):
        axis.plot(DT * np.arange(len(angle)), angle, color=color, label=name, linewidth=2)
axes[0].set(ylabel="elbow, joint 3 [°]")
axes[1].set(ylabel="forearm, joint 4 [°]", xlabel="time [s]")
axes[0].legend()
figure.savefig(output, dpi=120)
print(f"drawn to {output}")
