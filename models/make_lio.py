"""Make the shells of the Lio. Run `python -m models.make_lio`; lio.urdf names what is written here.

Each mesh is in the frame of its link: z along the arm, joints 2, 3 and 5 turn about y. White shells taper between round
blue joint housings; the base is a low, rounded platform.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from models.mesh import Mesh, grid, lofted, merge, rounded, superellipse, turned, write_obj

HERE = Path(__file__).parent / "lio" / "meshes"


def housing(radius: float, width: float) -> Mesh:
    """A drum across the arm, its rims rounded: the housing of a joint that turns about y."""
    h = width / 2
    return turned(rounded([[0, -h], [radius, -h], [radius, h], [0, h]], 0.014), "y", 44)


def cap(radius: float, width: float) -> Mesh:
    """The thin discs on both sides of a housing."""
    low, high = width / 2, width / 2 + 0.004
    disks = [[[0, s * low], [radius, s * low], [radius, s * high], [0, s * high]] for s in (-1, 1)]
    return merge(*(turned(rounded(d, 0.003), "y", 36) for d in disks))


def limb(stations: list[tuple[float, float, float]], power: float = 2.6) -> Mesh:
    """A shell along z through (z, half width in x, half width in y)."""
    return lofted([superellipse(a, b, power, 44) for _, a, b in stations], [(0, 0, z) for z, _, _ in stations])


def collar(radius: float, low: float, high: float) -> Mesh:
    """A ring around z between two heights."""
    return turned(rounded([[0, low], [radius, low], [radius, high], [0, high]], 0.006), sides=44)


def platform(low: float, high: float, shrink: float, fillet: float) -> Mesh:
    """A slice of the base's body, x -0.70 to 0.15 and y ±0.29."""
    a, b = 0.425 - shrink, 0.29 - shrink
    levels = [(fillet, low), (0.3 * fillet, low + 0.3 * fillet), (0.0, low + fillet)]
    levels += [(0.0, high - fillet), (0.3 * fillet, high - 0.3 * fillet), (fillet, high)]
    return lofted([superellipse(a - s, b - s, 5.5, 72) for s, _ in levels], [(-0.275, 0, z) for _, z in levels])


def wheels() -> Mesh:
    """Two driven wheels, 0.148 across, and four castors."""
    big = rounded([[0, -0.02], [0.074, -0.02], [0.074, 0.02], [0, 0.02]], 0.012)
    small = rounded([[0, -0.012], [0.035, -0.012], [0.035, 0.012], [0, 0.012]], 0.008)
    driven = [turned(big, "y", 36).moved((-0.275, s * 0.25, 0.074)) for s in (-1, 1)]
    castors = [turned(small, "y", 24).moved((x, s * 0.20, 0.035)) for x in (-0.62, 0.07) for s in (-1, 1)]
    return merge(*driven, *castors)


def column() -> Mesh:
    """From the platform to joint 1, at 0.478."""
    return limb(
        [(0.30, 0.135, 0.135), (0.32, 0.128, 0.128), (0.36, 0.100, 0.100), (0.44, 0.086, 0.086), (0.470, 0.082, 0.082)],
        2.0,
    )


def finger(side: float) -> Mesh:
    """A finger from its pivot to its tip, 0.149 long; its inner face is the pad's, turned by 0.15 rad."""
    line = [(0.000, 0.002, 0.013, 0.012), (0.035, 0.006, 0.013, 0.012), (0.075, 0.000, 0.013, 0.0105)]
    line += [(0.100, -0.0118, 0.014, 0.0075), (0.125, -0.0158, 0.0145, 0.0072), (0.146, -0.0190, 0.013, 0.0060)]
    return lofted(
        [superellipse(a, b, 3.5, 28) for _, _, a, b in line], [(0, side * (y + 0.001), z) for z, y, _, _ in line]
    )


def pad(side: float) -> Mesh:
    """The rubber of a finger, where the pad's contact box is."""
    outline = superellipse(0.015, 0.03, 8.0, 28)
    low, high = (np.column_stack([outline[:, 0], np.full(28, y), outline[:, 1]]) for y in (-0.009, -0.001))
    block = grid(
        np.stack([np.full_like(low, [0, -0.009, 0]), low, high, np.full_like(low, [0, -0.001, 0])]), close_columns=True
    )
    c, s = np.cos(0.15), np.sin(0.15)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    placed = block.moved((0, -0.0166, 0.1183), turn)
    return Mesh(placed.vertices * [1, side, 1], placed.triangles).outward()


def pad_hull() -> Mesh:
    """The pad's box, to touch: as a hull it has two tetrahedra a face, as a box five, each a contact point at least.

    A third fewer contact points hold an item as well, and a step with an item in the hand takes a sixth less time.
    """
    corners = np.array([0.03, 0.018, 0.06]) / 2 * [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return Mesh(corners, ConvexHull(corners).simplices).outward()


def main() -> None:
    """Write all shells."""
    shells = {
        "base_body": platform(0.075, 0.30, 0.0, 0.03),
        "base_skirt": platform(0.045, 0.085, 0.015, 0.01),
        "base_stripe": platform(0.205, 0.222, -0.0015, 0.002),
        "base_deck": platform(0.296, 0.312, 0.06, 0.012),
        "base_wheels": wheels(),
        "base_column": column(),
        "link1_shell": limb([(0.004, 0.080, 0.080), (0.03, 0.078, 0.078), (0.08, 0.072, 0.070), (0.15, 0.060, 0.056)]),
        "link1_joint": housing(0.068, 0.126),
        "link1_cap": cap(0.050, 0.126),
        "link2_shell": limb(
            [(0.02, 0.054, 0.05), (0.07, 0.06, 0.056), (0.15, 0.057, 0.053), (0.23, 0.05, 0.048), (0.28, 0.046, 0.044)]
        ),
        "link2_joint": housing(0.060, 0.112),
        "link2_cap": cap(0.044, 0.112),
        "link3_shell": limb([(0.02, 0.046, 0.044), (0.06, 0.051, 0.049), (0.12, 0.049, 0.049), (0.152, 0.047, 0.047)]),
        "link3_ring": collar(0.0485, 0.152, 0.166),
        "link4_shell": limb([(0.004, 0.047, 0.047), (0.05, 0.045, 0.044), (0.10, 0.041, 0.039), (0.135, 0.038, 0.036)]),
        "link4_joint": housing(0.050, 0.092),
        "link4_cap": cap(0.036, 0.092),
        "link5_shell": limb([(0.02, 0.038, 0.036), (0.05, 0.042, 0.041), (0.09, 0.042, 0.042), (0.118, 0.041, 0.041)]),
        "link5_ring": collar(0.0425, 0.117, 0.129),
        "link6_flange": collar(0.040, 0.002, 0.042),
        "gripper_body": limb(
            [(0, 0.036, 0.04), (0.02, 0.039, 0.05), (0.07, 0.038, 0.054), (0.105, 0.03, 0.052), (0.118, 0.022, 0.046)],
            3.6,
        ),
        "gripper_band": limb([(0.030, 0.0400, 0.0522), (0.040, 0.0404, 0.0536)], 3.6),
        "finger_left": finger(1.0),
        "finger_right": finger(-1.0),
        "pad_left": pad(1.0),
        "pad_right": pad(-1.0),
        "pad_hull": pad_hull(),
    }  # fmt: skip
    for name, mesh in shells.items():
        write_obj(HERE / f"{name}.obj", mesh)


if __name__ == "__main__":
    main()
