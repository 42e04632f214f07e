"""The simulated person: how late, how wrong, how patient."""

from dataclasses import dataclass

from canal.errors import InputError
from canal.joystick import JOYSTICK_PERIOD


@dataclass
class OperatorOptions:
    """The simulated person. Times in seconds, distances in metres."""

    delay_s: float = 0.25
    """How late the person sees (a multiple of the 50 ms in which a stick is sampled)."""
    noise_m: float = 0.003
    """Standard deviation of where the person sees a thing, per axis."""
    hand_noise: float = 0.08
    """Relative standard deviation of a push of the stick, and its angle in radians."""
    look_s: float = 0.15
    """After a push has had its effect, how long the person looks before the next."""
    press_s: float = 0.1
    """How long a button is held."""
    think_s: float = 0.4
    """After a button, how long before anything else."""
    aim_from: float = 0.62
    """|d| from which the person aims: close enough to see where the path leads, still above the things."""
    aim_until: float = 0.93
    """|d| beyond which the fingers are among the things, and only a clear miss is worth another push."""
    aim_tolerance_m: float = 0.006
    """A miss smaller than this is left alone."""
    end_tolerance_m: float = 0.010
    """The same for a last push at the end, among the things."""
    let_go_at: float = 1.0
    """d at which the person lets go of what may lie anywhere at its goal, on the first try. Below 1 it is a slip of the
    thumb: the thing hangs out, and is to be pushed in."""
    lay_beside: float = 0.9
    """How far to a side what may lie anywhere is laid where there is room, in radii of the last disk."""
    lay_above: float = 0.66
    """How far up an upright disk it is laid where both sides are taken, in the same radii; the less, the more level the
    disk is. Lower, the hand presses on what lies there; higher, what is let go falls deep."""
    judge_at: float = 0.78
    """d below which the gripper is clear of the goal, and the person judges what became of the thing."""
    lift_m: float = 0.10
    """Rise of the gripper after which the person checks that the thing came along."""
    lost_m: float = 0.16
    """A thing further than this from the gripper is not in it."""
    tries: int = 5
    """Attempts at one thing, and pushes at one that hangs out, before it is given up."""

    def __post_init__(self) -> None:
        self.validate()

    def validate(self) -> None:
        """Check all values (see `NavigationOptions.validate`)."""
        if not (
            self.delay_s >= 0 and abs(self.delay_s / JOYSTICK_PERIOD - round(self.delay_s / JOYSTICK_PERIOD)) < 1e-9
        ):
            raise InputError(f"operator.delay_s is {self.delay_s}; give a multiple of {JOYSTICK_PERIOD} s")
