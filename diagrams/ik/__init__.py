"""The orientation-weighted inverse kinematics (paper V-C): a Newton step as one MathematicalProgram each tick.

`OrientationWeightedIk` is the system, `IkSolver` what it asks. Reachability, the start posture and the pace that the
joints allow are found with the same solver.
"""

from diagrams.ik.joint_pace import at_joint_pace, unhurried
from diagrams.ik.options import CollisionAvoidanceOptions, IkOptions, IkStatus
from diagrams.ik.program import StepProgram
from diagrams.ik.reachability import ReachReport, reach_report
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import StartPosture, find_start_posture
from diagrams.ik.system import IkStatusField, OrientationWeightedIk
from diagrams.ik.target import wanted_pose

__all__ = [
    "CollisionAvoidanceOptions",
    "IkOptions",
    "IkSolver",
    "IkStatus",
    "IkStatusField",
    "OrientationWeightedIk",
    "ReachReport",
    "StartPosture",
    "StepProgram",
    "at_joint_pace",
    "find_start_posture",
    "reach_report",
    "unhurried",
    "wanted_pose",
]
