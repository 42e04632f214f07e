"""What waits for a page: only the newest of each kind, in an order in which it can be drawn."""

import struct

import pytest
import umsgpack
from hypothesis import given
from hypothesis import strategies as st

from geosacs_drake.console.meshcat_feed import split
from geosacs_drake.console.newest import Newest, head


def message(kind, path, **more):
    return umsgpack.packb({"type": kind, "path": path, **more})


def taken(newest):
    whole, found = newest.take(), []
    while whole:
        (size,) = struct.unpack("<I", whole[:4])
        found.append(umsgpack.unpackb(whole[4 : 4 + size]))
        whole = whole[4 + size :]
    return found


def test_only_the_newest_transform_of_each_path_is_passed_on():
    newest = Newest()
    for k in range(5):
        newest.add(message("set_transform", "/a", matrix=[k]))
        newest.add(message("set_transform", "/b", matrix=[-k]))
    assert [(m["path"], m["matrix"]) for m in taken(newest)] == [("/a", [4]), ("/b", [-4])]
    assert not len(newest)


def test_a_body_that_stands_is_told_once():
    newest = Newest()
    newest.add(message("set_transform", "/a", matrix=[1]))
    taken(newest)
    newest.add(message("set_transform", "/a", matrix=[1]))
    assert not taken(newest)
    newest.add(message("delete", "/"))
    newest.add(message("set_transform", "/a", matrix=[1]))
    assert [m["type"] for m in taken(newest)] == ["delete", "set_transform"]


def test_a_property_of_an_object_follows_the_object_that_it_was_set_on():
    newest = Newest()
    for k in range(3):
        newest.add(message("set_object", "/a", object=k))
        newest.add(message("set_property", "/a/<object>", property="castShadow", value=k))
    assert [m["type"] for m in taken(newest)] == ["set_object", "set_property"]


def test_what_is_below_a_deleted_path_goes_and_its_neighbour_stays():
    newest = Newest()
    for path in ("/a", "/a/b", "/ab"):
        newest.add(message("set_object", path, object=0))
    newest.add(message("delete", "/a"))
    assert [(m["type"], m["path"]) for m in taken(newest)] == [("set_object", "/ab"), ("delete", "/a")]


@pytest.mark.parametrize("size", [1, 31, 32, 255, 256, 3000])
def test_heads_are_read_as_msgpack_writes_them(size):
    path = "/" + "ü" * ((size - 1) // 2)
    assert head(message("set_property", path, property="p" * size, value=1)) == ("set_property", path, "p" * size)


@given(st.binary(max_size=80))
def test_no_bytes_break_it(data):
    newest = Newest()
    head(data)
    newest.add(data)
    newest.take()
    split(data)


def frame(payload):
    size = len(payload)
    if size < 126:
        return bytes([0x82, size]) + payload
    if size < 65536:
        return b"\x82\x7e" + struct.pack(">H", size) + payload
    return b"\x82\x7f" + struct.pack(">Q", size) + payload


def test_messages_are_taken_from_a_stream_wherever_it_is_cut():
    payloads = [b"a" * n for n in (1, 125, 126, 70000)]
    stream, found, rest = b"".join(map(frame, payloads)), [], b""
    for at in range(0, len(stream), 777):
        messages, rest = split(rest + stream[at : at + 777])
        found += messages
    assert found == payloads
    assert rest == b""
