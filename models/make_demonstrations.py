"""Make the demonstrations that ship: two a task, moved as a person's hand moves.

Run `python -m models.make_demonstrations`. Each is a path through keyframes of the TCP in the base frame B, with what
recordings of real hands have: pauses at both ends and on the way, tremor, noise, repeated samples, isolated long steps,
a hesitation that goes back, and a disagreement between the two that is large where the task leaves freedom and small
where it does not (the door).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

HERE = Path(__file__).parent / "demonstrations"
RATE = 20.0
"""Of recordings [Hz]."""
FORWARD = np.diag([1.0, -1.0, -1.0])
"""R_BT of a gripper that points along +x_B: x_T forward, the fingers open along y_T, z_T down."""


@dataclass(frozen=True)
class Key:
    """A keyframe, common to both hands, and how far they part there."""

    position: tuple[float, float, float]
    """p_BT [m]."""
    heading: float
    """Direction of the gripper about z_B [deg], 0 along +x."""
    pitch: float
    """How far the gripper points down [deg]; 90 is straight down."""
    spread: float
    """Each hand's distance from the middle, along `aside` [m]."""
    turn: float
    """Each hand's turn about the vertical [deg], one way and the other."""
    calm: float = 1.0
    """Share of the tremor that is left."""


@dataclass(frozen=True)
class Task:
    """Keyframes from pick to place, and the direction in which the hands part, at pick and at place."""

    name: str
    keys: Sequence[Key]
    aside: tuple[tuple[float, float, float], tuple[float, float, float]]
    moving_time: float = 26.5
    """Of a pass, pauses apart [s]: three items, home-pick-home-place-home, then take 140 s, as in the paper."""


@dataclass(frozen=True)
class Hand:
    """One person's way of moving."""

    side: float
    """+1 or -1: which way it parts from the middle."""
    seed: int
    pause: tuple[float, float] = (2.5, 3.5)
    """Before and after the motion [s]."""
    rests: Sequence[tuple[float, float]] = field(default_factory=tuple)
    """Pauses on the way: share of the path, duration [s]."""
    hesitation: float = 0.5
    """Share of the path where the hand goes back a little, before it goes on."""
    tempo: float = 1.0
    tremor: float = 0.004
    """Standard deviation of the slow tremor [m]."""


# Headings follow the azimuth, so that the arm moves in its own plane, but at the door of the machine, which is entered
# 35° across it; the pitch keeps joint 5 (0.416 m behind the TCP)
# within 0.33-0.58 m of the shoulder and in front of the column, and the gripper bent off the forearm by 20° and more:
# at 0° nothing moves the hand to a side without turning joint 4 by 90°.
LAUNDRY = Task(
    "laundry",
    [
        Key((0.450, 0.00, 0.342), 0, 90, 0.140, 9, 0.15),
        Key((0.450, 0.00, 0.440), 0, 90, 0.138, 9, 0.3),
        Key((0.442, 0.00, 0.550), 0, 84, 0.105, 10, 0.6),
        Key((0.430, 0.03, 0.660), 4, 70, 0.065, 12),
        Key((0.415, 0.140, 0.745), 18, 58, 0.04, 12),
        Key((0.375, 0.290, 0.775), 38, 50, 0.015, 10),
        Key((0.290, 0.420, 0.740), 62, 46, 0.03, 8),
        Key((0.190, 0.510, 0.680), 90, 46, 0.035, 6),
        Key((0.090, 0.533, 0.615), 112, 45, 0.025, 4, 0.7),
        Key((0.050, 0.591, 0.575), 122, 44, 0.015, 2.5, 0.4),
        Key((0.024, 0.628, 0.552), 125, 43, 0.01, 2, 0.25),
        Key((-0.007, 0.673, 0.532), 125, 42, 0.011, 1.5, 0.15),
        # Inside it is lowered, so that what is let go falls less deep. The hands part as far as the door lets the
        # gripper, so that items can be laid side by side.
        Key((-0.050, 0.734, 0.480), 125, 41, 0.045, 1.5, 0.15),
        Key((-0.084, 0.783, 0.422), 125, 40, 0.085, 1.5, 0.15),
    ],
    aside=((0.0, 1.0, 0.0), (0.819, 0.574, 0.0)),
)

RELOCATION = Task(
    "relocation",
    [
        Key((0.235, -0.455, 0.440), -63, 78, 0.140, 10, 0.15),
        Key((0.235, -0.455, 0.540), -63, 78, 0.138, 10, 0.3),
        Key((0.238, -0.445, 0.630), -62, 72, 0.110, 11, 0.6),
        Key((0.265, -0.380, 0.710), -55, 62, 0.070, 12),
        Key((0.320, -0.250, 0.765), -38, 54, 0.040, 10),
        Key((0.372, -0.080, 0.790), -12, 50, 0.015, 8),
        Key((0.372, 0.090, 0.790), 14, 50, 0.020, 8),
        Key((0.318, 0.255, 0.765), 39, 54, 0.045, 10),
        Key((0.262, 0.385, 0.705), 56, 62, 0.075, 10),
        Key((0.238, 0.447, 0.625), 62, 72, 0.110, 9, 0.6),
        Key((0.235, 0.455, 0.540), 63, 78, 0.135, 8, 0.3),
        Key((0.235, 0.455, 0.440), 63, 78, 0.138, 8, 0.15),
    ],
    aside=((0.89, 0.45, 0.0), (0.89, -0.45, 0.0)),
)

# As people show it who take the robot by its hand: the gripper leans by 17-20° where it grips, the hands come from and
# go to positions one behind the other, 0.28 m apart, turn it up to 26° otherwise, and all but meet past the middle.
TABLES = Task(
    "tables",
    [
        Key((0.235, -0.500, 0.475), -68, 72, 0.140, 9, 0.15),
        Key((0.230, -0.502, 0.560), -68, 71, 0.137, 10, 0.3),
        Key((0.222, -0.492, 0.665), -66, 65, 0.118, 11, 0.6),
        Key((0.222, -0.450, 0.765), -62, 57, 0.085, 12),
        Key((0.275, -0.345, 0.820), -50, 52, 0.045, 12),
        Key((0.360, -0.180, 0.830), -27, 50, 0.022, 11),
        Key((0.405, 0.000, 0.825), 0, 49, 0.012, 11),
        Key((0.362, 0.180, 0.825), 27, 49, 0.005, 12),
        Key((0.270, 0.345, 0.815), 52, 51, 0.030, 13),
        Key((0.205, 0.450, 0.765), 64, 57, 0.080, 13),
        Key((0.195, 0.495, 0.665), 68, 64, 0.118, 13, 0.6),
        Key((0.198, 0.508, 0.560), 69, 69, 0.136, 13, 0.3),
        Key((0.200, 0.505, 0.478), 69, 71, 0.138, 13, 0.15),
    ],
    aside=((0.16, -0.987, 0.0), (0.12, 0.993, 0.0)),
    moving_time=29.0,
)

HANDS = (
    Hand(+1.0, 11, (2.6, 3.8), ((0.34, 2.2),), hesitation=0.56, tempo=0.94),
    Hand(-1.0, 23, (3.4, 2.3), ((0.61, 2.8),), hesitation=0.44, tempo=1.06),
)


TASKS = (LAUNDRY, RELOCATION, TABLES)


def orientation(heading: np.ndarray, pitch: np.ndarray) -> Rotation:
    """R_BT for headings and pitches [deg] of shape (n,)."""
    return Rotation.from_euler("ZY", np.stack([heading, pitch], axis=1), degrees=True) * Rotation.from_matrix(FORWARD)


def progress(hand: Hand, moving_time: float, rng: np.random.Generator) -> np.ndarray:
    """Share of the path at each sample: slow start and end, rests, a hesitation. Shape (N,)."""
    moving = int(moving_time * hand.tempo * RATE)
    t = np.linspace(0, 1, moving)
    # Never still on the way, gentle at the ends.
    speed = (0.25 + np.minimum(1.0, 6.0 * np.minimum(t, 1 - t))) * (
        1 + 0.25 * np.sin(2 * np.pi * (2.3 * t + rng.random()))
    )
    s = np.cumsum(speed)
    s = (s - s[0]) / (s[-1] - s[0])
    # A hand that goes back by 8 mm of path, and on again.
    s = s - 0.012 * np.exp(-(((t - hand.hesitation) / 0.012) ** 2))
    parts, last = [np.full(int(hand.pause[0] * RATE), s[0])], 0
    for share, seconds in hand.rests:
        stop = int(np.searchsorted(s, share))
        parts += [s[last:stop], np.full(int(seconds * RATE), s[stop])]
        last = stop
    return np.concatenate([*parts, s[last:], np.full(int(hand.pause[1] * RATE), s[-1])])


def tremor(rng: np.random.Generator, n: int, columns: int) -> np.ndarray:
    """Slow, smooth wandering of unit standard deviation. Shape (n, columns)."""
    wander = gaussian_filter1d(rng.normal(size=(n + 200, columns)), 9.0, axis=0)[100:-100]
    return wander / wander.std(axis=0)


def demonstrate(task: Task, hand: Hand) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One demonstration: position (N, 3) [m], quaternion w x y z (N, 4), time (N,) [s]."""
    rng = np.random.default_rng(hand.seed)
    keys = task.keys
    points = np.array([k.position for k in keys])
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    knots /= knots[-1]
    s = progress(hand, task.moving_time, rng)
    n = len(s)

    def along(values: Sequence[float]) -> np.ndarray:
        return PchipInterpolator(knots, values)(np.clip(s, 0, 1))

    blend = along(np.linspace(0, 1, len(keys)).tolist())[:, None]
    aside = (1 - blend) * task.aside[0] + blend * task.aside[1]
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    # A hand at rest does not tremble as one that moves.
    moving = gaussian_filter1d((np.abs(np.gradient(s)) > 1e-5).astype(float), 5.0)[:, None]
    calm = along([k.calm for k in keys])[:, None] * (0.1 + 0.9 * moving)
    position = CubicSpline(knots, points)(np.clip(s, 0, 1))
    position += hand.side * along([k.spread for k in keys])[:, None] * aside
    position += hand.tremor * calm * tremor(rng, n, 3)
    turn = hand.side * along([k.turn for k in keys])
    R = orientation(along([k.heading for k in keys]) + turn, along([k.pitch for k in keys]))
    R = R * Rotation.from_rotvec(np.deg2rad(1.5) * calm * tremor(rng, n, 3))
    quaternion = R.as_quat()[:, [3, 0, 1, 2]]

    # Isolated long steps: frames that were dropped. Then samples that repeat the one before.
    kept = np.ones(n, dtype=bool)
    for start in rng.choice(np.arange(80, n - 80), 6, replace=False):
        kept[start : start + rng.integers(2, 5)] = False
    position, quaternion = position[kept], quaternion[kept]
    position += rng.normal(0, 1e-4, position.shape)
    for i in np.flatnonzero(rng.random(len(position)) < 0.05):
        if i > 0:
            position[i], quaternion[i] = position[i - 1], quaternion[i - 1]
    return position, quaternion, np.arange(len(position)) / RATE


def main() -> None:
    """Write all of them."""
    HERE.mkdir(exist_ok=True)
    for task in TASKS:
        for k, hand in enumerate(HANDS, start=1):
            position, quaternion, time = demonstrate(task, hand)
            path, temporary = HERE / f"{task.name}_{k}.npz", HERE / f"{task.name}_{k}.tmp.npz"
            np.savez_compressed(temporary, position=position, orientation=quaternion, time=time)
            temporary.replace(path)


if __name__ == "__main__":
    main()
