"""What a program on this machine may try on the console: every wrong request, broken messages, bytes that mean nothing.

All of it comes in an order that a seed draws, for as long as is wanted. A client that was let in, and should not have
been, sends a full stick at once, as one would that means it.
"""

from __future__ import annotations

import itertools
import json
import os
import random
import socket
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from benchmarks.console.raw_client import BINARY, PING, TEXT, ask, linked, receive, send

PATHS = ("", "index.html", "main.js", "view/", "view/meshcat.js", "link", "view/socket")
METHODS = ("GET", "POST", "PUT", "DELETE", "OPTIONS", "HEAD", "FLY")
WRONG_HOSTS = (
    None,
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
FULL_STICK = b'{"n": 0, "type": "drive", "stick": [1, 1]}'
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
    b'{"n": 0, "type": "drive", "stick": [1, 0], "x": "' + b"a" * 70000 + b'"}',
)  # fmt: skip
"""Messages that a page never sends; each would push the stick, if it were carried out in part."""


@dataclass(frozen=True)
class Request:
    """One way to ask, wrong in one respect at least."""

    path: str
    method: str
    host: str | None
    origin: str | None
    token: str


def wrong_requests(port: int, token: str) -> Iterator[Request]:
    """Every combination of path, method, host, origin and token but those of our own page.

    Args:
        port: of the server.
        token: the right one.
    """
    own = f"localhost:{port}"
    hosts = [own, *(host and host.format(port=port) for host in WRONG_HOSTS)]
    origins = [f"http://{own}", None, *(origin.format(port=port) for origin in WRONG_ORIGINS)]
    tokens = [token, "", "x", token[:-1], token + "x", token.swapcase()]
    for path, method, host, origin, said in itertools.product(PATHS, METHODS, hosts, origins, tokens):
        fits = origin == origins[0] or (origin is None and not _is_socket(path))
        if not (method == "GET" and host == own and fits and said == token):
            yield Request(path, method, host, origin, said)


def _is_socket(path: str) -> bool:
    return path.endswith(("link", "socket"))


class Attack:
    """Tries all of it on a server. `tried` counts what was tried, `let_in` lists what was not refused."""

    def __init__(self, port: int, token: str, seed: int = 0) -> None:
        """Attack the server at `port`, whose right token is known, too.

        Args:
            port: of the server on this machine.
            token: of the server.
            seed: draws the order.
        """
        self._port, self._token = port, token
        self._rng = random.Random(seed)
        self.tried: Counter[str] = Counter()
        self.let_in: list[str] = []

    def run(self, seconds: float) -> None:
        """Go on for so long, or until every combination was tried, whatever is longer for `seconds` of 60 and more.

        Args:
            seconds: of the clock.
        """
        requests = list(wrong_requests(self._port, self._token))
        self._rng.shuffle(requests)
        broken = list(BROKEN)
        self._rng.shuffle(broken)
        end = time.monotonic() + seconds
        while time.monotonic() < end or (seconds >= 60 and (requests or broken)):
            for _ in range(20):
                if requests:
                    self._ask(requests.pop())
            if broken:
                self._say(broken.pop())
            else:
                self._say(self._nonsense())
            self._throw()

    def _ask(self, request: Request) -> None:
        self.tried["requests"] += 1
        status, connection = ask(
            self._port,
            f"/{request.token}/{request.path}",
            host=request.host,
            origin=request.origin,
            method=request.method,
            upgrade=_is_socket(request.path),
        )
        with connection, suppress(OSError):
            if 100 <= status < 400:
                self.let_in.append(f"{status} for {request}")
            send(connection, FULL_STICK)

    def _say(self, message: bytes) -> None:
        """A broken message through an honest link: it is answered 400, or the link is closed without a word."""
        self.tried["messages"] += 1
        with linked(self._port, self._token) as connection, suppress(OSError):
            connection.settimeout(20)
            send(connection, message)
            while (answer := receive(connection)) is not None:
                if answer["type"] == "told":
                    self.let_in.append(f"{answer} for {message[:80]!r}")

    def _throw(self) -> None:
        """Random bytes, as a request and as frames of any kind."""
        self.tried["bytes"] += 1
        with socket.create_connection(("127.0.0.1", self._port), timeout=20) as connection, suppress(OSError):
            connection.sendall(os.urandom(self._rng.choice((1, 30, 300, 3000, 20000))))
        with linked(self._port, self._token) as connection, suppress(OSError):
            for opcode in (TEXT, BINARY, PING, 3, 11):
                send(connection, os.urandom(self._rng.choice((0, 50, 200, 5000))), opcode)

    def _nonsense(self) -> bytes:
        """A message of the right shape with something in it that does not belong there."""
        odd = self._rng.choice((None, [], {}, "", "x", -1, 1e400, True, [[1, 1]], "A" * 100))
        message: dict[str, object] = {"n": 0, "t": 0.0, "type": "drive", "stick": [1, 1]}
        message[self._rng.choice(("n", "type", "stick"))] = odd
        return json.dumps(message).encode()
