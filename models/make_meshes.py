"""Make the meshes of the washing machines. Run `python -m models.make_meshes`.

Frames as in make_world.py: origin at the middle of the door (the case: on the floor), the front looks along -y.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from models.make_world import (
    DEPTH,
    DOOR_HEIGHT,
    DRUM_DEPTH,
    DRUM_RADIUS,
    HALF_WIDTH,
    HEIGHT,
    LIP,
)
from models.mesh import Mesh, grid, merge, rounded, superellipse, turned, write_obj

HERE = Path(__file__).parent / "world" / "meshes"
SIDES = 64


def case(opening: float) -> Mesh:
    """The shell: an open front with a round hole, edges rounded; origin on the floor."""
    outline = superellipse(HALF_WIDTH, HEIGHT / 2, 14.0, SIDES)
    middle = HEIGHT / 2 - DOOR_HEIGHT
    angle = np.arctan2(outline[:, 1] + middle, outline[:, 0])
    hole = (opening + 0.035) * np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def row(shape: np.ndarray, y: float) -> np.ndarray:
        return np.stack([shape[:, 0], np.full(SIDES, y), shape[:, 1] + DOOR_HEIGHT], axis=1)

    def outer(shrink: float, y: float) -> np.ndarray:
        scaled = outline * (1 - shrink / np.array([HALF_WIDTH, HEIGHT / 2]))
        return row(scaled + [0, middle], y)

    rows = [row(hole, 0.03), row(hole, 0.0), outer(0.012, 0.0), outer(0.004, 0.003), outer(0.0, 0.012)]
    rows += [outer(0.0, DEPTH - 0.012), outer(0.004, DEPTH - 0.003), outer(0.012, DEPTH), outer(0.30, DEPTH)]
    return grid(np.stack(rows), close_columns=True).outward()


def drum() -> Mesh:
    """The drum as a thick-walled pot, open towards the door."""
    r, d, t = DRUM_RADIUS, DRUM_DEPTH, 0.012
    inside = rounded([[r, 0.03], [r, d], [0.09, d], [0.07, d - 0.025], [0.0, d - 0.03]], 0.03)
    outside = [[0.0, d + t], [r + t, d + t], [r + t, 0.03]]
    return turned(np.vstack([inside, outside]), "y", SIDES, close=True)


def drum_holes() -> Mesh:
    """Rows of dark dots on the drum's wall: what makes a drum a drum."""
    dots = []
    for i, y in enumerate(np.linspace(0.07, DRUM_DEPTH - 0.05, 7)):
        for k in range(40):
            angle = 2 * np.pi * (k + 0.5 * (i % 2)) / 40
            turn = 2 * np.pi * np.arange(6) / 6
            wide = angle + 0.0042 * np.cos(turn) / DRUM_RADIUS
            r = DRUM_RADIUS - 0.0015
            edge = np.stack([r * np.cos(wide), y + 0.0042 * np.sin(turn), r * np.sin(wide)], axis=1)
            dots.append(Mesh(edge, np.array([[0, j + 1, j] for j in range(1, 5)])))
    return merge(*dots)


def drum_ribs() -> Mesh:
    """Three paddles that lift the laundry; seen only, the rigid contact wall is the drum's."""
    ribs = []
    for k in range(3):
        angle = np.pi / 2 + 2 * np.pi * k / 3
        across = np.linspace(-1, 1, 13)
        along = np.linspace(0.05, DRUM_DEPTH - 0.02, 9)
        fade = np.sin(np.linspace(0.15, np.pi - 0.15, 9))[:, None] ** 0.4
        radius = DRUM_RADIUS - 0.002 - 0.024 * fade * np.cos(across * np.pi / 2) ** 1.5
        phi = angle + across * 0.032 / DRUM_RADIUS
        points = np.stack([radius * np.cos(phi), np.repeat(along[:, None], 13, axis=1), radius * np.sin(phi)], axis=-1)
        ribs.append(grid(points))
    return merge(*ribs)


def ring(opening: float) -> Mesh:
    """The polished door ring, its lip standing out in front."""
    a, b = opening + 0.002, opening + 0.045
    profile = rounded([[a, 0.02], [a, -LIP], [b - 0.006, -LIP], [b, -LIP + 0.01], [b, 0.02]], 0.012)
    return turned(profile, "y", SIDES, close=True)


def gasket(opening: float) -> Mesh:
    """The rubber bellows between door ring and drum."""
    line = [[opening + 0.002, 0.012], [opening, 0.018], [opening + 0.018, 0.024], [opening + 0.006, 0.032]]
    line += [[DRUM_RADIUS + 0.005, 0.034], [DRUM_RADIUS + 0.005, 0.045], [opening + 0.03, 0.028]]
    return turned(rounded(line, 0.004), "y", SIDES, close=True)


def door(opening: float) -> Mesh:
    """The door's frame: a ring around the glass, with a grip."""
    r = opening + 0.015
    profile = rounded([[r - 0.05, 0.022], [r - 0.05, -0.02], [r - 0.008, -0.025], [r, -0.012], [r, 0.022]], 0.012)
    return turned(profile, "y", SIDES, close=True)


def glass(opening: float) -> Mesh:
    """The bowl of the door, bulging into the drum when closed."""
    r = opening - 0.033
    bowl = [[0.0, 0.065], [0.5 * r, 0.06], [0.8 * r, 0.045], [r, 0.012], [r, -0.012], [0.5 * r, 0.0], [0.0, 0.004]]
    return turned(rounded(bowl, 0.02), "y", SIDES)


def main() -> None:
    """Write all of them."""
    for name, opening in (("washing_machine", 0.17), ("washing_machine_narrow", 0.15)):
        for part in (case, ring, gasket, door, glass):
            write_obj(HERE / f"{name}_{part.__name__}.obj", part(opening))
    for drawn in (drum, drum_holes, drum_ribs):
        write_obj(HERE / f"{drawn.__name__}.obj", drawn())


if __name__ == "__main__":
    main()
