"""A log says what its run was made from, and replays with nothing else told, bit for bit."""

import json

import numpy as np
import pytest

from canal.errors import InputError
from canal.files import write_npz
from canal.options import read_options
from diagrams.scenario import load_scenario, shipped_scenarios
from geosacs_drake.replay import Metadata, load_origin
from geosacs_drake.run import main
from models import SCENARIOS

PERSON = """t,k_x,k_y,gripper,reverse,start,stop
0.2,0,0,0,0,1,0
0.3,0,0,0,0,0,0
1.0,0.7,-0.5,0,0,0,0
1.3,0,0,0,0,0,0
1.5,0,0,0,0,1,0
1.6,0,0,0,0,0,0
1.8,-0.4,0.9,0,0,0,0
2.0,0,0,0,0,0,0
2.2,0,0,0,0,1,0
2.3,0,0,0,0,0,0
2.6,0,0,0,0,0,1
2.7,0,0,0,0,0,0
3.2,0,0,0,1,1,0
3.3,0,0,0,0,0,0
9.0,0,0,0,0,0,0
"""
"""A correction, a pause with another in it, a stop, and back."""


def run(capfd, *arguments, task="relocation") -> tuple[int, str]:
    with pytest.raises(SystemExit) as left:
        main(task, ["--headless", *map(str, arguments)])
    return left.value.code, capfd.readouterr().err


def same(a, b):
    with np.load(a) as first, np.load(b) as second:
        assert set(first.files) == set(second.files)
        for name in set(first.files) - {"metadata"}:
            np.testing.assert_array_equal(first[name], second[name], err_msg=name)


@pytest.mark.parametrize("rate", [17, 60])
def test_a_persons_run_replays_whatever_it_was_made_from(rate, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    with open("s.yaml", "w") as file:
        file.write((SCENARIOS / "relocation.yaml").read_text() + f"\ncontrol_rate_hz: {rate}\n")
    with open("person.csv", "w") as file:
        file.write(PERSON)
    run(capfd, "--scenario", "s.yaml", "--seed", 4, "--duration", 4.5, "--operator", "person.csv", "--log", "a.npz")
    with np.load("a.npz") as log:
        assert {"start", "pause", "stop", "reverse", "correction"} <= set(log["events"])
        assert log["person_in_charge"][-1] == 1
        metadata = json.loads(str(log["metadata"]))
    expected = {"seed": 4, "operator": "person.csv", "items_kind": "rigid", "scenario_name": "s.yaml", "duration": 4.5}
    assert expected.items() <= metadata.items()
    assert metadata["options"]["scenario"] == "s.yaml"
    assert len(metadata["scenario"]["items"]) == 3
    (tmp_path / "s.yaml").unlink()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    code, said = run(capfd, "--operator", "../a.npz", "--log", "b.npz")
    assert code == 1
    assert "replayed" not in said
    same("../a.npz", "b.npz")


def test_a_replay_that_is_told_otherwise_says_so(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    run(capfd, "--seed", 2, "--duration", 0.5, "--log", "a.npz")
    _, said = run(capfd, "--operator", "a.npz", "--seed", 3)
    assert "a.npz is replayed with seed 3 instead of 2" in said
    _, said = run(capfd, "--operator", "a.npz", "--scenario", "relocation-far")
    assert "a.npz is replayed with another scenario" in said
    _, said = run(capfd, "--operator", "a.npz", task="laundry")
    assert "a.npz is of a relocation; that is replayed" in said
    _, said = run(capfd, "--operator", "a.npz", "--seed", 2, "--scenario", "relocation")
    assert "replayed" not in said


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_scenario_is_the_same_in_a_log(name):
    scenario = load_scenario(name)
    metadata = Metadata(
        version="0", task=scenario.task, scenario_name=name, scenario=scenario, items_kind="rigid",
        operator="simulated", seed=0, duration=1.0, options={},
    )  # fmt: skip
    again = read_options(Metadata, json.loads(metadata.to_json()))
    assert again.scenario == scenario


@pytest.mark.parametrize("metadata", ["{", "[]", '{"seed": 1}', "nul", "[" * 100_000])
def test_metadata_that_cannot_be_used(metadata, tmp_path):
    path = tmp_path / "l.npz"
    write_npz(path, metadata=np.array(metadata))
    with pytest.raises(InputError, match=r"l\.npz.*a log as --log writes it"):
        load_origin(str(path))


def test_models_of_a_log_are_looked_at(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    run(capfd, "--duration", 0.1, "--log", "a.npz")
    with np.load("a.npz") as log:
        arrays = dict(log)
    metadata = json.loads(str(arrays["metadata"]))
    metadata["scenario"]["fixtures"][0]["model"] = "nowhere"
    write_npz(tmp_path / "b.npz", **(arrays | {"metadata": np.array(json.dumps(metadata))}))
    code, said = run(capfd, "--operator", "b.npz")
    assert code == 2
    assert "fixtures[0].model: 'nowhere' does not exist" in said
