"""A seeded generator of demonstrations with everything that recordings of a person's hand get wrong."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from canal.demonstration import Demonstration
from models.make_demonstrations import orientation as gripper_towards

RATE_HZ = 20.0
LEVEL = np.radians(35.0)  # hands that are guided part this much out of the horizontal at most


@dataclass(frozen=True)
class Hardness:
    """What is wrong with the demonstrations; the defaults are all that was seen in real ones."""

    pauses: bool = True  # 2-5 s at both ends, 2 s in mid-motion
    repeats: float = 0.05  # share of samples that repeat the previous one
    jumps: int = 3  # isolated steps of 3-6 times the usual
    noise: float = 1e-4  # [m]
    tremor: float = 0.007  # [m] amplitude of a slow tremor
    hesitations: int = 1  # near-180° turns, forth again after 2-4 cm
    locked_axis: bool = True  # one coordinate stands still for a while
    spread: float = 0.28  # [m] distance of the ends
    pinch: float = 0.009  # [m] distance half-way
    disagreement: float = 30.0  # [°] between the orientations
    sign_flips: int = 2
    hand_guided: bool = False  # as a person leads the Lio by its hand, see `_hand_guided`


EASY = Hardness(False, 0.0, 0, 0.0, 0.0, 0, False, 0.1, 0.02, 5.0, 0)

HAND_GUIDED = Hardness(hand_guided=True)

SHAPES = ("pick_and_place", "u_turn", "straight", "loop", "hairpin")


def _nominal(shape: str, rng: np.random.Generator) -> PchipInterpolator | CubicSpline:
    """p(u), u in [0, 1]."""
    if shape == "straight":
        start = rng.uniform([-0.1, -0.1, 0.4], [0.2, 0.1, 0.8])
        return CubicSpline([0, 1], [start, start + rng.uniform(0.4, 0.8) * np.array([1.0, 0, 0])])
    u = np.linspace(0, 1, 41)
    if shape == "loop":
        a, b = rng.uniform(0.2, 0.35, 2)
        tilt = Rotation.from_rotvec(rng.normal(size=3) * 0.3).as_matrix()
        angle = 2 * np.pi * u
        return CubicSpline(u, [0.3, 0.0, 0.7] + np.column_stack([a * np.cos(angle), b * np.sin(angle), 0 * u]) @ tilt)
    if shape == "hairpin":
        out, gap = rng.uniform(0.4, 0.6), rng.uniform(0.0, 0.08)
        there = np.column_stack([0.3 + gap * u, -out + out * (1 - np.abs(2 * u - 1)), 0.6 + 0.05 * u])
        return PchipInterpolator(u, there)
    if shape == "u_turn":
        depth, width = rng.uniform(0.3, 0.5), rng.uniform(0.25, 0.4)
        turn = np.pi * np.clip((u - 0.35) / 0.3, 0, 1)
        x = 0.3 + depth * (np.minimum(u / 0.35, 1) - np.maximum((u - 0.65) / 0.35, 0)) + width / 2 * np.sin(turn)
        y = -width / 2 * np.cos(turn)
        z = 0.6 + 0.1 * np.sin(np.pi * u) * rng.uniform(-1, 1)
        return CubicSpline(u[::2], gaussian_filter1d(np.column_stack([x, y, z]), 2, axis=0, mode="nearest")[::2])
    reach, side = rng.uniform(0.25, 0.45), rng.uniform(0.4, 0.55)
    low, high = rng.uniform(0.3, 0.55), rng.uniform(0.75, 0.95)
    points = np.array(
        [
            [reach, -side, low],
            [reach - 0.01, -side + 0.03, 0.5 * (low + high)],
            [reach + rng.uniform(-0.05, 0.05), -0.6 * side, high - 0.03],
            [reach + rng.uniform(0, 0.12), 0.0, high],
            [reach + rng.uniform(-0.05, 0.05), 0.6 * side, high - 0.03],
            [reach - 0.01, side - 0.03, 0.5 * (low + high)],
            [reach - 0.05, side, low + rng.uniform(0, 0.02)],
        ]
    )
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return CubicSpline(along / along[-1], points)


def hard_demonstrations(
    seed: int, n: int = 2, shape: str = "pick_and_place", hardness: Hardness | None = None
) -> list[Demonstration]:
    """`n` demonstrations of one task, as `n` tries of one person."""
    rng = np.random.default_rng([seed, n, SHAPES.index(shape)])
    h = hardness or Hardness()
    nominal = _nominal(shape, rng)
    middle = rng.uniform(0.4, 0.6)
    phase = rng.uniform(0, 2 * np.pi)
    if h.hand_guided:
        phase = LEVEL * (phase / np.pi - 1)
    across = _across(nominal)
    first = Rotation.random(random_state=np.random.RandomState(seed))
    last = Rotation.from_rotvec(rng.normal(size=3) * 0.6) * first
    lean = Rotation.from_rotvec([0, 0, 1]).as_rotvec()
    lean = rng.normal(size=3)
    lean /= np.linalg.norm(lean)
    demonstrations = []
    for k in range(n):
        angle = phase + 2 * np.pi * k / n
        u = _progress(rng, h)
        v = np.clip(u, 0, 1)
        half = 0.5 * (h.pinch + (h.spread - h.pinch) * np.abs((v - middle) / max(middle, 1 - middle)) ** 1.5)
        middle_of_all = _within_reach(nominal(v)) if h.hand_guided else nominal(v)
        position = middle_of_all + half[:, None] * (np.cos(angle) * across[0] + np.sin(angle) * across[1])
        position += _tremor(rng, u, h.tremor)
        if h.locked_axis:
            _lock(rng, position)
        position += rng.normal(size=position.shape) * h.noise
        own = Rotation.from_rotvec(np.radians(0.5 * h.disagreement) * np.cos(angle) * lean)
        turned = first * Rotation.from_rotvec(np.outer(v, (first.inv() * last).as_rotvec()))
        if h.hand_guided:
            turned = _hand_guided(middle_of_all, np.random.default_rng([seed, 1]))
        orientation = (turned * own).as_quat(scalar_first=True)
        orientation += rng.normal(size=orientation.shape) * 0.1 * min(h.noise, 0.001)
        position, orientation = _record(rng, position, orientation, h)
        demonstrations.append(Demonstration(position, orientation, name=f"{shape} {seed}.{k}"))
    return demonstrations


def _lift(path: np.ndarray) -> np.ndarray:
    """How far each point of a path (N, 3) is carried up, from 0 to 1. Shape (N,)."""
    z = path[:, 2]
    return (z - z.min()) / np.ptp(z)


def _within_reach(path: np.ndarray) -> np.ndarray:
    """A path (N, 3) moved to where the Lio follows it with its gripper bent down. Shape (N, 3).

    Ends nearer to its base, home 0.33 to 0.45 m before it, carried no higher than 0.83 m: beyond that the forearm,
    0.3 m long, and the hand, 0.42 m, do not fit in between.
    """
    x, y, z = path.T
    lift = _lift(path)
    return np.column_stack(
        [(1 - lift) * 0.75 * x + lift * (0.24 + 0.375 * x), y, np.where(z > 0.55, 0.55 + 0.7 * (z - 0.55), z)]
    )


def _hand_guided(path: np.ndarray, rng: np.random.Generator) -> Rotation:
    """The gripper as a person leads it along a path (N, 3): away from the base, down to what it grips, level between.

    At the ends it leans by 10 to 22° off straight down, as in recordings, and it is up to 15° askew.
    """
    askew, pitch = rng.uniform(-15, 15, 2), rng.uniform(68, 80, 2)
    along = np.linspace(0, 1, len(path))
    heading = np.degrees(np.arctan2(path[:, 1], path[:, 0])) + askew[0] + (askew[1] - askew[0]) * along
    ends = pitch[0] + (pitch[1] - pitch[0]) * along
    return gripper_towards(heading, ends + (48 - ends) * _lift(path) ** 1.5)


def _across(nominal) -> np.ndarray:
    """Two directions across the path on the whole, the first horizontal if the path allows."""
    points = nominal(np.linspace(0, 1, 50))
    main = np.linalg.svd(points - points.mean(axis=0))[2][0]
    side = np.cross(main, [0, 0, 1]) if abs(main[2]) < 0.9 else np.array([1.0, 0, 0])
    side -= side @ main * main
    side /= np.linalg.norm(side)
    return np.array([side, 0.3 * np.cross(main, side)])


def _progress(rng: np.random.Generator, h: Hardness) -> np.ndarray:
    """u at each sample: minimum-jerk strokes, pauses and hesitations."""
    moving = int(RATE_HZ * rng.uniform(12, 25))
    stops = np.sort(rng.uniform(0.15, 0.85, 2 + h.hesitations)) if h.pauses else rng.uniform(0.2, 0.8, h.hesitations)
    marks = [0.0]
    for stop in np.sort(stops[: h.hesitations]) if h.hesitations else []:
        marks += [stop, stop - rng.uniform(0.02, 0.035)]
    marks += [1.0]
    parts = [np.zeros(int(RATE_HZ * rng.uniform(2, 5)))] if h.pauses else []
    for a, b in pairwise(marks):
        s = np.linspace(0, 1, max(8, int(moving * abs(b - a))))
        parts.append(a + (b - a) * s**3 * (10 - 15 * s + 6 * s**2))
    u = np.concatenate(parts)
    if h.pauses:
        at = int(rng.uniform(0.4, 0.6) * len(u))
        u = np.concatenate([u[:at], np.full(int(RATE_HZ * 2), u[at]), u[at:]])
        u = np.concatenate([u, np.ones(int(RATE_HZ * rng.uniform(2, 5)))])
    return u


def _tremor(rng: np.random.Generator, u: np.ndarray, amplitude: float) -> np.ndarray:
    """Slow (0.3-0.8 Hz) wandering while the hand moves, still when it rests."""
    clock = np.cumsum(np.minimum(1.0, np.abs(np.gradient(u)) * 400)) / RATE_HZ
    wander = np.zeros((len(u), 3))
    for _ in range(3):
        wander += np.sin(2 * np.pi * rng.uniform(0.3, 0.8) * clock[:, None] + rng.uniform(0, 6.28, 3)) / 3
    fade = np.minimum(1, 15 * np.minimum(u, 1 - u)).clip(0)
    return amplitude * wander * fade[:, None]


def _lock(rng: np.random.Generator, position: np.ndarray) -> None:
    """One coordinate stands still for a while and then catches up."""
    n, axis = len(position), rng.integers(3)
    start, length = int(rng.uniform(0.35, 0.5) * n), int(0.12 * n)
    rows = slice(start, start + length)
    catch = np.clip(np.linspace(-1.5, 1, length), 0, 1)
    before, after = position[start, axis], position[start + length - 1, axis]
    if abs(after - before) < 0.04:
        position[rows, axis] = before + (after - before) * (3 * catch**2 - 2 * catch**3)


def _record(rng, position: np.ndarray, orientation: np.ndarray, h: Hardness) -> tuple[np.ndarray, np.ndarray]:
    """Dropped and repeated samples, sign flips."""
    keep = np.ones(len(position), bool)
    for _ in range(h.jumps):
        at = rng.integers(len(position) // 4, 3 * len(position) // 4)
        keep[at : at + rng.integers(2, 6)] = False
    position, orientation = position[keep], orientation[keep]
    for i in 1 + np.flatnonzero(rng.random(len(position) - 1) < h.repeats):
        position[i], orientation[i] = position[i - 1], orientation[i - 1]
    for _ in range(h.sign_flips):
        at = rng.integers(len(position))
        orientation[at:] *= -1
    return position, orientation
