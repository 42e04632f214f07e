"""What ended a run from inside, in our words: what failed, when, and how everything stood then."""

from __future__ import annotations

from pydrake.systems.framework import Context

from canal.navigation import Leg, NavigationState
from diagrams.shared_autonomy import SharedAutonomy
from diagrams.station.sleep import SleepManager


def describe_failure(error: BaseException, system: SharedAutonomy, sleep: SleepManager, root: Context) -> str:
    """One line without the library's own words, which the summary has under `failure`.

    Args:
        error: what was raised.
        system: the run's diagram.
        sleep: what sleeps in it.
        root: the diagram's context, as it was then.
    """
    try:
        state = _state(system, sleep, root)
    except (RuntimeError, ValueError, SystemExit):  # of Drake, asked about a state that is none
        state = "in a state of which nothing can be computed"
    return f"{_what(error)} at {root.get_time():.3f} s ({state})"


def _what(error: BaseException) -> str:
    text = str(error)
    if "websocket thread" in text:
        return "the page failed, a client sent it what Meshcat cannot read,"
    if "converge" in text:
        return "the contact solver did not converge"
    if isinstance(error, RuntimeError):  # of Drake's solvers: the plant's state has left what can be simulated
        return "a step of the simulation failed"
    return f"a step of the simulation failed ({type(error).__name__})"


def _state(system: SharedAutonomy, sleep: SleepManager, root: Context) -> str:
    """Where the robot was, in which state, with what in the hand, and what was being simulated."""
    context = system.navigator.GetMyContextFromRoot(root)
    navigation = NavigationState.from_vector(system.navigator.GetOutputPort("navigation_state").Eval(context))
    doing = "travelling"
    for name in ("correcting", "waiting", "blocked"):
        if getattr(navigation, name, 0.0):
            doing = name
    if not navigation.running:
        doing = "not running"
    gripper = "closed" if navigation.gripper_closed else "open"
    held = _in_hand(system, root)
    awake = sleep.names_awake(root)
    return (
        f"leg {Leg(int(navigation.leg)).name.lower()}, disk {navigation.disk:.1f}, {doing}, gripper {gripper}, "
        f"in the hand: {', '.join(held) or 'nothing'}, awake: {', '.join(awake) or 'nothing'}"
    )


def _in_hand(system: SharedAutonomy, root: Context) -> list[str]:
    station = system.station
    grips = station.GetOutputPort("grip_forces").Eval(station.GetMyContextFromRoot(root))
    return [item.name for item, force in zip(station.scene.items, grips, strict=True) if force > 0]
