"""How good learned canals are: wanted against seen, on recorded and on generated demonstrations.

python -m benchmarks.canal_quality
"""

from __future__ import annotations

import sys
from itertools import permutations
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from canal.demonstration import Demonstration, load_demonstration
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.quality import canal_quality, deviations, undershoot
from canal.retargeting import retarget, shape_cost
from canal.support_planes import SupportPlane, dips
from canal.surface import CanalSurface
from canal.surface_file import SHAPES
from models import MODELS

ROOT = Path(__file__).parents[1]
# Recordings of the real robot, when they lie beside the project.
RECORDED = ROOT.parent / "shared" / "demos"
N_SEEDS = 30

sys.path.insert(0, str(ROOT / "tests" / "canal"))
from hard_demonstrations import HAND_GUIDED, Hardness, hard_demonstrations  # noqa: E402, F401
from hard_demonstrations import SHAPES as WAYS  # noqa: E402, F401 (for benchmarks beside this one)


class Figure(NamedTuple):
    """A row of the table; met when `seen` is at most `wanted`."""

    case: str
    name: str
    wanted: float
    seen: float
    unit: str

    @property
    def met(self) -> bool:
        return bool(self.seen <= self.wanted)


def recorded() -> list[Demonstration]:
    """The two demonstrations of the real robot; empty where they are not."""
    return [load_demonstration(path) for path in sorted(RECORDED.glob("*.npz"))]


def shipped(task: str) -> list[Demonstration]:
    return [load_demonstration(path) for path in sorted((MODELS / "demonstrations").glob(f"{task}_*.npz"))]


def generated() -> list[list[Demonstration]]:
    return [hard_demonstrations(seed, 2 + seed % 4) for seed in range(N_SEEDS)]


def rms_mm(distance: np.ndarray) -> float:
    return 1e3 * float(np.sqrt(np.mean(distance**2)))


def noise_moves(demonstrations: list[Demonstration], canal: CanalSurface) -> float:
    """How far 0.1 mm of noise moves the directrix, [mm], worst of three draws."""
    worst = 0.0
    for seed in range(3):
        rng = np.random.default_rng(seed)
        noisy = [
            Demonstration(d.position + 1e-4 * rng.normal(size=d.position.shape), d.orientation, d.time, d.name)
            for d in demonstrations
        ]
        moved = learn_canal(noisy, LearningOptions(n_disks=canal.n_disks)).directrix - canal.directrix
        worst = max(worst, 1e3 * float(np.linalg.norm(moved, axis=1).max()))
    return worst


def geometry(case: str, sets: list[list[Demonstration]]) -> list[Figure]:
    """The rows that hold on every set; the worst of all sets is seen."""
    canals = [learn_canal(s) for s in sets]
    found = [canal_quality(c) for c in canals]
    rows = [
        Figure(case, "aligned points outside their ball", 1e-12, max(q.outside_ball for q in found), "m"),
        Figure(
            case,
            "undershoot below the lowest sample",
            1,
            max(1e3 * undershoot(c, [d.position for d in s]) for c, s in zip(canals, sets, strict=True)),
            "mm",
        ),
        Figure(case, "share of disks on an end's 5 %", 1.15, max(q.end_share_max for q in found), "1"),
        Figure(case, "step at ratio 0.8, relative", 2.0, max(q.step_ratio_max for q in found), "1"),
        Figure(case, "turn of x between neighbours", 8, max(q.x_turn_max for q in found), "deg"),
        Figure(case, "turn of y between neighbours", 8, max(q.y_turn_max for q in found), "deg"),
        Figure(case, "neighbouring disks that cross", 0, max(q.n_crossing for q in found), "1"),
        Figure(case, "tilt", 30, max(q.tilt_max for q in found), "deg"),
        Figure(case, "tangent to differences, p99", 1.5, max(q.tangent_error_p99 for q in found), "deg"),
        Figure(
            case,
            "0.1 mm of noise moves the directrix",
            1,
            max(noise_moves(s, c) for s, c in zip(sets, canals, strict=True)),
            "mm",
        ),
    ]
    return rows


def order(case: str, demonstrations: list[Demonstration]) -> Figure:
    first = learn_canal(demonstrations)
    differing = 0
    for again in permutations(demonstrations):
        other = learn_canal(list(again))
        differing += any(not np.array_equal(getattr(first, key), getattr(other, key)) for key in SHAPES)
    return Figure(case, f"orders of {len(demonstrations)} that change a bit", 0, differing, "1")


def of_recorded(demonstrations: list[Demonstration]) -> list[Figure]:
    """The rows for the real robot's demonstrations, tables included."""
    case = "recorded"
    canal = learn_canal(demonstrations)
    quality = canal_quality(canal)
    rows = [order(case, demonstrations), *geometry(case, [demonstrations])]
    for k, (demonstration, rms, most) in enumerate(zip(demonstrations, (14, 7), (40, 18), strict=True)):
        away = deviations(canal, demonstration.position)
        rows.append(Figure(case, f"deviation from raw {k + 1}, RMS", rms, rms_mm(away), "mm"))
        rows.append(Figure(case, f"deviation from raw {k + 1}, max", most, 1e3 * away.max(), "mm"))
    rows.append(Figure(case, "x to x_G, mean", 25, quality.x_to_global_mean, "deg"))
    rows.append(Figure(case, "x to x_G, max", 65, quality.x_to_global_max, "deg"))
    rows.append(Figure(case, "(for comparison) Bishop's x to x_G, mean", np.inf, quality.bishop_to_global_mean, "deg"))
    lowest = min(float(d.position[:, 2].min()) for d in demonstrations)
    for name, plane in (
        ("table touching the lowest sample", SupportPlane((0, 0, 1), lowest)),
        ("table 10 mm below", SupportPlane((0, 0, 1), lowest - 0.01)),
    ):
        held = learn_canal(demonstrations, LearningOptions(support_planes=(plane,)))
        quality = canal_quality(held)
        deep = dips(held.directrix, held.normals, held.radii, plane).max()
        rows.append(Figure(case, f"{name}: disk dips", 1e-9, max(0.0, float(deep)), "m"))
        rows.append(Figure(case, f"{name}: disks that cross", 0, quality.n_crossing, "1"))
        rows.append(Figure(case, f"{name}: tilt", 30, quality.tilt_max, "deg"))
    return rows


def of_generated() -> list[Figure]:
    case = f"generated, {N_SEEDS} seeds"
    sets = generated()
    worst = max(rms_mm(deviations(canal, d.position)) for s in sets for canal in [learn_canal(s)] for d in s)
    rows = [order(case, hard_demonstrations(0, n)) for n in (3, 5)]
    return [*rows, *geometry(case, sets), Figure(case, "deviation from raw, worst RMS", 8, worst, "mm")]


def of_retargeting(n: int = 40) -> list[Figure]:
    """The shipped laundry canal bent by up to 0.3 m and 30° at one end or at both."""
    canal = learn_canal(shipped("laundry"))
    rng = np.random.default_rng(0)
    rows = []
    for which, ends in (("pick", ("pick",)), ("place", ("place",)), ("both ends", ("pick", "place"))):
        ratios, crossing, tilt = [], 0, 0.0
        for _ in range(n):
            poses = {}
            for name in ends:
                disk = 0 if name == "pick" else -1
                shift, turn = rng.normal(size=3), rng.normal(size=3)
                turned = Rotation.from_rotvec(np.radians(30) * rng.random() * turn / np.linalg.norm(turn))
                old = Rotation.from_quat(canal.orientations[disk], scalar_first=True)
                poses[name] = (
                    canal.directrix[disk] + 0.3 * rng.random() ** (1 / 3) * shift / np.linalg.norm(shift),
                    (turned * old).as_quat(scalar_first=True),
                )
            bent = retarget(canal, **poses)
            ratios.append(shape_cost(canal, bent).curvature_ratio)
            quality = canal_quality(bent)
            crossing, tilt = max(crossing, quality.n_crossing), max(tilt, quality.tilt_max)
        case = f"laundry retargeted by up to 0.3 m and 30°, {which}"
        rows += [
            Figure(case, "curvature, relative", 1.5, max(ratios), "1"),
            Figure(case, "disks that cross", 0, crossing, "1"),
            Figure(case, "tilt", 30, tilt, "deg"),
        ]
    return rows


def all_figures() -> list[Figure]:
    demonstrations = recorded()
    rows = of_recorded(demonstrations) if len(demonstrations) == 2 else []
    return [*rows, *of_generated(), *of_retargeting()]


def print_figures(rows: list[Figure]) -> None:
    case = ""
    for row in rows:
        if row.case != case:
            case = row.case
            print(f"\n{case}")
        wanted = "" if np.isinf(row.wanted) else f"{'ok' if row.met else 'NOT MET'}, wanted ≤ {row.wanted:g}"
        print(f"  {row.name:45}{row.seen:10.3g} {row.unit:4} {wanted}")


if __name__ == "__main__":
    figures = all_figures()
    print_figures(figures)
    sys.exit(0 if all(row.met for row in figures) else 1)
