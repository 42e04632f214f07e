"""How a canal is travelled: options, with the paper's symbols."""

from typing import Annotated, Literal

from pydantic import Field

from canal.options import NotNegative, Positive, Share, options


@options("navigation")
class NavigationOptions:
    """How a canal is travelled. Times in seconds, speeds relative to the demonstrations'."""

    speed_scale: Annotated[float, Field(gt=0, le=100)] = 1.0
    """1: a whole pass takes the mean moving time of the demonstrations; 2: half of it."""
    delta: Annotated[float, Field(ge=1)] = 150.0
    """Sensitivity of the stick, δ of paper Table I: full stick moves 20/δ m/s."""
    eta_f: Share = 0.0
    """Final ratio η_f of the homeward legs: 0 converges to the directrix, 1 diverges to the wall."""
    decay: Literal["leg", "paper"] = "leg"
    """`leg`: η = η_f + (η_0 - η_f) exp(-a u²), u the part of the leg travelled. `paper`: exp(-λ·disks), Eq. in IV-C."""
    decay_a: Positive = 11.7
    """a of the default decay: what the robot's code comes to over 216 disks."""
    decay_lambda: NotNegative = 5e-4
    """λ of paper Table I, per disk; for `decay: paper`."""
    wait_at_ends: bool = True
    """At pick and place, wait for the operator: a grip, a release or a reversal goes on."""
    end_zone: Share = 0.1
    """Last part of an outward leg in which a grasp (a release) counts as made at pick (at place) and sends home."""
    gripper_pause_s: NotNegative = 0.25
    """Shortest pause after the gripper button; it lasts while the fingers move."""
    gripper_pause_limit_s: Positive = 2.0
    """Longest pause: fingers that never come to rest do not hold the arm up."""
