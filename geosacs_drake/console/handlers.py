"""What the console's server answers: the page's files, Meshcat's page, and two WebSockets; nothing without a token."""

# ruff: noqa: D102 (methods of Tornado's, described there)
from __future__ import annotations

import asyncio
import contextlib
import itertools
import mimetypes
import time
from pathlib import Path
from typing import Any, Protocol

from tornado.web import HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from geosacs_drake.console.access import Access
from geosacs_drake.console.control import Control
from geosacs_drake.console.link import Answers, Link
from geosacs_drake.console.meshcat_feed import meshcat_messages
from geosacs_drake.console.meshcat_page import meshcat_page
from geosacs_drake.console.messages import MOST_BYTES, read_message
from geosacs_drake.console.newest import Newest

PAGE = Path(__file__).parent / "page"
QUICK_S = 0.1
"""[s] A page that draws as quickly may have two pictures on their way to it, another one only one."""
NAMES = itertools.count(1)
"""Numbers of pages, so that each has a name of its own."""


class Server(Protocol):
    """What the handlers ask of the server that has them.

    Attributes:
        access: who may connect.
        control: who steers, and the latest command.
        answers: what the run does with other messages.
        links: the pages that are connected, by name.
        open: all websockets that are open.
        meshcat_address: host and port of Meshcat's own server.
        index: the page that is served.
    """

    access: Access
    control: Control
    answers: Answers
    links: dict[str, LinkSocket]
    open: set[WebSocketHandler]
    meshcat_address: tuple[str, int]
    index: str

    def welcome(self, name: str) -> str:
        """The first words to a page."""

    def refused(self, code: int, why: str) -> str:
        """What is said to a page whose message is broken.

        Args:
            code: HTTP status.
            why: in words.
        """


class _Guarded(RequestHandler):
    """Looks at Host, Origin and token before anything else."""

    needs_origin = False

    def initialize(self, server: Server) -> None:
        self.server = server

    def prepare(self) -> None:
        headers = self.request.headers
        access: Access = self.server.access
        refused = access.refusal(
            host=headers.get("Host"),
            origin=headers.get("Origin"),
            token=self.path_args[0] if self.path_args else "",
            needs_origin=self.needs_origin,
        )
        if refused:
            raise HTTPError(403, reason=refused)

    def set_default_headers(self) -> None:
        for name, value in HEADERS.items():
            self.set_header(name, value)

    def write_error(self, status_code: int, **kwargs: Any) -> None:
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(f"{status_code}: {self._reason}\n")


HEADERS = {
    "Server": "geosacs",
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Frame-Options": "SAMEORIGIN",
}
POLICY = "default-src 'self'; img-src 'self' data: blob:; style-src 'self'; frame-ancestors 'self'; base-uri 'none'"
"""Of our own page: nothing from elsewhere, no script within the HTML."""
MESHCAT_POLICY = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; connect-src 'self' data: blob:; "
    "frame-ancestors 'self'; base-uri 'none'"
)
"""Of Meshcat's, which has its script within."""


class Nothing(_Guarded):
    """Whatever else is asked for."""

    def get(self, *_: str) -> None:
        raise HTTPError(404, reason="there is nothing here")


class PageFile(_Guarded):
    """The page and its files."""

    def get(self, token: str, name: str) -> None:
        path = (PAGE / (name or self.server.index)).resolve()
        if not path.is_relative_to(PAGE) or not path.is_file():
            raise HTTPError(404, reason="there is nothing here")
        kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        text = kind.startswith("text/") or kind.endswith(("javascript", "json"))
        self.set_header("Content-Type", f"{kind}; charset=utf-8" if text else kind)
        self.set_header("Content-Security-Policy", POLICY)
        self.finish(path.read_bytes())


class MeshcatPage(_Guarded):
    """Drake's own page of Meshcat and its script, from our origin."""

    def get(self, token: str, name: str) -> None:
        kind, content = meshcat_page(name)
        self.set_header("Content-Type", kind)
        self.set_header("Content-Security-Policy", MESHCAT_POLICY)
        self.finish(content)


class _Socket(_Guarded, WebSocketHandler):
    needs_origin = True

    def check_origin(self, origin: str) -> bool:
        return True  # `prepare` has

    def get(self, *args: str, **kwargs: str) -> Any:  # type: ignore[override]
        if self.request.headers.get("Upgrade", "").lower() != "websocket":
            raise HTTPError(400, reason="this is a WebSocket")
        return super().get(*args, **kwargs)

    def set_default_headers(self) -> None:
        if self.request.headers.get("Upgrade", "").lower() != "websocket":
            super().set_default_headers()

    def say(self, message: str | bytes) -> None:
        """Send what can be sent."""
        with contextlib.suppress(WebSocketClosedError):
            sent = asyncio.ensure_future(self.write_message(message, binary=isinstance(message, bytes)))
            sent.add_done_callback(_hear)


def _hear(sent: asyncio.Future[None]) -> None:
    """Who goes while something is sent fills no terminal."""
    if not sent.cancelled():
        sent.exception()


class LinkSocket(_Socket):
    """Commands from a page, and the status to it."""

    def open(self, *_: str, **__: str) -> None:
        self.set_nodelay(True)
        self.name = f"page {next(NAMES)}"
        self.link = Link(self.name, self.server.control, self.server.answers)
        self.server.links[self.name] = self
        self.server.open.add(self)
        self.say(self.server.welcome(self.name))

    def on_message(self, message: str | bytes) -> None:
        try:
            answer = self.link.receive(read_message(message, self.link.last), time.monotonic())
        except ValueError as error:
            self.say(self.server.refused(400, str(error)))
            self.close(1008, "broken message")
            return
        if answer:
            self.say(answer)

    def on_close(self) -> None:
        self.server.open.discard(self)
        if hasattr(self, "name"):
            self.server.links.pop(self.name, None)
            self.server.control.leave(self.name)


class MeshcatSocket(_Socket):
    """What Meshcat tells its page, no faster than it draws; nothing goes the other way but numbers of pictures."""

    @property
    def ping_interval(self) -> None:
        """Not asked whether it is there: a page that draws for seconds answers late, and would begin anew."""
        return

    def open(self, *_: str, **__: str) -> None:
        self.set_nodelay(True)
        self.server.open.add(self)
        self.newest, self.sent, self.drawn = Newest(), 0, 0
        self.sent_s, self.took_s = 0.0, 0.0
        self._feed = asyncio.ensure_future(self._follow())

    async def _follow(self) -> None:
        host, port = self.server.meshcat_address
        with contextlib.suppress(OSError, asyncio.IncompleteReadError):
            async for messages in meshcat_messages(host, port):
                for message in messages:
                    self.newest.add(message)
                self._pass_on()
        self.close(1001, "the run has ended")

    def _pass_on(self) -> None:
        if len(self.newest) and self.sent - self.drawn < (2 if self.took_s < QUICK_S else 1):
            self.sent += 1
            self.sent_s = time.monotonic()
            self.say(self.sent.to_bytes(4, "little") + self.newest.take())

    def on_message(self, message: str | bytes) -> None:
        if not isinstance(message, str) or len(message) > 12 or not message.isdecimal():
            self.close(1008, "broken message")
            return
        self.drawn = max(self.drawn, min(int(message), self.sent))
        if self.drawn == self.sent:
            self.took_s = time.monotonic() - self.sent_s
        self._pass_on()

    def on_close(self) -> None:
        self.server.open.discard(self)
        if hasattr(self, "_feed"):
            self._feed.cancel()


ROUTES = (
    (r"/([\w-]*)/link", LinkSocket),
    (r"/([\w-]*)/view/socket", MeshcatSocket),
    (r"/([\w-]*)/view/(|meshcat\.js|meshcat\.ico|favicon\.ico)", MeshcatPage),
    (r"/([\w-]*)/([\w.-]*)", PageFile),
    (r"/([\w-]*).*", Nothing),
)
"""Patterns of addresses, and what answers there."""
SETTINGS: dict[str, Any] = {"websocket_max_message_size": MOST_BYTES, "websocket_ping_interval": 5}
"""Of Tornado\'s application."""
