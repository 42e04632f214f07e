"""A relocation's scene, fitted to a canal that somebody has shown: tables, starts and marks where its ends are.

Tables stand under both ends of the canal, so high that the gripper closes on items as it does in the shipped
relocation. Items start anywhere on the pick disk, and their marks lie anywhere on the place disk, as far as the arm
reaches, the table bears them and the gripper keeps its height above the table.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from canal.editing import with_support_planes
from canal.errors import InputError
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface
from diagrams.ik.joint_pace import unhurried
from diagrams.ik.reachability import ReachReport, reach_report
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import find_start_posture
from diagrams.scenario import Scenario
from diagrams.scene.fitted_table import FittedTable, fit_tables
from diagrams.scene.layout import draw_layout, hand_above
from diagrams.scene.open_gripper import gripper_depth, lean, opens_towards, tool_axes
from diagrams.scene.way_down import MOST_LEAN, room_at
from diagrams.scene.world import Fixture, Item, Region, Robot, Room
from diagrams.station.lio_station import START_POSTURE

GRIP_HEIGHT = 0.040
"""Of the TCP above the table when the gripper closes [m], as in the shipped relocation: the pads hold the middle of
apple, cup and cube, and the fingertips stay clear of the table."""
TIP_ROOM = 0.010
"""Least room of the fingertips above the table [m]: tracking errors are up to 5.5 mm, and a table gives way."""
MOST_GRIP_HEIGHT = 0.055
"""[m] Above this the pads hold the cube, 60 mm tall, by less than a third."""
BELOW_ENDS = 0.002
"""The support plane lies this far below the lowest disk [m], whose centre has to be above it."""
MOST_RISE = 0.012
"""How far a point of the disk may lie above or below its centre [m], for the gripper to close on what stands there."""
RIM_SHARE = 0.95
"""Part of a disk's reach that items may lie in: at its very rim a thumb could correct to one side alone."""
WIDEST_ITEM = 0.036
"""Radius of the cup, which is set down on its edge where the gripper leans otherwise than at the grip [m]."""
SET_DOWN = 0.001
"""From this high above the table items are let go [m]."""
YAW_RANGE_DEG = 15.0
"""Flat sides and handles may be turned by this much from where they suit the fingers."""
LEAST_HEIGHT = 0.03
"""Of a table: as thick as its board [m]."""
MOST_SIDEWAYS = 0.035
"""[m] How far the gripper may be off an item, the way its fingers open, when it is 0.05 above where it closes: its tips
pass the rim of the cup, open by 0.070 to each side, where the cup measures 0.036."""
BEYOND = (0.0, 0.008, 0.015)
"""[m] How far past what the gripper's centre reaches items may lie where a disk is small: fingers open 0.055 to each
side, and marks are met within 0.03."""
LEAST_FOLLOWED = 0.95
"""Of the directrix, for a canal to be within the arm's reach."""
RINGS, SPOKES = 8, 24
SEEDS_TRIED = 20
"""An item is kept only if there is room for it with all of these seeds."""


@dataclass(frozen=True)
class FittedScene:
    """What came of the fitting.

    Attributes:
        scenario: with tables, regions and support planes.
        canal: with its disks refined at the tables.
        lines: what a person should know, first what stands where.
    """

    scenario: Scenario
    canal: CanalSurface
    lines: list[str]


def fit_scene(canal: CanalSurface, template: Scenario, solver: IkSolver) -> FittedScene:
    """Fit tables, starts and marks to a canal.

    Args:
        canal: in the robot's base frame.
        template: a relocation, whose items and options are taken over.
        solver: of the arm alone, with the run's options.

    Returns:
        The scene, and the canal refined at its tables.

    Raises:
        InputError: at an end nothing can be gripped from a table, or the arm does not get there.
    """
    drop = _set_down_drop(canal)
    tops = {}
    for name, disk, more in (("pick", 0, 0.0), ("place", canal.n_disks - 1, drop)):
        tops[name] = float(canal.directrix[disk, 2]) - _grip_height(canal, name, disk) - more
        if tops[name] < LEAST_HEIGHT:
            raise InputError(
                f"the canal's {name} at {canal.directrix[disk, 2]:.2f} m leaves no room for a table; demonstrate "
                f"higher, or give a --scenario"
            )
    lowest = float(canal.directrix[:, 2].min()) - BELOW_ENDS
    table_plane = SupportPlane((0.0, 0.0, 1.0), lowest)
    canal = with_support_planes(canal, (table_plane,))
    start = find_start_posture(solver, unhurried(canal), preferred=START_POSTURE)
    if start.followed.mean() < LEAST_FOLLOWED:
        raise InputError(
            f"the arm follows {100 * float(start.followed.mean()):.0f} % of the canal (at least "
            f"{100 * LEAST_FOLLOWED:.0f}): it {start.describe()}; demonstrate within its reach, or give a --scenario"
        )
    report = reach_report(solver, canal, start, rings=RINGS, spokes=SPOKES, most_disks=2)
    tables = fit_tables(canal, report, start.path, tops)
    lines = [f"scene fitted to the canal: tables of {tops['pick']:.3f} m at pick and {tops['place']:.3f} m at place"]
    regions = {}
    for row, (name, table) in enumerate(tables.items()):
        region, share = _region(canal, report, row, name, table)
        regions[name] = region
        radius = 1e3 * float(canal.radii[report.disks[row]])
        if share < 0.995:
            what = "items start" if name == "pick" else "marks lie"
            lines.append(f"{100 * share:.0f} % of the {name} disk (radius {radius:.0f} mm) can be used: {what} there")
    scenario = replace(
        template,
        robot=Robot(),
        fixtures=[
            Fixture("floor", "floor"),
            *(Fixture("table", "table_any_height", [*t.center, tops[n]], t.yaw_deg) for n, t in tables.items()),
        ],
        items=[_item(item, canal, regions) for item in template.items],
        item_spacing=SPACING,
        support_planes=[table_plane],
    )
    scenario, beyond = _what_fits(scenario)
    if beyond > 0.0:
        lines.append(f"the disks are small: items lie up to {1e3 * beyond:.0f} mm past where the gripper reaches")
    dropped = [item.name for item in template.items[len(scenario.items) :]]
    if dropped:
        lines.append(
            f"there is room for {len(scenario.items)} of {len(template.items)} items, not for {', '.join(dropped)}"
        )
    return FittedScene(scenario, canal, lines)


SPACING = 0.085
"""[m] Between the middles of two items: they do not touch. What the fingers need is more, and has a direction."""


def _grip_height(canal: CanalSurface, name: str, disk: int) -> float:
    """Of the TCP above the table at an end [m].

    Raises:
        InputError: as the gripper is turned there, nothing can be gripped from a table.
    """
    q = canal.orientations[disk]
    height = max(GRIP_HEIGHT, gripper_depth(q) + TIP_ROOM)
    if lean(q) > MOST_LEAN or height > MOST_GRIP_HEIGHT:
        raise InputError(
            f"at {name} the gripper points {math.degrees(lean(q)):.0f}° off straight down, and its tips reach "
            f"{1e3 * gripper_depth(q):.0f} mm below its centre: from a table it grips up to "
            f"{math.degrees(MOST_LEAN):.0f}° and {1e3 * (MOST_GRIP_HEIGHT - TIP_ROOM):.0f} mm; demonstrate with the "
            "gripper pointing down, or give a --scenario"
        )
    return height


def _set_down_drop(canal: CanalSurface) -> float:
    """How much lower than gripped an item is set down [m]: by its edge, where the gripper leans otherwise."""
    up_pick, up_place = (tool_axes(q)[2] for q in canal.orientations[[0, -1]])  # the vertical, seen from the tool
    leans = math.acos(min(1.0, float(up_pick @ up_place)))
    return SET_DOWN + WIDEST_ITEM * math.sin(leans) - GRIP_HEIGHT * (1.0 - math.cos(leans))


def _region(canal: CanalSurface, report: ReachReport, row: int, name: str, table: FittedTable) -> tuple[Region, float]:
    """Where items may lie at an end, and which part of the disk's area that is."""
    disk = int(report.disks[row])
    center = canal.directrix[disk]
    usable = report.reached[row] & table.free
    room = room_at(canal, disk)
    most = max(MOST_SIDEWAYS, _sideways(room, np.zeros(2))) if name == "pick" else math.inf
    angles, reach, whole = np.empty(SPOKES), np.zeros(SPOKES), np.empty(SPOKES)
    for spoke, phi in enumerate(report.phis):
        offsets = np.array([canal.point(disk, eta, phi) - center for eta in report.etas])
        level = np.hypot(offsets[:, 0], offsets[:, 1])
        sideways = np.array([_sideways(room, offset[:2]) for offset in offsets])
        good = usable[:, spoke] & (np.abs(offsets[:, 2]) <= MOST_RISE) & (sideways <= most)
        first_bad = int(np.argmin(good)) if not good.all() else RINGS
        angles[spoke] = math.atan2(offsets[-1, 1], offsets[-1, 0]) % (2 * math.pi)
        reach[spoke] = level[first_bad - 1] if first_bad else 0.0
        whole[spoke] = level[-1]
    order = np.argsort(angles)
    around = np.arange(SPOKES) * (2 * math.pi / SPOKES)
    even = np.interp(around, angles[order], reach[order], period=2 * math.pi)
    even = RIM_SHARE * np.minimum(even, table.room(center[:2], around) / RIM_SHARE)
    rim = np.interp(around, angles[order], whole[order], period=2 * math.pi)
    share = float(np.sum((even / RIM_SHARE) ** 2) / max(float(np.sum(rim**2)), 1e-12))
    return Region(center=[*center[:2].tolist(), table.top], reach=even.tolist(), room=room), min(share, 1.0)


def _sideways(room: Room, spot: np.ndarray) -> float:
    """How far off a spot (2,) of the disk the gripper is, the way its fingers open, half-way down on it [m]."""
    off = hand_above(room, spot)[len(room.way) // 2] - spot
    yaw = math.radians(room.yaw_deg)
    return abs(float(off @ [math.cos(yaw), math.sin(yaw)]))


def _item(item: Item, canal: CanalSurface, regions: dict[str, Region]) -> Item:
    """An item of the template in the fitted regions, turned so that its handle or sides suit the fingers."""
    yaw = [-180.0, 180.0]
    if item.start.yaw_deg[1] - item.start.yaw_deg[0] < 360.0:  # it is not round
        # Across the fingers, and outwards rather than towards the robot.
        across = math.degrees(opens_towards(canal.orientations[0])) + 90.0
        outwards = math.degrees(math.atan2(canal.directrix[0, 1], canal.directrix[0, 0]))
        across += 180.0 * (math.cos(math.radians(across - outwards)) < 0)
        yaw = [across - YAW_RANGE_DEG, across + YAW_RANGE_DEG]
    return replace(item, start=replace(regions["pick"], yaw_deg=yaw), goal=regions["place"])


def _what_fits(scenario: Scenario) -> tuple[Scenario, float]:
    """The scenario with as many of its items as there is room for, whatever the seed; and how far past reach [m].

    Raises:
        InputError: there is no position for any.
    """
    for count in range(len(scenario.items), 0, -1):
        for beyond in BEYOND:
            fewer = replace(scenario, items=[_wider(item, beyond) for item in scenario.items[:count]])
            try:
                for seed in range(SEEDS_TRIED):
                    draw_layout(fewer, seed)
            except InputError:
                continue
            return fewer, beyond
    raise InputError("the arm reaches no position for an item at the canal's ends; demonstrate nearer to the robot")


def _wider(item: Item, by: float) -> Item:
    """An item that may lie, and belong, a little further out [m]."""
    start, goal = (None if r is None else replace(r, reach=[v + by for v in r.reach]) for r in (item.start, item.goal))
    return replace(item, start=start or item.start, goal=goal)
