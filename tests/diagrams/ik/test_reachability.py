"""The reach report: all of a canal that the arm itself drew, less of one that leaves its reach."""

import numpy as np
import pytest
from ik_arm import TCP, lio_plant
from ik_canals import Q_MIDDLE, swung_canal

from diagrams.ik.reachability import ReachReport, reach_report
from diagrams.ik.solver import IkSolver
from diagrams.ik.start_posture import find_start_posture

COARSE = {"rings": 2, "spokes": 4, "most_disks": 31}


@pytest.fixture(scope="module")
def solver() -> IkSolver:
    return IkSolver(lio_plant(), TCP)


@pytest.fixture(scope="module")
def near(solver: IkSolver) -> ReachReport:
    canal = swung_canal(solver)
    return reach_report(solver, canal, find_start_posture(solver, canal, preferred=Q_MIDDLE), **COARSE)


@pytest.fixture(scope="module")
def lifted(solver: IkSolver) -> ReachReport:
    """The end rises to 0.7 m above where the arm was."""
    canal = swung_canal(solver, lift=0.9)
    return reach_report(solver, canal, find_start_posture(solver, canal, preferred=Q_MIDDLE), **COARSE)


def test_a_canal_that_the_arm_drew_is_reached(near: ReachReport) -> None:
    assert near.center_reached.all()
    assert near.share.mean() > 0.9


def test_a_canal_that_leaves_the_reach_is_reached_in_part(lifted: ReachReport) -> None:
    n_disks = len(lifted.share)
    assert lifted.share[: n_disks // 3].mean() > 0.8
    assert lifted.share[-n_disks // 10 :].max() == 0.0
    assert not lifted.center_reached[-1]
    missed = ~lifted.reached
    tolerances = lifted.position_errors[missed] > 1e-3, lifted.orientation_errors[missed] > 1e-3
    assert np.all(tolerances[0] | tolerances[1])


def test_colors_go_from_red_to_blue(near: ReachReport, lifted: ReachReport) -> None:
    colors = lifted.colors()
    assert colors.shape == (len(lifted.share), 3)
    assert np.all((colors >= 0.0) & (colors <= 1.0))
    red, _, blue = colors[-1]
    assert red > blue
    red, _, blue = near.colors()[len(near.share) // 2]
    assert blue > red


def test_the_words_say_where_it_is_out_of_reach(near: ReachReport, lifted: ReachReport) -> None:
    for report, out_at_the_end in ((near, False), (lifted, True)):
        text = "\n".join(report.describe())
        assert f"the arm reaches {100 * report.share.mean():.0f} % of the canal" in text
        assert (f"to {len(report.share) - 1}: less than half is reached" in text) == out_at_the_end
