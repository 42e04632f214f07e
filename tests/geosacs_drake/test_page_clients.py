"""What any program on this machine can do to the page, and what it cannot."""

import json
import re
import time

import numpy as np
import pytest
from running import running
from waiting import wait_until
from websocket import Client, packed

from diagrams.scenario import load_scenario
from diagrams.shared_autonomy import build_shared_autonomy
from diagrams.teleop.meshcat_joystick import KEYS
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions

PRESS = [packed({"type": "button", "name": key.label}) for key in KEYS if key.code in ("Enter", "KeyG")]


def port_of(command) -> int:
    return int(command.address().rpartition(":")[2])


def arguments(folder, *more):
    return ("--no-console", "--port", "0", "--summary", str(folder / "s.json"), "--log", str(folder / "l.npz"), *more)


@pytest.mark.parametrize("message", [b"", b"\xc1\xff"], ids=["empty", "malformed"])
def test_a_message_that_meshcat_cannot_read_ends_the_run_with_its_files_whole(tmp_path, message):
    files = arguments(tmp_path, "--record", str(tmp_path / "p.html"), "--video", str(tmp_path / "f.gif"))
    with running("geosacs_drake.run_relocation", *files) as command:
        port = port_of(command)
        wait_until(lambda: _connected(port), "the page")
        time.sleep(8.0)  # until something is measured: the page is there before the run begins
        with Client(port) as client:
            client.send(message)
            wait_until(lambda: command.process.poll() is not None, "the run to end", 120)
        assert command.process.returncode == 2, command.output
    assert "the page failed" in command.output
    assert "Traceback" not in command.output
    assert {p.name for p in tmp_path.iterdir()} == {"s.json", "l.npz", "p.html", "f.gif"}
    assert "the page failed" in json.loads((tmp_path / "s.json").read_text())["reason"]
    with np.load(tmp_path / "l.npz") as log:
        assert len(log["time"])
    # The recording was made where no page reaches it.
    assert (tmp_path / "p.html").read_text().rstrip().endswith("</html>")
    assert (tmp_path / "f.gif").read_bytes().startswith(b"GIF89a")


def _connected(port) -> bool:
    try:
        with Client(port):
            return True
    except OSError:
        return False


def test_unknown_events_and_presses_change_nothing_where_nobody_was_asked_for(tmp_path):
    command_line = ("geosacs_drake.run_relocation", *arguments(tmp_path, "--duration", "4"))
    with running(*command_line) as command, Client(port_of(command)) as client:
        client.send(packed({"type": "nonsense", "name": "x"}), 20000)
        for press in PRESS:
            client.send(press, 20)
        wait_until(lambda: command.process.poll() is not None, "the run to end", 120)
    assert command.process.returncode == 1, command.output
    assert len(command.lines) < 10, "no line for each message"
    alone = tmp_path / "alone.npz"
    with running("geosacs_drake.run_relocation", "--headless", "--duration", "4", "--log", str(alone)) as command:
        wait_until(lambda: command.process.poll() is not None, "the run to end", 120)
    with np.load(tmp_path / "l.npz") as log, np.load(alone) as other:
        for name in ("stick", "buttons", "q"):
            np.testing.assert_array_equal(log[name], other[name])


@pytest.mark.parametrize(("operator", "heard"), [("simulated", False), ("person", True)])
def test_the_page_takes_commands_only_where_a_person_was_asked_for(meshcat, operator, heard):
    scenario = load_scenario("relocation")
    system = build_shared_autonomy(
        scenario=scenario, canal=prepare_canal(scenario, RunOptions()), operator=operator, meshcat=meshcat
    )
    assert system.diagram.HasSubsystemNamed("meshcat_joystick") == heard


def test_a_description_goes_escaped_into_the_recorded_page(tmp_path):
    from diagrams.view.meshcat_page import start_meshcat
    from diagrams.view.meshcat_recording import Recording

    Recording(start_meshcat(hidden=True), title="</title><script>x()</script>").save(tmp_path / "p.html")
    page = (tmp_path / "p.html").read_text()
    assert "<script>x()" not in page
    assert re.search("<title>&lt;/title&gt;&lt;script&gt;x", page)
