"""Drake's own page of Meshcat, with small scripts before its own: what was drawn, how well, from where."""

from __future__ import annotations

import functools
from pathlib import Path

from pydrake.common import FindResourceOrThrow

PAGE = Path(__file__).parent / "page"
SCRIPTS = ("meshcat_quality.js", "meshcat_frame.js", "meshcat_camera.js")
"""Ours, which run before Meshcat's own."""


@functools.cache
def meshcat_page(name: str) -> tuple[str, bytes]:
    """A file of Meshcat's page as Drake ships it: its kind and what it holds. The page itself has our script first."""
    if name.endswith(".js"):
        return "text/javascript; charset=utf-8", _drakes("meshcat.js")
    if name.endswith(".ico"):
        return "image/x-icon", _drakes("meshcat.ico")
    page = _drakes("meshcat.html").decode()
    script = "\n".join((PAGE / name).read_text() for name in SCRIPTS)
    start = "<head>"
    if start not in page:  # pragma: no cover
        raise RuntimeError("Meshcat's page has no head: this version of Drake has another one")
    return "text/html; charset=utf-8", page.replace(start, f"{start}\n<script>\n{script}\n</script>", 1).encode()


def _drakes(name: str) -> bytes:
    return Path(FindResourceOrThrow(f"drake/geometry/{name}")).read_bytes()
