"""How good a canal is: the measures that a person, a test and a benchmark look at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from canal.learning.disk_normals import crossings, tilts
from canal.rows import rows_between
from canal.surface import CanalSurface

_RATIO = 0.8  # η at which steps of points on the disks are compared with those of the centres
_DIRECTIONS = np.linspace(0.0, 2 * np.pi, 72, endpoint=False)


@dataclass(frozen=True)
class CanalQuality:
    """Measures of one canal. Angles in degrees, as a person reads them; lengths in metres.

    Attributes:
        outside_ball: how far an aligned point lies outside its ball, at most (negative: all inside).
        crossing: of neighbouring disks, see `relaxation.crossings`; they cross from 1 on.
        n_crossing: neighbours that cross.
        tilt_max: largest angle of a disk's normal to the tangent.
        x_turn_max, y_turn_max: largest angle of x, of y between neighbours.
        x_to_global_mean, x_to_global_max: angle of x to x_G.
        bishop_to_global_mean, bishop_to_global_max: the same for the Bishop frame's e_N, for comparison.
        step_ratio_max: largest step of a point at ratio 0.8, relative to the centre's.
        end_share_max: share of disks on the first or last 5 % of arc, relative to an even spread.
        tangent_error_p99: of e_T against central differences of the directrix, at 99 % of the disks.
    """

    outside_ball: float
    crossing: float
    n_crossing: int
    tilt_max: float
    x_turn_max: float
    y_turn_max: float
    x_to_global_mean: float
    x_to_global_max: float
    bishop_to_global_mean: float
    bishop_to_global_max: float
    step_ratio_max: float
    end_share_max: float
    tangent_error_p99: float


def canal_quality(canal: CanalSurface) -> CanalQuality:
    """Measure a canal."""
    from canal.learning.frames import bishop_frames

    c, r = canal.directrix, canal.radii
    apart = np.linalg.norm(canal.demonstrations - c, axis=2) - r
    crossing = crossings(c, canal.normals, r)
    bishop, _ = bishop_frames(c, canal.tangents, canal.x_axes[0])
    x_to_global = angles(canal.x_axes, np.broadcast_to(canal.x_global, c.shape))
    bishop_to_global = angles(bishop, np.broadcast_to(canal.x_global, c.shape))
    share = canal.arc / canal.length
    ends = max(np.mean(share <= 0.05), np.mean(share >= 0.95)) / 0.05
    return CanalQuality(
        outside_ball=float(apart.max()),
        crossing=float(crossing.max()),
        n_crossing=int(np.sum(crossing >= 1.0)),
        tilt_max=float(np.degrees(tilts(canal.normals, canal.tangents).max())),
        x_turn_max=float(angles(canal.x_axes[1:], canal.x_axes[:-1]).max()),
        y_turn_max=float(angles(canal.y_axes[1:], canal.y_axes[:-1]).max()),
        x_to_global_mean=float(x_to_global.mean()),
        x_to_global_max=float(x_to_global.max()),
        bishop_to_global_mean=float(bishop_to_global.mean()),
        bishop_to_global_max=float(bishop_to_global.max()),
        step_ratio_max=step_ratio(canal),
        end_share_max=float(ends),
        tangent_error_p99=float(np.percentile(tangent_errors(canal), 99)),
    )


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angle between unit vectors, row by row, [degrees]. Shape (N,).

    Args:
        a: unit. Shape (N, 3).
        b: unit. Shape (N, 3).
    """
    return np.asarray(np.degrees(2 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))))


def step_ratio(canal: CanalSurface, eta: float = _RATIO) -> float:
    """Largest step of a point at ratio η and fixed φ from disk to disk, relative to the centre's.

    Args:
        canal: the surface.
        eta: ratio η in [0, 1].
    """
    rim = eta * np.array([[canal.extent(s, phi) for s in range(canal.n_disks)] for phi in _DIRECTIONS])
    cosine, sine = np.cos(_DIRECTIONS)[:, None, None], np.sin(_DIRECTIONS)[:, None, None]
    points = canal.directrix + rim[:, :, None] * (cosine * canal.x_axes + sine * canal.y_axes)
    steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
    return float((steps / np.linalg.norm(np.diff(canal.directrix, axis=0), axis=1)).max())


def tangent_errors(canal: CanalSurface) -> np.ndarray:
    """Angle of e_T to central differences of the directrix, at the inner disks, [degrees]. Shape (N-2,)."""
    central = canal.directrix[2:] - canal.directrix[:-2]
    return angles(central / np.linalg.norm(central, axis=1, keepdims=True), canal.tangents[1:-1])


def deviations(canal: CanalSurface, raw: np.ndarray) -> np.ndarray:
    """Distance of each raw sample from the nearest processed demonstration's curve, [m].

    Args:
        canal: learned from `raw` among others.
        raw: positions of one demonstration. Shape (N, 3).

    Returns:
        Of the processed demonstration that is nearest on the whole. Shape (N,).
    """
    found = [KDTree(_dense(curve)).query(raw)[0] for curve in canal.demonstrations]
    return min(found, key=lambda distance: float(np.sum(distance**2)))


def undershoot(canal: CanalSurface, raws: list[np.ndarray]) -> float:
    """How far the processed demonstrations and the directrix reach below the lowest raw sample, [m].

    Args:
        canal: the surface.
        raws: positions as they were recorded, each (., 3), [m].
    """
    lowest = min(float(canal.demonstrations[..., 2].min()), float(canal.directrix[:, 2].min()))
    return min(float(raw[:, 2].min()) for raw in raws) - lowest


def curvature(canal: CanalSurface) -> np.ndarray:
    """Curvature of the directrix at each disk from the turning of its chords, [1/m]. Shape (N,)."""
    chords = np.diff(canal.directrix, axis=0)
    size = np.linalg.norm(chords, axis=1, keepdims=True)
    turn = np.radians(angles(chords[1:] / size[1:], chords[:-1] / size[:-1]))
    inner = turn / (0.5 * (size[1:, 0] + size[:-1, 0]))
    return np.concatenate([inner[:1], inner, inner[-1:]])


def _dense(curve: np.ndarray, per_step: int = 20) -> np.ndarray:
    at = np.linspace(0, len(curve) - 1, per_step * len(curve))
    return rows_between(curve, at)
