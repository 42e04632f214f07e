"""The start posture: the branch that follows the whole canal is found, whatever the others look like."""

from dataclasses import replace

import numpy as np
import pytest
from ik_arm import TCP, lio_plant, pose_of
from ik_canals import Q_MIDDLE, swung_canal

from canal.errors import InputError
from canal.surface import CanalSurface
from diagrams.ik.options import IkOptions
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import StartPosture, find_start_posture, follow


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


@pytest.fixture(scope="module")
def canal(solver: IkSolver) -> CanalSurface:
    return swung_canal(solver)


@pytest.fixture(scope="module")
def start(solver: IkSolver, canal: CanalSurface) -> StartPosture:
    return find_start_posture(solver, canal)


def test_the_whole_canal_is_followed_from_it(solver: IkSolver, canal: CanalSurface, start: StartPosture) -> None:
    assert start.complete
    assert start.branches > 1
    assert start.largest_step < 0.05
    home = canal.pose(canal.home_disk)
    np.testing.assert_allclose(pose_of(solver, start.q)[:3], home[:3], atol=1e-4)


def test_it_holds_in_the_loop_forth_and_back(solver: IkSolver, canal: CanalSurface, start: StartPosture) -> None:
    home, last = canal.home_disk, canal.n_disks - 1
    q, v = start.q, np.zeros(6)
    for disk in (*range(home, -1, -1), *range(last + 1), *range(last, home, -1)):
        result = solver.solve(canal.pose(disk), float(canal.orientation_weights[disk]), q, 0.06, v)
        q, v = result.q, (result.q - q) / 0.06
        assert result.position_error < 1e-3
        np.testing.assert_allclose(q, start.path[disk], atol=0.3)  # another branch is more than 1 rad away


def test_another_branch_is_told_from_it(solver: IkSolver, canal: CanalSurface) -> None:
    narrow = IkSolver(lio_plant(), TCP, IkOptions(soft_limit_margin=1.2))
    crippled = follow(narrow, canal, np.clip(Q_MIDDLE, narrow.q_min, narrow.q_max))
    assert not crippled.complete
    assert crippled.limit_margin <= 0.0


def test_the_branch_near_the_preferred_posture_is_taken_among_equals(solver: IkSolver, canal: CanalSurface) -> None:
    near = find_start_posture(solver, canal, preferred=Q_MIDDLE)
    assert near.complete
    assert np.abs(near.q - Q_MIDDLE).max() < 0.6


def test_the_choice_does_not_depend_on_the_dice(solver: IkSolver, canal: CanalSurface, start: StartPosture) -> None:
    np.testing.assert_allclose(find_start_posture(solver, canal, seed=1).q, start.q, atol=1e-3)


def test_the_choice_is_reported_in_one_line(start: StartPosture) -> None:
    line = start.describe()
    assert "\n" not in line
    assert "follows 100 % of the directrix" in line
    assert start.limit_joint in line


def test_a_home_out_of_reach_is_refused(solver: IkSolver, canal: CanalSurface) -> None:
    with pytest.raises(InputError, match="out of the arm's reach"):
        find_start_posture(solver, replace(canal, directrix=canal.directrix + [2.0, 0.0, 0.0]))
