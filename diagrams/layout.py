"""Where the items of a scenario lie, and where their marks are: drawn from the seed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw

from canal.errors import InputError
from diagrams.goals import DrumGoal, Goal, MarkGoal
from diagrams.scenario import Item, Region, Robot, Scenario, Thing

TRIES = 2000
LAYOUT_STREAM = 5
"""Sets this random stream apart from others with the same seed."""


@dataclass(frozen=True)
class Spot:
    """A point on a surface in W [m], and a turn about z [rad]."""

    position: np.ndarray
    yaw: float


def yaw_pose(position: list[float] | np.ndarray, yaw: float) -> RigidTransform:
    """A pose that is upright: a position [m] and a turn about z [rad]."""
    return RigidTransform(RollPitchYaw(0, 0, yaw), np.asarray(position, dtype=float))


def base_pose(robot: Robot) -> RigidTransform:
    """X_WB: where the robot's base stands."""
    return yaw_pose(robot.position, np.deg2rad(robot.yaw_deg))


def draw_layout(scenario: Scenario, seed: int) -> tuple[list[Spot], list[Spot | None]]:
    """Draw a start for each item, and a mark for each that has a goal; no two nearer than the scenario's spacing.

    Raises:
        InputError: the regions are too small for the spacing.
    """
    rng = np.random.default_rng((seed, LAYOUT_STREAM))
    starts: list[Spot] = []
    marks: list[Spot] = []
    goals: list[Spot | None] = []
    for item in scenario.items:
        region, key = item.start, "start"
        if item.kind == "soft" and item.soft_start is not None:
            region, key = item.soft_start, "soft_start"
        starts.append(_draw(rng, scenario, item, region, starts, key))
    for item in scenario.items:
        if item.goal is None:
            goals.append(None)
            continue
        marks.append(_draw(rng, scenario, item, item.goal, marks, "goal"))
        goals.append(marks[-1])
    return starts, goals


def _draw(
    rng: np.random.Generator, scenario: Scenario, item: Item, region: Region, others: list[Spot], what: str
) -> Spot:
    on = next((thing for thing in scenario.things if thing.name == region.frame), Thing())
    X_WT, spacing = yaw_pose(on.position, np.deg2rad(on.yaw_deg)), scenario.item_spacing
    for _ in range(TRIES):
        shift = rng.uniform(-1, 1, 2) * region.half_widths
        yaw = np.deg2rad(on.yaw_deg + rng.uniform(region.yaw_deg[0], region.yaw_deg[1]))
        position = X_WT.multiply(np.asarray(region.center, dtype=float) + [*shift, 0.0])
        if all(np.linalg.norm(position - other.position) >= spacing for other in others):
            return Spot(position, float(yaw))
    raise InputError(
        f"items.{item.name}.{what} leaves no place that is {spacing:g} m from the others; "
        "widen half_widths, move its center, or lower item_spacing"
    )


def make_goals(scenario: Scenario, marks: list[Spot | None], rest_heights: list[float]) -> list[Goal]:
    """What "placed" means for each item.

    Args:
        scenario: where the drum is.
        marks: as drawn; None: into the drum.
        rest_heights: of each item's origin above the surface that it stands on [m].
    """
    goals: list[Goal] = []
    for item, mark, height in zip(scenario.items, marks, rest_heights, strict=True):
        if mark is not None:
            goals.append(MarkGoal(position=mark.position + [0, 0, height], upright=item.upright))
            continue
        drum = scenario.drum
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
