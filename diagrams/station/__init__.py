"""The Lio in its scene: plant with contact, drives, sensors, and what sleeps while nothing happens.

`LioStation` is the diagram of all of it; `Rest` locks what lies still.
"""

from diagrams.station.lio_arm import BASE_FRAME, TCP_FRAME, arm_joints, arm_speeds, make_arm_plant
from diagrams.station.lio_drive import ARM, MOVING, LioDrive
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import START_POSTURE, LioStation, arm_stops, plant_config, set_drives
from diagrams.station.peaks import Peaks
from diagrams.station.sleep import Rest, rest_of
from diagrams.station.sleeping_item import make_piece

__all__ = [
    "ARM",
    "BASE_FRAME",
    "MOVING",
    "START_POSTURE",
    "TCP_FRAME",
    "LioDrive",
    "LioStation",
    "Peaks",
    "Rest",
    "arm_joints",
    "arm_speeds",
    "arm_stops",
    "make_arm_plant",
    "make_lio_solver",
    "make_piece",
    "plant_config",
    "rest_of",
    "set_drives",
]
