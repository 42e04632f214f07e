"""The console's server: Tornado in a thread of its own; the run stays in the main one and never waits for it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import math
import socket
import threading
import time
from collections import deque
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application
from tornado.websocket import WebSocketHandler

from canal.errors import InputError
from geosacs_drake.console.access import Access, new_token
from geosacs_drake.console.control import Control
from geosacs_drake.console.handlers import ROUTES, SETTINGS, LinkSocket
from geosacs_drake.console.link import Answers

FIRST_PORT, LAST_PORT = 7000, 7999
STATUS_PERIOD_S = 0.08
"""[s] Between two that pages are told: each one has the whole page drawn anew."""
HISTORY = 60
"""Events that a page gets to see that comes late."""


class ConsoleServer:
    """Serves the page, passes commands to `control`, and tells the pages what `show` is given."""

    def __init__(
        self,
        control: Control,
        answers: Answers | None = None,
        *,
        meshcat_address: tuple[str, int] = ("localhost", 7000),
        host: str = "localhost",
        port: int | None = None,
        token: str | None = None,
        index: str = "index.html",
    ) -> None:
        """Take a port; `start` serves.

        Args:
            control: gets the commands.
            answers: gets what is no command of the stick.
            meshcat_address: where Meshcat listens.
            host: the address to listen at.
            port: TCP port; None takes the first free one from 7000 on, 0 any free one.
            token: of an earlier run whose page stays; None draws one.
            index: the page's file.

        Raises:
            InputError: the port is taken, or the address is not this machine's.
        """
        self.control, self.answers = control, answers or Answers()
        self.meshcat_address, self.index = meshcat_address, index
        self._sockets, self.port = _take_port(host, port)
        self.access = Access(token or new_token(), self.port, open_to_network=host not in ("localhost", "127.0.0.1"))
        self.links: dict[str, LinkSocket] = {}
        self.open: set[WebSocketHandler] = set()
        self.about: dict[str, Any] = {}
        self._lock = threading.Lock()
        self._status: dict[str, Any] = {}
        self._number = 0
        self._events: deque[dict[str, Any]] = deque(maxlen=HISTORY)
        self._end: dict[str, Any] | None = None
        self._thread = threading.Thread(target=self._serve, name="console", daemon=True)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ready = threading.Event()

    @property
    def address(self) -> str:
        """What a person opens in a browser on this machine."""
        return f"http://localhost:{self.port}/{self.access.token}/"

    @property
    def network_address(self) -> str:
        """What a tablet in the same network opens; empty where no other machine may join."""
        if not self.access.open_to_network:
            return ""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.connect(("192.0.2.1", 9))  # sends nothing: asks which of our addresses leads outside
                own = probe.getsockname()[0]
            except OSError:
                own = socket.gethostname()
        return f"http://{own}:{self.port}/{self.access.token}/"

    def start(self) -> None:
        """Serve, in a thread of its own."""
        self._thread.start()
        self._ready.wait()

    def stop(self) -> None:
        """Close all connections and end the thread."""
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._shut)
            self._thread.join(timeout=1.0)

    # ---- called by the run, from its thread ----

    def introduce(self, about: dict[str, Any]) -> None:
        """What does not change while it runs, for pages that are there and for those that come.

        Args:
            about: as plain data.
        """
        with self._lock:
            self.about = about
        self._from_thread({"type": "about", "about": about})

    def show(self, status: dict[str, Any]) -> None:
        """What the pages show from now on."""
        with self._lock:
            self._status = status
            self._number += 1

    def picture_wanted(self) -> bool:
        """Whether a page waits for a picture of the gripper's camera."""
        return any(page.link.looks for page in list(self.links.values()))

    def show_picture(self, jpeg: bytes) -> None:
        """What the gripper's camera sees, for the pages that wait for it.

        Args:
            jpeg: the file's bytes.
        """
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._send_picture, jpeg)

    def tell(self, event: dict[str, Any]) -> None:
        """Something has happened: it goes to the pages' history."""
        with self._lock:
            self._events.append(event)
        self._from_thread({"type": "event", **event})

    def show_end(self, end: dict[str, Any]) -> None:
        """The run has ended; the pages show what was achieved. Returns when they have been told."""
        with self._lock:
            self._end = end
        told = threading.Event()
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._tell_all, json.dumps({"type": "end", **end}, default=_plain), told)
            told.wait(0.2)

    @property
    def pages(self) -> int:
        """Connected now."""
        return len(self.links)

    # ---- called in the server's thread ----

    def welcome(self, name: str) -> str:
        """The first words to a page."""
        with self._lock:
            words = {"type": "welcome", "you": name, "about": self.about, "history": list(self._events)}
            if self._end is not None:
                words["end"] = self._end
        return json.dumps(words, default=_plain)

    def refused(self, code: int, why: str) -> str:
        """What is said to a page whose message is broken.

        Args:
            code: HTTP status.
            why: in words.
        """
        return json.dumps({"type": "refused", "code": code, "text": why})

    def _serve(self) -> None:
        for name in ("tornado.access", "tornado.application", "tornado.general"):
            logging.getLogger(name).setLevel(logging.CRITICAL)  # who sends nonsense fills no terminal
        loop = self._loop = asyncio.new_event_loop()
        asyncio.set_event_loop(loop)
        routes = [(pattern, handler, {"server": self}) for pattern, handler in ROUTES]
        server = self._http = HTTPServer(
            Application(routes, **SETTINGS), max_header_size=16384, max_body_size=MOST_BODY, idle_connection_timeout=60
        )
        server.add_sockets(self._sockets)
        self._broadcasting = loop.create_task(self._broadcast())
        loop.call_soon(self._ready.set)
        with contextlib.suppress(RuntimeError):
            loop.run_forever()

    def _shut(self) -> None:
        assert self._loop is not None
        self._broadcasting.cancel()
        self._http.stop()
        for socket_ in list(self.open):
            socket_.close(1001, "the run has ended")
        self._loop.call_later(0.05, self._loop.stop)

    async def _broadcast(self) -> None:
        told, again = 0, 0.0
        while True:
            await asyncio.sleep(STATUS_PERIOD_S)
            with self._lock:
                number, status = self._number, self._status
            now = time.monotonic()
            if not self.links or (number == told and now < again):
                continue
            told, again = number, now + 0.25  # a run that stands still is told of, too
            self._tell_status(status, now)

    def _tell_status(self, status: dict[str, Any], now: float) -> None:
        situation = self.control.situation()
        self._serial = number = getattr(self, "_serial", 0) + 1
        common = status | {
            "type": "status",
            "number": number,
            "holder": situation.holder,
            "person": situation.person,
            "stopped": situation.stopped,
            "begun": situation.begun,
            "pages": len(self.links),
        }
        text = json.dumps(common, default=_plain)[:-1]
        for page in list(self.links.values()):
            page.link.tell(number, now)
            delay = page.link.delay_ms
            page.say(f'{text}, "delay_ms": {"null" if math.isnan(delay) else round(delay, 1)}}}')

    def _send_picture(self, jpeg: bytes) -> None:
        for page in list(self.links.values()):
            if page.link.looks:
                page.link.looks = False
                page.say(jpeg)

    def _from_thread(self, message: dict[str, Any]) -> None:
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._tell_all, json.dumps(message, default=_plain))

    def _tell_all(self, text: str, told: threading.Event | None = None) -> None:
        for page in list(self.links.values()):
            page.say(text)
        if told is not None:
            told.set()


MOST_BODY = 65536
"""[bytes] Of a request."""


def _plain(value: Any) -> Any:
    """A numpy value for JSON."""
    return value.tolist()


def _take_port(host: str, port: int | None) -> tuple[list[socket.socket], int]:
    for number in range(FIRST_PORT, LAST_PORT + 1) if port is None else (port,):
        try:
            sockets = bind_sockets(number, "127.0.0.1" if host == "localhost" else host, family=socket.AF_INET)
        except (OSError, OverflowError) as error:
            if port is None:
                continue
            words = getattr(error, "strerror", None) or str(error)
            raise InputError(f"port {port} on {host}: {words}; give a free one with --port") from None
        return sockets, sockets[0].getsockname()[1]
    raise InputError(f"every port in {FIRST_PORT}..{LAST_PORT} on {host} is taken: give a free one with --port")
