"""Where the items of a scenario lie, and where their marks are: drawn from the seed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw

from canal.errors import InputError
from diagrams.geometry.goals import DrumGoal, Goal, MarkGoal
from diagrams.scene.world import Fixture, Region, Robot, Room, World

TRIES, ROUNDS, DEALS = 200, 100, 30
CARRIED = 0.080
"""[m] Between the middles of an item in the hand and of one that stands: the widest measure 0.037, and a hand errs."""
LAYOUT_STREAM = 5
"""Sets this random stream apart from others with the same seed."""


@dataclass(frozen=True)
class Spot:
    """A point on a surface in W [m], and a turn about z [rad]."""

    position: np.ndarray
    """In W, [m]. Shape (3,)."""
    yaw: float
    """About z of W, [rad]."""


def yaw_pose(position: list[float] | np.ndarray, yaw: float) -> RigidTransform:
    """A pose that is upright: a position [m] and a turn about z [rad].

    Args:
        position: [m]. Shape (3,).
        yaw: about z, [rad].
    """
    return RigidTransform(RollPitchYaw(0, 0, yaw), np.asarray(position, dtype=float))


def base_pose(robot: Robot) -> RigidTransform:
    """X_WB: where the robot's base stands."""
    return yaw_pose(robot.position, np.deg2rad(robot.yaw_deg))


def draw_layout(world: World, seed: int) -> tuple[list[Spot], list[Spot | None]]:
    """Draw a start for each item, and a mark for each that has a goal; no two nearer than the scenario's spacing.

    Args:
        world: its items, their regions, and the fixtures that regions lie on.
        seed: of the draw.

    Returns:
        Starts and marks, in the items' order; None for an item without a goal.

    Raises:
        InputError: the regions are too small for the spacing, or for the hand's way down.
    """
    rng = np.random.default_rng((seed, LAYOUT_STREAM))
    for _ in range(DEALS):
        starts, marks = _draw_ends(rng, world)
        if (dealt := _in_turn(rng, world, starts, marks)) is not None:
            return starts, dealt
    raise InputError(
        "items: wherever they lie, the hand on its way to one meets another; give them more room, or fewer of them"
    )


def _draw_ends(rng: np.random.Generator, world: World) -> tuple[list[Spot], list[Spot | None]]:
    """Starts and marks, each no nearer to the others than they may be."""
    starts = _draw_all(
        rng,
        world,
        [
            (item.name, "deformable_start", item.deformable_start)
            if item.kind == "soft" and item.deformable_start is not None
            else (item.name, "start", item.start)
            for item in world.items
        ],
    )
    goals = {i: item.goal for i, item in enumerate(world.items) if item.goal is not None}
    drawn = _draw_all(rng, world, [(world.items[i].name, "goal", region) for i, region in goals.items()])
    marks = dict(zip(goals, drawn, strict=True))
    return starts, [marks.get(i) for i in range(len(world.items))]


def _draw_all(rng: np.random.Generator, world: World, regions: list[tuple[str, str, Region]]) -> list[Spot]:
    """A spot in each region (item, key, region), all apart; anew where the first leave no position for the last."""
    crowded = ""
    for _ in range(ROUNDS):
        spots: list[Spot] = []
        for item, key, region in regions:
            others = list(zip(spots, (r for _, _, r in regions), strict=False))
            spot = _draw(rng, world, region, others)
            if spot is None:
                crowded = crowded or f"items.{item}.{key}"
                break
            spots.append(spot)
        else:
            return spots
    raise InputError(
        f"{crowded} leaves no position that is {world.item_spacing:g} m from the others and clear of the fingers; "
        "widen its region, move its center, or lower item_spacing"
    )


def _draw(rng: np.random.Generator, world: World, region: Region, others: list[tuple[Spot, Region]]) -> Spot | None:
    on = next((fixture for fixture in world.fixtures if fixture.name == region.frame), Fixture())
    X_WT = yaw_pose(on.position, np.deg2rad(on.yaw_deg))
    for _ in range(TRIES):
        shift = _shift(rng, region)
        yaw = np.deg2rad(on.yaw_deg + rng.uniform(region.yaw_deg[0], region.yaw_deg[1]))
        position = X_WT.multiply(np.asarray(region.center, dtype=float) + [*shift, 0.0])
        if all(
            math.dist(position, other.position) >= world.item_spacing
            and _clear(position - other.position, region.room)
            and _clear(position - other.position, theirs.room)
            for other, theirs in others
        ):
            return Spot(position, float(yaw))
    return None


def _shift(rng: np.random.Generator, region: Region) -> np.ndarray:
    """A point of a region, evenly drawn, from its middle [m]. Shape (2,)."""
    if not region.reach:
        return rng.uniform(-1, 1, 2) * region.half_widths
    while True:
        distance, angle = max(region.reach) * math.sqrt(rng.uniform()), rng.uniform(0, 2 * math.pi)
        if distance <= reach_at(region.reach, angle):
            return distance * np.array([np.cos(angle), np.sin(angle)])


def reach_at(reach: Sequence[float], angle: float) -> float:
    """How far a region reaches at an angle [rad] about its middle, [m]: `reach` is given at equal angles.

    Args:
        reach: at equal angles from x on, [m].
        angle: [rad].
    """
    sector = angle * len(reach) / (2 * math.pi)
    k, share = math.floor(sector), sector % 1.0
    return (1.0 - share) * reach[k % len(reach)] + share * reach[(k + 1) % len(reach)]


def _clear(apart: np.ndarray, room: Room | None) -> bool:
    """Whether what lies `apart` [m] leaves an item the room that the fingers need."""
    if room is None:
        return True
    x, y = apart[:2].tolist()
    c, s = math.cos(math.radians(room.yaw_deg)), math.sin(math.radians(room.yaw_deg))
    return abs(c * x + s * y) >= room.along or abs(c * y - s * x) >= room.across


def hand_above(room: Room, spot: np.ndarray) -> np.ndarray:
    """What the hand is above on its way down to a spot (2,), both from the region's middle [m]. Shape (heights, 2).

    Args:
        room: what the fingers take.
        spot: where the item lies, from the middle of its region, [m]. Shape (2,).
    """
    x, y = spot
    return np.array([[dx + a * x - b * y, dy + b * x + a * y] for dx, dy, a, b in room.way]).reshape(-1, 2)


def in_the_way(room: Room | None, spot: np.ndarray, other: np.ndarray) -> bool:
    """Whether the hand, on its way to a spot, meets what stands at another: (2,) from the region's middle [m].

    Args:
        room: what the fingers take about `spot`; None for nothing.
        spot: where an item lies, from the middle of its region, [m]. Shape (2,).
        other: where another lies, likewise. Shape (2,).
    """
    if room is None:
        return False
    aside = [other - hand for hand in hand_above(room, spot)]
    return any(math.hypot(*apart) < CARRIED or not _clear(apart, room) for apart in aside)


def _in_turn(
    rng: np.random.Generator, world: World, starts: list[Spot], marks: list[Spot | None]
) -> list[Spot | None] | None:
    """The marks, dealt so that items can be carried one after the other; None: the hand always meets one.

    Where the hand comes down aslant, what stands there has to be taken first, or placed last.
    """
    goals = [item.goal for item in world.items if item.goal is not None]
    known = [mark for mark in marks if mark is not None]
    alike = 0 < len(goals) == len(known) == len(marks) and all(goal == goals[0] for goal in goals)
    if not alike or goals[0].room is None or not goals[0].room.way:
        return marks
    taken, cleared = _turns(rng, starts, [item.start for item in world.items]), _turns(rng, known, goals)
    if taken is None or cleared is None:
        return None
    dealt = dict(zip(taken, reversed(cleared), strict=True))  # what could be taken first is placed last
    return [marks[dealt[i]] for i in range(len(marks))]


def _turns(rng: np.random.Generator, spots: list[Spot], regions: list[Region]) -> list[int] | None:
    """An order in which items can be taken away, each past those that are still there; None: there is none."""
    left, turns = list(range(len(spots))), []
    seen = [spot.position[:2] - region.center[:2] for spot, region in zip(spots, regions, strict=True)]
    while left:
        free = [i for i in left if not any(in_the_way(regions[i].room, seen[i], seen[j]) for j in left if j != i)]
        if not free:
            return None
        turns.append(int(rng.choice(free)))
        left.remove(turns[-1])
    return turns


def make_goals(world: World, marks: list[Spot | None], rest_heights: list[float]) -> list[Goal]:
    """What "placed" means for each item.

    Args:
        world: where the drum is.
        marks: as drawn; None: into the drum.
        rest_heights: of each item's origin above the surface that it stands on [m].
    """
    goals: list[Goal] = []
    for item, mark, height in zip(world.items, marks, rest_heights, strict=True):
        if mark is not None:
            goals.append(MarkGoal(position=mark.position + [0, 0, height], upright=item.upright))
            continue
        drum = world.drum
        if drum is None:
            raise InputError(f"items.{item.name} has no goal, and there is no drum; give one of them")
        inward = np.asarray(drum.inward, dtype=float)
        goals.append(
            DrumGoal(
                p_WD=np.asarray(drum.center, dtype=float),
                inward=inward / np.linalg.norm(inward),
                depth=drum.depth,
                radius=drum.radius,
            )
        )
    return goals
