"""What the inverse kinematics can be asked for, and how a tick can end."""

import enum
from dataclasses import dataclass, field

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


@dataclass
class KeepClearOptions:
    """Keeping clear of oneself and of what the scene declares solid, by linearised signed distances."""

    margin: float = 0.02
    """Distance that every watched pair keeps [m]."""
    influence: float = 0.10
    """Pairs further apart than this [m] are left out of the program."""
    slack_weight: float = 1e4
    """Price of a metre of missing clearance, so that a start inside an obstacle has a way out [cost] / [m]."""
    solid_bodies: list[str] = field(default_factory=list)
    """Names of the bodies beside the arm to keep clear of; empty means all that the arm's plant knows."""


@dataclass
class IkOptions:
    """Options of `diagrams.ik_solver.IkSolver`; a plain dataclass, so that `yaml_load_typed` reads it."""

    position_weight: float = POSITION_WEIGHT
    """w_p, [cost] / [m²]."""
    axis_weights: list[float] = field(default_factory=lambda: [1.0, 1.0, 1.0])
    """Factors on the orientation weight about the tool's x, y and z; 0 leaves that rotation free."""
    speed_limits: list[float] = field(default_factory=list)
    """Joint speeds [rad/s]; empty takes the model's."""
    acceleration_limits: list[float] = field(default_factory=list)
    """Joint accelerations [rad/s²]; empty means not bounded."""
    soft_limit_margin: float = 0.0
    """Distance kept from the model's joint limits [rad]."""
    position_tolerance: float = 1e-3
    """A miss above this [m] at rest is reported as out of reach."""
    orientation_tolerance: float = 0.0
    """A miss above this [rad] at rest is reported as out of reach; 0 means that orientation does not count."""
    max_iterations: int = 30
    """Steps of Newton's method in one tick."""
    qp_solvers: list[str] = field(default_factory=lambda: ["clarabel", "osqp"])
    """Drake solvers tried in turn when the active set is not found directly."""
    keep_clear: KeepClearOptions | None = None
    """None: no distances are computed."""
