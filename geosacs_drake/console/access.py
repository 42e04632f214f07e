"""Who may talk to the console: Host, Origin and a random token are looked at in every request."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from dataclasses import dataclass
from urllib.parse import urlsplit

LOCAL = ("localhost", "127.0.0.1", "[::1]")
"""Names of this machine to itself."""


def new_token() -> str:
    """96 random bits, fit for a path."""
    return secrets.token_urlsafe(12)


@dataclass(frozen=True)
class Access:
    """What a request must say.

    Attributes:
        token: first part of each path.
        port: of the server.
        open_to_network: whether other machines may join. Their browsers name this machine by a number or by its own
            name; a name that somebody else's DNS points here is neither, and is refused.
    """

    token: str
    port: int
    open_to_network: bool = False

    def refusal(self, *, host: str | None, origin: str | None, token: str, needs_origin: bool) -> str:
        """Why a request is refused; empty where it is not.

        Args:
            host: its Host header.
            origin: its Origin header.
            token: what its path begins with.
            needs_origin: whether it is one that a browser never sends without Origin.
        """
        if not secrets.compare_digest(token.encode(), self.token.encode()):
            return "the token is missing or wrong: open the address that the terminal prints"
        if host is None or not self._is_ours(host):
            return "this host is not served here"
        if origin is None:
            return "a page must say where it comes from" if needs_origin else ""
        parts = urlsplit(origin)
        same = parts.scheme == "http" and parts.netloc.lower() == host.lower()
        return "" if same else "this page may not command the robot"

    def _is_ours(self, host: str) -> bool:
        name, colon, port = host.lower().rpartition(":")
        if not colon or port != str(self.port):
            return False
        if name in LOCAL:
            return True
        if not self.open_to_network:
            return False
        try:
            ipaddress.ip_address(name.strip("[]"))
        except ValueError:
            return name in (socket.gethostname().lower(), f"{socket.gethostname().lower()}.local")
        return True
