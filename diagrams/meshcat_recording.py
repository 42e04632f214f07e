"""What was seen in Meshcat as one HTML file that plays anywhere, without a network."""

from __future__ import annotations

import os
from pathlib import Path

from pydrake.geometry import Meshcat

from canal.demonstration import write_and_rename
from canal.errors import InputError

FRAMES_PER_SECOND = 32.0
"""As often as the pictures are drawn."""

PAGE_TITLE = "<title>Drake MeshCat</title>"


def start_recording(meshcat: Meshcat, path: str | Path) -> None:
    """Record from now on what the visualizers publish, to be saved at `path`.

    Raises:
        InputError: nothing can be written there (better known before the run than after it).
    """
    folder = Path(path).absolute().parent
    if Path(path).is_dir() or not folder.is_dir() or not os.access(folder, os.W_OK):
        raise InputError(f"{path}: cannot be written; give a file in a folder that exists and may be written to")
    meshcat.StartRecording(frames_per_second=FRAMES_PER_SECOND)


def save_recording(meshcat: Meshcat, path: str | Path, *, title: str) -> None:
    """End the recording and write it to `path`, whole or not at all.

    The file holds the scene, the animation (it plays when opened, and "Animations" under "Open Controls" plays it
    again) and all the scripts.

    Raises:
        InputError: the file cannot be written.
    """
    meshcat.StopRecording()
    meshcat.PublishRecording()
    html = meshcat.StaticHtml().replace(PAGE_TITLE, f"<title>{title}</title>", 1)
    write_and_rename(Path(path), lambda stream: stream.write(html.encode()))
