"""A solver that fails ends a run in our words, with its files whole; and what was built for the run goes with it."""

import gc
import json
import re
import weakref

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

import geosacs_drake.simulate
from diagrams.scenario import load_scenario
from diagrams.shared_autonomy import build_shared_autonomy
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run import main
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate

DRAKES_WORDS = (
    "The SAP solver failed to converge at simulation time = 1.5. Reasons for divergence and possible solutions "
    "include:\n  1. Externally applied actuation values diverged due to external reasons to the solver. Revise your "
    "control logic.\n  5. Some other cause. You may want to use Stack Overflow (#drake tag) to request some assistance."
)


class FailingSimulator:
    """Drake's, whose third half second does not converge."""

    def __init__(self, diagram) -> None:
        self._simulator = Simulator(diagram)

    def __getattr__(self, name):
        return getattr(self._simulator, name)

    def AdvanceTo(self, boundary_time):
        if boundary_time > 1.2:
            raise RuntimeError(DRAKES_WORDS)
        return self._simulator.AdvanceTo(boundary_time)


def test_a_solver_that_fails_ends_the_run_in_our_words_with_whole_files(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(geosacs_drake.simulate, "Simulator", FailingSimulator)
    summary, log = tmp_path / "s.json", tmp_path / "l.npz"
    with pytest.raises(SystemExit) as left:
        main("relocation", ["--headless", "--summary", str(summary), "--log", str(log)])
    out, err = capfd.readouterr()
    assert left.value.code != 0
    data = json.loads(summary.read_text())
    assert not data["success"]
    assert re.fullmatch(
        r"the contact solver did not converge at 1\.000 s \(leg home_to_pick, disk \d+\.\d, [a-z ]+, gripper open, "
        r"in the hand: nothing, awake: robot\)",
        data["reason"],
    )
    assert data["failure"].startswith("The SAP solver failed to converge")
    said = out + err
    assert data["reason"] in said
    assert "its files hold what was measured until then" in said
    assert "Stack Overflow" not in said
    assert "Traceback" not in said
    with np.load(log, allow_pickle=False) as signals:
        assert signals["time"][-1] == pytest.approx(1.0, abs=0.03)
    assert not list(tmp_path.glob(".*")), "no temporary file is left"


def test_a_run_that_is_over_is_collected():
    """Five megabytes a run stayed: a collection does not look through what was frozen, ever again."""
    scenario = load_scenario("relocation")
    system = build_shared_autonomy(scenario=scenario, canal=prepare_canal(scenario, RunOptions()))
    simulate(system, task="relocation", seed=0, item_names=[i.name for i in scenario.items], duration=0.1)
    left = [weakref.ref(part) for part in (system.diagram, system.station.plant, system.ik, system.monitor)]
    del system
    gc.collect()
    assert [reference() for reference in left] == [None] * 4
