"""One's own recordings do the task: a scene is fitted to them, or a line says why the given one does not fit."""

import json
from dataclasses import replace

import numpy as np
import pytest

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.support_planes import dips
from canal.surface_file import save_canal
from diagrams.scenario import load_scenario, shipped_scenarios
from geosacs_drake.prepare_canal import prepare_canal, prepare_task
from geosacs_drake.run import main
from geosacs_drake.run_options import RunOptions
from models import MODELS

TABLES = [MODELS / "demonstrations" / f"tables_{k}.npz" for k in (1, 2)]


def run(capfd, *arguments, task="relocation") -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as left:
        main(task, [str(a) for a in arguments])
    out, err = capfd.readouterr()
    return left.value.code, out, err


def test_a_pair_as_a_person_records_it_carries_apple_cup_and_cube(tmp_path, capfd):
    summary = tmp_path / "s.json"
    code, out, err = run(capfd, "--headless", "--demos", *TABLES, "--seed", 1, "--summary", summary)
    assert code == 0, out + err
    assert "scene fitted to the canal: tables of 0.4" in err
    data = json.loads(summary.read_text())
    assert data["success"]
    assert [item["name"] for item in data["items"] if item["placed"]] == ["apple", "cup", "cube"]
    assert data["max_contact_force_n"]["lio-table"] < 140, "ISO/TS 15066, quasi-static, hand"


@pytest.mark.parametrize(
    ("task", "says"), [("relocation", "mm (at most 30) too low for its p"), ("laundry", "beside the reach")]
)
def test_a_scenario_that_the_canal_does_not_lead_to_is_one_line_and_status_2(task, says, capfd):
    code, out, err = run(capfd, "--headless", "--demos", *TABLES, "--scenario", task, task=task)
    assert code == 2
    assert out == ""
    (line,) = [line for line in err.splitlines() if line.startswith(f"run_{task}: ")]
    assert says in line
    assert "leave" in line or "without --scenario" in line


def test_a_canal_shown_too_fast_is_travelled_more_slowly_with_a_word_before_the_start(tmp_path, capfd):
    canal = replace(prepare_canal(load_scenario("relocation"), RunOptions()), moving_time_s=0.5, support_planes=())
    save_canal(tmp_path / "fast.npz", canal)
    log = tmp_path / "l.npz"
    code, _, err = run(capfd, "--headless", "--canal", tmp_path / "fast.npz", "--duration", 8, "--log", log)
    assert code == 1
    assert "to travel the canal in 0.5 s would take" in err
    with np.load(log) as signals:
        ticks = np.diff(signals["time"])
        moved = np.abs(np.diff(signals["q_command"], axis=0)) / ticks[:, None]
        assert moved.max() <= np.radians(95.0) + 1e-6
        assert np.percentile(moved.max(axis=1), 99) < 0.97 * np.radians(95.0), "travel leaves the joints some room"


@pytest.mark.parametrize("name", ["relocation", "laundry"])
def test_a_canal_from_a_file_keeps_the_scenarios_planes(name, tmp_path):
    scenario = load_scenario(name)
    learned = prepare_canal(scenario, RunOptions())
    bare = load_scenario(name)
    bare.support_planes = []
    save_canal(tmp_path / "bare.npz", prepare_canal(bare, RunOptions()))
    loaded = prepare_canal(scenario, RunOptions(canal=tmp_path / "bare.npz"))
    assert loaded.support_planes == learned.support_planes != ()
    np.testing.assert_array_equal(loaded.normals, learned.normals)
    np.testing.assert_array_equal(loaded.x_axes, learned.x_axes)
    assert np.isclose(np.abs(loaded.normals[0] @ loaded.support_planes[0].normal), 1.0), "the paper's refinement"


@pytest.mark.parametrize("name", shipped_scenarios())
def test_every_shipped_scenario_refines_its_canal_at_a_surface(name):
    scenario = load_scenario(name)
    canal = prepare_canal(scenario, RunOptions())
    plane = scenario.support_planes[0]
    assert np.allclose(canal.normals[0], plane.normal, atol=1e-9), "the first disk is level with it"
    scenario.support_planes = []
    as_shown = prepare_canal(scenario, RunOptions())
    assert not np.allclose(as_shown.normals[0], plane.normal, atol=1e-3)
    assert dips(as_shown.directrix, as_shown.normals, as_shown.radii, plane).max() > 0, "as shown, a disk dips into it"
    assert dips(canal.directrix, canal.normals, canal.radii, plane).max() <= 1e-9


def test_a_canal_that_passes_below_the_scenarios_plane_is_refused(tmp_path, capfd):
    save_canal(tmp_path / "low.npz", prepare_canal(load_scenario("laundry"), RunOptions()))
    code, _, err = run(capfd, "--headless", "--canal", tmp_path / "low.npz", "--scenario", "relocation")
    assert code == 2
    assert "beyond the support plane" in err.splitlines()[-1]


def test_demonstrations_and_the_canal_learned_from_them_get_the_same_scene(tmp_path):
    save_canal(tmp_path / "c.npz", learn_canal([load_demonstration(path) for path in TABLES]))
    one, canal = prepare_task(load_scenario("relocation"), RunOptions(demos=tuple(TABLES)))
    other, loaded = prepare_task(load_scenario("relocation"), RunOptions(canal=tmp_path / "c.npz"))
    assert one == other
    np.testing.assert_array_equal(canal.normals, loaded.normals)
