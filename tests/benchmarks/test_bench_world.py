"""What the benchmark of whole runs sees."""

import numpy as np
import pytest

from benchmarks.bench_world import Watch
from diagrams.scenario import load_scenario, with_items
from diagrams.shared_autonomy import build_shared_autonomy
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate


def test_a_watch_looks_at_every_tick_and_at_every_half_second():
    scenario = with_items(load_scenario("laundry"), "rigid")
    canal = prepare_canal(scenario, RunOptions(headless=True))
    system = build_shared_autonomy(scenario=scenario, canal=canal, seed=0)
    watch = Watch(system)
    names = [item.name for item in scenario.items]
    result = simulate(system, task="laundry", seed=0, item_names=names, duration=5.0, watch=watch)
    assert len(watch.penetration) == pytest.approx(500, abs=2)
    assert len(watch.factors) == 10
    assert max(watch.penetration) > 0.95 * result.max_penetration_m, "it looks more often than the monitor"
    assert np.isfinite(list(watch.slip.values())).all()
