"""What comes from a hand: joysticks, live or recorded, the choice between them, and what the stick's directions mean.

A joystick vector is described in `canal.navigation.joystick`. It is made clean where a device hands it on: by
`LiveSample`, `MeshcatJoystick` and `JoystickRecording`; selector, mapping and navigator trust it.
"""

from diagrams.teleop.joystick_recording import JoystickRecording, load_recording
from diagrams.teleop.joystick_selector import JoystickSelector, RecordedJoystick
from diagrams.teleop.live_joystick import LiveJoystick, LiveSample
from diagrams.teleop.meshcat_joystick import CONTROLS, MeshcatJoystick
from diagrams.teleop.stick_mapping import StickMapping, hand_for

__all__ = [
    "CONTROLS",
    "JoystickRecording",
    "JoystickSelector",
    "LiveJoystick",
    "LiveSample",
    "MeshcatJoystick",
    "RecordedJoystick",
    "StickMapping",
    "hand_for",
    "load_recording",
]
