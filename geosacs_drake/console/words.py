"""What the robot is doing, in words that a person understands."""

from __future__ import annotations

from canal.navigation import Leg, NavigationState

TRAVEL = {
    Leg.HOME_TO_PICK: ("Going to pick", "The stick shifts its path to the side; it comes to the items by itself."),
    Leg.PICK_TO_HOME: ("Coming back from pick", "It lifts, and returns to the middle of its way."),
    Leg.HOME_TO_PLACE: ("Going to place", "The stick shifts its path to the side; it stops at the end."),
    Leg.PLACE_TO_HOME: ("Coming back from place", "It returns to the middle of its way."),
}
"""By leg: a headline, and what to know about it."""
LEGS = {
    Leg.HOME_TO_PICK: "to pick",
    Leg.PICK_TO_HOME: "back from pick",
    Leg.HOME_TO_PLACE: "to place",
    Leg.PLACE_TO_HOME: "back from place",
}
"""Name of each leg for a person."""


def doing(state: NavigationState, standing: str, *, person: bool, begun: bool) -> tuple[str, str, str]:
    """What the robot is doing.

    Args:
        state: of the navigation.
        standing: what an announcer has to say about it; empty while all goes its way.
        person: whether a person is in charge.
        begun: whether somebody has said Start or Watch.

    Returns:
        A headline, a sentence about it, and its tone: `ready`, `go`, `steer`, `wait` or `stop`.
    """
    leg = Leg(int(state.leg))
    if not begun:
        return "Ready", "Press Start to steer it yourself, or Watch to see it work.", "ready"
    if state.alarm:
        headline = "Stopped: it presses on something" if state.blocked else "It presses on something"
        return headline, standing, "stop"
    if not state.running:
        if state.travelled == 0 and not standing:
            return "Ready", "Press Start.", "ready"
        return "Stopped", standing.removeprefix("Stopped: ").capitalize() or "Nothing moves until Start.", "stop"
    if state.pause_s >= 0:
        return ("Gripping", "The fingers close.", "wait") if state.gripper_closed else ("Letting go", "", "wait")
    if state.correcting:
        whose = "You move" if person else "The simulated operator moves"
        return "Steering", f"{whose} it on its disk; let go, and it travels on from there.", "steer"
    if state.paused:
        return "Paused", standing.removeprefix("Paused on its disk: ").capitalize() or "Start goes on.", "wait"
    if state.waiting:
        return *_waiting(leg, bool(state.gripper_closed)), "wait"
    return *TRAVEL[leg], "go"


def start_word(state: NavigationState) -> str:
    """What a press of Start would do; empty where it would do nothing, since the robot waits for something else.

    Args:
        state: of the navigation.
    """
    if not state.running:
        return "Start"
    if state.paused:
        return "Go on"
    return "" if state.blocked or state.waiting else "Pause"


def _waiting(leg: Leg, closed: bool) -> tuple[str, str]:
    if leg is Leg.HOME_TO_PICK:
        if closed:
            return "Waiting at pick", "The gripper is closed: Let go opens it, Reverse goes back."
        return "Waiting: steer, then grip", "Move over what is to be taken, and press Grip."
    if closed:
        return "Waiting: steer, then let go", "Move to where it belongs, and press Let go."
    return "Waiting at place", "The gripper is open: Reverse goes back."
