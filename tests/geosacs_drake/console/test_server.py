"""What a program on this machine can do to the console by a socket of its own: nothing, without the token."""

import base64
import itertools
import json
import os
import socket
import struct
import time

import pytest
from waiting import wait_until

from geosacs_drake.console.control import Control
from geosacs_drake.console.server import ConsoleServer


@pytest.fixture
def server():
    server = ConsoleServer(Control(), port=0)
    server.start()
    yield server
    server.stop()


def ask(server, path, *, host=None, origin=None, method="GET", upgrade=False, more=""):
    """Status line and connection of a request; nothing of a browser's."""
    connection = socket.create_connection(("127.0.0.1", server.port), timeout=20)
    lines = [f"{method} {path} HTTP/1.1"]
    if host is not None:
        lines.append(f"Host: {host}")
    if origin is not None:
        lines.append(f"Origin: {origin}")
    if upgrade:
        key = base64.b64encode(os.urandom(16)).decode()
        lines += ["Upgrade: websocket", "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13"]
    connection.sendall(("\r\n".join(lines) + "\r\n" + more + "\r\n").encode())
    answer = b""
    while b"\r\n\r\n" not in answer and (byte := connection.recv(1)):
        answer += byte
    return (int(answer.split()[1]) if answer else 0), connection


def own(server):
    return f"localhost:{server.port}"


def send(connection, payload, opcode=1):
    mask, size = os.urandom(4), len(payload)
    head = bytes([0x80 | opcode])
    head += (
        bytes([0x80 | size])
        if size < 126
        else b"\xfe" + struct.pack(">H", size)
        if size < 65536
        else (b"\xff" + struct.pack(">Q", size))
    )
    connection.sendall(head + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(payload)))


def receive(connection):
    """The next text, or None where the connection was closed."""
    try:
        head = connection.recv(2)
        if len(head) < 2 or head[0] & 0x0F == 8:
            return None
        size = head[1]
        if size == 126:
            (size,) = struct.unpack(">H", connection.recv(2))
        data = b""
        while len(data) < size:
            data += connection.recv(size - len(data))
    except ConnectionResetError:
        return None
    return json.loads(data)


def linked(server):
    status, connection = ask(
        server, f"/{server.access.token}/link", host=own(server), origin=f"http://{own(server)}", upgrade=True
    )
    assert status == 101
    assert receive(connection)["type"] == "welcome"
    return connection


def say(connection, n, **message):
    send(connection, json.dumps({"n": n, **message}).encode())


PATHS = ("", "index.html", "main.js", "view/", "view/meshcat.js", "link", "view/socket")
WRONG_HOSTS = (
    "",
    "evil.example",
    "evil.example:{port}",
    "localhost",
    "localhost:1",
    "127.0.0.1.evil:{port}",
    "10.1.1.1:{port}",
)
WRONG_ORIGINS = (
    "null",
    "http://evil.example",
    "https://localhost:{port}",
    "http://localhost:1",
    "http://127.0.0.1:{port}",
)


@pytest.mark.parametrize("path", PATHS)
def test_wrong_hosts_origins_and_tokens_are_refused(server, path):
    token, upgrade = server.access.token, path.endswith(("link", "socket"))
    right = f"http://{own(server)}"
    cases = [(token, host.format(port=server.port), right) for host in WRONG_HOSTS]
    cases += [(token, own(server), origin.format(port=server.port)) for origin in WRONG_ORIGINS]
    cases += [(wrong, own(server), right) for wrong in ("", "x", token[:-1], token + "x", token.swapcase())]
    if upgrade:
        cases.append((token, own(server), None))
    for wrong, host, origin in cases:
        status, _ = ask(server, f"/{wrong}/{path}", host=host, origin=origin, upgrade=upgrade)
        assert status == 403, (wrong, host, origin)
    status, _ = ask(server, f"/{token}/{path}", host=own(server), origin=right, upgrade=upgrade)
    assert status == (101 if upgrade else 200)


def test_nothing_but_get_is_answered_and_nothing_but_the_page_is_there(server):
    for method in ("POST", "PUT", "DELETE", "OPTIONS", "PATCH"):
        status, _ = ask(
            server, f"/{server.access.token}/", host=own(server), method=method, more="Content-Length: 0\r\n"
        )
        assert status in (403, 405), method
    for path in (
        "../control.py",
        "..%2fcontrol.py",
        "%2e%2e/control.py",
        "nothing.js",
        "view/../../x",
        "page/index.html",
    ):
        status, _ = ask(server, f"/{server.access.token}/{path}", host=own(server))
        assert status in (403, 404), path
    assert ask(server, f"/{server.access.token}/link", host=own(server), origin=f"http://{own(server)}")[0] == 400


def test_a_stick_arrives_clamped_and_is_gone_with_its_connection(server):
    connection = linked(server)
    say(connection, 0, type="drive", stick=[30.0, -40.0])
    wait_until(lambda: server.control.sample().joystick[0] == pytest.approx(1 / 2**0.5), "the stick", 5)
    say(connection, 1, type="drive", stick=[0.3, -0.4])
    wait_until(lambda: tuple(server.control.sample().joystick[:2]) == (0.3, -0.4), "the stick", 5)
    connection.close()
    wait_until(lambda: not server.control.sample().joystick.any(), "the stick to fall", 5)
    assert server.control.situation().holder == ""


BROKEN = (
    b"", b"{", b"null", b"[]", b"{}", b'"drive"', b"\xff\xfe",
    b'{"n": 0, "type": "drive"}',
    b'{"n": 0, "type": "drive", "stick": [1]}',
    b'{"n": 0, "type": "drive", "stick": [1, 2, 3]}',
    b'{"n": 0, "type": "drive", "stick": [NaN, 0]}',
    b'{"n": 0, "type": "drive", "stick": [Infinity, 0]}',
    b'{"n": 0, "type": "drive", "stick": [1e999, 0]}',
    b'{"n": 0, "type": "drive", "stick": ["a", 0]}',
    b'{"n": 0, "type": "drive", "stick": [0, 0], "more": 1}',
    b'{"n": -1, "type": "drive", "stick": [1, 0]}',
    b'{"n": 0.5, "type": "drive", "stick": [1, 0]}',
    b'{"type": "drive", "stick": [1, 0]}',
    b'{"n": 0, "type": "press", "button": "fly"}',
    b'{"n": 0, "type": "step", "direction": [1, 0], "mm": 1e9}',
    b'{"n": 0, "type": "step", "direction": [1, 0], "mm": -1}',
    b'{"n": 0, "type": "nothing"}',
    b'{"n": 0, "t": "now", "type": "drive", "stick": [1, 0]}',
    b"[" * 4000,
    b'{"n": 0, "type": "drive", "stick": [1, 0], "x": "' + b"a" * 5000 + b'"}',
)  # fmt: skip


@pytest.mark.parametrize("payload", BROKEN, ids=range(len(BROKEN)))
def test_a_broken_message_is_answered_400_and_ends_its_connection_alone(server, payload):
    other = linked(server)
    connection = linked(server)
    send(connection, payload)
    answers = list(iter(lambda: receive(connection), None))
    assert all(a["code"] == 400 for a in answers if a["type"] == "refused")
    assert not server.control.sample().joystick.any()
    say(other, 0, type="press", button="gripper")
    wait_until(lambda: server.control.sample().joystick[2] == 1, "the other page's press", 5)


def test_numbers_must_grow(server):
    connection = linked(server)
    say(connection, 5, type="drive", stick=[0, 0])
    say(connection, 5, type="press", button="gripper")
    answers = list(iter(lambda: receive(connection), None))
    assert [a["code"] for a in answers if a["type"] == "refused"] == [400]
    assert not server.control.sample().joystick.any()


def test_bytes_that_mean_nothing_move_nothing(server):
    """The same for a minute is a line of `make acceptance`."""
    rng, end = itertools.count(), time.monotonic() + 3.0
    while time.monotonic() < end:
        if next(rng) % 2:
            with socket.create_connection(("127.0.0.1", server.port), timeout=20) as connection:
                connection.sendall(os.urandom(300))
        else:
            connection = linked(server)
            try:
                for opcode in (1, 2, 9, 3, 11):
                    send(connection, os.urandom(50), opcode)
            except OSError:
                pass
            connection.close()
        assert not server.control.sample().joystick.any()
    linked(server)
    assert not server.control.situation().person


def test_another_machines_browser_is_welcome_only_where_it_was_asked_for(server):
    host = f"192.168.1.5:{server.port}"
    assert ask(server, f"/{server.access.token}/", host=host)[0] == 403
    opened = ConsoleServer(Control(), port=0, host="0.0.0.0")
    opened.start()
    try:
        host = f"192.168.1.5:{opened.port}"
        assert ask(opened, f"/{opened.access.token}/", host=host)[0] == 200
        assert ask(opened, f"/{opened.access.token}/", host=f"evil.example:{opened.port}")[0] == 403
    finally:
        opened.stop()
