"""A simulated person who sees what someone at the table would see, and steers with the same joystick."""

from diagrams.operator.options import OperatorOptions
from diagrams.operator.system import SimulatedOperator

__all__ = ["OperatorOptions", "SimulatedOperator"]
