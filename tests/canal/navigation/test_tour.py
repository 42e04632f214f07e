import numpy as np
import pytest
from canals import hard_canal

from canal.navigation import NavigationOptions
from canal.navigation.tour import Push, segments, tour


def test_a_tour_visits_pick_place_and_home_and_keeps_to_the_disks():
    canal = hard_canal()
    travelled = tour(canal)
    assert travelled.disk.min() == pytest.approx(0, abs=1)
    assert travelled.disk.max() == pytest.approx(canal.n_disks - 1, abs=1)
    assert travelled.disk[-1] == pytest.approx(canal.home_disk, abs=0.5)
    assert 0 <= travelled.eta.min() <= travelled.eta.max() <= 1
    assert len(travelled.corrections) == 4
    assert travelled.eta[-1] < 1e-3


def test_without_pushes_the_directrix_is_travelled():
    canal = hard_canal()
    travelled = tour(canal, pushes=())
    assert not travelled.correcting.any()
    centres = np.array([canal.center(disk) for disk in travelled.disk])
    assert np.abs(travelled.position - centres).max() < 1e-12


def test_while_the_thumb_pushes_the_way_stands_still():
    canal = hard_canal()
    travelled = tour(canal, [Push(0.1, 1.0, (1.0, 0.0))])
    assert np.ptp(travelled.disk[travelled.correcting]) == 0
    twice = tour(canal, [Push(0.1, 1.0, (1.0, 0.0))], NavigationOptions(wait_at_ends=False, speed_scale=2.0))
    assert len(twice.disk) < 0.6 * len(travelled.disk) + 100


def test_segments_start_where_the_correction_began():
    position = np.arange(21.0).reshape(7, 3)
    found = segments(position, np.array([0, 1, 1, 0, 0, 1, 1]))
    assert [len(part) for part in found] == [3, 3]
    assert np.array_equal(found[0][0], position[0])
    assert segments(position, np.zeros(7)) == []
