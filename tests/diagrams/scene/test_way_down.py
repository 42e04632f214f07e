"""Where a canal comes down aslant, nothing stands in the hand's way: items are drawn, dealt and taken in turn."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from canal.demonstration import load_demonstration
from canal.editing import with_support_planes
from canal.errors import InputError
from canal.learning import learn_canal
from canal.navigation import NavigationOptions, NavigationState
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface
from diagrams.geometry.goals import MarkGoal
from diagrams.operator.options import OperatorOptions
from diagrams.operator.policy import OperatorPolicy
from diagrams.operator.state import Mode, OperatorState, Sight
from diagrams.scenario import Scenario, load_scenario
from diagrams.scene.layout import draw_layout, hand_above, in_the_way
from diagrams.scene.way_down import HEIGHTS, room_at
from diagrams.scene.world import Region, Room
from models import MODELS


@pytest.fixture(scope="module")
def canal() -> CanalSurface:
    """The shipped pair, led aslant: the way down goes by half as much to the side."""
    straight = [load_demonstration(MODELS / "demonstrations" / f"tables_{k}.npz") for k in (1, 2)]
    aslant = [np.outer(0.5 * d.position[:, 2], [1.0, 0.0, 0.0]) for d in straight]
    shown = learn_canal([replace(d, position=d.position + by) for d, by in zip(straight, aslant, strict=True)])
    return with_support_planes(shown, (SupportPlane((0.0, 0.0, 1.0), float(shown.directrix[:, 2].min()) - 0.002),))


@pytest.mark.parametrize("last", [False, True])
def test_the_hand_is_where_the_way_says(canal: CanalSurface, last: bool) -> None:
    end = canal.n_disks - 1 if last else 0
    middle, room = canal.directrix[end], room_at(canal, end)
    assert len(room.way) == len(HEIGHTS)
    for eta, phi in ((0.0, 0.0), (0.6, 1.0), (0.8, 4.0)):
        spot = canal.point(end, eta, phi)
        for height, hand in zip(HEIGHTS, hand_above(room, spot[:2] - middle[:2]), strict=True):
            disk = float(end)
            while canal.point(disk, eta, phi)[2] < spot[2] + height:
                disk += -0.25 if last else 0.25
            assert hand == pytest.approx(canal.point(disk, eta, phi)[:2] - middle[:2], abs=0.008)


def slanted(dx: float, *, narrows: float = 1.0, reach: float = 0.12) -> Scenario:
    """A relocation on two disks onto which the hand comes down from `dx` metres along x."""
    way = [[0.5 * dx, 0.0, (1 + narrows) / 2, 0.0], [dx, 0.0, narrows, 0.0]]
    region = Region(reach=[reach], room=Room(yaw_deg=0.0, across=0.065, way=way))
    template = load_scenario("relocation")
    return replace(template, items=[replace(item, start=region, goal=region) for item in template.items])


def stands_free(spots: list[np.ndarray], room: Room) -> np.ndarray:
    return np.array([[not in_the_way(room, one, other) for other in spots] for one in spots])


@pytest.mark.parametrize("dx", [0.03, 0.06, -0.06])
def test_items_can_be_carried_one_after_the_other(dx: float) -> None:
    scenario = slanted(dx)
    room = scenario.items[0].start.room
    assert room is not None
    out_of_turn = 0
    for seed in range(20):
        starts, marks = draw_layout(scenario, seed)
        taken = stands_free([spot.position[:2] for spot in starts], room)
        placed = stands_free([mark.position[:2] for mark in marks if mark is not None], room)
        in_turn = [
            all(taken[order[s], order[t]] and placed[order[t], order[s]] for t in range(3) for s in range(t))
            for order in permutations(range(3))
        ]
        assert any(in_turn)
        out_of_turn += not all(in_turn)
    assert out_of_turn > 3, "or the turn would not matter"


def test_where_the_hand_always_meets_another_is_refused() -> None:
    over_the_middle = slanted(0.0, narrows=0.0, reach=0.075)
    two = replace(over_the_middle, items=over_the_middle.items[:2])
    with pytest.raises(InputError, match="the hand on its way to one meets another"):
        draw_layout(two, 0)


@pytest.mark.parametrize("first", [0, 1])
def test_the_person_takes_first_what_is_in_the_way(canal: CanalSurface, first: int) -> None:
    """Two items lie clear of each other, and so do their marks; but the way to one mark leads over the other."""
    last = canal.n_disks - 1
    start, end = canal.directrix[0], canal.directrix[last]
    room = room_at(canal, last)
    # A mark below where the hand comes from, and the other clear of the fingers there, once the hand is down.
    across = np.deg2rad(room.yaw_deg + 90.0)
    aside = np.append(0.041 * np.array([np.cos(across), np.sin(across)]), 0.0)
    middle = np.append(hand_above(room, np.zeros(2))[-1] / 2, 0.0)
    if (aside @ middle) < 0:
        aside = -aside
    marks = [end - aside, end + aside]
    assert in_the_way(room, (-aside)[:2], aside[:2])
    assert not in_the_way(room, aside[:2], (-aside)[:2])
    marks = marks if first == 0 else marks[::-1]
    policy = OperatorPolicy(
        canal,
        [MarkGoal(mark) for mark in marks],
        OperatorOptions(),
        stick_speed=20.0 / NavigationOptions().delta,
        p_BG=np.array(marks),
        seed=0,
    )
    along = np.append(0.08 * np.array([np.cos(across), np.sin(across)]), 0.0)
    sight = Sight(
        np.array([start - along, start + along]), np.zeros(2, bool), start, NavigationState(float(canal.home_disk))
    )
    state = OperatorState(mode=float(Mode.PICK))
    chosen = policy.decide(state.pack(np.zeros(2), np.zeros(2)), sight, 1.0)
    assert OperatorState.unpack(chosen, 2)[0].item == first
