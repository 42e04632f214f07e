"""A WebSocket client that sends what a browser would not."""

from __future__ import annotations

import base64
import os
import socket
import struct


class Client:
    """A connection to a server on this machine, from a page of another origin, for a `with` block.

    It has to stay open until the server has taken what was sent: a socket that is closed with something unread in it
    (the scene, which Meshcat sends first) resets its connection, and the kernel drops what the server has not read.
    """

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=30)
        key = base64.b64encode(os.urandom(16)).decode()
        request = (
            "GET / HTTP/1.1\r\nHost: elsewhere.example\r\nOrigin: http://elsewhere.example\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        self.socket.sendall(request.encode())
        answer = b""
        while b"\r\n\r\n" not in answer:
            answer += self.socket.recv(1)
        assert b" 101 " in answer

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def send(self, payload: bytes, times: int = 1) -> None:
        """Send a binary message, so many times."""
        mask, size = os.urandom(4), len(payload)
        header = bytes([0x82, 0x80 | size]) if size < 126 else bytes([0x82, 0xFE]) + struct.pack(">H", size)
        self.socket.sendall((header + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(payload))) * times)


def packed(message: dict[str, str]) -> bytes:
    """A small mapping of short texts in MessagePack, as Meshcat's page sends events."""
    words = [text.encode() for pair in message.items() for text in pair]
    return bytes([0x80 | len(message)]) + b"".join(
        (bytes([0xA0 | len(w)]) if len(w) < 32 else bytes([0xD9, len(w)])) + w for w in words
    )
