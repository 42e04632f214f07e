"""What Meshcat tells its page, kept until the page asks for more: only the newest of what is replaced anyway."""

from __future__ import annotations

import struct

_REPLACED = ("set_transform", "set_object", "set_property", "set_target", "set_animation", "realtime_rate")


def head(message: bytes) -> tuple[str, str, str]:
    """Type, path and property of a message in MessagePack, as far as it begins with them; empty texts else."""
    found = {"type": "", "path": "", "property": ""}
    at = 1
    try:
        if not 0x80 <= message[0] <= 0x8F:
            return "", "", ""
        for _ in range(min(message[0] & 0x0F, 3)):
            key, at = _text(message, at)
            if key not in found:
                break
            found[key], at = _text(message, at)
    except (IndexError, ValueError):
        pass
    return found["type"], found["path"], found["property"]


def _text(message: bytes, at: int) -> tuple[str, int]:
    first = message[at]
    if 0xA0 <= first <= 0xBF:
        size, at = first & 0x1F, at + 1
    elif first == 0xD9:
        size, at = message[at + 1], at + 2
    elif first == 0xDA:
        size, at = int.from_bytes(message[at + 1 : at + 3], "big"), at + 3
    else:
        raise ValueError("no text")
    return message[at : at + size].decode(), at + size


class Newest:
    """Messages that wait, in the order in which the newest of each kind came; no more than the scene is large."""

    def __init__(self) -> None:
        self._waiting: dict[object, bytes] = {}
        self._placed: dict[str, bytes] = {}
        self._others = 0

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, message: bytes) -> None:
        """Keep a message; what it replaces goes."""
        kind, path, name = head(message)
        if kind == "set_transform" and self._placed.get(path) == message:
            return  # where it is: bodies that stand are told again at each picture
        if kind == "set_transform":
            self._placed[path] = message
        elif kind == "delete":
            self._forget(path)
        if kind in _REPLACED:
            key: object = (kind, path, name)
            self._waiting.pop(key, None)
        else:
            self._others += 1
            key = self._others
        self._waiting[key] = message

    def take(self) -> bytes:
        """All that waits, as one: of each message its length in four bytes, little-endian, and the message."""
        whole = b"".join(part for m in self._waiting.values() for part in (struct.pack("<I", len(m)), m))
        self._waiting.clear()
        return whole

    def _forget(self, path: str) -> None:
        below = path.rstrip("/") + "/"
        gone = [k for k in self._waiting if isinstance(k, tuple) and (k[1] == path or k[1].startswith(below))]
        for key in gone:
            del self._waiting[key]
        for place in [p for p in self._placed if p == path or p.startswith(below)]:
            del self._placed[place]
