"""All checks, in the order of the table."""

from benchmarks.acceptance import canals, doors, idle, kinematics, recorded, replay, runs, speed
from benchmarks.acceptance.check import Check

NOT_LOOKED_AT = (
    "a real robot, a real gamepad, a person's hands",
    "the page in a browser (the tests look at it)",
    "pictures, films and recordings: how they look",
    "the seeds and scenarios that are not named above; hours instead of minutes (`make fuzz`)",
    "machines of another kind: times are this one's, ratios are kept",
)


def all_checks() -> list[Check]:
    """Every check; what cannot be run here says why."""
    of_modules = (runs, recorded, canals, kinematics, idle, replay, speed, doors)
    return [check for module in of_modules for check in module.checks()]
