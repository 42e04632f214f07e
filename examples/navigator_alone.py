"""The navigator alone, as a Drake system, under a scripted stick.

A recorded joystick is connected to `CanalNavigator`, and nothing else: no robot, no contact. Start is pressed at
once, two corrections follow, and a reversal in the middle of the way back. Out come the wanted pose of the tool, its
orientation weight, and the navigation state, all of it logged by Drake's own log sinks.
"""

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource, LogVectorOutput
from style import BLUE, CORRECTION, GREEN, GREY, PATH, RED, draw_canal, fit, new_figure, save, shipped_canal, solid

from canal.navigation import FIELD_NAMES, NavigationOptions
from canal.navigation.joystick import JOYSTICK_SIZE, K_X, K_Y, REVERSE, START
from diagrams.navigator import CanalNavigator
from diagrams.teleop.joystick_recording import JoystickRecording
from diagrams.teleop.joystick_selector import RecordedJoystick

canal = shipped_canal("relocation")
script = (  # from, until [s], where in the joystick vector, value
    (0.1, 0.3, START, 1.0), (9.0, 9.5, K_X, 1.0), (9.0, 9.5, K_Y, -0.6), (19.0, 19.6, K_X, -0.8),
    (34.0, 34.2, REVERSE, 1.0),
)  # fmt: skip
time = np.arange(0.0, 60.0, 0.05)
joystick = np.zeros((len(time), JOYSTICK_SIZE))
for begin, end, index, value in script:
    joystick[(time >= begin) & (time < end), index] = value

builder = DiagramBuilder()
stick = RecordedJoystick.AddToBuilder(builder=builder, recording=JoystickRecording(time, joystick))
fingers = builder.AddSystem(ConstantVectorSource(np.zeros(2)))
options = NavigationOptions(wait_at_ends=False)
navigator = CanalNavigator.AddToBuilder(builder=builder, canal=canal, options=options)
builder.Connect(stick.GetOutputPort("joystick"), navigator.GetInputPort("joystick"))
builder.Connect(fingers.get_output_port(), navigator.GetInputPort("gripper_state"))
logs = {
    name: LogVectorOutput(navigator.GetOutputPort(name), builder, 0.05) for name in ("X_BT_desired", "navigation_state")
}
simulator = Simulator(builder.Build())
simulator.AdvanceTo(59.9)

logged = {name: sink.FindLog(simulator.get_context()) for name, sink in logs.items()}
t, position = logged["X_BT_desired"].sample_times(), logged["X_BT_desired"].data()[:3].T
state = dict(zip(FIELD_NAMES, logged["navigation_state"].data(), strict=True))
correcting = state["correcting"] > 0

figure = new_figure(11, 4.6)
axes = solid(figure, (1, 2, 1), view=(20, -35))
rims = draw_canal(axes, canal, disks=30)
axes.plot(*position.T, color=PATH, zorder=5)
axes.plot(*np.where(correcting[:, None], position, np.nan).T, color=CORRECTION, lw=3.5, zorder=6)
fit(axes, rims, zoom=1.4)
panels = np.atleast_1d(figure.add_gridspec(3, 2)[:, 1].subgridspec(3, 1).subplots(sharex=True))
panels[0].plot(time, joystick[:, K_X], color=RED, label="$k_x$")
panels[0].plot(time, joystick[:, K_Y], color=GREEN, label="$k_y$")
panels[0].legend(ncols=2, loc="upper right")
panels[1].plot(t, state["disk"], color=BLUE)
panels[2].plot(t, state["eta"], color=GREEN)
for panel, name in zip(panels, ("stick", "disk", "ratio η"), strict=True):
    panel.set_ylabel(name)
    panel.axvline(34.0, color=GREY, lw=1, ls=":")
panels[2].set_xlabel("time [s]; dotted: reverse is pressed")
print(f"{int(state['corrections'][-1])} corrections, {1e3 * state['correction_distance_m'][-1]:.0f} mm; "
      f"{int(state['backtracks'][-1])} reversal")  # fmt: skip
save(figure)
