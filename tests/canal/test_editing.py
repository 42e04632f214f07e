import numpy as np
import pytest
from canals import elliptic_canal, hard_canal
from hard_demonstrations import hard_demonstrations

from canal.demonstration import Demonstration
from canal.editing import add_demonstration, cut, join, reverse
from canal.errors import InputError
from canal.learning import learn_canal
from canal.learning.disk_normals import ROOM
from canal.quality import canal_quality
from canal.retargeting import retarget


def assert_is_canal(canal):
    quality = canal_quality(canal)
    assert quality.outside_ball <= 1e-12
    assert quality.end_share_max <= 1.15
    assert quality.crossing <= ROOM
    assert quality.tangent_error_p99 <= 1.5
    frame = np.stack([canal.x_axes, canal.y_axes, canal.normals], axis=1)
    assert np.abs(frame @ frame.transpose(0, 2, 1) - np.eye(3)).max() < 1e-12


def test_reverse_keeps_points_and_twice_is_the_identity():
    canal = elliptic_canal()
    back = reverse(canal)
    last = canal.n_disks - 1
    for s in (0, 10.5, canal.home_disk, 99.25):
        assert np.abs(back.point(last - s, 0.7, 1.1) - canal.point(s, 0.7, 1.1)).max() < 1e-12
        assert np.abs(back.orientation(last - s) - canal.orientation(s)).max() < 1e-12
    assert np.array_equal(back.tangents[0], -canal.tangents[-1])
    again = reverse(back)
    for name in ("directrix", "radii", "normals", "x_axes", "y_axes", "demonstrations", "ellipses"):
        assert np.array_equal(getattr(again, name), getattr(canal, name))
    assert_is_canal(back)


def test_a_cut_is_the_part_and_has_its_own_home():
    canal = hard_canal()
    first, last = 30.5, 200.0
    part = cut(canal, first, last)
    assert_is_canal(part)
    assert np.abs(part.directrix[0] - canal.center(first)).max() < 1e-9
    assert np.abs(part.directrix[-1] - canal.center(last)).max() < 1e-9
    share = (last - first) / (canal.n_disks - 1)
    assert part.length == pytest.approx(share * canal.length, rel=1e-3)
    assert part.moving_time_s == pytest.approx(share * canal.moving_time_s, rel=1e-3)
    assert np.abs(part.center(part.home_disk) - canal.center((first + last) / 2)).max() < 1e-4
    assert part.radius(part.home_disk) == pytest.approx(canal.radius((first + last) / 2), abs=1e-4)


@pytest.mark.parametrize(("first", "last"), [(-1, 50), (50, 20), (10, 11), (0, 1000), (np.nan, 50)])
def test_a_cut_that_is_none_is_refused(first, last):
    with pytest.raises(InputError, match="cut from disk"):
        cut(hard_canal(), first, last)


def test_what_was_cut_is_joined_again():
    canal = hard_canal()
    joined = join(cut(canal, 0, 150), cut(canal, 150, canal.n_disks - 1))
    assert_is_canal(joined)
    assert joined.length == pytest.approx(canal.length, rel=2e-3)
    assert joined.moving_time_s == pytest.approx(canal.moving_time_s, rel=1e-3)
    at = np.linspace(0, 1, 60)
    apart = [
        np.linalg.norm(joined.center(u * (joined.n_disks - 1)) - canal.center(u * (canal.n_disks - 1))) for u in at
    ]
    assert max(apart) < 0.004


def test_canals_of_other_numbers_of_demonstrations_with_a_gap_are_joined():
    first = hard_canal(3, 2)
    second = hard_canal(4, 3)
    second = retarget(second, pick=first.directrix[-1] + [0.02, 0.01, 0.0], place=second.directrix[-1])
    joined = join(first, second)
    assert len(joined.demonstrations) == 6
    assert np.abs(joined.directrix[0] - first.directrix[0]).max() < 1e-9
    assert np.abs(joined.directrix[-1] - second.directrix[-1]).max() < 1e-9
    assert np.isfinite(joined.directrix).all()
    assert canal_quality(joined).outside_ball <= 1e-12
    steps = np.linalg.norm(np.diff(joined.demonstrations, axis=1), axis=2)
    assert steps.max() < 0.03


def test_canals_that_do_not_meet_are_not_joined():
    with pytest.raises(InputError, match="retarget"):
        join(hard_canal(), hard_canal())


def test_a_demonstration_added_without_the_old_ones_comes_near_to_learning_all_anew():
    demonstrations = hard_demonstrations(6, 3)
    anew = learn_canal(demonstrations)
    added = add_demonstration(learn_canal(demonstrations[:2]), demonstrations[2])
    assert_is_canal(added)
    assert len(added.demonstrations) == 3
    at = np.linspace(0, 1, 80)
    apart = [np.linalg.norm(added.center(u * (added.n_disks - 1)) - anew.center(u * (anew.n_disks - 1))) for u in at]
    assert max(apart) < 0.03
    assert np.mean(apart) < 0.012
    assert added.moving_time_s == pytest.approx(anew.moving_time_s, rel=1e-6)


def test_a_demonstration_that_runs_the_other_way_is_not_added():
    d = hard_demonstrations(6, 3)[2]
    with pytest.raises(InputError, match="opposite direction to the canal"):
        add_demonstration(hard_canal(6, 3), Demonstration(d.position[::-1], d.orientation[::-1]))
