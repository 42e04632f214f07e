"""A connection to Meshcat as its page has one, read in bulk: a message costs a few microseconds of the run's time."""

from __future__ import annotations

import asyncio
import base64
import os
from collections.abc import AsyncIterator

BULK = 1 << 20
"""[bytes] Read at once."""
PAUSE_S = 0.02
"""[s] Between two looks: what came together is handled together."""


async def meshcat_messages(host: str, port: int) -> AsyncIterator[list[bytes]]:
    """What Meshcat tells a page, from the whole scene on; ends when Meshcat does. Nothing is ever said to it.

    Args:
        host: where Meshcat listens.
        port: likewise.

    Yields:
        The messages that have come since the last look.
    """
    reader, writer = await asyncio.open_connection(host, port, limit=4 * BULK)
    try:
        key = base64.b64encode(os.urandom(16)).decode()
        writer.write(
            (
                f"GET / HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
            ).encode()
        )
        await reader.readuntil(b"\r\n\r\n")
        rest = b""
        while chunk := await reader.read(BULK):
            messages, rest = split(rest + chunk)
            if messages:
                yield messages
            await asyncio.sleep(PAUSE_S)
    finally:
        writer.close()


def split(data: bytes) -> tuple[list[bytes], bytes]:
    """Whole messages of a server's WebSocket, and what is left. Meshcat sends each in one frame, unmasked."""
    messages, at = [], 0
    while len(data) >= at + 2:
        size, start = data[at + 1] & 0x7F, at + 2
        if size == 126:
            size, start = int.from_bytes(data[at + 2 : at + 4], "big"), at + 4
        elif size == 127:
            size, start = int.from_bytes(data[at + 2 : at + 10], "big"), at + 10
        if len(data) < start + size:
            break
        if data[at] & 0x0F in (1, 2):
            messages.append(data[start : start + size])
        at = start + size
    return messages, data[at:]
