"""What each deviation from the paper is worth: canals learned both ways, rule by rule (docs/deviations.md).

python -m benchmarks.bench_paper [--seeds N]
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

from benchmarks.canal_quality import hard_demonstrations, recorded, rms_mm, shipped
from benchmarks.table import Row, print_table, write_csv
from canal.demonstration import Demonstration
from canal.errors import InputError
from canal.learning import learn_canal
from canal.learning_options import MEASURED, PAPER, LearningOptions
from canal.navigation import Leg, NavigationOptions, NavigationState, disks_per_second, strategy_ratio
from canal.quality import canal_quality, deviations
from canal.surface import CanalSurface

OUTPUT = Path("build/bench-paper.csv")
SEEDS = 12
SAMPLES_PER_S = 20.0
"""Of the paper's control: one disk each."""


def ways() -> dict[str, LearningOptions]:
    """How canals are learned: ours, ours with one of the paper's rules each, and all of the paper's."""
    single = {f"ours, but {key} = {value}": LearningOptions(**{key: value}) for key, value in PAPER.items()}
    return (
        {"ours": MEASURED}
        | single
        | {
            "the paper's": LearningOptions(preset="paper"),
            "the paper's, but y_window = 1": LearningOptions(preset="paper", y_window=1),
            "the paper's, but trimmed": LearningOptions(preset="paper", soft_trimming=True),
        }
    )


def learned(demonstrations: list[Demonstration], options: LearningOptions) -> dict[tuple[str, str], float]:
    """Measures of one canal, by name and unit."""
    canal = learn_canal(demonstrations, options)
    q = canal_quality(canal)
    missed = [deviations(canal, d.position) for d in demonstrations]
    return {
        ("neighbouring disks that cross", "1"): q.n_crossing,
        ("gap of neighbours used", "1"): q.crossing,
        ("tilt", "deg"): q.tilt_max,
        ("turn of x", "deg"): q.x_turn_max,
        ("turn of y", "deg"): q.y_turn_max,
        ("step at ratio 0.8 over the centre's", "1"): q.step_ratio_max,
        ("e_T to differences, p99", "deg"): q.tangent_error_p99,
        ("recorded to learned, RMS", "mm"): max(map(rms_mm, missed)),
        ("recorded to learned, worst", "mm"): 1e3 * max(float(m.max()) for m in missed),
        ("0.1 mm of noise moves the directrix", "mm"): _moved_by_noise(demonstrations, options, canal),
    }


def _moved_by_noise(demonstrations: list[Demonstration], options: LearningOptions, canal: CanalSurface) -> float:
    rng = np.random.default_rng(0)
    noisy = [
        Demonstration(d.position + 1e-4 * rng.normal(size=d.position.shape), d.orientation, d.time, d.name)
        for d in demonstrations
    ]
    other, u = learn_canal(noisy, options), np.linspace(0.0, 1.0, 400)
    a, b = (
        np.column_stack([np.interp(u, c.arc / c.length, column) for column in c.directrix.T]) for c in (canal, other)
    )
    return 1e3 * float(np.linalg.norm(a - b, axis=1).max())


def learning(case: str, sets: list[list[Demonstration]]) -> list[Row]:
    """The worst of all sets, for each way of learning."""
    rows = []
    for name, options in ways().items():
        found, failed = [], 0
        for demonstrations in sets:
            try:
                found.append(learned(demonstrations, options))
            except InputError:
                failed += 1
        rows.append(Row(case, name, "could not be learned", failed, "1"))
        rows += [Row(case, name, key[0], max(f[key] for f in found), key[1]) for key in found[0]]
    return rows


def travel(case: str, demonstrations: list[Demonstration]) -> list[Row]:
    """Figures of a canal, and of travelling it, by our rules and by the paper's."""
    canal = learn_canal(demonstrations)
    home = canal.home_disk
    rows = []
    for name, decay in (("ours", "leg"), ("the paper's", "paper")):
        options = NavigationOptions(decay=decay)
        state = NavigationState(disk=0.0, eta=1.0, leg=float(Leg.PICK_TO_HOME), anchor_eta=1.0)
        left = strategy_ratio(canal, state, float(home), options)
        rows.append(Row(case, name, "left of a correction from pick at home", 100 * left, "%"))
    ours, papers = disks_per_second(canal, NavigationOptions()), SAMPLES_PER_S
    for name, rate in (("ours", ours), ("the paper's", papers)):
        rows.append(Row(case, name, "a pass takes", (canal.n_disks - 1) / rate, "s"))
    rows.append(Row(case, "demonstrations", "a pass takes", float(np.mean([d.duration for d in demonstrations])), "s"))
    rows.append(Row(case, "ours", "a full diagonal stick, over a full straight one", 1.0, "1"))
    rows.append(Row(case, "the paper's", "a full diagonal stick, over a full straight one", math.sqrt(2.0), "1"))
    steps = np.abs(np.diff(canal.orientation_weights))
    rows.append(Row(case, "the paper's", "w_o jumps from disk to disk by up to", float(steps.max()), "1"))
    rows.append(Row(case, "ours", "w_o from disk to disk in a tick of 20 Hz", float(steps.max() * ours / 20.0), "1"))
    off = np.abs(np.sum((canal.demonstrations - canal.directrix) * canal.normals, axis=2))
    rows.append(Row(case, "both", "aligned points off their disk's plane", 1e3 * float(off.max()), "mm"))
    rows.append(Row(case, "both", "radius, least", 1e3 * float(canal.radii.min()), "mm"))
    return rows


def main(seeds: int = SEEDS) -> None:
    """Print the tables, and write them."""
    cases = {"recorded": recorded(), "laundry": shipped("laundry"), "relocation": shipped("relocation")}
    rows: list[Row] = []
    for case, demonstrations in cases.items():
        if demonstrations:
            rows += learning(case, [demonstrations]) + travel(f"travelling, {case}", demonstrations)
    if seeds:
        rows += learning(f"generated, worst of {seeds} seeds", [hard_demonstrations(seed) for seed in range(seeds)])
    print_table(rows)
    write_csv(OUTPUT, rows)


if __name__ == "__main__":
    main(int(sys.argv[sys.argv.index("--seeds") + 1]) if "--seeds" in sys.argv else SEEDS)
