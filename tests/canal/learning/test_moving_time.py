"""Time: what counts as moving, what a gap is, and what is no time at all."""

import numpy as np
import pytest
from hard_demonstrations import hard_demonstrations

from canal.demonstration import Demonstration
from canal.errors import InputError
from canal.learning import learn_canal
from canal.learning.trimming import trim
from models.make_demonstrations import HANDS, LAUNDRY, RELOCATION, demonstrate

RATE = 20


def _minimum_jerk(seconds: float) -> np.ndarray:
    s = np.linspace(0, 1, round(seconds * RATE))
    return s**3 * (10 - 15 * s + 6 * s**2)


def _evenly_accelerated(seconds: float) -> np.ndarray:
    s = np.linspace(0, 1, round(seconds * RATE))
    speed = np.minimum(1.0, 4 * np.minimum(s, 1 - s))
    u = np.cumsum(speed)
    return (u - u[0]) / (u[-1] - u[0])


def _recorded(u: np.ndarray, noise: float = 1e-4, seed: int = 0) -> Demonstration:
    rng = np.random.default_rng(seed)
    position = np.column_stack([0.3 + 0.1 * np.sin(3 * u), 0.8 * u - 0.4, 0.5 + 0.2 * np.sin(np.pi * u)])
    return Demonstration(position + noise * rng.normal(size=position.shape), np.tile([1.0, 0, 0, 0], (len(u), 1)))


def _with_pauses(stroke, parts: int, seconds: float, pause: float) -> np.ndarray:
    still = np.zeros(round(pause * RATE))
    u = [still]
    for k in range(parts):
        u += [(k + stroke(seconds / parts)) / parts, still + (k + 1) / parts]
    return np.concatenate(u)


@pytest.mark.parametrize("stroke", [_minimum_jerk, _evenly_accelerated])
@pytest.mark.parametrize("parts", [1, 2, 3])
@pytest.mark.parametrize("pause", [1.0, 4.0, 20.0])
@pytest.mark.parametrize("noise", [0.0, 1e-4])
def test_moving_time_is_what_was_generated(stroke, parts, pause, noise):
    d = _recorded(_with_pauses(stroke, parts, 12.0, pause), noise)
    assert trim(d, 201).moving_time == pytest.approx(12.0, rel=0.05)


def test_pauses_do_not_count_however_long_they_are():
    short, long = (trim(_recorded(_with_pauses(_minimum_jerk, 2, 12.0, pause)), 201) for pause in (1.0, 30.0))
    assert long.moving_time == pytest.approx(short.moving_time, rel=0.02)


def test_slow_work_near_a_goal_is_motion():
    """A hand that takes 10 s for the last 4 cm, at a twentieth of its usual speed, is not pausing."""
    fast, slow = np.linspace(0, 0.95, 8 * RATE), np.linspace(0.95, 1, 10 * RATE)
    d = _recorded(np.concatenate([np.zeros(3 * RATE), fast, slow, np.ones(3 * RATE)]), 0.0)
    assert trim(d, 201).moving_time == pytest.approx(18.0, rel=0.05)


@pytest.mark.parametrize("task", [LAUNDRY, RELOCATION])
def test_the_pace_of_a_canal_is_that_of_its_demonstrations(task):
    """The generator's hands move for 26.5 s on the mean, with rests, tremor and dropped samples."""
    canal = learn_canal([Demonstration(*demonstrate(task, hand)) for hand in HANDS])
    assert canal.moving_time_s == pytest.approx(task.moving_time, rel=0.05)


def _with_gap(d: Demonstration, gap: float, written: bool) -> Demonstration:
    """A demonstration that rests for `gap` seconds half-way, in which the recorder goes on writing, or does not."""
    k = len(d) // 2
    rest = round(gap * RATE) if written else 1
    position = np.concatenate([d.position[:k], np.tile(d.position[k], (rest, 1)), d.position[k:]])
    orientation = np.concatenate([d.orientation[:k], np.tile(d.orientation[k], (rest, 1)), d.orientation[k:]])
    time = np.arange(len(position)) / RATE
    if not written:
        time[k + 1 :] += gap
    return Demonstration(position, orientation, time, d.name)


def _apart(a, b) -> float:
    u = np.linspace(0, 1, 400)
    a, b = (
        np.column_stack([np.interp(u, np.linspace(0, 1, c.n_disks), column) for column in c.directrix.T])
        for c in (a, b)
    )
    return float(np.linalg.norm(a - b, axis=1).max())


@pytest.mark.parametrize("gap", [5.0, 60.0, 600.0])
def test_a_gap_in_time_bends_nothing(gap):
    plain = hard_demonstrations(4)
    canal = learn_canal([_with_gap(d, gap, False) for d in plain])
    # At every length of the gap it is the same canal, to what a tenth of a millimetre of noise does.
    assert _apart(canal, learn_canal([_with_gap(d, 2.0, False) for d in plain])) < 1e-5
    assert _apart(canal, learn_canal([_with_gap(d, 2.0, True) for d in plain])) < 1e-3
    assert canal.moving_time_s == pytest.approx(learn_canal(plain).moving_time_s, rel=0.05)


def test_what_moved_in_a_gap_took_its_time():
    """Samples that are lost on the way, for 2 s, are passed at the usual speed, not at once."""
    d = _recorded(np.linspace(0, 1, 20 * RATE), 0.0)
    keep = np.ones(len(d), bool)
    keep[8 * RATE : 10 * RATE] = False
    lost = Demonstration(d.position[keep], d.orientation[keep], d.time[keep])
    whole, motion = trim(d, 201), trim(lost, 201)
    assert motion.moving_time == pytest.approx(whole.moving_time, rel=0.02)
    assert np.abs(motion.position - whole.position).max() < 0.02


@pytest.mark.parametrize("unit", [1e3, 1e6, 1e9])
def test_times_in_other_units_are_refused(unit):
    d = hard_demonstrations(4)[0]
    with pytest.raises(InputError, match="--time-unit ms") as caught:
        trim(Demonstration(d.position, d.orientation, d.time * unit), 201)
    assert "\n" not in str(caught.value)
