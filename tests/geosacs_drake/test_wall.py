"""A wall across the canal: the robot stops at it, says so, does not drive on, and comes back."""

import numpy as np
import pytest

from canal.navigation.joystick import GRIPPER, JOYSTICK_SIZE, REVERSE, START
from diagrams.announcements import Event
from diagrams.scenario import load_scenario
from diagrams.shared_autonomy import build_shared_autonomy
from diagrams.station.lio_drive import ARM
from diagrams.teleop.joystick_recording import JoystickRecording
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate
from models import SCENARIOS

WALL = """<sdf version="1.9"><model name="wall"><link name="wall"><collision name="c">
<geometry><box><size>0.3 0.3 0.05</size></box></geometry></collision></link></model></sdf>"""


def thumb(*presses: tuple[float, int]) -> JoystickRecording:
    """Short presses at their times, and nothing after."""
    rows = [(0.0, np.zeros(JOYSTICK_SIZE))]
    for when, button in presses:
        rows += [(when, np.eye(JOYSTICK_SIZE)[button]), (when + 0.1, np.zeros(JOYSTICK_SIZE))]
    return JoystickRecording(np.array([t for t, _ in rows]), np.array([level for _, level in rows]))


@pytest.fixture(scope="module")
def walled(tmp_path_factory):
    """The relocation with a wall half-way to pick, its canal, and the disk at which the wall begins."""
    folder = tmp_path_factory.mktemp("walled")
    canal = prepare_canal(load_scenario("relocation"), RunOptions(headless=True))
    x, y, z = canal.directrix[canal.home_disk // 2] - [0.0, 0.0, 0.05]
    (folder / "wall.sdf").write_text(WALL)
    fixture = f"fixtures:\n  - {{name: wall, model: wall.sdf, position: [{x:.3f}, {y:.3f}, {z:.3f}]}}\n"
    text = (SCENARIOS / "relocation.yaml").read_text()
    (folder / "walled.yaml").write_text(text.replace("fixtures:\n", fixture, 1))
    return load_scenario(folder / "walled.yaml"), canal


def test_it_stops_at_a_wall_does_not_drive_on_and_comes_back(walled):
    scenario, canal = walled
    said = []
    # Start again, twice, and the gripper: none of them leads further in. Then back.
    presses = ((0.5, START), (9.0, START), (9.5, START), (10.0, GRIPPER), (13.0, REVERSE))
    system = build_shared_autonomy(scenario=scenario, canal=canal, operator=thumb(*presses), say=said.append)
    names = [i.name for i in scenario.items]
    station, pressing = system.station, []

    def watch(root):
        pressing.append(station.GetOutputPort("contact_forces").Eval(station.GetMyContextFromRoot(root)).copy())

    result = simulate(system, task="wall", seed=0, item_names=names, duration=15.0, watch=watch)
    np.testing.assert_array_equal(result.peak_forces, np.max(pressing, axis=0), "of every step of the plant")
    assert (result.peak_forces >= result.signals["contact_forces"].max(axis=0)).all()
    disk = result.signals["navigation_state"][:, 0]
    time = result.signals["time"]
    force = result.peak_forces[result.contact_pairs.index("lio-wall")]
    stood = disk[(time > 8.5) & (time < 13.0)]
    assert 0 < stood[0] < canal.home_disk, "it was on its way"
    assert np.ptp(stood) == 0
    assert scenario.monitor.force_limit_n < force < 1.3 * scenario.monitor.force_limit_n
    assert disk[-1] > stood[0] + 15, "the way back is free"
    first = next(a for a in said if a.event is Event.PRESSES)
    assert "presses on the wall" in first.text
    assert f"{first.force_n:.0f} N" in first.text
    assert [a.event for a in said].count(Event.IGNORED) == 2, "both starts"
    assert said[-1].event is Event.FREE
    assert result.signals["lio_state"][-1, ARM] < 0.3, "the gripper closed when told"
