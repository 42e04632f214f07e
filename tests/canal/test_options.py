"""Options: what a field may be is declared at the field, and what it may not be is said in one line."""

from __future__ import annotations

from dataclasses import field, replace
from typing import Literal

import pytest

from canal.errors import InputError
from canal.options import COMMAND_LINE, Positive, Vector3, options, read_options, short


@options("inner")
class Inner:
    """A part."""

    speed: Positive = 1.0
    mode: Literal["leg", "paper"] = "leg"
    count: int = 3
    center: Vector3 = field(default_factory=lambda: [0.0, 0.0, 0.0])

    def __post_init__(self) -> None:
        if self.count == 7:
            raise InputError("count 7 does not go with this; give another")


@options()
class Outer:
    """The whole."""

    inner: Inner = field(default_factory=Inner)
    items: list[Inner] = field(default_factory=list)
    maybe: Inner | None = None
    name: str = ""


@options(COMMAND_LINE)
class Command:
    """Options of a command."""

    realtime_rate: Positive = 1.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Inner(speed=-1), "inner.speed is -1; give a number above 0"),
        (lambda: Inner(-1), "inner.speed is -1; give a number above 0"),
        (lambda: Inner(speed=float("nan")), "inner.speed is nan; give a finite number"),
        (lambda: replace(Inner(), speed=0), "inner.speed is 0; give a number above 0"),
        (lambda: Inner(pace=1), "inner.pace is not known; use speed, mode, count, center"),
        (lambda: Inner(count=2.5), "inner.count is 2.5; give a whole number"),
        (lambda: Inner(count=7), "inner: count 7 does not go with this; give another"),
        (lambda: Inner(mode="x"), "inner.mode is 'x'; give one of leg or paper"),
        (lambda: Inner(center=[1, 2]), "inner.center is [1, 2]; give 3 of them"),
        (lambda: Command(realtime_rate=0), "--realtime-rate is 0; give a number above 0"),
        (lambda: read_options(Outer, 7), "the document is 7; give keys among inner, items, maybe, name"),
        (lambda: read_options(Outer, {"inner": {"speed": "fast"}}), "inner.speed is 'fast'; give a number"),
        (lambda: read_options(Outer, {"items": [{"speed": 0}]}), "items[0].speed is 0; give a number above 0"),
        (lambda: read_options(Outer, {"items": [{"pace": 0}]}), "items[0].pace is not known; use speed, mode,"),
        (lambda: read_options(Outer, {"maybe": {"pace": 0}}), "maybe.pace is not known; use speed, mode,"),
        (lambda: read_options(Outer, {"maybe": 3}), "maybe is 3; give keys among speed, mode, count, center"),
        (lambda: read_options(Outer, {"name": 3}), "name is 3; give text"),
        (lambda: read_options(Outer, {"inner": {"speed": 10**5000}}), "inner.speed is a number of too many digits;"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_line(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_plain_data_becomes_options():
    made = read_options(
        Outer, {"inner": {"speed": "5e-4"}, "items": [{"mode": "paper"}]}
    )  # YAML 1.1 reads 5e-4 as text
    assert made == Outer(inner=Inner(speed=5e-4), items=[Inner(mode="paper")])
    assert read_options(Outer, {}) == Outer()


def test_a_value_that_is_huge_is_shown_short():
    bomb: list = [1] * 10
    for _ in range(9):
        bomb = [bomb] * 10
    assert len(short(bomb)) < 130
    assert len(short("x" * 10**6)) < 100
