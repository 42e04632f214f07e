"""From demonstrations to a canal surface (paper V-A, IV-A, IV-B and V-B)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from canal.demonstration import Demonstration
from canal.errors import InputError
from canal.learning import orientation as orient
from canal.learning.alignment import align, evenly_moving
from canal.learning.disk_normals import MAX_TILT, continuous_directions, crossings, relax_normals, reversals, tilts
from canal.learning.ellipses import FEWEST_FOR_ELLIPSES, disk_ellipses
from canal.learning.frames import correction_frames, perpendicular
from canal.learning.splines import arc_length, fit_spline, knots_every, rotation_curve, uniform_in_arc
from canal.learning.trimming import trim
from canal.learning_options import MEASURED, LearningOptions
from canal.rows import rows_between
from canal.support_planes import SupportPlane, dips, hold_at_planes
from canal.surface import CanalSurface

DISK_SPACING_M = 0.005
FEWEST_DISKS, MOST_DISKS = 200, 1000
"""One disk in 5 mm of the directrix, within these bounds of N_f."""
SHORT_M = 0.05  # from pick to place; a hand need not be helped over less
N_POINTS = 201  # M, points of a demonstration during alignment
WIDE_SPREAD = 2 * math.sin(math.radians(45.0) / 4)  # σ of 45° to either side: their mean is shown by nobody
MAX_X_TURN = math.radians(6.0)  # of x about n between neighbours: a thumb follows 6° in 5 mm


def learn_canal(
    demonstrations: Sequence[Demonstration],
    options: LearningOptions = MEASURED,
    progress: Callable[[str], None] = lambda stage: None,
) -> CanalSurface:
    """Learn a canal surface from two or more demonstrations, in any order.

    Args:
        demonstrations: all in one frame, all from pick to place.
        options: how.
        progress: called with a word at each stage.

    Returns:
        The canal; what a person should know is in its `warnings`.

    Raises:
        InputError: fewer than two, one without motion, opposite directions, a centre beyond a support plane.
    """
    if len(demonstrations) < 2:
        raise InputError(f"{len(demonstrations)} demonstration(s); a canal needs at least two, of the same task")
    with threadpool_limits(
        limits=1
    ):  # matrices are small: threads wait for each other three times as long as they work
        return _learn(demonstrations, options, progress)


def _learn(
    demonstrations: Sequence[Demonstration], options: LearningOptions, progress: Callable[[str], None]
) -> CanalSurface:
    progress("trimming")
    motions = [(trim(d, N_POINTS, options.soft_trimming), d) for d in demonstrations]
    # A canonical order that a rigid motion of all the data does not change; the bytes decide on equal lengths.
    motions.sort(key=lambda m: (len(m[1]), round(m[0].length, 9), m[1].position.tobytes(), m[1].orientation.tobytes()))
    progress("aligning")
    moving = [motion for motion, _ in motions]
    warps = align(moving, options.band, options.warp_smoothing)
    if options.even_parameter:
        warps = evenly_moving(moving, warps)

    progress("fitting")
    knots = knots_every(options.step)
    curves = []
    for (motion, _), warp in zip(motions, warps, strict=True):
        curves.append(fit_spline(knots, rows_between(motion.position, warp), options.interpolate))
    mean = fit_spline(knots, np.mean([curve(knots) for curve in curves], axis=0), interpolate=True)
    u_arc = arc_length(mean)
    length = u_arc[1][-1]
    if length < 1e-4:
        raise InputError(
            f"the mean of the demonstrations is {1e3 * length:.2f} mm long: they cancel each other; show the same "
            "motion in each"
        )
    at = uniform_in_arc(mean, options.n_disks or disk_count(length), u_arc)
    positions = np.stack([curve(at) for curve in curves])
    quaternions = []
    for (motion, _), warp in zip(motions, warps, strict=True):
        turned = rows_between(motion.orientation, warp[np.round(knots * (N_POINTS - 1)).astype(int)])
        quaternions.append(rotation_curve(knots, turned / np.linalg.norm(turned, axis=1, keepdims=True), at))

    progress("disks and frames")
    return build_surface(
        positions,
        np.stack(quaternions),
        tangents=unit_tangents(mean(at, 1)),
        moving_time_s=float(np.mean([motion.moving_time for motion, _ in motions])),
        options=options,
        raw=[d.position for _, d in motions] if options.contain_raw else None,
    )


def disk_count(length: float) -> int:
    """N_f for a directrix of this length [m]: one every 5 mm, 200 to 1000, made odd."""
    return min(max(math.ceil(length / DISK_SPACING_M), FEWEST_DISKS), MOST_DISKS) // 2 * 2 + 1


def unit_tangents(derivatives: np.ndarray) -> np.ndarray:
    """Unit vectors along derivatives of a curve; one that vanishes takes its predecessor's. Shape (N, 3)."""
    size = np.linalg.norm(derivatives, axis=1)
    known = size > 1e-9 * size.max()
    nearest = np.maximum.accumulate(np.where(known, np.arange(len(size)), int(np.argmax(known))))
    return np.asarray(derivatives[nearest] / size[nearest, None])


def build_surface(
    positions: np.ndarray,
    quaternions: np.ndarray,
    *,
    tangents: np.ndarray,
    moving_time_s: float,
    options: LearningOptions = MEASURED,
    raw: list[np.ndarray] | None = None,
    widening: np.ndarray | float = 0.0,
) -> CanalSurface:
    """The canal around demonstrations that are aligned disk by disk (paper IV-A, IV-B, V-B).

    Args:
        positions: [m]. Shape (n, N, 3).
        quaternions: unit, (w, x, y, z). Shape (n, N, 4).
        tangents: e_T of the mean curve at each disk. Shape (N, 3).
        moving_time_s: mean time spent moving, [s].
        options: margin, planes, frames, weights.
        raw: further points that must lie in the balls, each (., 3), [m].
        widening: added to the radii besides the margin, [m]. Shape (N,).

    Raises:
        InputError: a centre lies beyond a support plane.
    """
    centres = positions.mean(axis=0)
    radii = np.linalg.norm(positions - centres, axis=2).max(axis=0)
    if raw is not None:
        radii = _containing(centres, radii, np.concatenate(raw))
    radii = radii + options.margin + widening
    quaternions = orient.agree_in_sign(quaternions)
    mean = orient.mean_orientation(quaternions)
    spread = orient.orientation_spread(quaternions, mean)

    disks = relax_normals if options.relax_disks else _upright
    normals = disks(centres, tangents, radii)
    held: dict[int, np.ndarray] = {}
    while options.support_planes:
        more = hold_at_planes(centres, tangents, normals, radii, options.support_planes)
        if set(more) <= set(held):
            break
        held.update({s: m for s, m in more.items() if s not in held})
        normals = disks(centres, tangents, radii, held)

    x_global = np.asarray(options.x_global, dtype=float)
    x_global = x_global / np.linalg.norm(x_global)
    x_axes, y_axes = correction_frames(
        centres,
        normals,
        radii if options.cap_x_turn else np.zeros_like(radii),
        x_global,
        start=_tool_axis_across(mean[0], normals[0]),
        y_window=options.y_window,
        max_turn=MAX_X_TURN if options.cap_x_turn else math.inf,
    )
    ellipses = None
    warnings = _warnings(centres, tangents, normals, radii, options.support_planes)
    if options.ellipse and len(positions) >= FEWEST_FOR_ELLIPSES:
        ellipses = disk_ellipses(positions - centres, x_axes, y_axes, radii)
    elif options.ellipse:
        warnings += (f"{len(positions)} demonstrations say nothing about ellipses (3 do): cross-sections are circles",)
    if spread.max() > WIDE_SPREAD:
        s = int(np.argmax(spread))
        warnings += (
            f"the demonstrations disagree in orientation by {math.degrees(4 * math.asin(spread[s] / 2)):.0f}° (root "
            f"mean square) from their mean at disk {s} of {len(spread) - 1}",
        )
    return CanalSurface(
        directrix=centres,
        radii=radii,
        tangents=tangents,
        normals=normals,
        x_axes=x_axes,
        y_axes=y_axes,
        orientations=mean,
        orientation_sd=spread,
        orientation_weights=orient.orientation_weight(spread, options.alpha, options.beta),
        demonstrations=positions,
        demonstration_orientations=quaternions,
        moving_time_s=moving_time_s,
        ellipses=ellipses,
        support_planes=options.support_planes,
        x_global=x_global,
        warnings=warnings,
        options=options,
    )


def _upright(
    points: np.ndarray, tangents: np.ndarray, radii: np.ndarray, held: dict[int, np.ndarray] | None = None
) -> np.ndarray:
    """Disks orthogonal to the path as in the paper, but those that are held at a plane. Shape (N, 3)."""
    normals = tangents.copy()
    for s, normal in (held or {}).items():
        normals[s] = normal if normal @ tangents[s] >= 0 else -normal
    return continuous_directions(normals)


def _containing(centres: np.ndarray, radii: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Radii widened until each point lies in the ball of the disk nearest to it."""
    from scipy.spatial import KDTree

    distance, nearest = KDTree(centres).query(points)
    radii = radii.copy()
    np.maximum.at(radii, nearest, distance)
    return radii


def _tool_axis_across(quaternion: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The tool's own axis that lies most across a direction. Shape (3,)."""
    w, x, y, z = quaternion
    axes = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    along = np.abs(axes @ normal)
    return axes[int(np.argmin(along))] if along.min() < 0.9 else perpendicular(normal)


def _warnings(
    centres: np.ndarray,
    tangents: np.ndarray,
    normals: np.ndarray,
    radii: np.ndarray,
    planes: tuple[SupportPlane, ...],
) -> tuple[str, ...]:
    lines = []
    length = float(np.sum(np.linalg.norm(np.diff(centres, axis=0), axis=1)))
    if length < SHORT_M:
        lines.append(f"the canal is {1e3 * length:.0f} mm long: demonstrations must be given in metres")
    last = len(centres) - 1
    bad = np.flatnonzero(crossings(centres, normals, radii) >= 1.0)
    if bad.size:
        lines.append(
            f"neighbouring disks cross at {bad.size} places, first at disk {bad[0]}, last at {bad[-1]} of {last}: a "
            f"bend tighter than the radius ({1e3 * radii[bad].max():.0f} mm)"
        )
    tilt = tilts(normals, tangents)
    turned = np.sum(tangents[1:] * tangents[:-1], axis=1) < 0
    for first, end in reversals(centres, tangents, radii):
        lines.append(
            f"the path turns back at disks {first} to {end} of {last}, within less than the radius "
            f"({1e3 * radii[first : end + 1].max():.0f} mm): its disks do not turn over with it"
        )
        tilt[first : end + 1] = 0.0
        turned[first:end] = False
    if tilt.max() > MAX_TILT + 1e-9:
        s = int(np.argmax(tilt))
        lines.append(f"disk {s} of {last} is tilted by {np.degrees(tilt[s]):.0f}° against the path")
    if turned.any():
        lines.append(f"the path reverses at disk {int(np.argmax(turned)) + 1} of {last}")
    for plane in planes:
        deep = dips(centres, normals, radii, plane)
        if deep.max() > 1e-9:
            s = int(np.argmax(deep))
            lines.append(
                f"disk {s} of {last} runs alongside the plane {plane.normal}, {plane.offset:g} and would reach "
                f"{1e3 * deep[s]:.0f} mm beyond it: points are clipped there"
            )
    return tuple(lines)
