"""Write the furniture: washing machines, basket, tables, marks.

Run `python -m models.make_world`. Every fixture is welded to the world where a scenario says; its origin is on
the floor (or on the table, for basket and mark), its front looks along -y. Fixtures are compliant, items stiff.
"""

from __future__ import annotations

from math import cos, pi, sin, tan
from pathlib import Path

from models.sdf import Link, Material, box, cylinder, mesh, write_model

HERE = Path(__file__).parent / "world"
SCRIPT = "models/make_world.py"

STEEL = Material(friction=0.4, modulus=1e7, margin=0.004)
"""Sheet metal and drum. With this stiffness and margin a rigid bundle that falls into the drum sinks in by 2-4 mm.
Cloth has a margin of its own (`diagrams.deformable.contact`)."""
WOOD = Material(friction=0.6, modulus=3e6, margin=0.001)
WICKER = Material(friction=0.6, modulus=1e6, margin=0.001)
"""Softer, so that what lies in the basket comes to rest with few contact points, which is what a step costs."""

WHITE = (0.94, 0.95, 0.96)
GREY = (0.72, 0.75, 0.78)
CHROME = (0.82, 0.85, 0.88)
DARK = (0.13, 0.14, 0.17)
GASKET = (0.30, 0.31, 0.34)
BLUE = (0.10, 0.42, 0.72)
OAK = (0.80, 0.62, 0.42)
LEGS = (0.33, 0.29, 0.26)
CANE = (0.82, 0.66, 0.44)
CANE_DARK = (0.66, 0.49, 0.30)

DOOR_HEIGHT = 0.55
"""Centre of the round opening above the floor [m]."""
DRUM_RADIUS = 0.25
DRUM_DEPTH = 0.34
"""Of the drum behind the plane of the door, y = 0 of the model [m]."""
HALF_WIDTH, HEIGHT, DEPTH = 0.31, 0.90, 0.42
LIP = 0.03
"""How far the door ring stands out in front [m]."""
PANEL_RADIUS = 0.27


def polar(radius: float, angle: float) -> tuple[float, float]:
    """x and z of a point round the door's centre, angle 0 at the right."""
    return radius * cos(angle), DOOR_HEIGHT + radius * sin(angle)


def ring(
    link: Link, inner: float, outer: float, front: float, back: float, sides: int, material: Material = STEEL
) -> None:
    """Collision of a round ring: boxes whose inner faces make a polygon around the circle of radius `inner`.

    Boxes reach past their neighbours, so that nothing gets in between.
    """
    for k in range(sides):
        angle = 2 * pi * k / sides
        x, z = polar((inner + outer) / 2, angle)
        size = (outer - inner, back - front, 2 * outer * tan(pi / sides))
        link.collision(box(size), material, (x, (front + back) / 2, z), (0, -angle, 0))


def washing_machine(name: str, opening: float) -> None:
    """A front-loading machine with a round opening of the given radius [m]."""
    link = Link("machine")
    thick = 0.02
    # The door ring with its lip, the front panel around it, and the panel's corners.
    ring(link, opening, opening + 0.04, -LIP, 0.03, sides=16)
    ring(link, opening + 0.02, PANEL_RADIUS, 0.0, 0.03, sides=12)
    inner = 0.19
    side = HALF_WIDTH - inner
    for sign in (-1, 1):
        link.collision(box((side, 0.03, HEIGHT)), STEEL, (sign * (inner + side / 2), 0.015, HEIGHT / 2))
    for low, high in ((0.0, DOOR_HEIGHT - inner), (DOOR_HEIGHT + inner, HEIGHT)):
        link.collision(box((2 * inner, 0.03, high - low)), STEEL, (0, 0.015, (low + high) / 2))
    # The drum: staves, and a back.
    # 45 mm, though less would look the same: cloth that falls 0.2 m sinks in by 10 mm in one step of 5 ms, and what is
    # past the middle of a wall comes out on the other side. Twelve, since each overlap is computed twice.
    ring(link, DRUM_RADIUS, DRUM_RADIUS + 0.045, 0.02, DRUM_DEPTH + 0.03, sides=12)
    reach = DRUM_RADIUS + 0.03
    link.collision(box((2 * reach, 0.03, 2 * reach)), STEEL, (0, DRUM_DEPTH + 0.015, DOOR_HEIGHT))
    # The case.
    for sign in (-1, 1):
        link.collision(box((thick, DEPTH, HEIGHT)), STEEL, (sign * (HALF_WIDTH - thick / 2), DEPTH / 2, HEIGHT / 2))
    link.collision(box((2 * HALF_WIDTH, DEPTH, thick)), STEEL, (0, DEPTH / 2, HEIGHT - thick / 2))
    # The door, swung open by 125 degrees about its hinge at the left.
    hinge, swing, door = -(opening + 0.03), 2.18, opening + 0.015
    x, y = hinge + door * cos(swing), -LIP - 0.01 - door * sin(swing)
    link.collision(cylinder(door, 0.05), STEEL, (x, y, DOOR_HEIGHT), (pi / 2, 0, -swing))

    at = (0.0, 0.0, DOOR_HEIGHT)
    link.visual(mesh(f"meshes/{name}_case.obj"), WHITE)
    link.visual(mesh("meshes/drum.obj"), CHROME, at)
    link.visual(mesh("meshes/drum_holes.obj"), DARK, at)
    link.visual(mesh("meshes/drum_ribs.obj"), GREY, at)
    link.visual(mesh(f"meshes/{name}_gasket.obj"), GASKET, at)
    link.visual(mesh(f"meshes/{name}_ring.obj"), CHROME, at)
    pose = (x, y, DOOR_HEIGHT)
    link.visual(mesh(f"meshes/{name}_door.obj"), CHROME, pose, (0, 0, -swing))
    link.visual(mesh(f"meshes/{name}_glass.obj"), (0.35, 0.50, 0.60), pose, (0, 0, -swing), alpha=0.55)
    link.visual(box((0.03, 0.03, 0.10)), GREY, (hinge, -LIP, DOOR_HEIGHT))
    # Controls: drawer, display, knob, buttons, feet.
    top = HEIGHT - 0.075
    link.visual(box((0.15, 0.012, 0.075)), (0.88, 0.90, 0.92), (-0.20, -0.002, top))
    link.visual(box((0.11, 0.012, 0.045)), DARK, (0.06, -0.002, top))
    link.visual(box((0.09, 0.014, 0.012)), (0.25, 0.75, 0.95), (0.06, -0.002, top + 0.008))
    link.visual(cylinder(0.034, 0.05), CHROME, (0.20, -0.015, top), (pi / 2, 0, 0))
    link.visual(box((0.006, 0.052, 0.022)), BLUE, (0.20, -0.016, top + 0.022))
    for k in range(4):
        link.visual(cylinder(0.008, 0.016), BLUE, (-0.05 + 0.0, -0.004, top - 0.03 + 0.02 * k), (pi / 2, 0, 0))
    link.visual(box((0.14, 0.012, 0.09)), (0.88, 0.90, 0.92), (0.19, -0.002, 0.08))
    write_model(HERE / f"{name}.sdf", name, [link], SCRIPT)


def basket(name: str, x: float) -> None:
    """A laundry basket, `x` [m] wide along x; origin at the middle of its underside."""
    link = Link("basket")
    y, z, wall = 0.50, 0.10, 0.012
    link.collision(box((x, y, 0.01)), WICKER, (0, 0, 0.005))
    for sign in (-1, 1):
        link.collision(box((0.02, y, z)), WICKER, (sign * (x - wall) / 2, 0, z / 2))
        link.collision(box((x, 0.02, z)), WICKER, (0, sign * (y - wall) / 2, z / 2))
    link.visual(box((x, y, 0.01)), CANE_DARK, (0, 0, 0.005))
    for k in range(5):
        height, color = 0.012 + 0.019 * k, CANE if k % 2 else CANE_DARK
        grow = 0.002 * (k % 2)
        for sign in (-1, 1):
            link.visual(box((0.010 + grow, y, 0.014)), color, (sign * (x - wall) / 2, 0, height))
            link.visual(box((x, 0.010 + grow, 0.014)), color, (0, sign * (y - wall) / 2, height))
    for k in range(13):
        offset = (k / 12 - 0.5) * (y - wall)
        for sign in (-1, 1):
            link.visual(cylinder(0.006, z), CANE, (sign * (x - wall) / 2, offset, z / 2))
    for k in range(1, 9):
        offset = (k / 9 - 0.5) * (x - wall)
        for sign in (-1, 1):
            link.visual(cylinder(0.006, z), CANE, (offset, sign * (y - wall) / 2, z / 2))
    for sign in (-1, 1):
        link.visual(cylinder(0.009, y + 0.006), CANE, (sign * (x - wall) / 2, 0, z), (pi / 2, 0, 0))
        link.visual(cylinder(0.009, x + 0.006), CANE, (0, sign * (y - wall) / 2, z), (0, pi / 2, 0))
    write_model(HERE / f"{name}.sdf", name, [link], SCRIPT)


def table(name: str, width: float, depth: float, height: float) -> None:
    """A table `width` along x and `depth` along y, its top at `height` [m]; origin on the floor."""
    link = Link("table")
    thick, leg = 0.03, 0.045
    link.solid(box((width, depth, thick)), WOOD, OAK, (0, 0, height - thick / 2))
    for sx in (-1, 1):
        for sy in (-1, 1):
            at = (sx * (width / 2 - 0.05), sy * (depth / 2 - 0.05), (height - thick) / 2)
            link.solid(box((leg, leg, height - thick)), WOOD, LEGS, at)
    link.visual(box((width - 0.1, 0.02, 0.05)), LEGS, (0, depth / 2 - 0.05, height - thick - 0.025))
    link.visual(box((width - 0.1, 0.02, 0.05)), LEGS, (0, -depth / 2 + 0.05, height - thick - 0.025))
    write_model(HERE / f"{name}.sdf", name, [link], SCRIPT)


BOARD = (0.48, 0.60, 0.03)
"""Of the table of any height [m]."""


def table_any_height(name: str = "table_any_height") -> None:
    """A table for any height: origin in the middle of its top, and legs that are seen down to the floor and beyond."""
    link = Link("table")
    width, depth, thick = BOARD
    link.solid(box(BOARD), WOOD, OAK, (0, 0, -thick / 2))
    for sx in (-1, 1):
        for sy in (-1, 1):
            at = (sx * (width / 2 - 0.05), sy * (depth / 2 - 0.05), -thick - 0.5)
            link.visual(box((0.045, 0.045, 1.0)), LEGS, at)
    write_model(HERE / f"{name}.sdf", name, [link], SCRIPT)


def floor(name: str = "floor") -> None:
    """A stretch of floor; a box, since deformables do not touch half-spaces."""
    link = Link("floor")
    link.collision(box((4.0, 4.0, 0.2)), WOOD, (0, 0.3, -0.1))
    link.visual(cylinder(1.7, 0.01), (0.87, 0.86, 0.84), (0.1, 0.25, -0.0055))
    write_model(HERE / f"{name}.sdf", name, [link], SCRIPT)


def main() -> None:
    """Write all of them."""
    washing_machine("washing_machine", opening=0.17)
    washing_machine("washing_machine_narrow", opening=0.15)
    floor()
    basket("basket", x=0.36)
    basket("basket_wide", x=0.44)
    table("laundry_table", width=0.46, depth=0.70, height=0.30)
    table("table", width=0.56, depth=0.66, height=0.40)
    table_any_height()


if __name__ == "__main__":
    main()
