"""Frames along a curve: Frenet, Bishop and correction frames (paper III and IV-B)."""

from __future__ import annotations

import math

import numpy as np

EPSILON = 1e-10
"""ε of the paper's Table I: sines and lengths below it count as zero."""
_WELL_POSED = math.cos(math.radians(80.0))  # x_G says something about a disk up to this angle to it


def frenet_frames(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """e_T, e_N, e_B and the curvature κ from the first and second derivatives of a curve.

    Where the curvature vanishes e_N is not defined; there it is carried over from the neighbour by projection.

    Args:
        first: c'(u). Shape (N, 3).
        second: c''(u). Shape (N, 3).

    Returns:
        e_T, e_N, e_B of shape (N, 3), and κ of shape (N,), [1/m].
    """
    speed = np.linalg.norm(first, axis=1)
    tangent = first / speed[:, None]
    across = second - np.sum(second * tangent, axis=1)[:, None] * tangent
    size = np.linalg.norm(across, axis=1)
    curvature = size / speed**2
    defined = curvature > 1e-9 * max(1.0, float(curvature.max()))
    normal = np.where(defined[:, None], across / np.where(defined, size, 1.0)[:, None], 0.0)
    known = np.flatnonzero(defined)
    if known.size == 0:
        normal[0] = perpendicular(tangent[0])
        known = np.array([0])
    for s in range(int(known[0]) - 1, -1, -1):
        normal[s] = project(normal[s + 1], tangent[s])
    for s in range(int(known[0]) + 1, len(normal)):
        if not defined[s]:
            normal[s] = project(normal[s - 1], tangent[s])
    return tangent, normal, np.cross(tangent, normal), curvature


def bishop_frames(points: np.ndarray, tangents: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation-minimising frames by double reflection (Wang, Jüttler, Zheng, Liu 2008), of fourth order.

    Args:
        points: [m]. Shape (N, 3).
        tangents: unit. Shape (N, 3).
        start: the first e_N; its part along the first tangent is taken away. Shape (3,).

    Returns:
        e_N and e_B = e_T × e_N, unit. Shapes (N, 3).
    """
    normals = np.empty_like(points)
    normals[0] = project(start, tangents[0])
    for s in range(len(points) - 1):
        chord = points[s + 1] - points[s]
        normal, tangent = normals[s], tangents[s]
        square = chord @ chord
        if square > 0:
            normal = normal - 2 / square * (chord @ normal) * chord
            tangent = tangent - 2 / square * (chord @ tangent) * chord
        change = tangents[s + 1] - tangent
        square = change @ change
        if square > 0:
            normal = normal - 2 / square * (change @ normal) * change
        normals[s + 1] = project(normal, tangents[s + 1])
    return normals, np.cross(tangents, normals)


def correction_frames(
    points: np.ndarray,
    normals: np.ndarray,
    radii: np.ndarray,
    x_global: np.ndarray,
    start: np.ndarray,
    y_window: int = 1,
    max_turn: float = math.inf,
) -> tuple[np.ndarray, np.ndarray]:
    """The axes along which a thumb corrects (paper IV-B), as near to the person's x_G as continuity allows.

    x_s is x_G projected on the disk, slerped towards the projection of x_{s-1} by t = θ_X / (π/2), and turns
    about n no further than r Δψ = |Δc| from one disk to the next. y_s = n × x_s, negated when it points more
    than 90° away from y before it. Where the path starts along x_G, the frames start at the first disk that x_G
    says something about, and are carried back from there.

    Args:
        points: centres, [m]. Shape (N, 3).
        normals: unit, sign-continuous. Shape (N, 3).
        radii: [m], for the bound on the turn of x; zeros for none. Shape (N,).
        x_global: x_G, unit. Shape (3,).
        start: x of the first disk if the whole path runs along x_G; used for nothing else. Shape (3,).
        y_window: number of previous disks whose mean y decides on the sign (10 in the paper).
        max_turn: further bound on the turn of x about n between neighbours, [rad].

    Returns:
        x and y, unit. Shapes (N, 3).
    """
    projected = x_global - (normals @ x_global)[:, None] * normals
    size = np.linalg.norm(projected, axis=1)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    widest = np.maximum(radii[1:], radii[:-1])
    turn = np.minimum(np.divide(steps, widest, out=np.full_like(steps, np.inf), where=widest > 1e-9), max_turn)

    x = np.empty_like(normals)
    posed = np.flatnonzero(size > _WELL_POSED)
    first = int(posed[0]) if posed.size else 0
    x[first] = project(projected[first] if posed.size else start, normals[first])
    for s in range(first - 1, -1, -1):
        x[s] = _next_x(x[s + 1], normals[s], projected[s], size[s], turn[s])
    for s in range(first + 1, len(normals)):
        x[s] = _next_x(x[s - 1], normals[s], projected[s], size[s], turn[s - 1])

    y = np.cross(normals, x)
    for s in range(1, len(y)):
        if y[s] @ y[max(0, s - y_window) : s].sum(axis=0) < 0:
            y[s] = -y[s]
    return x, y


def _next_x(before: np.ndarray, normal: np.ndarray, projected: np.ndarray, size: float, turn: float) -> np.ndarray:
    """One step of the correction x-axis. `size` is cos θ_X, as x_G is a unit vector."""
    carried = project(before, normal)
    if size <= EPSILON:
        return carried
    ahead = projected / size
    sine, cosine = float(np.cross(carried, ahead) @ normal), float(carried @ ahead)
    if abs(sine) <= EPSILON:
        return carried
    theta_x = math.acos(min(1.0, size))
    psi = (1.0 - theta_x / (math.pi / 2)) * math.atan2(sine, cosine)
    psi = math.copysign(min(abs(psi), turn), psi)
    turned = math.cos(psi) * carried + math.sin(psi) * np.cross(normal, carried)
    return project(turned, normal)


def project(vector: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The unit vector along the part of `vector` across the unit `normal`; some such vector if there is none.

    Args:
        vector: any. Shape (3,).
        normal: unit. Shape (3,).

    Returns:
        Unit, across the normal. Shape (3,).
    """
    across = vector - (vector @ normal) * normal
    size = math.sqrt(across @ across)
    if size <= EPSILON:
        return perpendicular(normal)
    across = across / size
    across = across - (across @ normal) * normal  # once more, for vectors nearly along the normal
    return np.asarray(across / math.sqrt(across @ across))


def perpendicular(normal: np.ndarray) -> np.ndarray:
    """A unit vector across a unit vector."""
    across = np.zeros(3)
    across[int(np.argmin(np.abs(normal)))] = 1.0
    across = across - (across @ normal) * normal
    return np.asarray(across / np.linalg.norm(across))
