"""The simulated person: how late, how wrong, how patient."""

from typing import Annotated

from pydantic import AfterValidator, Field

from canal.errors import InputError
from canal.navigation.joystick import JOYSTICK_PERIOD
from canal.options import NotNegative, Share, options

Seconds = Annotated[float, Field(ge=0, le=60)]
"""[s]"""


def _whole_samples(delay_s: float) -> float:
    samples = delay_s / JOYSTICK_PERIOD
    if abs(samples - round(samples)) > 1e-9:
        raise InputError(f"give a multiple of {JOYSTICK_PERIOD:g} s")
    return delay_s


@options("operator")
class OperatorOptions:
    """The simulated person. Times in seconds, distances in metres."""

    delay_s: Annotated[float, Field(ge=0, le=5), AfterValidator(_whole_samples)] = 0.25
    """How late the person sees (a multiple of the 50 ms in which a stick is sampled)."""
    noise_m: Annotated[float, Field(ge=0, le=1)] = 0.003
    """Standard deviation of where the person sees an item, per axis."""
    hand_noise: Share = 0.08
    """Relative standard deviation of a push of the stick, and its angle in radians."""
    look_s: Seconds = 0.15
    """After a push has had its effect, how long the person looks before the next."""
    press_s: Seconds = 0.1
    """How long a button is held."""
    think_s: Seconds = 0.4
    """After a button, how long before anything else."""
    aim_from: Share = 0.62
    """|d| from which the person aims: close enough to see where the path leads, still above the items."""
    aim_until: Share = 0.93
    """|d| beyond which the fingers are among the items, and only a clear miss is worth another push."""
    aim_tolerance_m: NotNegative = 0.006
    """A miss smaller than this is left alone."""
    end_tolerance_m: NotNegative = 0.010
    """The same for a last push at the end, among the items."""
    let_go_at: Share = 1.0
    """d at which the person lets go of what may lie anywhere at its goal, on the first try. Below 1 it is a slip of the
    thumb: the item hangs out, and is to be pushed in."""
    lay_beside: Share = 0.9
    """How far to a side what may lie anywhere is laid where there is room, in radii of the last disk."""
    lay_above: Share = 0.66
    """How far up an upright disk it is laid where both sides are taken, in the same radii; the less, the more level the
    disk is. Lower, the hand presses on what lies there; higher, what is let go falls deep."""
    judge_at: Share = 0.78
    """d below which the gripper is clear of the goal, and the person judges what became of the item."""
    lift_m: NotNegative = 0.10
    """Rise of the gripper after which the person checks that the item came along."""
    lost_m: NotNegative = 0.16
    """An item further than this from the gripper is not in it."""
    tries: Annotated[int, Field(ge=0, le=1000)] = 5
    """Attempts at one item, and pushes at one that hangs out, before it is given up."""
