"""The Lio in its scene: plant with contact, drives, sensors, and what sleeps while nothing happens.

`LioStation` is the diagram of all of it; `SleepManager` locks what lies still.
"""

from diagrams.station.lio_arm import BASE_FRAME, TCP_FRAME, arm_joints, arm_speeds, make_arm_plant
from diagrams.station.lio_drive import ARM, MOVING, LioDrive
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE, LioStation, arm_stops, plant_config, set_drives
from diagrams.station.peaks import Peaks
from diagrams.station.sleep import SleepManager, sleep_manager
from diagrams.station.sleeping_item import make_sleeping_item

__all__ = [
    "ARM",
    "BASE_FRAME",
    "MOVING",
    "START_POSTURE",
    "TCP_FRAME",
    "LioDrive",
    "LioStation",
    "Peaks",
    "SleepManager",
    "arm_joints",
    "arm_speeds",
    "arm_stops",
    "make_arm_plant",
    "make_lio_solver",
    "make_sleeping_item",
    "plant_config",
    "set_drives",
    "sleep_manager",
]
