"""What learning and navigating a canal costs, and what the alignment's rivals cost for the same task.

    make bench-canal

The alignment is dynamic time warping of two demonstrations, resampled to the same points, in the same band. Rivals:
dtaidistance (C) and dtw-python (C). How good canals are: `python -m benchmarks.canal_quality`.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.canal_quality import RECORDED, recorded, shipped
from benchmarks.table import Row, print_table, write_csv
from canal.learning.learn import N_POINTS, learn_canal
from canal.learning.trimming import trim
from canal.learning.warping import warping_path
from canal.learning_options import BAND
from canal.navigation import initial_state, step
from canal.navigation.joystick import JOYSTICK_SIZE
from canal.surface import CanalSurface
from models import MODELS

OUTPUT = Path(__file__).parents[1] / "build" / "bench-canal.csv"
_LARGE = (10, 10_000)
_ROUNDS = 9

# A process of its own: imports, just-in-time compilation and memory count.
_FRESH = """
import resource, sys, time
start, busy = time.perf_counter(), 0.0
import numpy as np
from canal.demonstration import Demonstration, load_demonstration
from canal.learning import learn_canal
n, samples = int(sys.argv[1]), int(sys.argv[2])
if n:
    rng = np.random.default_rng(0)
    u = np.linspace(0, 1, samples)
    def one(k):
        wander = sum(0.004 * np.sin(2 * np.pi * f * u[:, None] * 20 + rng.uniform(0, 6, 3)) for f in (0.5, 1.1))
        path = np.column_stack([0.35 + 0.08 * np.sin(np.pi * u), u - 0.5, 0.5 + 0.35 * np.sin(np.pi * u) ** 0.5])
        spread = 0.12 * np.abs(2 * u - 1)[:, None] * np.array([np.cos(k), np.sin(k), 0.2])
        return Demonstration(path + wander + spread + 1e-4 * rng.normal(size=path.shape),
                             np.tile([1.0, 0, 0, 0], (samples, 1)), np.arange(samples) * 0.005)
    demonstrations = [one(k) for k in range(n)]
    start, busy = time.perf_counter(), time.process_time()
else:
    demonstrations = [load_demonstration(path) for path in sys.argv[3:]]
canal = learn_canal(demonstrations)
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
print(time.perf_counter() - start, time.process_time() - busy, peak)
"""


def main() -> None:
    """Measure, print, write."""
    demonstrations = recorded() or shipped("relocation")
    name = "two recorded demonstrations" if recorded() else "two shipped demonstrations"
    rows = [*learning(name, demonstrations), *navigation(learn_canal(demonstrations)), *alignment(demonstrations)]
    print_table(rows)
    write_csv(OUTPUT, rows)
    print(f"\nwritten to {OUTPUT}")


def learning(name: str, demonstrations: list) -> list[Row]:
    """Warm, in a fresh process, and on much data."""
    files = [str(path) for path in _files()]
    fresh = min(_fresh(0, 0, *files) for _ in range(3))
    wall, busy, memory = _fresh(*_LARGE)
    case = f"learning, {_LARGE[0]} demonstrations × {_LARGE[1]} samples, fresh process without imports"
    return [
        Row(f"learning, {name}", "geosacs", "warm", 1e3 * _median(lambda: learn_canal(demonstrations)), "ms"),
        Row(f"learning, {name}", "geosacs", "fresh process, imports included", 1e3 * fresh[0], "ms"),
        Row(f"learning, {name}", "geosacs", "fresh process, processor time", 1e3 * fresh[1], "ms"),
        Row(case, "geosacs", "time", 1e3 * wall, "ms"),
        Row(case, "geosacs", "processor time", 1e3 * busy, "ms"),
        Row(case, "geosacs", "peak memory", memory, "MB"),
    ]


def navigation(canal: CanalSurface) -> list[Row]:
    """One step of travel and of correction, and what the loop asks of a surface."""
    going = np.zeros(JOYSTICK_SIZE)
    going[4] = 1.0
    state = step(canal, initial_state(canal), going, 0.01)
    pushing = np.array([0.5, 0.3, 0, 0, 1.0, 0])
    p, disk = canal.point(50.3, 0.4, 1.0), 50.3
    calls: dict[str, Callable] = {
        "step of travel": lambda: step(canal, state, going, 0.01),
        "step of correction": lambda: step(canal, state, pushing, 0.01),
        "point": lambda: canal.point(disk, 0.4, 1.0),
        "disk_coordinates": lambda: canal.disk_coordinates(disk, p),
        "axes": lambda: canal.axes(disk),
        "orientation": lambda: canal.orientation(disk),
    }
    return [Row("navigation", "geosacs", name, 1e6 * _median(call, 2000), "us") for name, call in calls.items()]


def alignment(demonstrations: list) -> list[Row]:
    """Warping paths of the same curves in the same band: time, and the mean distance of what is paired."""
    a, b = (trim(d, N_POINTS).position for d in demonstrations[:2])
    window = round(BAND * N_POINTS)
    contenders: dict[str, Callable[[], np.ndarray]] = {
        "geosacs (tslearn, uncompiled)": lambda: warping_path(a, b, BAND),
    }
    try:
        from dtaidistance import dtw_ndim

        contenders["dtaidistance"] = lambda: np.array(dtw_ndim.warping_path(a, b, window=window + 1, use_c=True))
    except ImportError:
        print("dtaidistance is not installed: pip install -e .[bench]", file=sys.stderr)
    try:
        import dtw

        def dtw_python() -> np.ndarray:
            found = dtw.dtw(
                a, b, window_type="sakoechiba", window_args={"window_size": window}, step_pattern="symmetric1"
            )
            return np.column_stack([found.index1, found.index2])

        contenders["dtw-python"] = dtw_python
    except ImportError:
        print("dtw-python is not installed: pip install -e .[bench]", file=sys.stderr)
    rows = []
    for name, path in contenders.items():
        pairs = path()
        apart = np.linalg.norm(a[pairs[:, 0]] - b[pairs[:, 1]], axis=1)
        rows += [
            Row("alignment", name, "warm", 1e3 * _median(path), "ms"),
            Row("alignment", name, "summed squared distance", float(np.sum(apart**2)), "m2"),
            Row("alignment", name, "mean distance of pairs", 1e3 * float(apart.mean()), "mm"),
        ]
    return rows


def _files() -> list[Path]:
    return sorted(RECORDED.glob("*.npz")) or sorted((MODELS / "demonstrations").glob("relocation_*.npz"))


def _fresh(n: int, samples: int, *files: str) -> tuple[float, float, float]:
    """Seconds, processor seconds and MB of a process of its own."""
    command = [sys.executable, "-c", _FRESH, str(n), str(samples), *files]
    seconds, busy, megabytes = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    return float(seconds), float(busy), float(megabytes)


def _median(call: Callable[[], object], rounds: int = _ROUNDS) -> float:
    """Median seconds of a call, after one for warming up."""
    call()
    seconds = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds)


if __name__ == "__main__":
    main()
