"""Three kinds of laundry: a sock, a T-shirt gathered as one picks it up, a towel rolled lengthwise.

Each is a tube (or three) of a few cells for the solver and the same tube in fine rings for the eye: folds run along the
axis, hems are thicker, cuffs, bands and stripes are colours. Sizes and weights are those of real garments: [m], [kg].
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from canal.errors import InputError
from diagrams.deformable.tet_mesh import EmbeddedSurface, TetBuilder, TetMesh, Tube, embed

Rgb = tuple[float, float, float]
"""Red, green and blue in [0, 1]."""


@dataclass(frozen=True)
class DeformableShape:
    """One garment: the solid, the surface drawn for it, and its mass in [kg]. Lies around the origin, z up."""

    kind: str
    """Key of `DEFORMABLE_KINDS`."""
    mesh: TetMesh
    """The solid that is simulated, [m]."""
    surface: EmbeddedSurface
    """What is drawn, embedded in the solid."""
    mass: float
    """[kg]"""

    def density(self) -> float:
        """Mass density in [kg/m³]: of cloth with the air between its folds."""
        return self.mass / float(self.mesh.volumes().sum())


@dataclass(frozen=True)
class _Skin:
    """How a tube is drawn: rings × sectors, folds as relative depth, colour by (s, angle), what its ends show."""

    tube: Tube
    rings: int
    sectors: int
    fold: Callable[[np.ndarray, np.ndarray], np.ndarray]
    color: Callable[[np.ndarray, np.ndarray], np.ndarray]
    end: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """Colour of both ends by (radius, angle), radius 0 at the axis and 1 at the rim."""


def make_shape(kind: str, color: Rgb | None = None, *, segments: int = 0) -> DeformableShape:
    """Make a garment of the given kind: `sock`, `tshirt` or `towel`, in its own colour or the given one.

    `segments` of the tube, twelve tetrahedra each, are as many as each kind needs unless given (a study of elements).

    Raises:
        InputError: a kind that does not exist.

    Args:
        kind: `sock`, `tshirt` or `towel`.
        color: None for its own.
        segments: of the tube; None for the kind's own.
    """
    if kind not in DEFORMABLE_KINDS:
        raise InputError(f"deformable item kind {kind!r} does not exist; use one of {', '.join(DEFORMABLE_KINDS)}")
    return DEFORMABLE_KINDS[kind](color, segments)


def _finish(kind: str, mesh: TetMesh, skins: Sequence[_Skin], mass: float) -> DeformableShape:
    """Centre the garment on its centre of mass, embed the skins."""
    volumes = mesh.volumes()
    centers = mesh.vertices[mesh.tetrahedra].mean(axis=1)
    center = volumes @ centers / volumes.sum()
    parts = [_draw(skin) for skin in skins]
    points = np.concatenate([p for p, _, _ in parts])
    offsets = np.cumsum([0] + [len(p) for p, _, _ in parts[:-1]])
    triangles = np.concatenate([t + o for (_, t, _), o in zip(parts, offsets, strict=True)])
    corners, weights = embed(mesh, points)
    surface = EmbeddedSurface(corners, weights, triangles, np.concatenate([c for _, _, c in parts]))
    return DeformableShape(kind, TetMesh(mesh.vertices - center, mesh.tetrahedra), surface, mass)


def _draw(skin: _Skin) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rings along the tube, inner rings over both ends: points (n, 3), triangles (m, 3), colours (n, 3)."""
    m = skin.sectors
    inner = np.array(_END_RADII)
    s = np.concatenate([np.zeros(len(inner)), np.linspace(0.0, 1.0, skin.rings), np.ones(len(inner))])
    radius = np.concatenate([inner, np.ones(skin.rings), inner[::-1]])
    sunk = _END_DEPTH * (1.0 - radius) * np.where(s < 0.5, 1.0, -1.0)  # the ends are a little hollow
    grid, angle = np.meshgrid(s, np.arange(m) * 2.0 * np.pi / m, indexing="ij")
    depth = skin.fold(grid, angle) * radius[:, None]
    points = skin.tube.at(grid + sunk[:, None], depth * np.cos(angle), depth * np.sin(angle))
    cap = np.broadcast_to(radius[:, None], grid.shape)
    colors = np.where((cap < 1.0)[..., None], skin.end(cap, angle), skin.color(grid, angle))
    middles = skin.tube.at(np.array([_END_DEPTH, 1.0 - _END_DEPTH]), np.zeros(2), np.zeros(2))
    dots = skin.end(np.zeros(2), np.zeros(2))
    n = len(s)
    ring, sector = (a.ravel() for a in np.meshgrid(np.arange(n - 1), np.arange(m), indexing="ij"))
    a, b = ring * m + sector, ring * m + (sector + 1) % m
    j = np.arange(m)
    first, last = n * m, n * m + 1
    triangles = [
        np.stack([a, b, a + m], axis=1),
        np.stack([b, b + m, a + m], axis=1),
        np.stack([np.full(m, first), (j + 1) % m, j], axis=1),
        np.stack([np.full(m, last), (n - 1) * m + j, (n - 1) * m + (j + 1) % m], axis=1),
    ]
    return (
        np.vstack([points.reshape(-1, 3), middles]),
        np.concatenate(triangles),
        np.vstack([colors.reshape(-1, 3), dots]),
    )


_END_RADII = (0.28, 0.52, 0.76)
_END_DEPTH = 0.03  # of the axis


def _creases(s: np.ndarray, angle: np.ndarray, seed: int) -> np.ndarray:
    """Wrinkles of cloth that lay in a heap: a few slanted waves, their phases from `seed`. About -1 to 1."""
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, 4)
    waves = ((3.0, 17.0, 0.45), (-5.0, 23.0, 0.30), (2.0, -31.0, 0.25), (7.0, 8.0, 0.25))
    total = np.zeros(np.broadcast(s, angle).shape)
    for (around, along, share), start in zip(waves, phase, strict=True):
        total += share * np.sin(around * angle + along * s + start)
    return total


def _plain(color: Rgb) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    return lambda radius, angle: np.broadcast_to(np.array(color), (*radius.shape, 3))


def _bands(s: np.ndarray, base: Rgb, bands: Sequence[tuple[float, float, Rgb]]) -> np.ndarray:
    """Colour by s: `base`, and (from, to, colour) on top. Shape (*s.shape, 3)."""
    colors = np.broadcast_to(np.array(base), (*s.shape, 3)).copy()
    for low, high, color in bands:
        colors[(s >= low) & (s <= high)] = color
    return colors


def _shade(colors: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Darken the valleys of the folds, as light would."""
    return np.clip(colors * (0.55 + 0.45 * depth / depth.max())[..., None], 0.0, 1.0)


def _mix(color: Rgb, other: Rgb, share: float) -> Rgb:
    r, g, b = (float((1.0 - share) * x + share * y) for x, y in zip(color, other, strict=True))
    return r, g, b


def _sock(color: Rgb | None, segments: int) -> DeformableShape:
    base = color or (0.74, 0.05, 0.10)
    white: Rgb = (0.95, 0.94, 0.90)
    tube = Tube.bent(
        np.zeros(3),
        0.20,
        lambda s: 0.95 / (1.0 + np.exp(-(s - 0.52) * 18.0)),
        lambda s: 0.027 + 0.004 * np.exp(-(((s - 0.52) / 0.10) ** 2)) - 0.006 * np.clip(s - 0.85, 0, 1) / 0.15,
        lambda s: 0.022 - 0.004 * s,
    )

    def fold(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        ribs = 0.05 * np.cos(9.0 * angle) * (s < 0.24)
        wrinkles = 0.05 * np.sin(37.0 * s + 2.0 * np.sin(angle)) * np.exp(-(((s - 0.5) / 0.16) ** 2))
        toe = np.sqrt(np.clip(1.0 - (np.clip(s - 0.86, 0.0, 1.0) / 0.16) ** 2, 0.05, 1.0))
        return (0.95 + ribs + wrinkles + 0.03 * _creases(s, angle, 1)) * toe

    def paint(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        stripes = [(0.25 + 0.085 * i, 0.29 + 0.085 * i, white) for i in range(3)]
        colors = _bands(s, base, [(0.0, 0.2, white), *stripes, (0.86, 1.0, white)])
        heel = (np.abs(s - 0.53) < 0.075) & (np.cos(angle) < -0.2)
        colors[heel] = white
        return _shade(colors, fold(s, angle))

    builder = TetBuilder()
    builder.add_tube(tube, segments or 5)
    return _finish("sock", builder.mesh(), [_Skin(tube, 28, 18, fold, paint, _plain(white))], mass=0.06)


def _tshirt(color: Rgb | None, segments: int) -> DeformableShape:
    base = color or (0.05, 0.26, 0.60)
    dark, light = _mix(base, (0.0, 0.0, 0.0), 0.65), _mix(base, (1.0, 1.0, 1.0), 0.75)
    body = Tube.bent(
        np.zeros(3),
        0.22,
        # Collar towards the robot: it enters the door collar down, and its sleeves do not rest on the fingers.
        lambda s: np.pi + 0.3 * np.sin(2.0 * np.pi * s),
        lambda s: 0.043 - 0.008 * np.sin(np.pi * s),
        lambda s: 0.033 - 0.004 * s,
    )
    builder = TetBuilder()
    segments = segments or 5
    sections = builder.add_tube(body, segments)
    sleeves = []
    for sign, side in ((1, 0), (-1, 2)):
        root = np.arctan2(*(body.axis[-8] - body.axis[-16])[[1, 0]])
        # Away from where the hand takes it: a sleeve that lies back along the body hooks a finger on release.
        sleeve = Tube.bent(
            body.at(np.array(1.0 - 1.5 / segments), np.array(0.0), np.array(0.0)),
            0.095,
            lambda s, sign=sign, root=root: np.full_like(s, root + sign * 1.3),  # type: ignore[misc]
            lambda s: 0.025 + 0.002 * s,
            lambda s: 0.027 - 0.003 * s,
        )
        builder.add_branch(sections[-3], sections[-2], side, sleeve, (0.76, 1.0))
        sleeves.append(sleeve)

    def fold(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        flare = 0.09 + 0.09 * np.exp(-s / 0.2)
        gathers = np.cos(7.0 * angle + 2.5 * np.sin(5.0 * s)) + 0.5 * np.cos(4.0 * angle - 9.0 * s + 1.0)
        collar = np.where(s > 0.9, 0.75 - 0.12 * (s - 0.9) / 0.1, 0.93)
        return collar + (flare * gathers + 0.05 * _creases(s, angle, 2)) * np.where(s > 0.9, 0.25, 1.0)

    def paint(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        chest = [(0.52, 0.58, light), (0.61, 0.64, light)]
        return _shade(_bands(s, base, [*chest, (0.0, 0.04, dark), (0.95, 1.0, light)]), fold(s, angle))

    def sleeve_fold(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        return 0.92 + 0.07 * np.cos(5.0 * angle + 3.0 * s) + 0.05 * _creases(s, angle, 3)

    def sleeve_paint(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        return _shade(_bands(s, base, [(0.9, 1.0, light)]), sleeve_fold(s, angle))

    skins = [_Skin(body, 26, 24, fold, paint, _plain(dark))]
    skins += [_Skin(tube, 9, 16, sleeve_fold, sleeve_paint, _plain(dark)) for tube in sleeves]
    return _finish("tshirt", builder.mesh(), skins, mass=0.17)


def _towel(color: Rgb | None, segments: int) -> DeformableShape:
    base = color or (0.88, 0.55, 0.10)
    stripe, fringe = _mix(base, (0.35, 0.10, 0.05), 0.75), _mix(base, (1.0, 1.0, 1.0), 0.7)
    tube = Tube.bent(
        np.zeros(3),
        0.22,
        lambda s: 0.15 * np.sin(2.0 * np.pi * s),
        lambda s: 0.046 - 0.006 * np.sin(np.pi * s) ** 2,
        lambda s: 0.039 - 0.004 * np.sin(np.pi * s) ** 2,
    )

    def fold(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        turn = (angle - 0.7 + 0.25 * np.sin(4.0 * s)) % (2.0 * np.pi)
        seam = 0.16 * (turn / (2.0 * np.pi))  # a roll: the radius grows by one layer a turn, and steps at the free edge
        creases = 0.06 * _creases(s, angle, 4)
        return 0.82 + seam + creases

    def paint(s: np.ndarray, angle: np.ndarray) -> np.ndarray:
        bands = [(0.0, 0.03, fringe), (0.97, 1.0, fringe)]
        bands += [(x, x + 0.05, stripe) for x in (0.10, 0.18, 0.77, 0.85)]
        return _shade(_bands(s, base, bands), fold(s, angle))

    def layers(radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
        turn = (3.0 * radius + angle / (2.0 * np.pi)) % 1.0  # the roll, seen from its end
        return np.where((turn < 0.35)[..., None], np.array(_mix(base, (0.0, 0.0, 0.0), 0.6)), np.array(base))

    builder = TetBuilder()
    builder.add_tube(tube, segments or 5)
    return _finish("towel", builder.mesh(), [_Skin(tube, 30, 24, fold, paint, layers)], mass=0.26)


DEFORMABLE_KINDS: dict[str, Callable[[Rgb | None, int], DeformableShape]] = {
    "sock": _sock,
    "tshirt": _tshirt,
    "towel": _towel,
}
"""What makes a garment of each kind: from its colour (None: its own) and a number of segments (0: its own)."""
