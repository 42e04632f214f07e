"""Soft trimming: a demonstration as a function of how far it has moved, pauses left out (paper V-A, step 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from canal.demonstration import SAMPLE_RATE_HZ, Demonstration
from canal.errors import InputError
from canal.learning.moving_time import moving_time
from canal.rows import accumulate, rows_between

SMOOTHING_SAMPLES = 4.0  # [samples at 20 Hz] σ of the smoothing in time
ROTATION_LENGTH_M = 0.07  # [m / rad] λ: how much motion a turn on the spot is
SPEED_SHARE = 0.25  # v₀ = 0.25 Σv²/Σv: half of the weight is lost at a quarter of the usual speed
LARGEST_JUMP_M, LARGEST_JUMP = 0.15, 30.0  # [m], [usual steps]; recordings have steps of up to 6 usual ones
SLOWEST_M_S = 0.002
"""[m/s] on the mean while it moves: hands move at 20 to 500 mm/s, at a thousandth of it if time is in ms."""
LONGEST_GAP = 10.0  # [usual steps in time] half a second at 20 Hz; a longer one is a pause that was not written
SMALLEST_MOTION_M = 0.005  # [m] a tremor reaches 5 mm; what moves less has no direction


@dataclass(frozen=True, eq=False)
class Motion:
    """A demonstration resampled uniformly in ℓ, the moved length.

    Attributes:
        position: [m]. Shape (M, 3).
        orientation: unit quaternions, sign-continuous. Shape (M, 4).
        moving_time: time spent moving, pauses left out, [s]; see `canal.learning.moving_time`.
        length: ℓ of the whole, [m], turns included.
        name: of the demonstration.
    """

    position: np.ndarray
    orientation: np.ndarray
    moving_time: float
    length: float
    name: str


def trim(demonstration: Demonstration, n_points: int, soft: bool = True) -> Motion:
    """Leave out, softly, what does not move, and resample uniformly in what does.

    With v the speed (rotation counted as λ times its rate), dℓ = v w dt, w = (v/v₀)² / (1 + (v/v₀)²). A
    threshold instead of w is discontinuous in the data.

    Args:
        demonstration: as recorded.
        n_points: M, how many points to return.
        soft: False keeps everything, as recorded, and resamples uniformly in time.

    Raises:
        InputError: it does not move, or jumps.
    """
    n = len(demonstration)
    extent = np.ptp(demonstration.position, axis=0).max()
    if extent < SMALLEST_MOTION_M:
        raise InputError(
            f"{demonstration.name}: no motion, it stays within {1e3 * extent:.1f} mm (at least "
            f"{1e3 * SMALLEST_MOTION_M:.0f} mm); record it again"
        )
    _refuse_jumps(demonstration)
    recorded = _without_gaps(demonstration)
    dt = recorded[-1] / (n - 1)
    clock = np.linspace(0.0, recorded[-1], n)
    # A fast recording is smoothed as long as a slow one; a short one never over more than its own features.
    sigma = min(max(SMOOTHING_SAMPLES, SMOOTHING_SAMPLES / (SAMPLE_RATE_HZ * dt)), n / 50.0)
    position = rows_between(demonstration.position, clock, recorded)
    turned = rows_between(continuous_signs(demonstration.orientation), clock, recorded)
    moving = moving_time(np.hstack([position, 2.0 * ROTATION_LENGTH_M * turned]), dt)
    if soft:
        position, turned = _smooth(position, sigma), _smooth(turned, sigma)
    orientation = continuous_signs(turned / np.linalg.norm(turned, axis=1, keepdims=True))
    step = _steps(position, orientation)
    usual = np.sum(step**2) / np.sum(step)
    if usual < SLOWEST_M_S * dt:
        raise InputError(
            f"{demonstration.name}: moves at {1e3 * usual / dt:.2g} mm/s, {demonstration.duration:.0f} s in all (at "
            f"least {1e3 * SLOWEST_M_S:.0f} mm/s); give time in seconds (learn --time-unit ms, us or ns)"
        )
    ratio = (step / (SPEED_SHARE * usual)) ** 2
    length = accumulate(step * ratio / (1.0 + ratio))
    # The least slope keeps ℓ invertible where nothing moves at all.
    length += np.arange(n) * (1e-9 * length[-1] / n)
    at = np.interp(np.linspace(0.0, length[-1], n_points), length, np.arange(n, dtype=float))
    if not soft:
        at = np.linspace(0.0, n - 1.0, n_points)
    turned = rows_between(orientation, at)
    return Motion(
        position=rows_between(position, at),
        orientation=turned / np.linalg.norm(turned, axis=1, keepdims=True),
        moving_time=moving,
        length=float(length[-1]),
        name=demonstration.name,
    )


def _steps(position: np.ndarray, orientation: np.ndarray) -> np.ndarray:
    """How far each sample is from the one before, turns included, [m]. Shape (N-1,)."""
    moved = np.linalg.norm(np.diff(position, axis=0), axis=1)
    half_chord = 0.5 * np.linalg.norm(np.diff(orientation, axis=0), axis=1)
    return np.hypot(moved, ROTATION_LENGTH_M * 4.0 * np.arcsin(np.minimum(half_chord, 1.0)))


def _without_gaps(demonstration: Demonstration) -> np.ndarray:
    """Times of the samples from 0 on, with gaps no longer than what happened in them takes, [s]. Shape (N,).

    A recorder that writes nothing in a pause leaves a gap. Spread over it, even times would be too far apart for the
    motion. A step counts at most `LONGEST_GAP` usual ones, or what its way takes at the usual speed if that is more.
    """
    dt = np.diff(demonstration.time)
    longest = LONGEST_GAP * np.median(dt)
    if dt.max() > longest:
        step = _steps(demonstration.position, continuous_signs(demonstration.orientation))
        even = dt <= longest
        speed = np.sum(step[even] ** 2) / max(np.sum(step[even] * dt[even]), 1e-12)
        dt = np.minimum(dt, np.maximum(longest, step / max(speed, 1e-12)))
    return accumulate(dt)


def _refuse_jumps(demonstration: Demonstration) -> None:
    """A lost sensor, unlike a lost sample, moves further at once than a hand can: nothing can be learned from it."""
    steps = np.linalg.norm(np.diff(demonstration.position, axis=0), axis=1)
    usual = float(np.median(steps[steps > 0]))
    worst = int(np.argmax(steps))
    if steps[worst] > max(LARGEST_JUMP_M, LARGEST_JUMP * usual):
        raise InputError(
            f"{demonstration.name}: jumps by {1e3 * steps[worst]:.0f} mm at sample {worst + 1} (at most "
            f"{1e3 * LARGEST_JUMP_M:.0f} mm, or {LARGEST_JUMP:.0f} usual steps); cut it out, or record again"
        )


def continuous_signs(orientation: np.ndarray) -> np.ndarray:
    """The same rotations with q_i · q_{i-1} ≥ 0 along the first axis. Shape (N, 4)."""
    turns = np.sum(orientation[1:] * orientation[:-1], axis=1) < 0
    sign = np.where(np.cumsum(turns) % 2 == 1, -1.0, 1.0)
    return np.concatenate([orientation[:1], orientation[1:] * sign[:, None]])


def _smooth(values: np.ndarray, sigma: float) -> np.ndarray:
    """Gaussian smoothing that keeps both ends where they are (point reflection). Shape (N, k)."""
    n = len(values)
    pad = min(n - 1, int(np.ceil(4 * sigma)))
    if sigma < 0.1 or pad < 1:
        return values
    padded = np.concatenate([2 * values[0] - values[pad:0:-1], values, 2 * values[-1] - values[-2 : -pad - 2 : -1]])
    return np.asarray(gaussian_filter1d(padded, sigma, axis=0, mode="nearest")[pad : pad + n])
