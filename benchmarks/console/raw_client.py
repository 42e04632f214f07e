"""A client of the console's server that says what no browser would: requests and WebSocket frames byte by byte."""

from __future__ import annotations

import base64
import json
import os
import socket
import struct
from typing import Any

TEXT, BINARY, CLOSE, PING = 1, 2, 8, 9
"""Opcodes of WebSocket frames."""


def ask(
    port: int,
    path: str,
    *,
    host: str | None = None,
    origin: str | None = None,
    method: str = "GET",
    upgrade: bool = False,
    more: str = "",
) -> tuple[int, socket.socket]:
    """Send a request, and read the head of the answer.

    Args:
        port: of the server on this machine.
        path: with the token.
        host: header; None leaves it out.
        origin: likewise.
        method: of HTTP.
        upgrade: whether a WebSocket is asked for.
        more: further lines of the head, each with its end.

    Returns:
        The status, 0 where the server closes without a word; and the connection.
    """
    connection = socket.create_connection(("127.0.0.1", port), timeout=20)
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
    try:
        while b"\r\n\r\n" not in answer and (byte := connection.recv(1)):
            answer += byte
    except ConnectionResetError:
        return 0, connection
    return (int(answer.split()[1]) if answer else 0), connection


def send(connection: socket.socket, payload: bytes, opcode: int = TEXT) -> None:
    """Send one frame.

    Args:
        connection: a WebSocket's.
        payload: what it carries.
        opcode: its kind.
    """
    mask, size = os.urandom(4), len(payload)
    head = bytes([0x80 | opcode])
    if size < 126:
        head += bytes([0x80 | size])
    elif size < 65536:
        head += b"\xfe" + struct.pack(">H", size)
    else:
        head += b"\xff" + struct.pack(">Q", size)
    connection.sendall(head + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(payload)))


def receive(connection: socket.socket) -> Any:
    """The next text as JSON, or None where the connection was closed."""
    try:
        head = _whole(connection, 2)
        while head[0] & 0x0F == PING:
            _whole(connection, head[1])
            head = _whole(connection, 2)
        if head[0] & 0x0F == CLOSE:
            return None
        size = head[1]
        if size == 126:
            (size,) = struct.unpack(">H", _whole(connection, 2))
        elif size == 127:
            (size,) = struct.unpack(">Q", _whole(connection, 8))
        return json.loads(_whole(connection, size))
    except OSError:
        return None


def _whole(connection: socket.socket, size: int) -> bytes:
    data = b""
    while len(data) < size:
        more = connection.recv(size - len(data))
        if not more:
            raise ConnectionResetError
        data += more
    return data


def say(connection: socket.socket, n: int, **message: Any) -> None:
    """Send a message of a page.

    Args:
        connection: of its link.
        n: its number.
        message: what else it holds.
    """
    send(connection, json.dumps({"n": n, **message}).encode())


def linked(port: int, token: str) -> socket.socket:
    """A link as a page has one, which has been welcomed.

    Args:
        port: of the server.
        token: of the server.

    Raises:
        ConnectionError: it was not let in.
    """
    host = f"localhost:{port}"
    status, connection = ask(port, f"/{token}/link", host=host, origin=f"http://{host}", upgrade=True)
    if status != 101 or receive(connection)["type"] != "welcome":
        raise ConnectionError(f"the server answers {status}")
    return connection
