"""How the controls of devices are bound: a file for each name, in the person's folder for settings."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from canal.errors import InputError
from canal.files import write_and_rename
from geosacs_drake.console.messages import MOST_BYTES

MOST_FILES = 50
"""That are read; a person has a few devices."""


def settings_folder() -> Path:
    """Where a person's settings of this program are: as XDG says, below `~/.config` else."""
    return Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config") / "geosacs" / "controllers"


class BindingFiles:
    """The bindings that were kept."""

    def __init__(self, folder: Path | None = None) -> None:
        """Keep them in `folder`; None: in the person's own."""
        self.folder = folder or settings_folder()

    def all(self) -> dict[str, Any]:
        """By name, the newest first. What cannot be read is left out."""
        try:
            files = sorted(self.folder.glob("*.json"), key=lambda path: -path.stat().st_mtime)[:MOST_FILES]
        except OSError:
            return {}
        found = {}
        for path in files:
            try:
                bindings = json.loads(path.read_text()[: 2 * MOST_BYTES])
            except (OSError, ValueError):
                continue
            if isinstance(bindings, dict) and isinstance(bindings.get("device"), str):
                found[path.stem] = bindings
        return found

    def keep(self, name: str, bindings: dict[str, Any]) -> str:
        """Write bindings to the file of a name that is safe as one; what a person is told.

        Args:
            name: of the file, without its ending.
            bindings: what is kept.
        """
        path = self.folder / f"{name}.json"
        text = json.dumps(bindings, indent=2) + "\n"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            write_and_rename(path, lambda stream: stream.write(text.encode()))
        except (OSError, InputError) as error:
            return f"The controls could not be saved: {getattr(error, 'strerror', None) or error}"
        return f"Saved to {path}"
