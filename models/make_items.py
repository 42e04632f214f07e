"""Write the items to carry: apple, cup, cube, and clothes bundled so tightly that they are rigid.

Run `python -m models.make_items`. Origin in the middle, which is the centre of mass; long side along x, standing on -z.
"""

from __future__ import annotations

from math import cos, pi
from pathlib import Path

import numpy as np

from models.mesh import Mesh, grid, lofted, merge, rounded, superellipse, turned, write_obj
from models.sdf import Color, Link, Material, box, mesh, write_model

HERE = Path(__file__).parent / "items"
MESHES = HERE / "meshes"
SCRIPT = "models/make_items.py"

HARD = 1e8
"""Modulus [Pa]: so stiff that it gives way to nothing here, but not rigid, since Drake computes rigid on rigid as one
point, on which a bundle that lies on another rocks without end."""
SKIN = Material(friction=0.8, modulus=HARD)
CHINA = Material(friction=0.8, modulus=HARD)
BEECH = Material(friction=0.8, modulus=HARD)
COTTON = Material(friction=0.9, modulus=HARD)

RED, LEAF, STALK = (0.83, 0.14, 0.13), (0.35, 0.60, 0.20), (0.38, 0.26, 0.15)
TEAL, AMBER = (0.05, 0.55, 0.60), (0.95, 0.68, 0.18)
CORAL, CREAM, NAVY = (0.91, 0.38, 0.33), (0.97, 0.94, 0.86), (0.13, 0.22, 0.45)
MINT = (0.48, 0.76, 0.66)

APPLE = (0.038, 0.038, 0.036)
"""Semi-axes [m]."""
CUP_RADIUS, CUP_HEIGHT = 0.036, 0.090
CUBE = 0.060
SOCK = (0.062, 0.027, 0.024)
SHIRT = (0.076, 0.038, 0.029)
TOWEL = (0.090, 0.041, 0.035)
"""Semi-axes of the bundles [m]. Round, since the corner of a box sinks in by 8 mm where it falls into the drum."""


def item(name: str, mass: float, inertia: tuple[float, float, float], shape: str, material: Material,
         parts: list[tuple[Mesh, Color]], turn: tuple[float, float, float] = (0, 0, 0)) -> None:  # fmt: skip
    """Write a free body with one shape to touch, and meshes to see."""
    link = Link(name, static=False, mass=mass, inertia=inertia)
    link.collision(shape, material, (0, 0, 0), turn)
    for k, (part, color) in enumerate(parts):
        write_obj(MESHES / f"{name}_{k}.obj", part)
        link.visual(mesh(f"meshes/{name}_{k}.obj"), color)
    write_model(HERE / f"{name}.sdf", name, [link], SCRIPT)


def hull(name: str, points: np.ndarray) -> str:
    """A coarse convex body through rings of points (rows, n, 3), as a shape to touch.

    Few, flat facets: what stands on one is at rest, with few contact points, which is what a step costs.
    """
    write_obj(MESHES / f"{name}_hull.obj", grid(points, close_columns=True).outward())
    return mesh(f"meshes/{name}_hull.obj", convex=True)


def blunt(radii: tuple[float, float, float], power: float, rows: int, sides: int) -> np.ndarray:
    """Rings of an ellipsoid along x for `hull`, grown so that its facets lie half inside and half outside of it."""
    grow = cos(pi / sides) ** -0.5
    t, angle = np.linspace(0, pi, rows), 2 * pi * (np.arange(sides) + 0.5) / sides
    p, s = np.meshgrid(t, angle, indexing="ij")
    a, b, c = radii
    wide = grow * np.sin(p) ** (2 / power)
    x = -a * np.sign(np.cos(p)) * np.abs(np.cos(p)) ** (2 / power)
    return np.stack([x, b * wide * np.cos(s), c * wide * np.sin(s)], axis=-1)


def ellipsoid_inertia(m: float, a: float, b: float, c: float) -> tuple[float, float, float]:
    """Principal moments of a solid ellipsoid with semi-axes a, b, c."""
    return m * (b * b + c * c) / 5, m * (a * a + c * c) / 5, m * (a * a + b * b) / 5


def box_inertia(m: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Principal moments of a solid box with edges x, y, z."""
    return m * (y * y + z * z) / 12, m * (x * x + z * z) / 12, m * (x * x + y * y) / 12


def cylinder_inertia(m: float, r: float, h: float) -> tuple[float, float, float]:
    """Principal moments of a solid cylinder along z."""
    side = m * (3 * r * r + h * h) / 12
    return side, side, m * r * r / 2


def apple() -> None:
    """An apple, with its dimples, a stalk and a leaf."""
    a, _, c = APPLE
    t = np.linspace(-pi / 2, pi / 2, 33)
    radius = a * np.cos(t) ** 0.8
    height = c * (np.sin(t) - 0.34 * np.exp(-((radius / 0.011) ** 2)) * np.sign(t)) + 0.0016 * np.cos(2 * t)
    body = turned(np.stack([np.abs(radius), height], axis=1), sides=40)
    stalk = turned([[0, 0.020], [0.002, 0.020], [0.0022, 0.046], [0, 0.046]], sides=8).moved((0.001, 0, 0))
    s, w = np.meshgrid(np.linspace(0, 1, 9), np.linspace(-1, 1, 5), indexing="ij")
    leaf = np.stack([0.028 * s, 0.009 * w * np.sin(pi * s), 0.036 + 0.014 * s - 0.012 * s * s + 0.002 * w * w], -1)
    item("apple", 0.18, ellipsoid_inertia(0.18, *APPLE), hull("apple", blunt(APPLE, 2.0, 8, 10)[..., [1, 2, 0]]), SKIN,
         [(body, RED), (stalk, STALK), (grid(leaf), LEAF)])  # fmt: skip


def cup() -> None:
    """A cup with a handle to look at; its walls are one solid to the touch."""
    r, h = CUP_RADIUS, CUP_HEIGHT / 2
    wall = [
        [0, -h],
        [0.030, -h],
        [r - 0.002, -h + 0.012],
        [r, h],
        [r - 0.003, h],
        [r - 0.005, -h + 0.014],
        [0, -h + 0.006],
    ]
    body = turned(rounded(wall, 0.004), sides=40)
    bend = np.linspace(-0.45 * pi, 0.45 * pi, 15)
    section = 2 * pi * np.arange(10) / 10
    b, s = np.meshgrid(bend, section, indexing="ij")
    reach = 0.026 + 0.004 * np.cos(s)
    loop = np.stack([r - 0.006 + 0.8 * reach * np.cos(b), 0.0055 * np.sin(s), reach * np.sin(b)], axis=-1)
    band = turned([[r + 0.0002, 0.010], [r + 0.0002, 0.022]], sides=40)
    ring = 2 * pi * np.arange(12) / 12
    edge = r * cos(pi / 12) ** -0.5 * np.stack([np.cos(ring), np.sin(ring)], axis=1)
    prism = np.stack([np.column_stack([k * edge, np.full(12, z)]) for k, z in ((0, -h), (1, -h), (1, h), (0, h))])
    item("cup", 0.22, cylinder_inertia(0.22, r, 2 * h), hull("cup", prism), CHINA,
         [(body, TEAL), (grid(loop, close_columns=True), TEAL), (band, CREAM)])  # fmt: skip


def cube() -> None:
    """A toy block with a round inlay on every side."""
    e = CUBE / 2
    heights = [-e, -e + 0.001, -e + 0.004, e - 0.004, e - 0.001, e]
    shrink = [0.004, 0.0012, 0.0, 0.0, 0.0012, 0.004]
    body = lofted([superellipse(e - s, e - s, 16.0) for s in shrink], [(0, 0, z) for z in heights])
    disk = turned([[0, e], [0.018, e], [0.018, e + 0.0006], [0, e + 0.0006]], sides=32)
    turn = {"x": np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]), "y": np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])}
    disks = [disk] + [disk.moved(rotation=turn[axis] * sign) for axis in "xy" for sign in (1, -1)]
    item("cube", 0.25, box_inertia(0.25, CUBE, CUBE, CUBE), box((CUBE,) * 3), BEECH,
         [(body, AMBER), (merge(*(d.outward() for d in disks)), CREAM)])  # fmt: skip


def bundle(radii: tuple[float, float, float], power: float, wrinkles: float = 0.0, rows: int = 24) -> np.ndarray:
    """Points (rows, 40, 3) of a blunt ellipsoid along x, with folds that wind around it."""
    a, b, c = radii
    t = np.linspace(0, pi, rows)
    angle = 2 * pi * np.arange(40) / 40
    p, s = np.meshgrid(t, angle, indexing="ij")
    wide = np.sin(p) ** (2 / power)
    fold = 1 + wrinkles * np.sin(3 * s + 4 * p) * np.sin(p)
    x = -a * np.sign(np.cos(p)) * np.abs(np.cos(p)) ** (2 / power)
    return np.stack([x, b * wide * fold * np.cos(s), c * wide * fold * np.sin(s)], axis=-1)


def bands(points: np.ndarray, rows: list[tuple[int, int]]) -> Mesh:
    """Stripes: rows of a bundle, drawn a little larger."""
    grown = points * [1.0, 1.015, 1.015]
    return merge(*(grid(grown[low : high + 1], close_columns=True) for low, high in rows))


def tshirt() -> None:
    """A T-shirt, bundled; a stripe runs around it."""
    body = bundle(SHIRT, 2.5, 0.05)
    item("tshirt", 0.18, ellipsoid_inertia(0.18, *SHIRT), hull("tshirt", blunt(SHIRT, 2.5, 8, 10)), COTTON,
         [(grid(body, close_columns=True).outward(), CORAL), (bands(body, [(9, 11), (13, 14)]), CREAM)])  # fmt: skip


def towel() -> None:
    """A towel, rolled; two borders at each end."""
    body = bundle(TOWEL, 3.0, 0.03)
    rings = [(4, 5), (6, 7), (16, 17), (18, 19)]
    item("towel", 0.25, ellipsoid_inertia(0.25, *TOWEL), hull("towel", blunt(TOWEL, 3.0, 8, 10)), COTTON,
         [(grid(body, close_columns=True).outward(), MINT), (bands(body, rings), CREAM)])  # fmt: skip


def sock() -> None:
    """A pair of socks, bundled: striped."""
    # On the narrower facets of ten sides some went on rolling through the basket.
    body = bundle(SOCK, 2.2, 0.04)
    stripes = [(k, k + 1) for k in (4, 7, 10, 13, 16, 19)]
    item("sock", 0.06, ellipsoid_inertia(0.06, *SOCK), hull("sock", blunt(SOCK, 2.2, 8, 8)), COTTON,
         [(grid(body, close_columns=True).outward(), NAVY), (bands(body, stripes), CREAM)])  # fmt: skip


def main() -> None:
    """Write all of them."""
    for make in (apple, cup, cube, tshirt, towel, sock):
        make()


if __name__ == "__main__":
    main()
