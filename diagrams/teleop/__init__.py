"""What comes from a hand: joysticks, live or recorded, the choice between them, and what the stick's directions mean.

A joystick vector is described in `canal.navigation.joystick`.
"""

from diagrams.teleop.joystick_recording import JoystickRecording, load_recording
from diagrams.teleop.joystick_selector import JoystickSelector, RecordedJoystick, clean_joystick
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
    "clean_joystick",
    "hand_for",
    "load_recording",
]
