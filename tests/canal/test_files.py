"""Outputs destroy nothing: links, pipes, devices, modes, owners, full disks."""

import os
import stat
import subprocess
import sys
import threading

import numpy as np
import pytest

from canal import files
from canal.errors import InputError
from canal.files import check_output, discard_unfinished, identity, write_and_rename, write_npz


def put(text: bytes):
    return lambda stream: stream.write(text)


@pytest.mark.parametrize("umask", [0o022, 0o077, 0o002])
def test_a_new_file_has_what_the_umask_leaves(tmp_path, umask):
    before = os.umask(umask)
    try:
        write_and_rename(tmp_path / "a", put(b"x"))
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o666 & ~umask


def test_an_existing_file_keeps_its_mode_and_owner(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    path.chmod(0o640)
    owner = (12345, 12345) if os.geteuid() == 0 else (os.geteuid(), os.getegid())
    os.chown(path, *owner)
    write_and_rename(path, put(b"new"))
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert (path.stat().st_uid, path.stat().st_gid) == owner


def test_a_link_is_followed(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    target, link = tmp_path / "elsewhere" / "t", tmp_path / "link"
    link.symlink_to(target)
    for text in (b"dangling before", b"there before"):
        check_output(link)
        write_and_rename(link, put(text))
        assert link.is_symlink()
        assert target.read_bytes() == text
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["elsewhere", "link", "t"]


def test_a_pipe_stays_a_pipe_and_gets_the_bytes(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    check_output(pipe)
    got = []
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    reader.start()
    write_npz(pipe, a=np.arange(30000))
    reader.join(30)
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    (tmp_path / "copy.npz").write_bytes(got[0])
    with np.load(tmp_path / "copy.npz") as copy:
        np.testing.assert_array_equal(copy["a"], np.arange(30000))


def test_a_pipe_that_nobody_reads_is_said(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "READER_S", 0.1)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="nobody reads"):
        write_and_rename(tmp_path / "pipe", put(b"x"))


@pytest.mark.skipif(os.geteuid() != 0, reason="only root makes devices")
def test_a_device_stays_a_device(tmp_path):
    null = tmp_path / "null"
    os.mknod(null, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    check_output(null)
    write_and_rename(null, put(b"x"))
    assert stat.S_ISCHR(null.stat().st_mode)
    assert [p.name for p in tmp_path.iterdir()] == ["null"]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root makes devices")
def test_a_disk_is_refused(tmp_path):
    os.mknod(tmp_path / "disk", 0o666 | stat.S_IFBLK, os.makedev(259, 259))
    with pytest.raises(InputError, match="is a disk"):
        check_output(tmp_path / "disk")


def test_a_full_disk_is_said_and_the_old_file_stays(tmp_path):
    full = tmp_path / "full"
    full.symlink_to("/dev/full")
    with pytest.raises(InputError, match="No space left"):
        write_and_rename(full, put(b"x"))


def test_a_write_that_fails_leaves_the_old_file_and_no_temporary_one(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")

    def interrupted(stream):
        stream.write(b"half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_and_rename(path, interrupted)
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("a", b"old")]


def test_who_ends_the_process_while_it_writes_can_remove_what_is_half_written(tmp_path):
    def write(stream):
        assert len(list(tmp_path.iterdir())) == 1
        discard_unfinished()
        assert not list(tmp_path.iterdir())

    with pytest.raises(InputError):
        write_and_rename(tmp_path / "a", write)


def test_the_stream_of_the_command_itself_is_written_in_place(tmp_path):
    # As in `run --summary /dev/stdout > out.json`.
    out = tmp_path / "out.json"
    code = (
        "from pathlib import Path; from canal.files import write_and_rename as w;"
        "print('before', flush=True); w(Path('/dev/stdout'), lambda s: s.write(b'{}\\n')); print('after')"
    )
    with out.open("w") as stream:
        subprocess.run([sys.executable, "-c", code], stdout=stream, check=True)
    assert out.read_text() == "before\n{}\nafter\n"


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("x" * 300, "too long"),
        ("no/where/a", "there is no folder"),
        ("file/a", "Not a directory"),
        (".", "is a folder"),
    ],
)
def test_what_can_be_known_before(tmp_path, name, says):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=says) as error:
        check_output(tmp_path / name)
    assert "\n" not in str(error.value)
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_a_loop_of_links(tmp_path):
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(InputError, match="links"):
        check_output(tmp_path / "a")


def test_names_of_one_file(tmp_path):
    a = tmp_path / "a"
    a.touch()
    (tmp_path / "soft").symlink_to(a)
    os.link(a, tmp_path / "hard")
    (tmp_path / "folder").symlink_to(tmp_path)
    names = [a, tmp_path / "soft", tmp_path / "hard", tmp_path / "folder" / "a", tmp_path / ".." / tmp_path.name / "a"]
    assert len({identity(name) for name in names}) == 1
    assert identity(tmp_path / "new") == identity(tmp_path / "folder" / "new") != identity(a)
