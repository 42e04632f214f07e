"""A run with its console: a person takes over, hands back to the simulated operator, and ends it with a tab open."""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from running import running
from waiting import wait_until

OPTIONS = ("--items", "rigid", "--mapping", "axes", "--port", "0")


@pytest.mark.browser
def test_a_person_watches_steers_hands_back_and_ends_the_run(page, tmp_path):
    log, summary = tmp_path / "log.npz", tmp_path / "summary.json"
    files = ("--log", str(log), "--summary", str(summary))
    with running("geosacs_drake.run_laundry", *OPTIONS, *files) as command:
        page.set_viewport_size({"width": 1280, "height": 800})
        page.goto(command.address())
        headline = page.locator("#headline")
        wait_until(lambda: headline.inner_text() == "Ready", "the run to be ready", 60)
        page.get_by_role("button", name="Watch").click()
        wait_until(lambda: headline.inner_text() == "Going to pick", "the simulated operator", 30)
        scene = page.frames[1]
        children = "Object.keys(viewer.scene_tree.find(['drake']).children)"
        wait_until(lambda: {"canal", "trail"} <= set(scene.evaluate(children)), "the picture", 60)
        # From above: looked for twice, since once other commands to the frame came again and again.
        scene.evaluate("window.heard = 0; addEventListener('message', () => { heard += 1; })")
        for _ in range(3):
            page.locator("#view").click()
        height = "Math.round(100 * viewer.camera.position.y)"
        for _ in range(2):
            wait_until(lambda: scene.evaluate(height) == 275, "the view from above", 30)
            page.wait_for_timeout(500)
        assert scene.evaluate("heard") < 10
        disk = page.get_by_role("progressbar")
        page.keyboard.down("ArrowRight")
        wait_until(lambda: headline.inner_text() == "Steering", "the person's correction", 30)
        assert "You move it" in page.inner_text("#sentence")
        stands = int(disk.get_attribute("aria-valuenow") or -1)
        page.wait_for_timeout(1000)
        # In a second it would travel 12 %. A page that is starved by other programs lets go for a moment, as it should.
        assert abs(int(disk.get_attribute("aria-valuenow") or -1) - stands) <= 3
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
        # A held arrow, and nothing but that arrow.
        steered = stick[person]
        assert (steered[:, 0] > 0).sum() >= 5
        assert np.abs(steered[:, 1]).max() < 1e-12
        assert not signals["joystick"][person, 2:].any()


@pytest.mark.browser
def test_it_runs_again_at_the_same_address_when_the_page_says_so(page):
    """Only where there is a terminal to end it from: a pseudo-terminal here."""
    pty = pytest.importorskip("pty", reason="needs a terminal")
    leader, follower = pty.openpty()
    options = ("--items", "rigid", "--port", "0", "--duration", "2")
    process = subprocess.Popen(
        [sys.executable, "-m", "geosacs_drake.run_laundry", *options], stdout=follower, stderr=follower
    )
    try:
        page.goto(printed_address(leader))
        page.get_by_role("button", name="Watch").click()
        ended = page.get_by_role("dialog", name="Ended")
        ended.wait_for(timeout=60_000)
        ended.get_by_role("button", name="Run again").click()
        wait_until(lambda: page.locator("#headline").inner_text() == "Ready", "the next run", 120)
        assert process.poll() is None, "it is the same process"
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 1
    finally:
        process.kill()
        process.wait()
        os.close(leader)
        os.close(follower)


def printed_address(terminal: int) -> str:
    """The page's address, from what a run prints; what it prints later is read and left."""
    lines: list[str] = []

    def read() -> None:
        with contextlib.suppress(OSError):
            while data := os.read(terminal, 4096):
                lines.append(data.decode(errors="replace"))

    threading.Thread(target=read, daemon=True).start()
    wait_until(lambda: bool(re.search(r"at http://\S+/\r", "".join(lines))), "the address", 120)
    found = re.search(r"at (http://\S+/)\r", "".join(lines))
    assert found
    return found.group(1)
