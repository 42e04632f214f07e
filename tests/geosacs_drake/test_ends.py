"""Whatever ends a run leaves what was measured in whole files: signals, closed pipes, faults inside, full disks."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from running import RunningCommand
from waiting import wait_until

from diagrams.shared_autonomy import SharedAutonomy
from geosacs_drake import run as run_module
from geosacs_drake.process.interrupts import SAME_PRESS_S
from geosacs_drake.run import main

ROOT = Path(__file__).parents[2]
PROGRAM = """
import ctypes, time
import canal.files, geosacs_drake.run as run

def show(bar, progress):
    print("at", progress.time_s, flush=True)
    {in_step}

def slowly(path, write, write_whole=canal.files.write_and_rename):
    def wait(stream):
        stream.write(b"half")
        print("writing", flush=True)
        time.sleep(5)
        stream.seek(0)
        write(stream)
    write_whole(path, wait)

run._Bar.show = show
{first}
run.main("relocation", {arguments!r})
"""


def start(tmp_path, in_step="pass", first="", **keywords) -> RunningCommand:
    """A run that says how far it is, with something done after each half second."""
    arguments = ["--headless", "--realtime-rate", "1", *map(str, files(tmp_path))]
    program = PROGRAM.format(in_step=in_step, first=first, arguments=arguments)
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        **keywords,
    )
    return RunningCommand(process)


def files(tmp_path) -> list:
    return ["--summary", tmp_path / "s.json", "--log", tmp_path / "l.npz"]


def assert_whole(folder, *more: str) -> dict:
    """Summary and log are there and readable, and nothing else."""
    assert sorted(p.name for p in folder.iterdir()) == sorted(["l.npz", "s.json", *more])
    with np.load(folder / "l.npz") as log:
        assert log["time"].shape == log["eta"].shape
    return json.loads((folder / "s.json").read_text())


def ended(command: RunningCommand) -> int:
    wait_until(lambda: command.process.poll() is not None, "the run to end", 60)
    return command.process.returncode


def says(command: RunningCommand, words: str) -> None:
    wait_until(lambda: words in command.output or command.process.poll() is not None, words, 120)
    assert words in command.output, command.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_the_first_signal_asks(tmp_path, number):
    command = start(tmp_path)
    says(command, "at 0.5")
    command.process.send_signal(number)
    command.process.send_signal(number)  # as GNU timeout does: one request
    assert ended(command) == 1, command.output
    assert assert_whole(tmp_path)["reason"] == "interrupted"
    assert "once more ends it at once" in command.output


DEADLOCK = "lock = ctypes.create_string_buffer(128); [ctypes.PyDLL(None).pthread_mutex_lock(lock) for _ in (1, 2)]"
"""A call from which Python never comes back, with the interpreter's lock held, as by Drake."""


@pytest.mark.parametrize(
    ("hang", "status"),
    [("time.sleep(1000)", 128 + signal.SIGTERM), (DEADLOCK, -signal.SIGKILL)],
    ids=["python", "c"],
)
def test_the_second_signal_ends_a_step_that_hangs(tmp_path, hang, status):
    command = start(tmp_path, in_step=hang)
    says(command, "at 0.5")
    command.process.send_signal(signal.SIGTERM)
    time.sleep(APART_S)  # deaf where Python is not reached: nothing tells when the first one was heard
    command.process.send_signal(signal.SIGTERM)
    assert ended(command) == status
    assert not list(tmp_path.iterdir())


APART_S = 2 * SAME_PRESS_S
"""[s] Two presses, not one."""

SLOWLY = "canal.files.write_and_rename = slowly"


def test_a_signal_while_it_writes_lets_it_write(tmp_path):
    command = start(tmp_path, first=SLOWLY)
    says(command, "at 0.5")
    command.process.send_signal(signal.SIGINT)
    says(command, "writing")
    time.sleep(APART_S)
    command.process.send_signal(signal.SIGINT)
    assert ended(command) == 1, command.output
    assert_whole(tmp_path)
    assert "is writing its files; once more" in command.output


def test_two_signals_while_it_writes_leave_nothing_half_written(tmp_path):
    command = start(tmp_path, first=SLOWLY)
    says(command, "at 0.5")
    command.process.send_signal(signal.SIGINT)
    says(command, "writing")
    assert list(tmp_path.glob(".*"))
    time.sleep(APART_S)
    command.process.send_signal(signal.SIGINT)
    says(command, "is writing its files")
    time.sleep(APART_S)
    command.process.send_signal(signal.SIGINT)
    assert ended(command) == 128 + signal.SIGINT
    assert not list(tmp_path.glob(".*"))


SHORT = ["--headless", "--duration", "1"]


@pytest.mark.parametrize("closed", ["stdout", "both", "descriptors"])
def test_nobody_reads_what_it_prints(tmp_path, closed):
    command = [sys.executable, "-m", "geosacs_drake.run_relocation", *SHORT, *map(str, files(tmp_path))]
    read, write = os.pipe()
    os.close(read)
    streams = {"stdout": write, "stderr": write if closed == "both" else subprocess.PIPE}
    if closed == "descriptors":  # `>&- 2>&-`
        command = ["sh", "-c", 'exec "$@" >&- 2>&-', "sh", *command]
    done = subprocess.run(command, **streams, env={**os.environ, "PYTHONPATH": str(ROOT)}, timeout=120)
    os.close(write)
    assert done.returncode == 1
    assert not done.stderr
    assert_whole(tmp_path)


def test_nobody_reads_the_help(tmp_path):
    command = f"{sys.executable} -m geosacs_drake.learn --help | true; echo ${{PIPESTATUS[0]}}"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    assert (done.stdout, done.stderr) == ("0\n", "")


def run(capfd, *arguments) -> tuple[int, str, list[str]]:
    with pytest.raises(SystemExit) as left:
        main("relocation", [str(a) for a in arguments])
    out, err = capfd.readouterr()
    return left.value.code, out, [line for line in err.splitlines() if line.startswith("run_relocation: ")]


@pytest.mark.parametrize(
    "fault",
    [ValueError("a\nb"), OverflowError("x"), RuntimeError("x"), SystemExit("condition 'a' failed."), MemoryError()],
    ids=lambda fault: type(fault).__name__,
)
def test_a_fault_inside_leaves_files_and_is_not_taken_for_a_task_not_done(tmp_path, monkeypatch, capfd, fault):
    def fail(*_):
        raise fault

    monkeypatch.setattr(run_module._Bar, "show", fail)
    code, out, lines = run(capfd, *SHORT, *files(tmp_path))
    assert code == 2
    assert len(lines) == 1, lines
    assert "failed" in lines[0]
    assert "its files hold what was measured" in lines[0]
    summary = assert_whole(tmp_path)
    assert "failed" in summary["reason"]
    assert not summary["success"]
    assert "not done" in out


def test_a_fault_before_anything_is_measured_is_one_line(tmp_path, monkeypatch, capfd):
    def fail(*_):
        raise SystemExit("condition 'a' failed.")

    monkeypatch.setattr(SharedAutonomy, "take_first_measurements", fail)
    code, _, lines = run(capfd, *SHORT, *files(tmp_path))
    assert code == 2
    assert len(lines) == 1
    assert "nothing was measured" in lines[0]
    assert not list(tmp_path.iterdir())


def test_each_output_stands_alone(tmp_path, capfd):
    (tmp_path / "full.npz").symlink_to("/dev/full")
    film, page = tmp_path / "f.gif", tmp_path / "p.html"
    arguments = ("--summary", tmp_path / "s.json", "--log", tmp_path / "full.npz", "--video", film, "--record", page)
    code, out, lines = run(capfd, *SHORT, *arguments)
    assert code == 2
    assert len(lines) == 1
    assert "--log" in lines[0]
    assert "No space left" in lines[0]
    assert "not done" in out
    assert json.loads((tmp_path / "s.json").read_text())["task"] == "relocation"
    assert film.read_bytes().startswith(b"GIF89a")
    assert page.read_text().rstrip().endswith("</html>")
    assert {p.name for p in tmp_path.iterdir()} == {"s.json", "full.npz", "f.gif", "p.html"}
