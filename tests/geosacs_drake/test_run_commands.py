"""The commands as a person types them: a few simulated seconds, their files, and every way to get them wrong."""

import json
import socket

import numpy as np
import pytest

from canal.demonstration import Demonstration, save_demonstration
from canal.learning import learn_canal
from canal.surface_file import save_canal
from diagrams.scenario import load_scenario
from diagrams.station.lio_ik import make_lio_solver
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.results.summary import WALL_CLOCK_KEYS
from geosacs_drake.run import main
from geosacs_drake.run_options import RunOptions
from models import MODELS

SUMMARY_KEYS = {
    "task", "success", "reason", "seed", "items", "task_time_s", "correction_time_s", "correction_share", "corrections",
    "correction_distance_m", "measured_correction_distance_m", "backtracks", "ik", "max_contact_force_n",
    "max_penetration_m", "tcp_error_m", "realtime_factor", "realtime_factor_worst_half_second", "version",
    "scenario", "operator", "items_kind", "delay_ms", "peak_joint_speed_share",
}  # fmt: skip


def run(capfd, *arguments, task="laundry") -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as left:
        main(task, [str(a) for a in arguments])
    out, err = capfd.readouterr()
    return left.value.code, out, err


def without_wall_clock(summary: dict) -> dict:
    summary = json.loads(json.dumps(summary))
    for key in WALL_CLOCK_KEYS:
        *path, last = key.split(".")
        place = summary
        for step in path:
            place = place[step]
        del place[last]
    return summary


@pytest.mark.parametrize("task", ["laundry", "relocation"])
def test_short_run_is_not_done_and_writes_its_files(task, tmp_path, capfd):
    summary, log = tmp_path / "s.json", tmp_path / "l.npz"
    code, out, _ = run(
        capfd, "--headless", "--items", "rigid", "--duration", 3, "--summary", summary, "--log", log, task=task
    )
    assert code == 1
    assert "not done, time is up" in out
    data = json.loads(summary.read_text())
    assert set(data) == SUMMARY_KEYS
    assert data["task"] == task
    assert not data["success"]
    assert len(data["items"]) == 3
    assert data["ik"]["bound_violations"] == 0
    with np.load(log, allow_pickle=False) as signals:
        ticks = len(signals["time"])
        assert ticks == pytest.approx(181, abs=2)
        for name, size in (("X_BT_desired", 7), ("X_BT", 7), ("q_command", 6), ("q", 6), ("stick", 2), ("buttons", 4)):
            assert signals[name].shape == (ticks, size)
        for name in ("disk", "eta", "phi", "leg", "gripper", "ik_status"):
            assert signals[name].shape == (ticks,)
        assert signals["events"][0] == "start"
    assert not list(tmp_path.glob(".*")), "no temporary file is left"


def test_same_seed_same_run_and_a_log_replays(tmp_path, capfd):
    paths = [tmp_path / f"{i}.json" for i in range(4)]
    log, other_log, replayed = (tmp_path / f"{name}.npz" for name in ("l", "o", "r"))
    common = ("--headless", "--duration", 6, "--items", "rigid")
    run(capfd, *common, "--seed", 5, "--summary", paths[0], "--log", log)
    run(capfd, *common, "--seed", 5, "--summary", paths[1])
    run(capfd, *common, "--seed", 6, "--summary", paths[2], "--log", other_log)
    run(capfd, *common, "--seed", 5, "--operator", log, "--log", replayed, "--summary", paths[3])
    first, second, _, replay = (without_wall_clock(json.loads(p.read_text())) for p in paths)
    assert (first.pop("operator"), second.pop("operator"), replay.pop("operator")) == ("simulated",) * 2 + (str(log),)
    assert first == second == replay
    with np.load(log) as a, np.load(replayed) as b, np.load(other_log) as other:
        assert not np.array_equal(a["item_poses"], other["item_poses"])
        for name in set(a.files) - {"metadata"}:
            np.testing.assert_array_equal(a[name], b[name], err_msg=name)


def test_loads_the_machine(tmp_path, capfd):
    code, out, _ = run(capfd, "--headless", "--items", "rigid", "--seed", 0, "--summary", tmp_path / "s.json")
    data = json.loads((tmp_path / "s.json").read_text())
    assert code == 0, out
    assert data["success"]
    assert all(item["placed"] and item["time_s"] > 0 for item in data["items"])
    assert data["max_contact_force_n"]["lio-machine"] < 140, "ISO/TS 15066, quasi-static, hand"


def demonstration(side: float, count: int = 100) -> Demonstration:
    t = np.linspace(0, 1, count)
    position = np.column_stack([0.3 + side + 0 * t, t - 0.5, 0.7 + 0.1 * np.sin(np.pi * t)])
    return Demonstration(position, np.tile([0.5, -0.5, 0.5, 0.5], (count, 1)), None, str(side))


@pytest.fixture
def files(tmp_path):
    """Files as they go wrong, by name."""
    good = demonstration(0.0)
    save_demonstration(tmp_path / "good.npz", good)
    save_demonstration(tmp_path / "other.npz", demonstration(0.05))
    (tmp_path / "empty.npz").touch()
    (tmp_path / "text.npz").write_text("not an archive")
    (tmp_path / "wrong.yaml").write_text("taks: laundry\n")
    (tmp_path / "broken.yaml").write_text("task: [laundry\n")
    p, q = np.array(good.position), np.array(good.orientation)
    np.savez(tmp_path / "keyless.npz", pos=p)
    np.savez(tmp_path / "nan.npz", position=np.where(p > 0.7, np.nan, p), orientation=q)
    np.savez(tmp_path / "one.npz", position=p[:1], orientation=q[:1])
    np.savez(tmp_path / "zero.npz", position=p, orientation=0 * q)
    np.savez(tmp_path / "pickled.npz", position=np.array([{}], dtype=object), orientation=q)
    save_demonstration(tmp_path / "backwards.npz", Demonstration(p[::-1], q, None, "backwards"))
    far = Demonstration(p + [5.0, 0, 0], q, None, "far")
    save_canal(tmp_path / "far.npz", learn_canal([far, far]))
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--demos", "nowhere.npz", "good.npz"], "nowhere.npz"),
        (["--demos", "empty.npz", "good.npz"], "empty"),
        (["--demos", "text.npz", "good.npz"], "text.npz"),
        (["--demos", "keyless.npz", "good.npz"], "position"),
        (["--demos", "nan.npz", "good.npz"], "not finite"),
        (["--demos", "one.npz", "good.npz"], "1 samples"),
        (["--demos", "zero.npz", "good.npz"], "norm"),
        (["--demos", "pickled.npz", "good.npz"], "pickles"),
        (["--demos", "backwards.npz", "good.npz"], "opposite"),
        (["--demos", "good.npz"], "at least two"),
        (["--canal", "nowhere.npz"], "nowhere.npz"),
        (["--canal", "good.npz"], "good.npz"),
        (["--canal", "far.npz"], "reach"),
        (["--canal", "good.npz", "--demos", "good.npz", "other.npz"], "exclude"),
        (["--scenario", "nowhere.yaml"], "nowhere.yaml"),
        (["--scenario", "wrong.yaml"], "taks"),
        (["--scenario", "broken.yaml"], "broken.yaml"),
        (["--operator", "nowhere.csv"], "nowhere.csv"),
        (["--operator", "good.npz"], "good.npz"),
        (["--operator", "gamepad"], "browser"),
        (["--seed", "-1"], "--seed"),
        (["--seed", "many"], "--seed"),
        (["--duration", "0"], "--duration"),
        (["--realtime-rate", "-1"], "--realtime-rate"),
        (["--items", "wet"], "wet"),
        (["--colour", "blue"], "--colour"),
        (["--summary", "nowhere/s.json"], "nowhere"),
    ],
)
def test_bad_input_is_one_clear_line_and_status_2(arguments, says, files, monkeypatch, capfd):
    monkeypatch.chdir(files)
    code, out, err = run(capfd, "--headless", "--duration", 1, *arguments)
    assert code == 2, out + err
    lines = [line for line in err.splitlines() if line.startswith("run_laundry: ")]
    assert len(lines) == 1, err
    assert says in lines[0]
    assert "Traceback" not in err
    assert out == ""


def test_a_taken_port_is_one_clear_line_and_status_2(capfd):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        code, _, err = run(capfd, "--duration", 1, "--port", port)
    assert code == 2
    assert str(port) in err.splitlines()[-1]


def test_a_canal_and_its_demonstrations_run_alike(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    demos = [MODELS / "demonstrations" / f"relocation_{i}.npz" for i in (1, 2)]
    scenario = load_scenario("relocation")
    save_canal("c.npz", prepare_canal(scenario, RunOptions(demos=tuple(demos))))
    common = ("--headless", "--duration", 2)
    run(capfd, *common, "--canal", "c.npz", "--log", "a.npz", task="relocation")
    run(capfd, *common, "--demos", *demos, "--log", "b.npz", task="relocation")
    with np.load("a.npz") as a, np.load("b.npz") as b:
        np.testing.assert_array_equal(a["q"], b["q"])


def test_a_run_with_collision_avoidance_keeps_its_distance(capfd, tmp_path):
    log = tmp_path / "log.npz"
    code, _, _ = run(
        capfd, "--headless", "--items", "rigid", "--scenario", "laundry-guarded", "--duration", 4, "--log", log
    )
    assert code == 1, "time is up before anything is placed"
    with np.load(log) as signals:
        commands = signals["q_command"]
    scenario = load_scenario("laundry-guarded")
    solver = make_lio_solver(scenario, scenario.ik)
    for q in commands[:: len(commands) // 20]:
        solver.kinematics.set(q)
        assert solver.clearance.near(0.0).distances.min(initial=1.0) >= scenario.ik.collision_avoidance.margin - 1e-6
