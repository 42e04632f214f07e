"""The inverse kinematics alone, on a target that moves.

The tool is to draw a figure of eight, faster and faster, while it points down. Twice: with the largest weight of
orientation that a canal gives, and with hardly any. Where the joints are not fast enough the tool falls behind, but
every command is within the limits. With little weight the position is met better, and the tool leans: that is the
trade that each disk of a canal makes by how much its demonstrations agreed (section V-C of the paper).
"""

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource, LogVectorOutput, TrajectorySource
from pydrake.trajectories import PiecewisePolynomial
from style import BLACK, BLUE, GREY, RED, fit, new_figure, save, solid

from diagrams.ik.solver import IkSolver
from diagrams.ik.system import IkStatusField, OrientationWeightedIk
from diagrams.station.lio_arm import TCP_FRAME, arm_joints, arm_speeds, make_arm_plant

HOME = np.radians([-88.0, -20.0, 65.0, -2.0, 96.0, 2.0])
DURATION, RATE = 12.0, 100.0
arm = make_arm_plant()
context = arm.CreateDefaultContext()
tool, base = arm.GetFrameByName(TCP_FRAME), arm.world_frame()


def tool_pose(q: np.ndarray) -> RigidTransform:
    """Where the tool is in a posture (6,)."""
    for joint, angle in zip(arm_joints(arm), q, strict=True):
        joint.set_angle(context, angle)
    return tool.CalcPose(context, base)


X_start = tool_pose(HOME)
middle, quaternion = X_start.translation(), X_start.rotation().ToQuaternion().wxyz()

t = np.linspace(0.0, DURATION, 400)
turn = 2 * np.pi * 4 * (t / DURATION) ** 2  # four figures of eight
wanted = middle + np.column_stack([0.16 * np.sin(turn), 0.20 * np.sin(turn) * np.cos(turn), 0.05 * (1 - np.cos(turn))])
poses = np.vstack([wanted.T, np.tile(quaternion, (len(t), 1)).T])

figure = new_figure(11, 4.8)
axes = solid(figure, (1, 2, 1), view=(35, -50))
axes.plot(*wanted.T, color=GREY, ls=":", zorder=3, label="wanted")
panels = figure.add_gridspec(3, 2)[:, 1].subgridspec(3, 1).subplots(sharex=True)
for weight, color in ((15.0, BLUE), (0.02, RED)):
    builder = DiagramBuilder()
    target = builder.AddSystem(TrajectorySource(PiecewisePolynomial.FirstOrderHold(t, poses)))
    weighed = builder.AddSystem(ConstantVectorSource(np.array([weight])))
    ik = OrientationWeightedIk.AddToBuilder(
        builder=builder,
        solver=IkSolver(arm, TCP_FRAME),
        q_start=HOME,
        X_BT_desired=target.get_output_port(),
        orientation_weight=weighed.get_output_port(),
    )
    commands = LogVectorOutput(ik.GetOutputPort("desired_state"), builder, 1 / RATE)
    statuses = LogVectorOutput(ik.GetOutputPort("ik_status"), builder, 1 / RATE)
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(DURATION)
    command, status = commands.FindLog(simulator.get_context()), statuses.FindLog(simulator.get_context())
    path = [tool_pose(q).translation() for q in command.data()[:6].T]
    at, name = command.sample_times()[1:], f"$w_o$ = {weight:g}"
    axes.plot(*np.array(path).T, color=color, lw=1.4, zorder=4, label=name)
    missed, leaning = (
        status.data()[IkStatusField.POSITION_ERROR, 1:],
        status.data()[IkStatusField.ORIENTATION_ERROR, 1:],
    )
    speed = np.abs(command.data()[6:, 1:] / arm_speeds(arm)[:, None]).max(axis=0)
    for panel, values in zip(panels, (1e3 * missed, np.degrees(leaning), 100 * speed), strict=True):
        panel.plot(at, values, color=color, lw=1.4, label=name)
    print(f"w_o = {weight:5g}: missed by up to {1e3 * missed.max():.0f} mm and {np.degrees(leaning.max()):.0f}°, "
          f"fastest joint at {100 * speed.max():.0f} % of its limit")  # fmt: skip
for panel, label in zip(panels, ("missed [mm]", "leaning [°]", "fastest joint [%]"), strict=True):
    panel.set_ylabel(label)
panels[2].set_xlabel("time [s]")
panels[0].legend()
axes.scatter(*middle, color=BLACK, s=15)
fit(axes, wanted, zoom=1.2)
save(figure)
