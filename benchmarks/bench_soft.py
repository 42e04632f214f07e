"""Which time step, elements, contact approximation and solver settings for cloth: `make bench-soft`.

Each contender does three things. *carry*: the hand takes the towel from a floor, lifts it, holds it for 2 s and carries
it through a quarter turn to the door; slip is how far the nodes between the pads move in the hand. *rest*: three
clothes lie side by side for 2 s after they settled; energy must not grow and nothing may wander. *pile*: three clothes
fall into the drum on each other; how fast it still is while they do. Speeds are CPU time of the plant alone. Then, for
soft and rigid clothes, how far from each other they end with a time step and with half of it (`half_step`).
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.deformable_rig import CLOSED, OPEN, Rig, Setting
from benchmarks.half_step import apart
from benchmarks.table import Row, print_table, write_csv
from diagrams.deformable.contact import MARGIN
from diagrams.deformable.items import DeformableMaterial
from diagrams.deformable.laundry import make_shape

KINDS = ("sock", "tshirt", "towel")
PADS = 5
"""Nodes nearest to the TCP, whose mean tells the slip."""


def contenders() -> Iterator[tuple[str, str, Setting, int]]:
    """Group, name, setting and segments of the towel; the choice first in each group."""
    base, cloth = Setting(), DeformableMaterial()
    for step in (base.time_step, 0.002, 0.005, 0.01):
        yield "time step", f"{1e3 * step:g} ms", replace(base, time_step=step), 0
    for name in ("lagged", "similar", "sap"):
        yield "approximation", name, replace(base, approximation=name), 0
    for tolerance in (2e-4, 1e-4, 5e-4, 1e-3):
        yield "stiction tolerance", f"{tolerance:g} m/s", replace(base, stiction_tolerance=tolerance), 0
    for gradient in (3e7, 3e5, 3e6, 3e8):
        yield "contact gradient", f"{gradient:g} Pa/m", replace(base, gradient=gradient), 0
    for margin in (MARGIN, 0.0, 2e-3, 4e-3):
        yield "margin", f"{1e3 * margin:g} mm", replace(base, margin=margin), 0
    for stiffness in (8e3, 3e3, 2e4, 5e4):
        yield "stiffness", f"{stiffness:g} Pa", replace(base, material=replace(cloth, youngs_modulus=stiffness)), 0
    for damping in (0.05, 0.01, 0.2):
        yield "damping", f"{damping:g} s", replace(base, material=replace(cloth, stiffness_damping=damping)), 0
    for air in (5.0, 0.5, 2.0):
        yield "air", f"{air:g} 1/s", replace(base, material=replace(cloth, mass_damping=air)), 0
    for model in ("linear_corotated", "corotated", "neohookean"):
        yield "material model", model, replace(base, material=replace(cloth, model=model)), 0
    for segments in (5, 7, 12, 20):
        yield "elements", f"{12 * segments} tetrahedra", base, segments


def carry(setting: Setting, segments: int) -> Iterator[tuple[str, float, str]]:
    """Take, hold and turn the towel."""
    rig = Rig([("towel", make_shape("towel", segments=segments), [0.45, 0.0, 0.34], 0.0)], setting)
    rig.wait(0.6)
    x, y = rig.nodes(0).mean(axis=0)[:2]
    begin = time.process_time()
    rig.move([x, y, 0.33, 0.0, OPEN], 1.0)
    rig.move([x, y, 0.33, 0.0, CLOSED], 0.6)
    rig.move([x, y, 0.6, 0.0, CLOSED], 1.2)
    rig.wait(0.3)
    held = rig.nodes_in_hand(0)
    near = np.argsort(np.linalg.norm(held, axis=1))[:PADS]
    rig.wait(2.0)
    yield "slip in 2 s", _moved(rig, held, near), "mm"
    rig.move([0.0, 0.75, 0.55, np.pi / 2, CLOSED], 2.0)
    rig.wait(0.3)
    yield "slip in a carry", _moved(rig, held, near), "mm"
    yield "held", float(np.linalg.norm(rig.nodes_in_hand(0).mean(axis=0)) < 0.15), "1"
    yield "carry, real-time factor", 7.4 / (time.process_time() - begin), "1"


def _moved(rig: Rig, held: np.ndarray, near: np.ndarray) -> float:
    return 1e3 * float(np.linalg.norm((rig.nodes_in_hand(0) - held)[near].mean(axis=0)))


def rest(setting: Setting, segments: int) -> Iterator[tuple[str, float, str]]:
    """Three clothes side by side."""
    shapes = {k: make_shape(k, segments=segments if k == "towel" else 0) for k in KINDS}
    rig = Rig([(k, shapes[k], [0.45, 0.17 * (i - 1), 0.345], 0.0) for i, k in enumerate(KINDS)], setting)
    rig.wait(1.0)
    starts = [rig.nodes(k).mean(axis=0) for k in range(3)]
    energies = []
    begin = time.process_time()
    for _ in range(20):
        rig.wait(0.1)
        energies.append(rig.kinetic_energy())
    yield "rest, real-time factor", 2.0 / (time.process_time() - begin), "1"
    yield "greatest kinetic energy at rest", 1e6 * max(energies), "uJ"
    drift = max(float(np.linalg.norm(rig.nodes(k).mean(axis=0) - p)) for k, p in enumerate(starts))
    yield "drift in 2 s", 1e3 * drift, "mm"


def pile(setting: Setting, segments: int) -> Iterator[tuple[str, float, str]]:
    """Three clothes on each other in the drum."""
    order = ("tshirt", "towel", "sock")
    shapes = [make_shape(k, segments=segments if k == "towel" else 0) for k in order]
    heights, yaws = (0.36, 0.46, 0.54), (0.4, 0.1, 1.2)
    rig = Rig([(order[i], shapes[i], [0.0, 1.0, heights[i]], yaws[i]) for i in range(3)], setting)
    factors, depths = [], []
    for _ in range(4):
        spent = 0.0
        for _ in range(50):
            begin = time.process_time()
            rig.wait(0.01)
            spent += time.process_time() - begin
            depths.append(max(rig.depth(k) for k in range(3)))
        factors.append(0.5 / spent)
    yield "pile, worst half second", min(factors), "1"
    yield "pile, deepest node", 1e3 * max(depths), "mm"
    yield "pile, fastest node after 2 s", max(rig.speed(k) for k in range(3)), "m/s"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="run the groups whose name contains this")
    parser.add_argument("--output", type=Path, default=Path("build/bench-soft.csv"))
    arguments = parser.parse_args()
    rows: list[Row] = []
    done: dict[tuple[Setting, int], list[tuple[str, float, str]]] = {}
    for group, name, setting, segments in contenders():
        if arguments.only not in group:
            continue
        key = (setting, 0 if segments == 5 else segments)
        if key not in done:
            try:
                done[key] = [m for task in (carry, rest, pile) for m in task(setting, key[1])]
            except RuntimeError as error:  # a solver that gives up is a result
                print(f"{group} {name}: {' '.join(str(error).split())[:100]}")
                done[key] = [("held", 0.0, "1")]
        rows += [Row(group, name, metric, value, unit) for metric, value, unit in done[key]]
        print(f"{group}: {name} done", flush=True)
    if arguments.only in "half step":
        for kind in KINDS:
            for what, deformable in (("soft", True), ("rigid", False)):
                rows.append(
                    Row("half step", f"{what} {kind}", "ends apart", 1e3 * apart(kind, deformable=deformable), "mm")
                )
                print(f"half step: {what} {kind} done", flush=True)
    print_table(rows)
    write_csv(arguments.output, rows)


if __name__ == "__main__":
    main()
