"""A run with its console: a person takes over, hands back to the simulated operator, and ends it with a tab open."""

import json
import signal

import numpy as np
import pytest
from running import running
from waiting import wait_until


@pytest.mark.browser
def test_a_person_watches_steers_hands_back_and_ends_the_run(page, tmp_path):
    log, summary = tmp_path / "log.npz", tmp_path / "summary.json"
    files = ("--log", str(log), "--summary", str(summary))
    with running("geosacs_drake.run_laundry", "--items", "rigid", "--port", "0", *files) as command:
        page.set_viewport_size({"width": 1280, "height": 800})
        page.goto(command.address())
        headline = page.locator("#headline")
        wait_until(lambda: headline.inner_text() == "Ready", "the run to be ready", 60)
        page.get_by_role("button", name="Watch").click()
        wait_until(lambda: headline.inner_text() == "Going to pick", "the simulated operator", 30)
        scene = page.frames[1]
        children = "Object.keys(viewer.scene_tree.find(['drake']).children)"
        wait_until(lambda: {"canal", "trail"} <= set(scene.evaluate(children)), "the picture", 60)
        disk = page.get_by_role("progressbar")
        page.keyboard.down("ArrowRight")
        wait_until(lambda: headline.inner_text() == "Steering", "the person's correction", 30)
        assert "You move it" in page.inner_text("#sentence")
        stands = disk.get_attribute("aria-valuenow")
        page.wait_for_timeout(1000)
        assert disk.get_attribute("aria-valuenow") == stands
        page.keyboard.up("ArrowRight")
        wait_until(lambda: headline.inner_text() == "Going to pick", "the travel", 30)
        page.get_by_role("button", name="Hand back").click()
        page.get_by_role("button", name="Take control").wait_for()
        page.wait_for_timeout(1500)
        command.process.send_signal(signal.SIGINT)
        wait_until(lambda: command.process.poll() is not None, "the command to leave", 60)
        assert command.process.returncode == 1, command.output
        page.get_by_role("dialog", name="Ended").wait_for()
    assert json.loads(summary.read_text())["success"] is False
    with np.load(log) as signals:
        person, stick = signals["joystick_in_charge"] > 0.5, signals["joystick"][:, :2]
        assert np.flatnonzero(np.diff(person[:-1].astype(int))).size == 2, "taken once, handed back once"
        # A second of a held arrow, and nothing but that arrow.
        steered = stick[person]
        assert (steered[:, 0] > 0).sum() >= 20
        assert not steered[:, 1].any()
        assert not signals["joystick"][person, 2:].any()
