"""What the inverse kinematics can be asked for, and how a tick can end."""

import enum
from dataclasses import field
from typing import Annotated

from pydantic import Field

from canal.options import NotNegative, Positive, options

# w_p of the paper's Table I.
POSITION_WEIGHT = 100.0
"""Default of w_p, [cost] / [m²]."""


class IkStatus(enum.IntEnum):
    """How a tick ended. Only `HELD` means that the target was not followed at all."""

    CONVERGED = 0
    """The optimum, with no bound active."""
    AT_BOUND = 1
    """The optimum within the bounds, and at least one of them (limit, speed, clearance) is active."""
    OUT_OF_REACH = 2
    """The optimum, with no bound on speed active, and yet the position is missed by more than 1 mm."""
    HELD = 3
    """No usable target (not finite, zero quaternion) or no solution: the last posture, or the nearest within limits."""


@options("ik.collision_avoidance")
class CollisionAvoidanceOptions:
    """Collision avoidance, with the arm itself and with solid bodies, by linearised signed distances."""

    margin: NotNegative = 0.02
    """Distance that every watched pair keeps [m]."""
    solid_bodies: list[str] = field(default_factory=list)
    """Names of the bodies beside the arm to avoid; empty means all that the arm's plant knows."""


@options("ik")
class IkOptions:
    """Options of `diagrams.ik.solver.IkSolver`."""

    position_weight: Annotated[float, Field(gt=0, le=1e6)] = POSITION_WEIGHT
    """w_p, [cost] / [m²]."""
    speed_limits: list[Positive] = field(default_factory=list)
    """Joint speeds [rad/s]; empty takes the model's."""
    soft_limit_margin: NotNegative = 0.0
    """Distance kept from the model's joint limits [rad]."""
    collision_avoidance: CollisionAvoidanceOptions | None = None
    """None: no distances are computed."""
