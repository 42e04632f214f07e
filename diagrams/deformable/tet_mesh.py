"""Tetrahedral volumes and the finer surfaces embedded in them: what the solver moves and what the eye sees.

A garment is simulated as a coarse solid (60 to 300 tetrahedra, see `laundry`) and drawn as a surface of
a thousand triangles, each vertex of which hangs on one tetrahedron by barycentric coordinates: x = Σ_i b_i x_i.
Linear elements deform affinely, so the drawn surface follows the solid exactly. Pure numpy, no Drake.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

_FACES_OF_TETRAHEDRON = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))
"""Corners of the face opposite each corner, counter-clockwise from outside for a positive volume."""

_SECTION = np.array([(0, 0), (1, -1), (1, 1), (-1, 1), (-1, -1)]) * 0.886
"""Axis node and corners of a coarse section in half axes: the rectangle with the area of the ellipse, √π/2."""

_BLUNT = 0.6
"""The same of the sections at both ends, relative to the others: a right-angled corner that falls on a floor has little
area to stop it with, and sinks in by 10 mm where a blunt one sinks in by 6."""


@dataclass(frozen=True)
class TetMesh:
    """A solid of tetrahedra.

    Attributes
    ----------
    vertices : array, shape (N, 3)
        Positions in [m].
    tetrahedra : array, shape (M, 4)
        Indices of the corners, ordered so that every volume is positive.
    """

    vertices: np.ndarray
    """Positions of the nodes, [m]. Shape (N, 3)."""
    tetrahedra: np.ndarray
    """Indices of the corners. Shape (T, 4)."""

    def volumes(self) -> np.ndarray:
        """Signed volume of each tetrahedron in [m³], shape (M,)."""
        a, b, c, d = (self.vertices[self.tetrahedra[:, i]] for i in range(4))
        return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0

    def boundary(self) -> np.ndarray:
        """Triangles that belong to one tetrahedron only, outward normals, shape (F, 3)."""
        faces = self.tetrahedra[:, np.array(_FACES_OF_TETRAHEDRON)].reshape(-1, 3)
        _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        return faces[np.sort(first[count == 1])]

    def to_vtk(self) -> str:
        """Legacy ASCII VTK (cell type 10), the text Drake's `InMemoryMesh` reads."""
        points = "\n".join(" ".join(f"{x:.9g}" for x in row) for row in self.vertices)
        cells = "\n".join("4 " + " ".join(str(i) for i in row) for row in self.tetrahedra)
        n, m = len(self.vertices), len(self.tetrahedra)
        return (
            "# vtk DataFile Version 3.0\nlaundry\nASCII\nDATASET UNSTRUCTURED_GRID\n"
            f"POINTS {n} double\n{points}\nCELLS {m} {5 * m}\n{cells}\nCELL_TYPES {m}\n" + "10\n" * m
        )


@dataclass(frozen=True)
class EmbeddedSurface:
    """A fine triangle surface that hangs on the tetrahedra of a `TetMesh`.

    Attributes
    ----------
    corners : array, shape (n, 4)
        For each surface vertex, the four mesh vertices it hangs on.
    weights : array, shape (n, 4)
        Barycentric coordinates; rows sum to 1. A vertex just outside the solid has a negative one.
    triangles : array, shape (m, 3)
        Indices of surface vertices, outward normals.
    colors : array, shape (n, 3)
        Red, green, blue in [0, 1].
    """

    corners: np.ndarray
    """Of each point, the nodes of the tetrahedron that carries it. Shape (M, 4)."""
    weights: np.ndarray
    """Barycentric coordinates of each point there. Shape (M, 4)."""
    triangles: np.ndarray
    """Indices of points. Shape (F, 3)."""
    colors: np.ndarray
    """Of each point: red, green and blue in [0, 1]. Shape (M, 3)."""

    def positions(self, node_positions: np.ndarray) -> np.ndarray:
        """Where the surface is when the nodes are at `node_positions` (N, 3) in [m]. Shape (n, 3)."""
        return np.einsum("nk,nki->ni", self.weights, node_positions[self.corners])


def embed(mesh: TetMesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Barycentric coordinates of `points` (n, 3) in `mesh`: corners (n, 4) and weights (n, 4).

    A point inside the solid gets the tetrahedron that contains it; one outside gets the tetrahedron in which its most
    negative coordinate is least so, and is then extrapolated.

    Args:
        mesh: the solid.
        points: [m]. Shape (n, 3).
    """
    origin = mesh.vertices[mesh.tetrahedra[:, 0]]
    edges = mesh.vertices[mesh.tetrahedra[:, 1:]] - origin[:, None, :]  # (M, 3, 3), rows are edges
    to_weights = np.linalg.inv(edges)
    relative = points[:, None, :] - origin[None, :, :]
    last_three = np.einsum("nmi,mij->nmj", relative, to_weights)
    weights = np.concatenate([1.0 - last_three.sum(axis=2, keepdims=True), last_three], axis=2)
    best = np.argmax(weights.min(axis=2), axis=1)
    return mesh.tetrahedra[best], weights[np.arange(len(points)), best]


@dataclass(frozen=True)
class Tube:
    """A tube around a curved axis in a horizontal plane: the common shape of gathered cloth.

    Attributes:
        axis: points of the axis, uniform in s from 0 to 1, [m]. Shape (K, 3).
        half_width: half axis of the elliptic section sideways, [m]. Shape (K,).
        half_height: likewise upwards. Shape (K,).
    """

    axis: np.ndarray
    half_width: np.ndarray
    half_height: np.ndarray

    @staticmethod
    def bent(
        start: np.ndarray,
        length: float,
        heading: Callable[[np.ndarray], np.ndarray],
        half_width: Callable[[np.ndarray], np.ndarray],
        half_height: Callable[[np.ndarray], np.ndarray],
    ) -> Tube:
        """Integrate a heading [rad] along `length` [m] from `start` (3,); functions of s in [0, 1].

        Args:
            start: of the axis, [m]. Shape (3,).
            length: of the axis, [m].
            heading: direction at s, [rad].
            half_width: at s, [m].
            half_height: at s, [m].
        """
        s = np.linspace(0.0, 1.0, 65)
        angle = heading(s)
        step = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(s)], axis=1) * length / (len(s) - 1)
        middle = 0.5 * (step[1:] + step[:-1])
        axis = np.asarray(start, dtype=float) + np.vstack([np.zeros(3), np.cumsum(middle, axis=0)])
        return Tube(axis, half_width(s) * np.ones_like(s), half_height(s) * np.ones_like(s))

    def at(self, s: np.ndarray, side: np.ndarray, up: np.ndarray) -> np.ndarray:
        """Points at axis parameter s, `side` and `up` in units of the half axes; arrays of one shape (...).

        Args:
            s: along the axis, in [0, 1].
            side: across, in half widths.
            up: upwards, in half heights.
        """
        s = np.asarray(s, dtype=float)
        grid = np.linspace(0.0, 1.0, len(self.axis))
        tangents = np.gradient(self.axis, axis=0)
        sample = [np.interp(s, grid, column) for column in (*self.axis.T, *tangents.T[:2])]
        norm = np.hypot(sample[3], sample[4])
        left = np.stack([-sample[4] / norm, sample[3] / norm, np.zeros_like(s)], axis=-1)
        width = np.interp(s, grid, self.half_width) * side
        height = np.interp(s, grid, self.half_height) * up
        position = np.stack(sample[:3], axis=-1) + width[..., None] * left
        position[..., 2] += height
        return position


class TetBuilder:
    """Grows a solid out of tubes: sections of four corners around a node on the axis, twelve tetrahedra between two.

    The nodes on the axis lie inside the solid. Drake needs them: what keeps two deformable bodies apart is their depth
    below the surface, which a mesh with boundary nodes only does not have.
    """

    def __init__(self) -> None:
        self._points: list[np.ndarray] = []
        self._tetrahedra: list[list[int]] = []

    def add_tube(self, tube: Tube, segments: int) -> list[list[int]]:
        """Fill a tube; returns the sections, each as [axis node, four corners counter-clockwise seen from its end].

        Args:
            tube: its axis and half axes.
            segments: number of subdivisions of the shape.
        """
        sections = [self._section(tube, i / segments) for i in range(segments + 1)]
        self._join(sections)
        return sections

    def add_branch(self, low: list[int], high: list[int], side: int, tube: Tube, starts_at: tuple[float, ...]) -> None:
        """Grow `tube` out of the side face (0..3) between two neighbouring sections of another one.

        A block of fourteen tetrahedra around one new node joins that face to the branch's first section; the sections
        are at the tube's parameters `starts_at`.

        Args:
            low: a section, as `add_tube` gives it.
            high: the next one.
            side: which of the faces between them, 0 to 3.
            tube: of the branch.
            starts_at: parameters of the branch's sections.
        """
        j, k = 1 + side, 1 + (side + 1) % 4
        root = [low[j], high[j], high[k], low[k]]
        faces = [f for f in self.mesh().boundary() if set(f) <= set(root)]
        sections = [self._section(tube, s) for s in starts_at]
        first = sections[0][1:]
        corners = np.array([self._points[i] for i in first])
        cycles = (first, first[::-1])
        turns = [c[i:] + c[:i] for c in cycles for i in range(4)]  # pair the corners so that nothing is twisted
        start = np.array([self._points[i] for i in root])
        apart = [np.linalg.norm(corners[[first.index(i) for i in turn]] - start) for turn in turns]
        first = turns[int(np.argmin(apart))]
        middle = self._add(0.5 * (start.mean(axis=0) + corners.mean(axis=0)))
        for face in faces:
            self._tetrahedra.append([middle, *(int(i) for i in face)])
        for i in range(4):
            a, b, c, d = root[i], root[(i + 1) % 4], first[i], first[(i + 1) % 4]
            self._tetrahedra += [[middle, a, b, c], [middle, b, d, c], [middle, sections[0][0], c, d]]
        self._join(sections)

    def mesh(self) -> TetMesh:
        """The solid so far, every volume positive."""
        mesh = TetMesh(np.array(self._points), np.array(self._tetrahedra))
        negative = mesh.volumes() < 0.0
        mesh.tetrahedra[negative] = mesh.tetrahedra[negative][:, [0, 2, 1, 3]]
        return mesh

    def _add(self, point: np.ndarray) -> int:
        self._points.append(point)
        return len(self._points) - 1

    def _section(self, tube: Tube, s: float) -> list[int]:
        side, up = _SECTION.T * (_BLUNT if s in (0.0, 1.0) else 1.0)
        return [self._add(p) for p in tube.at(np.full(5, s), side, up)]

    def _join(self, sections: list[list[int]]) -> None:
        for low, high in pairwise(sections):
            for j in range(4):
                # Sorted by index, so that the diagonal of a face is the same seen from both its prisms.
                (a, d), (b, e), (c, f) = sorted((low[m], high[m]) for m in (0, 1 + j, 1 + (j + 1) % 4))
                self._tetrahedra += [[a, b, c, f], [a, b, e, f], [a, d, e, f]]
