"""Triangle meshes from profiles: turned, lofted, cut; written as OBJ with normals that keep sharp edges sharp."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

Profile = Sequence[Sequence[float]] | np.ndarray
"""Points (n, 2)."""

CREASE = np.cos(np.deg2rad(38.0))
"""Faces that meet at more than 38° keep their edge; others shade smoothly."""


@dataclass(frozen=True)
class Mesh:
    """Vertices (n, 3) in metres and triangles (m, 3), seen from outside counterclockwise."""

    vertices: np.ndarray
    triangles: np.ndarray

    def moved(self, offset: Sequence[float] = (0, 0, 0), rotation: np.ndarray | None = None) -> Mesh:
        """The same, first turned, then shifted."""
        turned = self.vertices if rotation is None else self.vertices @ rotation.T
        return Mesh(turned + np.asarray(offset, dtype=float), self.triangles)

    def volume(self) -> float:
        """Signed volume [m³]; negative: inside out."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)

    def outward(self) -> Mesh:
        """Turned right side out."""
        return self if self.volume() >= 0 else Mesh(self.vertices, self.triangles[:, ::-1])


def merge(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    offsets = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    return Mesh(
        np.vstack([m.vertices for m in meshes]),
        np.vstack([m.triangles + o for m, o in zip(meshes, offsets, strict=True)]),
    )


def grid(points: np.ndarray, close_rows: bool = False, close_columns: bool = False) -> Mesh:
    """A sheet through a grid of points (rows, columns, 3), seamless where closed."""
    rows, columns = points.shape[:2]
    i = np.arange(rows if close_rows else rows - 1)
    j = np.arange(columns if close_columns else columns - 1)
    a, b = np.meshgrid(i, j, indexing="ij")
    a1, b1 = (a + 1) % rows, (b + 1) % columns
    corners = [(r * columns + c).ravel() for r, c in ((a, b), (a1, b), (a1, b1), (a, b1))]
    p, q, r, s = corners
    triangles = np.vstack([np.stack([p, q, r], axis=1), np.stack([p, r, s], axis=1)])
    return Mesh(points.reshape(-1, 3), triangles)


def turned(profile: Profile, axis: str = "z", sides: int = 48, close: bool = False) -> Mesh:
    """A surface of revolution. `profile` has (radius, height on the axis); closed: a ring, else a solid with ends."""
    line = np.asarray(profile, dtype=float)
    angle = 2 * np.pi * np.arange(sides) / sides
    r, h = line[:, :1], np.repeat(line[:, 1:], sides, axis=1)
    u, v = r * np.cos(angle), r * np.sin(angle)
    order = {"z": (u, v, h), "y": (v, h, u), "x": (h, u, v)}[axis]
    return grid(np.stack(order, axis=-1), close_rows=close, close_columns=True).outward()


def rounded(profile: Profile, fillet: float, steps: int = 4) -> np.ndarray:
    """A profile (n, 2), its inner corners rounded with at most the given radius [m]."""
    p = np.asarray(profile, dtype=float)
    out = [p[0]]
    for before, corner, after in zip(p[:-2], p[1:-1], p[2:], strict=True):
        a, b = before - corner, after - corner
        cut = min(fillet, 0.45 * np.linalg.norm(a), 0.45 * np.linalg.norm(b))
        start, end = corner + a / np.linalg.norm(a) * cut, corner + b / np.linalg.norm(b) * cut
        t = np.linspace(0, 1, steps + 1)[:, None]
        out.extend((1 - t) ** 2 * start + 2 * t * (1 - t) * corner + t**2 * end)
    out.append(p[-1])
    return np.array(out)


def superellipse(a: float, b: float, power: float, sides: int = 48) -> np.ndarray:
    """Outline (sides, 2) of |x/a|^power + |y/b|^power = 1: an ellipse at 2, towards a rectangle above."""
    t = 2 * np.pi * np.arange(sides) / sides
    c, s = np.cos(t), np.sin(t)
    return np.stack([a * np.sign(c) * np.abs(c) ** (2 / power), b * np.sign(s) * np.abs(s) ** (2 / power)], axis=1)


def lofted(outlines: Sequence[np.ndarray], centers: Sequence[Sequence[float]]) -> Mesh:
    """A closed skin along outlines (n, 2) in planes across z, each at its centre (x, y, z); ends are capped."""
    rows = [
        np.column_stack([o + np.asarray(c)[:2], np.full(len(o), c[2])]) for o, c in zip(outlines, centers, strict=True)
    ]
    first, last = (np.broadcast_to(np.asarray(c, dtype=float), rows[0].shape) for c in (centers[0], centers[-1]))
    return grid(np.stack([first, *rows, last]), close_columns=True).outward()


def write_obj(path: Path, mesh: Mesh, digits: int = 5) -> None:
    """Write an OBJ with a normal a corner: the mean over the faces there that are nearly in one plane with this one."""
    v, t = mesh.vertices, mesh.triangles
    area = np.cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])
    size = np.linalg.norm(area, axis=1)
    keep = size > 1e-12
    t, area, size = t[keep], area[keep], size[keep]
    unit = area / size[:, None]
    # Vertices that coincide count as one, or a seam would show.
    _, same = np.unique(np.round(v, 6), axis=0, return_inverse=True)
    around: dict[int, list[int]] = {}
    for face, corners in enumerate(same.ravel()[t]):
        for corner in set(corners.tolist()):
            around.setdefault(corner, []).append(face)
    normals: dict[tuple[float, ...], int] = {}
    lines = [f"v {x:.{digits}f} {y:.{digits}f} {z:.{digits}f}\n" for x, y, z in v]
    faces = []
    for face, corners in enumerate(t):
        words = []
        for corner in corners:
            near = np.array(around[int(same.ravel()[corner])])
            near = near[unit[near] @ unit[face] > CREASE]
            total = area[near].sum(axis=0)
            normal = tuple((np.round(total / np.linalg.norm(total), 3) + 0.0).tolist())
            words.append(f"{corner + 1}//{normals.setdefault(normal, len(normals) + 1)}")
        faces.append("f " + " ".join(words) + "\n")
    lines += [f"vn {x:g} {y:g} {z:g}\n" for x, y, z in normals]
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    temporary.write_text("".join(lines + faces))
    temporary.replace(path)
