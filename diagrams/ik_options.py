"""What the inverse kinematics can be asked for, and how a tick can end."""

import enum
from dataclasses import field
from typing import Annotated

from pydantic import Field

from canal.options import NotNegative, Positive, options

# SPEC 5 / the paper's implementation: w_p = 100.
POSITION_WEIGHT = 100.0


class IkStatus(enum.IntEnum):
    """How a tick ended. Only `HELD` means that the target was not followed at all."""

    CONVERGED = 0
    """The optimum, with no bound active."""
    AT_BOUND = 1
    """The optimum within the bounds, and at least one of them (limit, speed, acceleration, clearance) is active."""
    OUT_OF_REACH = 2
    """The optimum, with no bound on speed active, and yet the pose is missed by more than the tolerance."""
    HELD = 3
    """No usable target (not finite, zero quaternion) or no solution: the last posture, braking if it must."""


@options("ik.keep_clear")
class KeepClearOptions:
    """Keeping clear of oneself and of what the scene declares solid, by linearised signed distances."""

    margin: NotNegative = 0.02
    """Distance that every watched pair keeps [m]."""
    influence: Positive = 0.10
    """Pairs further apart than this [m] are left out of the program."""
    slack_weight: Annotated[float, Field(gt=0, le=1e9)] = 1e4
    """Price of a metre of missing clearance, so that a start inside an obstacle has a way out [cost] / [m]."""
    solid_bodies: list[str] = field(default_factory=list)
    """Names of the bodies beside the arm to keep clear of; empty means all that the arm's plant knows."""


Factor = Annotated[float, Field(ge=0, le=1e3)]


@options("ik")
class IkOptions:
    """Options of `diagrams.ik_solver.IkSolver`."""

    position_weight: Annotated[float, Field(gt=0, le=1e6)] = POSITION_WEIGHT
    """w_p, [cost] / [m²]."""
    axis_weights: Annotated[list[Factor], Field(min_length=3, max_length=3)] = field(
        default_factory=lambda: [1.0, 1.0, 1.0]
    )
    """Factors on the orientation weight about the tool's x, y and z; 0 leaves that rotation free."""
    speed_limits: list[Positive] = field(default_factory=list)
    """Joint speeds [rad/s]; empty takes the model's."""
    acceleration_limits: list[Positive] = field(default_factory=list)
    """Joint accelerations [rad/s²]; empty means not bounded."""
    soft_limit_margin: NotNegative = 0.0
    """Distance kept from the model's joint limits [rad]."""
    position_tolerance: NotNegative = 1e-3
    """A miss above this [m] at rest is reported as out of reach."""
    orientation_tolerance: NotNegative = 0.0
    """A miss above this [rad] at rest is reported as out of reach; 0 means that orientation does not count."""
    max_iterations: Annotated[int, Field(ge=1, le=1000)] = 30
    """Steps of Newton's method in one tick."""
    qp_solvers: list[str] = field(default_factory=lambda: ["clarabel", "osqp"])
    """Drake solvers tried in turn when the active set is not found directly."""
    keep_clear: KeepClearOptions | None = None
    """None: no distances are computed."""
