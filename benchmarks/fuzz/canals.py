"""Random canals: learned with random options, saved and loaded bit for bit, edited, moved, travelled."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.canal_quality import WAYS, Hardness, hard_demonstrations
from benchmarks.fuzz.options import random_options
from canal.editing import add_demonstration, cut, join, reverse
from canal.errors import InputError
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.navigation.tour import tour
from canal.retargeting import retarget
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface
from canal.surface_file import SHAPES, load_canal, save_canal

ROUNDING = 1e-9


def case(seed: int) -> str:
    """Learn a canal and do two things to it."""
    rng = np.random.default_rng(seed)
    way = WAYS[rng.integers(len(WAYS))]
    hardness = _hardness(rng)
    demonstrations = hard_demonstrations(seed, int(rng.integers(2, 6)), way, hardness)
    options = random_options(LearningOptions(), rng, share=0.3)
    direction = rng.normal(size=3)
    if rng.random() < 0.3:
        options = _with(options, x_global=tuple(direction.tolist()))
    if rng.random() < 0.3:
        options = _with(options, support_planes=(_plane(rng, [d.position for d in demonstrations]),))
    try:
        canal = learn_canal(demonstrations, options)
    except InputError as error:
        raise InputError(f"learning: {error}") from None
    check(canal, y_window=options.y_window)
    saved_and_loaded(canal)
    for _ in range(2):
        name = str(rng.choice(list(EDITS)))
        try:
            canal = EDITS[name](canal, rng)
        except InputError as error:
            if "\n" in str(error):
                raise AssertionError(f"an error of several lines: {error}") from error
        else:
            check(canal, y_window=options.y_window)
            saved_and_loaded(canal)
    travelled = tour(canal)
    assert np.isfinite(travelled.position).all(), "a tour that is not finite"
    return way


def _with(options: LearningOptions, **changes: object) -> LearningOptions:
    import dataclasses

    return dataclasses.replace(options, **changes)  # type: ignore[arg-type]


def _hardness(rng: np.random.Generator) -> Hardness:
    """From hardly anything wrong to more than anybody has recorded."""
    return Hardness(
        pauses=bool(rng.random() < 0.7),
        repeats=float(rng.choice([0.0, 0.05, 0.3])),
        jumps=int(rng.integers(0, 6)),
        noise=float(rng.choice([0.0, 1e-4, 1e-3])),
        tremor=float(rng.choice([0.0, 0.007, 0.02])),
        hesitations=int(rng.integers(0, 3)),
        locked_axis=bool(rng.random() < 0.5),
        spread=float(rng.choice([0.0, 0.05, 0.28, 0.5])),
        pinch=float(rng.choice([0.0, 0.009, 0.2])),
        disagreement=float(rng.choice([0.0, 30.0, 120.0])),
        sign_flips=int(rng.integers(0, 4)),
    )


def _plane(rng: np.random.Generator, positions: list[np.ndarray]) -> SupportPlane:
    """A table below everything, or a wall beside everything; now and then through it."""
    normal = [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)][rng.integers(3)]
    lowest = min(float((p @ normal).min()) for p in positions)
    return SupportPlane(normal, lowest + float(rng.choice([0.0, -0.01, -0.05, 0.02])))


def check(canal: CanalSurface, y_window: int = 1) -> None:
    """The laws of a canal; with the paper's window y may turn over."""
    for name in SHAPES:
        assert np.isfinite(getattr(canal, name)).all(), f"{name} is not finite"
    assert canal.moving_time_s > 0
    assert (canal.radii >= 0).all()
    x, y, n = canal.x_axes, canal.y_axes, canal.normals
    for name, rows in (("x", x), ("y", y), ("normal", n), ("tangent", canal.tangents), ("q", canal.orientations)):
        assert np.abs(np.linalg.norm(rows, axis=1) - 1).max() < ROUNDING, f"{name} is not unit"
    for name, a, b in (("x, y", x, y), ("x, normal", x, n), ("y, normal", y, n)):
        assert np.abs(np.sum(a * b, axis=1)).max() < ROUNDING, f"{name} are not orthogonal"
    outside = np.linalg.norm(canal.demonstrations - canal.directrix, axis=2).max(axis=0) - canal.radii
    assert outside.max() < 1e-9, f"a demonstration lies {outside.max():g} m outside its ball"
    assert np.sum(canal.orientations[1:] * canal.orientations[:-1], axis=1).min() > 0, "a quaternion changes its sign"
    assert (np.sum(x[1:] * x[:-1], axis=1) > 0).all(), "x turns over"
    assert y_window > 1 or (np.sum(y[1:] * y[:-1], axis=1) > 0).all(), "y turns over"
    for disk in np.linspace(0, canal.n_disks - 1, 7):
        for eta, phi in ((0.0, 0.0), (0.5, 2.0), (1.0, -1.0)):
            p = canal.point(disk, eta, phi)
            assert np.isfinite(p).all(), "a point that is not finite"
            assert np.linalg.norm(p - canal.center(disk)) <= canal.radius(disk) * (1 + 1e-6) + ROUNDING, "off its disk"
            back = canal.point(disk, *canal.disk_coordinates(disk, p))
            assert np.linalg.norm(back - p) < 1e-6, "a point that its own coordinates do not give back"


def saved_and_loaded(canal: CanalSurface) -> None:
    """A file gives back a canal bit for bit."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "c.npz"
        save_canal(path, canal)
        again = load_canal(path)
    for name in (*SHAPES, "x_global"):
        assert np.array_equal(getattr(canal, name), getattr(again, name)), f"{name} changes on its way to a file"
    assert canal.moving_time_s == again.moving_time_s
    assert canal.support_planes == again.support_planes
    assert canal.warnings == again.warnings
    assert (canal.ellipses is None) == (again.ellipses is None)
    assert canal.ellipses is None or np.array_equal(canal.ellipses, again.ellipses)


def _cut(canal: CanalSurface, rng: np.random.Generator) -> CanalSurface:
    first, last = np.sort(rng.uniform(0, canal.n_disks - 1, 2)).tolist()
    return cut(canal, first, last)


def _join(canal: CanalSurface, rng: np.random.Generator) -> CanalSurface:
    at = float(rng.uniform(0.2, 0.8)) * (canal.n_disks - 1)
    return join(cut(canal, 0, at), cut(canal, min(at + float(rng.uniform(0, 3)), canal.n_disks - 3), canal.n_disks - 1))


def _add(canal: CanalSurface, rng: np.random.Generator) -> CanalSurface:
    demonstrations = hard_demonstrations(int(rng.integers(1000)), 2, WAYS[0])
    own = canal.demonstrations[0] + rng.normal(scale=0.02, size=3)
    if rng.random() < 0.7:
        from canal.demonstration import Demonstration

        demonstrations = [Demonstration(own, canal.demonstration_orientations[0], name="one more")]
    return add_demonstration(canal, demonstrations[0])


def _retarget(canal: CanalSurface, rng: np.random.Generator) -> CanalSurface:
    """Within 0.3 m and 30°, as documented; pick, place or both."""
    poses = {}
    for name, disk in (("pick", 0), ("place", -1)):
        if rng.random() < 0.7:
            shift, axis = rng.normal(size=3), rng.normal(size=3)
            turn = Rotation.from_rotvec(np.radians(30) * rng.random() * axis / np.linalg.norm(axis))
            old = Rotation.from_quat(canal.orientations[disk], scalar_first=True)
            moved = canal.directrix[disk] + 0.3 * rng.random() * shift / np.linalg.norm(shift)
            poses[name] = (moved, (turn * old).as_quat(scalar_first=True))
    return retarget(canal, **poses)


EDITS: dict[str, Callable[[CanalSurface, np.random.Generator], CanalSurface]] = {
    "reverse": lambda canal, rng: reverse(canal),
    "cut": _cut,
    "join": _join,
    "add": _add,
    "retarget": _retarget,
}
"""What is done to canals."""
