"""Outputs that appear whole or not at all, and destroy nothing: links are followed, pipes and devices stay what they
are, an existing file keeps its mode and owner, a new one has what the umask leaves."""

from __future__ import annotations

import contextlib
import errno
import io
import os
import secrets
import stat
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from canal.errors import InputError

READER_S = 10.0
"""[s] How long a pipe waits for somebody who reads it."""

_unfinished: set[Path] = set()
"""Temporary files that are being written."""


def write_npz(path: str | os.PathLike[str], **arrays: np.ndarray) -> None:
    """Write arrays to an `.npz`: a reader sees the old file or the whole new one, never half of it."""
    write_and_rename(Path(path), lambda stream: np.savez_compressed(stream, allow_pickle=False, **arrays))


def write_and_rename(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Call `write(stream)` on a temporary binary file beside `path`, then rename it to `path`.

    A pipe or a character device gets the same bytes in place.

    Args:
        path: what to write; a link means what it points to.
        write: writes all of it to a binary stream.

    Raises:
        InputError: the folder does not exist or cannot be written to, the disk is full, nobody reads the pipe.
    """
    try:
        status = _status(path)
        if status is None or (stat.S_ISREG(status.st_mode) and _own_stream(status) is None):
            _write_beside(path, status, write)
        else:
            _write_in_place(path, status, write)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({_reason(error)}); choose another path") from None


def check_output(path: Path) -> None:
    """Whether `path` can be written, as far as it can be known before.

    Raises:
        InputError: there is no such folder, or what is there is none to write to.
    """
    try:
        status = _status(path)
        mode = 0 if status is None else status.st_mode
        if stat.S_ISDIR(mode):
            raise InputError(f"{path}: is a folder; give a file")
        if stat.S_ISBLK(mode) or stat.S_ISSOCK(mode):
            raise InputError(f"{path}: is a {'disk' if stat.S_ISBLK(mode) else 'socket'}; give a file or a pipe")
        if status is not None and not os.access(path, os.W_OK):
            raise InputError(f"{path}: is write-protected; choose another path")
        if status is None or stat.S_ISREG(mode):
            folder = _target(path).parent
            if not folder.is_dir():
                raise InputError(
                    f"{path}: there is no folder {folder if folder.is_absolute() else path.parent}; make it first"
                )
            with _temporary(folder) as (temporary, handle):
                os.close(handle)
                temporary.unlink()
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({_reason(error)}); choose another path") from None


def identity(path: Path) -> object:
    """Equal for two names of one file, also where links or hard links lead to it; None for a device that takes all.

    Raises:
        OSError: the name cannot be looked up.
    """
    status = _status(path)
    if status is None:
        return str(_target(path))
    return None if stat.S_ISCHR(status.st_mode) else (status.st_dev, status.st_ino)


def discard_unfinished() -> None:
    """Remove the temporary files that are being written: for who ends the process without unwinding."""
    for temporary in tuple(_unfinished):
        with contextlib.suppress(OSError):
            temporary.unlink()


def _status(path: Path) -> os.stat_result | None:
    """Of what the name leads to; None where there is nothing yet."""
    try:
        return os.stat(path)
    except FileNotFoundError:
        return None


def _target(path: Path) -> Path:
    return Path(os.path.realpath(path))


def _own_stream(status: os.stat_result) -> int | None:
    """The descriptor of standard output or error if that is the file: renaming another over it would cut it off."""
    for descriptor in (1, 2):
        with contextlib.suppress(OSError):
            if os.path.samestat(os.fstat(descriptor), status):
                return descriptor
    return None


@contextlib.contextmanager
def _temporary(folder: Path) -> Iterator[tuple[Path, int]]:
    """A new file and its descriptor; removed if the block is left by an exception."""
    path = folder / f".{secrets.token_hex(8)}.part"
    _unfinished.add(path)
    try:
        yield path, os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    except BaseException:
        with contextlib.suppress(OSError):
            path.unlink()
        raise
    finally:
        _unfinished.discard(path)


def _write_beside(path: Path, status: os.stat_result | None, write: Callable[[BinaryIO], object]) -> None:
    target = _target(path)
    with _temporary(target.parent) as (temporary, handle):
        with os.fdopen(handle, "wb") as stream:
            if status is not None:
                with contextlib.suppress(OSError):  # only its owner may give it to another
                    os.fchown(handle, status.st_uid, status.st_gid)
                os.fchmod(handle, stat.S_IMODE(status.st_mode))
            write(stream)
            stream.flush()
            os.fsync(handle)  # what a full disk refuses is known before the old file goes
        os.replace(temporary, target)


def _write_in_place(path: Path, status: os.stat_result, write: Callable[[BinaryIO], object]) -> None:
    content = io.BytesIO()  # archives seek in what they write
    write(content)
    own = _own_stream(status)
    with os.fdopen(_open_pipe(path) if own is None else os.dup(own), "wb") as stream:
        stream.write(content.getbuffer())


def _open_pipe(path: Path) -> int:
    """Open for writing what is there; without a reader a pipe would wait for ever."""
    give_up = time.monotonic() + READER_S
    while True:
        try:
            handle = os.open(path, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        except OSError as error:
            if error.errno != errno.ENXIO:
                raise
            if time.monotonic() > give_up:
                raise OSError(errno.ENXIO, "nobody reads this pipe") from None
            time.sleep(0.05)
        else:
            os.set_blocking(handle, True)
            return handle


def _reason(error: OSError) -> str:
    return error.strerror or str(error)
