"""Canals from canals: in reverse, cut, joined to another, with one demonstration more."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline
from scipy.optimize import linear_sum_assignment

from canal.demonstration import Demonstration
from canal.errors import InputError
from canal.learning.alignment import align_to
from canal.learning.learn import N_POINTS, build_surface, disk_count, unit_tangents
from canal.learning.splines import arc_length, fit_spline, knots_every, rotation_curve, slerp, uniform_in_arc
from canal.learning.trimming import trim
from canal.learning_options import LearningOptions
from canal.rows import accumulate, rows_between
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface

LARGEST_GAP_M = 0.1  # between canals that are joined; a wider one is a motion nobody has shown
_BRIDGE_SHARE = 0.08  # of the shorter canal, given up on either side of a joint for a smooth passage
# Of the second of two joined canals, what the first's need not be the same as.
_OWN = ("preset", "margin", "contain_raw", "n_disks", "support_planes", "x_global")


def reverse(canal: CanalSurface) -> CanalSurface:
    """The canal from place to pick: the same disks and correction axes, tangents and normals turned round."""
    flipped = ("directrix", "radii", "x_axes", "y_axes", "orientations", "orientation_sd", "orientation_weights")
    changes = {name: getattr(canal, name)[::-1] for name in flipped}
    changes |= {name: -getattr(canal, name)[::-1] for name in ("tangents", "normals")}
    changes |= {name: getattr(canal, name)[:, ::-1] for name in ("demonstrations", "demonstration_orientations")}
    if canal.ellipses is not None:
        changes["ellipses"] = canal.ellipses[::-1]
    return replace(canal, **changes)


def cut(canal: CanalSurface, first: float, last: float) -> CanalSurface:
    """The part of a canal between two continuous disks, with its own disks, home and moving time.

    Args:
        canal: the surface.
        first: continuous index of the new first disk.
        last: of the new last one, at least two further on.

    Raises:
        InputError: the disks are out of range or in the wrong order.
    """
    end = canal.n_disks - 1
    if not (first >= 0 and first + 2 <= last <= end):
        raise InputError(f"cut from disk {first:g} to {last:g}; give 0 ≤ first, first + 2 ≤ last ≤ {end}")
    keep = np.unique(np.concatenate([[first], np.arange(math.ceil(first), math.floor(last) + 1), [last]]))
    share = (canal.arc[-1] / end * (last - first)) / canal.length
    return rebuild(
        canal,
        np.stack([rows_between(curve, keep) for curve in canal.demonstrations]),
        np.stack([_unit(rows_between(turned, keep)) for turned in canal.demonstration_orientations]),
        moving_time_s=canal.moving_time_s * share,
        share=share,
        beyond=beyond_data(canal, keep),
    )


def join(first: CanalSurface, second: CanalSurface) -> CanalSurface:
    """Two canals, one after the other, as one with a smooth passage.

    Demonstrations are paired by where they end and begin; where their numbers differ, each is taken as often as it
    takes. Near the joint both give way to a bridge that takes over their directions.

    Args:
        first: from pick on.
        second: on to place; begins where the first ends.

    Raises:
        InputError: the second does not begin where the first ends.
    """
    gap = float(np.linalg.norm(second.directrix[0] - first.directrix[-1]))
    if gap > LARGEST_GAP_M:
        raise InputError(
            f"the second canal begins {1e3 * gap:.0f} mm from where the first ends (at most "
            f"{1e3 * LARGEST_GAP_M:.0f}); retarget one of them to the other's end"
        )
    n = math.lcm(len(first.demonstrations), len(second.demonstrations))
    a, qa = _repeated(first, n)
    b, qb = _repeated(second, n)
    apart = np.linalg.norm(a[:, None, -1] - b[None, :, 0], axis=2)
    order = linear_sum_assignment(apart**2)[1]
    b, qb = b[order], qb[order]
    qb = qb * np.where(np.sum(qa[:, -1] * qb[:, 0], axis=1) < 0, -1.0, 1.0)[:, None, None]

    reach = max(_BRIDGE_SHARE * min(first.length, second.length), gap)
    i = min(int(np.searchsorted(first.arc, first.length - reach)), first.n_disks - 3)
    j = max(int(np.searchsorted(second.arc, reach)), 2)
    spacing = first.length / (first.n_disks - 1)
    steps = max(8, math.ceil((2 * reach + gap) / spacing))
    t = np.linspace(0.0, 1.0, steps + 1)[1:-1]
    chord = np.linalg.norm(b[:, j] - a[:, i], axis=1)[:, None]
    start = unit_tangents(a[:, i] - a[:, i - 1]) * chord
    end = unit_tangents(b[:, j + 1] - b[:, j]) * chord
    bridges = [
        CubicHermiteSpline([0.0, 1.0], [p, q], [u, v])(t)
        for p, q, u, v in zip(a[:, i], b[:, j], start, end, strict=True)
    ]
    turns = [
        slerp(np.tile(p, (len(t), 1)), np.tile(q, (len(t), 1)), t) for p, q in zip(qa[:, i], qb[:, j], strict=True)
    ]
    common = replace(
        first.options,
        margin=min(first.options.margin, second.options.margin),
        contain_raw=first.options.contain_raw and second.options.contain_raw,
        support_planes=tuple(dict.fromkeys(first.support_planes + second.support_planes)),
    )
    beyond = [beyond_data(canal, np.arange(canal.n_disks), common.margin) for canal in (first, second)]
    joined = rebuild(
        first,
        np.concatenate([a[:, : i + 1], np.stack(bridges), b[:, j:]], axis=1),
        np.concatenate([qa[:, : i + 1], np.stack(turns), qb[:, j:]], axis=1),
        moving_time_s=first.moving_time_s + second.moving_time_s,
        share=1.0 + second.length / first.length,
        beyond=np.interp(
            np.arange(i + len(t) + second.n_disks - j + 1),
            [*range(i + 1), *range(i + len(t) + 1, i + len(t) + second.n_disks - j + 1)],
            np.concatenate([beyond[0][: i + 1], beyond[1][j:]]),
        ),
        options=common,
    )
    differ = [key for key in vars(common) if key not in _OWN and getattr(second.options, key) != getattr(common, key)]
    if differ:
        told = ", ".join(f"{key} {getattr(second.options, key)} instead of {getattr(common, key)}" for key in differ)
        line = f"the second of the joined canals was learned with {told}: the first's is used for both"
        joined = replace(joined, warnings=(*joined.warnings, line))
    return joined


def add_demonstration(canal: CanalSurface, demonstration: Demonstration) -> CanalSurface:
    """A canal with one more demonstration, aligned to its directrix; the recorded old ones are not needed.

    Args:
        canal: learned.
        demonstration: in the same frame, from pick to place.

    Raises:
        InputError: the demonstration does not move, or runs from place to pick.
    """
    learned = canal.options
    motion = trim(demonstration, N_POINTS, learned.soft_trimming)
    disks = np.linspace(0, canal.n_disks - 1, N_POINTS)
    warp = align_to(rows_between(canal.directrix, disks), motion, learned.band, learned.warp_smoothing)
    knots, at = knots_every(learned.step), np.linspace(0.0, 1.0, canal.n_disks)
    position = fit_spline(knots, rows_between(motion.position, warp), learned.interpolate)(at)
    turned = rows_between(motion.orientation, warp[np.round(knots * (N_POINTS - 1)).astype(int)])
    n = len(canal.demonstrations)
    return rebuild(
        canal,
        np.concatenate([canal.demonstrations, position[None]]),
        np.concatenate([canal.demonstration_orientations, rotation_curve(knots, _unit(turned), at)[None]]),
        moving_time_s=(n * canal.moving_time_s + motion.moving_time) / (n + 1),
        beyond=beyond_data(canal, np.arange(canal.n_disks)),
        raw=[demonstration.position] if learned.contain_raw else None,
    )


def with_support_planes(canal: CanalSurface, planes: tuple[SupportPlane, ...]) -> CanalSurface:
    """The canal refined at these support planes as well as at its own: same disks, but for their normals and frames.

    Args:
        canal: learned.
        planes: in B, besides those that it has.

    Raises:
        InputError: a centre lies beyond a plane.
    """
    together = tuple(dict.fromkeys(canal.support_planes + planes))
    if together == canal.support_planes:
        return canal
    ball = np.linalg.norm(canal.demonstrations - canal.directrix, axis=2).max(axis=0)
    learned = replace(own_options(canal), support_planes=together)
    refined = build_surface(
        canal.demonstrations,
        canal.demonstration_orientations,
        tangents=canal.tangents,
        moving_time_s=canal.moving_time_s,
        options=learned,
        widening=np.maximum(canal.radii - ball - learned.margin, 0.0),
    )
    kept = ("directrix", "radii", "orientations", "orientation_sd", "orientation_weights", "options")
    return replace(refined, **{name: getattr(canal, name) for name in kept})


def rebuild(
    canal: CanalSurface,
    positions: np.ndarray,
    quaternions: np.ndarray,
    *,
    moving_time_s: float,
    beyond: np.ndarray,
    share: float = 1.0,
    options: LearningOptions | None = None,
    raw: list[np.ndarray] | None = None,
) -> CanalSurface:
    """A canal around aligned demonstrations, with disks uniform in the arc of their mean.

    Args:
        canal: whose options are used.
        positions: aligned, at any spacing. Shape (n, M, 3).
        quaternions: unit, sign-continuous. Shape (n, M, 4).
        moving_time_s: of the new canal, [s].
        beyond: what radii hold beyond the data and the margin at the M points, [m]. Shape (M,).
        share: length relative to `canal`; a number of disks that was asked for grows or shrinks with it.
        options: instead of the canal's.
        raw: further points that must lie in the balls, each (., 3), [m].
    """
    m = positions.shape[1]
    steps = np.linalg.norm(np.diff(positions.mean(axis=0), axis=0), axis=1)
    along = accumulate(np.maximum(steps, 1e-12))
    u = along / along[-1]
    curves = [CubicSpline(u, curve) for curve in positions]
    mean = CubicSpline(u, positions.mean(axis=0))
    u_arc = arc_length(mean)
    learned = options or own_options(canal)
    if learned.n_disks is not None:
        learned = replace(learned, n_disks=max(3, round(learned.n_disks * share) // 2 * 2 + 1))
    at = uniform_in_arc(mean, learned.n_disks or disk_count(u_arc[1][-1]), u_arc)
    position = np.interp(at, u, np.arange(m, dtype=float))
    return build_surface(
        np.stack([curve(at) for curve in curves]),
        np.stack([_unit(rows_between(turned, position)) for turned in quaternions]),
        tangents=unit_tangents(mean(at, 1)),
        moving_time_s=moving_time_s,
        options=learned,
        raw=raw,
        widening=np.interp(position, np.arange(m), beyond),
    )


def own_options(canal: CanalSurface) -> LearningOptions:
    """How a canal was learned, with the planes, the x_G and the kind of cross-sections that it has now."""
    x, y, z = canal.x_global.tolist()
    return replace(
        canal.options,
        x_global=(x, y, z),
        ellipse=canal.ellipses is not None or canal.options.ellipse,
        support_planes=canal.support_planes,
    )


def beyond_data(canal: CanalSurface, at: np.ndarray, margin: float | None = None) -> np.ndarray:
    """What a canal's radii hold beyond its data and a margin (its own if None) at continuous disks, [m].

    Args:
        canal: the surface.
        at: continuous disks. Shape (P,).
        margin: [m]; None for the canal's own.

    Returns:
        Shape (P,).
    """
    ball = np.linalg.norm(canal.demonstrations - canal.directrix, axis=2).max(axis=0)
    margin = canal.options.margin if margin is None else margin
    return np.asarray(np.interp(at, np.arange(canal.n_disks), np.maximum(canal.radii - ball - margin, 0.0)))


def _repeated(canal: CanalSurface, n: int) -> tuple[np.ndarray, np.ndarray]:
    times = n // len(canal.demonstrations)
    return np.tile(canal.demonstrations, (times, 1, 1)), np.tile(canal.demonstration_orientations, (times, 1, 1))


def _unit(rows: np.ndarray) -> np.ndarray:
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))
