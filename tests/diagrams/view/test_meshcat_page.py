"""Meshcat: for this machine only, a taken port, and leaving while a browser looks on."""

import os
import socket
import subprocess
import sys

import numpy as np
import pytest
from waiting import wait_until
from websocket import Client

from canal.errors import InputError
from diagrams.view import meshcat_page as meshcat_server
from diagrams.view.meshcat_page import leave, start_meshcat


def test_listens_on_localhost_only(meshcat):
    with socket.create_connection(("127.0.0.1", meshcat.port()), timeout=5):
        pass
    # The whole of 127/8 is this machine, so a server on every interface would answer here too.
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", meshcat.port()), timeout=5)


def test_a_taken_port_is_input_that_cannot_be_used():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(InputError, match=rf"port {port} on localhost is taken: .*--port") as error:
            start_meshcat(port=port)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("port", [-1, 80, 1023, 65536, 70000])
def test_a_port_that_no_program_may_take(port):
    with pytest.raises(InputError, match=rf"port {port} is outside 1024\.\.65535"):
        start_meshcat(port=port)


def test_a_machine_that_forbids_it(monkeypatch):
    monkeypatch.setenv("DRAKE_ALLOW_NETWORK", "none")
    with pytest.raises(InputError, match="--headless"):
        start_meshcat()


def test_two_servers_take_different_ports():
    assert start_meshcat().port() != start_meshcat().port()


def test_without_a_browser_leaving_is_an_ordinary_exit(meshcat):
    with pytest.raises(SystemExit) as leaving:
        leave(3, meshcat)
    assert leaving.value.code == 3


PROGRAM = """
import sys
from diagrams.view.meshcat_page import leave, start_meshcat
meshcat = start_meshcat(port=0)
print(meshcat.web_url(), flush=True)
sys.stdin.readline()
print("connections", meshcat.GetNumActiveConnections(), end="")
leave(7, meshcat)
"""


@pytest.mark.browser
def test_leaves_at_once_with_a_browser_connected(page):
    program = subprocess.Popen(
        [sys.executable, "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
    )
    url = program.stdout.readline().strip()
    page.goto(url)
    page.wait_for_function("connection.readyState === 1")
    # The destructor would wait for the page, which stays.
    output, _ = program.communicate("\n", timeout=60)
    assert output == "connections 1"
    assert program.returncode == 7


def test_a_recording_has_an_address_of_its_own():
    hidden = start_meshcat(hidden=True)
    host = hidden.web_url().removeprefix("http://").partition(":")[0]
    if not sys.platform.startswith("linux"):
        return
    assert host.startswith("127.")
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", hidden.port()), timeout=5)
    assert "</html>" in hidden.StaticHtml()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_starting_a_page_leaves_no_file_open():
    start_meshcat(port=0)
    before = len(os.listdir("/proc/self/fd"))
    with open(os.devnull):  # a file that is no socket
        for _ in range(5):
            list(meshcat_server._listeners(1))
    assert len(os.listdir("/proc/self/fd")) <= before


def test_a_client_that_does_not_read_is_cut_off(monkeypatch):
    monkeypatch.setattr(meshcat_server, "DEAF_MS", 500)
    meshcat = start_meshcat(port=0)
    with Client(meshcat.port()):
        wait_until(lambda: meshcat.GetNumActiveConnections() == 1, "the client")
        line = np.random.default_rng(0).random((3, 100000))

        def gone() -> bool:
            meshcat.SetLine("line", line)  # 1 MB that it does not take
            return meshcat.GetNumActiveConnections() == 0

        wait_until(gone, "the client to be cut off", 60)
