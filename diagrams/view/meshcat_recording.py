"""What was seen in Meshcat as one HTML file that plays anywhere, without a network."""

from __future__ import annotations

import html
from pathlib import Path

from pydrake.geometry import Meshcat

from canal.files import write_and_rename

FRAMES_PER_SECOND = 32.0
"""As often as the pictures are drawn."""

PAGE_TITLE = "<title>Drake MeshCat</title>"
"""Title of the page that is written."""


class Recording:
    """Records what the visualizers publish in a Meshcat, from when it is made until it is saved."""

    def __init__(self, meshcat: Meshcat, *, title: str = "GeoSACS") -> None:
        """Begin; `title` is what the browser writes above the page."""
        self._meshcat = meshcat
        self._title = title
        meshcat.StartRecording(frames_per_second=FRAMES_PER_SECOND)

    def save(self, path: str | Path) -> None:
        """End the recording and write it to `path`, whole or not at all.

        The file holds the scene, the animation and all the scripts. It plays when opened; "Animations" under
        "Open Controls" plays it again.

        Raises:
            InputError: the file cannot be written.
        """
        self._meshcat.StopRecording()
        self._meshcat.PublishRecording()
        title = f"<title>{html.escape(self._title)}</title>"
        page = self._meshcat.StaticHtml().replace(PAGE_TITLE, title, 1)
        write_and_rename(Path(path), lambda stream: stream.write(page.encode()))
