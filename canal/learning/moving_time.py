"""How long a hand moves in a recording, pauses left out."""

from __future__ import annotations

import numpy as np

SLOW = 0.1  # share of the usual speed below which a hand may be pausing; tremor at rest reaches 0.03
HALF_WINDOW_S = 0.1  # [s] speeds are differences over this to either side: 0.1 mm of noise then makes 0.7 mm/s
TREMOR_M = 0.015  # [m] a hand that rests stays within this; its slow tremor has 5 to 10 mm
FEWEST_SAMPLES = 2  # to either side, in slower recordings
ONSET = 2.5
"""A hand that sets off takes 2 d/v (evenly accelerated) to 3 d/v (minimum jerk) for its first way d up to a speed v."""


def moving_time(poses: np.ndarray, dt: float) -> float:
    """Time in which a hand moves: all of it but its pauses, what it takes to stop and set off included.

    A pause is a stretch slower than a tenth of the usual speed Σv²/Σv, in which the hand stays where it is but for
    its tremor. Of it counts, at each of its ends, the time that the way d between where the hand rests and where it
    leaves the stretch at the speed v takes, `ONSET` d/v. A stretch in which it gets further is slow work, and is
    looked at anew by its own usual speed. So a slow start, slow work near a goal and a turn without a rest are
    motion; standing still is not.

    Args:
        poses: at even times, in one unit: position and 2 λ times the quaternion, sign-continuous, [m]. Shape (N, k).
        dt: between them, [s].

    Returns:
        [s], at most that from the first sample to the last.
    """
    n = len(poses)
    half = max(1, min(max(FEWEST_SAMPLES, round(HALF_WINDOW_S / dt)), n // 50))
    padded = np.concatenate([2 * poses[0] - poses[half:0:-1], poses, 2 * poses[-1] - poses[-2 : -half - 2 : -1]])
    velocity = (padded[2 * half :] - padded[: -2 * half]) / (2 * half)
    return _moving_samples(poses, velocity, 0, n) * dt * (n - 1) / n


def _moving_samples(poses: np.ndarray, velocity: np.ndarray, begin: int, stop: int) -> float:
    """How many of the samples from `begin` up to `stop` are of motion."""
    speed = np.linalg.norm(velocity[begin:stop], axis=1)
    slow = speed < SLOW * np.sum(speed**2) / np.sum(speed)
    samples = float(np.sum(~slow))
    borders = begin + np.flatnonzero(np.diff(slow, prepend=False, append=False))
    for first, end in zip(borders[::2].tolist(), borders[1::2].tolist(), strict=True):
        if end - first < stop - begin and np.ptp(poses[first:end], axis=0).max() > TREMOR_M:
            samples += _moving_samples(poses, velocity, first, end)
            continue
        rest = np.median(poses[first:end], axis=0)
        sides = [s for s in (first - 1, end) if begin <= s < stop]
        for s in sides:
            v = float(np.linalg.norm(velocity[s]))
            way = abs(float((poses[s] - rest) @ velocity[s])) / v  # along the motion: tremor goes any way
            samples += min(ONSET * way / v, (end - first) / len(sides))
    return samples
