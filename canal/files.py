"""Files that we write: whole, or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from canal.errors import InputError


def write_npz(path: str | os.PathLike, **arrays: np.ndarray) -> None:
    """Write arrays to an `.npz`: a reader sees the old file or the whole new one, never half of it."""
    write_and_rename(Path(path), lambda stream: np.savez_compressed(stream, allow_pickle=False, **arrays))


def write_and_rename(path: Path, write: Callable) -> None:
    """Call `write(stream)` on a temporary binary file beside `path`, then rename it to `path`.

    Raises:
        InputError: the folder does not exist or cannot be written to.
    """
    temporary = None
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent or ".")
        with os.fdopen(handle, "wb") as stream:
            write(stream)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another place") from None
