"""A canal in closed form, and a system that says where on it we are."""

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from canal.surface import CanalSurface
from diagrams.navigator import CanalNavigator
from diagrams.teleop.joystick_recording import JoystickRecording
from diagrams.teleop.joystick_selector import RecordedJoystick
from diagrams.view.canal_view import CanalView

BEND = 0.5  # [m]


def quarter_turn(n: int = 101) -> CanalSurface:
    """A canal about a quarter of a circle of 0.5 m in the plane z = 0.6, its radius falling from 60 to 20 mm."""
    angle = np.linspace(0, np.pi / 2, n)
    cos, sin, zero = np.cos(angle), np.sin(angle), np.zeros(n)
    directrix = np.stack([BEND * cos, BEND * sin, np.full(n, 0.6)], axis=1)
    radii = np.linspace(0.06, 0.02, n)
    tangents, outward = np.stack([-sin, cos, zero], axis=1), np.stack([cos, sin, zero], axis=1)
    up = np.tile([0.0, 0, 1], (n, 1))
    orientations = np.tile([1.0, 0, 0, 0], (n, 1))
    return CanalSurface(
        directrix=directrix,
        radii=radii,
        tangents=tangents,
        normals=tangents,
        x_axes=outward,
        y_axes=up,
        orientations=orientations,
        orientation_sd=zero,
        orientation_weights=np.full(n, 10.0),
        demonstrations=np.stack([directrix + radii[:, None] * up, directrix - radii[:, None] * up]),
        demonstration_orientations=np.stack([orientations, orientations]),
        moving_time_s=8.0,
    )


def simulate_view(meshcat, canal, rows, **options):
    """A simulator of recorded joystick → navigator → view; `rows` are t and the joystick vector."""
    rows = np.asarray(rows, dtype=float)
    builder = DiagramBuilder()
    source = RecordedJoystick.AddToBuilder(builder=builder, recording=JoystickRecording(rows[:, 0], rows[:, 1:]))
    navigator = CanalNavigator.AddToBuilder(builder=builder, canal=canal)
    builder.Connect(source.GetOutputPort("joystick"), navigator.GetInputPort("joystick"))
    gripper = builder.AddSystem(ConstantVectorSource([0.0, 0.0]))
    builder.Connect(gripper.get_output_port(), navigator.GetInputPort("gripper_state"))
    CanalView.AddToBuilder(
        builder=builder,
        meshcat=meshcat,
        canal=canal,
        navigation_state=navigator.GetOutputPort("navigation_state"),
        X_BT=navigator.GetOutputPort("X_BT_desired"),
        **options,
    )
    return Simulator(builder.Build()), navigator


START = ((0.0, 0, 0, 0, 0, 1, 0), (0.2, 0, 0, 0, 0, 0, 0), (100.0, 0, 0, 0, 0, 0, 0))
NUDGE = (
    (0.0, 0, 0, 0, 0, 1, 0),
    (0.2, 0, 0, 0, 0, 0, 0),
    (1.0, 0.3, 0.6, 0, 0, 0, 0),
    (1.2, 0, 0, 0, 0, 0, 0),
    (100.0, 0, 0, 0, 0, 0, 0),
)
"""Start, and a correction after a second."""
NUDGE_AND_STOP = (*NUDGE[:-1], (1.5, 0, 0, 0, 0, 0, 1), (100.0, 0, 0, 0, 0, 0, 0))
"""The same, stopped half a second later."""
