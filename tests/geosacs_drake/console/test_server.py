"""What a program on this machine can do to the console by a socket of its own: nothing, without the token."""

import threading
import time

import pytest
from waiting import wait_until

from benchmarks.console import raw_client
from benchmarks.console.attack import BROKEN, PATHS, WRONG_HOSTS, WRONG_ORIGINS, Attack
from benchmarks.console.raw_client import receive, say, send
from geosacs_drake.console.access import Access
from geosacs_drake.console.control import Control
from geosacs_drake.console.server import ConsoleServer


@pytest.fixture
def server():
    server = ConsoleServer(Control(), port=0)
    server.start()
    yield server
    server.stop()


def ask(server, path, **request):
    """Status line and connection of a request; nothing of a browser's."""
    return raw_client.ask(server.port, path, **request)


def own(server):
    return f"localhost:{server.port}"


def linked(server):
    return raw_client.linked(server.port, server.access.token)


@pytest.mark.parametrize("path", PATHS)
def test_wrong_hosts_origins_and_tokens_are_refused(server, path):
    token, upgrade = server.access.token, path.endswith(("link", "socket"))
    right = f"http://{own(server)}"
    cases = [(token, host.format(port=server.port), right) for host in WRONG_HOSTS if host is not None]
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


def test_every_wrong_request_message_and_byte_is_refused_and_moves_nothing(server):
    """Three seconds of it; `make bench-console` tries every combination, for a minute, on a run."""
    attack = Attack(server.port, server.access.token)
    attacker = threading.Thread(target=attack.run, args=(3.0,))
    attacker.start()
    while attacker.is_alive():
        assert not server.control.sample().joystick.any()
        time.sleep(0.002)
    assert attack.let_in == []
    assert min(attack.tried[kind] for kind in ("requests", "messages", "bytes")) > 0
    assert not server.control.situation().person
    connection = linked(server)
    say(connection, 0, type="press", button="gripper")
    wait_until(lambda: server.control.sample().joystick[2] == 1, "an honest press", 5)


def test_an_attack_that_is_let_in_is_seen(server, monkeypatch):
    monkeypatch.setattr(Access, "refusal", lambda *_, **__: "")
    attack = Attack(server.port, server.access.token)
    attack.run(0.5)
    assert attack.let_in


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
