"""Right on the stick is right in the view: over all disks of the canals that ship, for each seat."""

import functools

import numpy as np
import pytest
from canal_examples import quarter_turn
from hypothesis import given, settings
from hypothesis import strategies as st

from canal.navigation import NavigationState
from canal.navigation.stick_directions import SEATS, View, stick_directions, view_from
from diagrams.scenario import load_scenario
from diagrams.teleop.stick_mapping import StickMapping, hand_for
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions
from models import SCENARIOS

CANALS = sorted(path.stem for path in SCENARIOS.glob("*.yaml"))
MOST_TURN = 20.0
"""[deg] From disk to disk."""


@functools.cache
def shipped(name):
    return prepare_canal(load_scenario(name), RunOptions())


def normals(canal):
    found = np.cross(canal.x_axes, canal.y_axes)
    return found / np.linalg.norm(found, axis=1)[:, None]


def degrees(cosine):
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def check(canal, view):
    directions, n = stick_directions(canal, view), normals(canal)
    assert directions.shape == (canal.n_disks, 2, 3)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=2), 1, atol=1e-12)
    np.testing.assert_allclose(np.einsum("nkj,nj->nk", directions, n), 0, atol=1e-9)
    for axis, wanted in enumerate((view.right, view.up)):
        to_plane = degrees(np.sqrt(1 - np.clip(n @ wanted, -1, 1) ** 2))
        held = to_plane <= 45
        off = degrees(directions[:, axis] @ wanted)
        assert off[held].size == 0 or off[held].max() <= 45 + 1e-6
    turn = degrees(np.einsum("nkj,nkj->nk", directions[1:], directions[:-1]))
    tilt = degrees(np.abs(np.einsum("nj,nj->n", n[1:], n[:-1])))
    assert turn.max() <= max(MOST_TURN, tilt.max() + 16)
    return directions


@pytest.mark.parametrize("seat", SEATS)
@pytest.mark.parametrize("name", CANALS)
def test_right_and_up_move_the_point_to_the_right_and_up(name, seat):
    """Wherever the disk's plane holds a direction within 45° of it, and without a jump."""
    directions = check(shipped(name), SEATS[seat])
    # Both are of use nearly everywhere: two of a hundred disks at most have axes less than 30° across each other.
    across = np.linalg.norm(np.cross(directions[:, 0], directions[:, 1]), axis=1)
    assert (across < 0.5).mean() <= 0.035


def test_the_papers_axes_do_not():
    """What the mapping is for: by the raw axes, right on the stick is not right in the view."""
    canal = shipped("laundry")
    off = degrees(canal.x_axes @ SEATS["front"].right)
    held = np.abs(normals(canal) @ SEATS["front"].right) <= np.sqrt(0.5)
    assert (off[held] > 45).mean() > 0.5


def test_up_on_a_lying_disk_is_away_from_the_person():
    canal = shipped("laundry")
    for seat in SEATS.values():
        right, up = stick_directions(canal, seat)[0]
        assert right @ seat.right > 0.9
        assert up @ seat.away > 0.9


@settings(max_examples=15, deadline=None)
@given(st.floats(-np.pi, np.pi), st.floats(-1.2, 1.2))
def test_any_view_is_mapped_as_well(turn, pitch):
    right = np.array([np.cos(turn), np.sin(turn), 0.0])
    flat = np.array([-np.sin(turn), np.cos(turn), 0.0])
    up = np.cos(pitch) * np.array([0.0, 0.0, 1.0]) + np.sin(pitch) * flat
    check(shipped("relocation"), view_from(right, up))


def evaluated(mapping, disk, stick):
    context = mapping.CreateDefaultContext()
    mapping.GetInputPort("joystick").FixValue(context, [*stick, 1, 0, 0, 0])
    mapping.GetInputPort("navigation_state").FixValue(context, NavigationState(disk=disk).to_vector())
    matrix = mapping.GetOutputPort("matrix").Eval(context).copy()
    return mapping.GetOutputPort("mapped_joystick").Eval(context).copy(), matrix


@pytest.mark.parametrize("disk", [0.0, 33.3, 99.5, 100.0])
def test_the_stick_comes_out_along_the_correction_axes(disk):
    canal = quarter_turn()
    view = View(np.array([1.0, 0, 0]), np.array([0.0, 0, 1]))
    directions = stick_directions(canal, view)
    joystick, matrix = evaluated(StickMapping(canal, directions), disk, (0.6, 0.0))
    x, y = canal.axes(disk)
    moved = joystick[0] * x + joystick[1] * y
    assert np.linalg.norm(moved) == pytest.approx(0.6)
    assert moved @ directions[round(disk), 0] == pytest.approx(0.6, abs=0.02)
    assert joystick[2:].tolist() == [1, 0, 0, 0]
    np.testing.assert_allclose(matrix.reshape(2, 2) @ [0.6, 0], joystick[:2], atol=1e-12)


def test_the_papers_axes_stay_an_option_bit_for_bit():
    canal = shipped("laundry")
    for disk in (0.0, 17.0, 282.0):
        joystick, _ = evaluated(StickMapping(canal, None), disk, (0.3, -0.4))
        np.testing.assert_allclose(joystick[:2], (0.3, -0.4), atol=1e-9)


@given(st.floats(-np.pi, np.pi), st.floats(-np.pi, np.pi), st.floats(0, 1), st.floats(-np.pi, np.pi))
def test_a_hand_that_knows_the_mapping_moves_as_it_wants(a, b, long, way):
    matrix = np.array([[np.cos(a), np.cos(b)], [np.sin(a), np.sin(b)]])
    wanted = long * np.array([np.cos(way), np.sin(way)])
    hand = hand_for(matrix.ravel(), wanted)
    assert np.linalg.norm(hand) <= 1 + 1e-9
    got = matrix @ hand
    if abs(np.sin(a - b)) > 0.25:
        assert abs(got[0] * wanted[1] - got[1] * wanted[0]) < 1e-9, "in the direction that is wanted"
        assert got @ wanted >= 0
        assert np.linalg.norm(got) <= long + 1e-9


def test_another_choice_is_taken_at_the_next_sample():
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    canal = quarter_turn()
    ways = {0: SEATS["front"], 1: SEATS["behind"]}
    choice = [0]
    builder = DiagramBuilder()
    mapping = builder.AddNamedSystem(
        "mapping",
        StickMapping(
            canal, stick_directions(canal, ways[0]), lambda: (choice[0], stick_directions(canal, ways[choice[0]]))
        ),
    )
    builder.ExportInput(mapping.GetInputPort("joystick"), "joystick")
    builder.ExportInput(mapping.GetInputPort("navigation_state"), "navigation_state")
    builder.ExportOutput(mapping.GetOutputPort("mapped_joystick"), "out")
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = simulator.get_mutable_context()
    diagram.GetInputPort("joystick").FixValue(context, [1, 0, 0, 0, 0, 0])
    diagram.GetInputPort("navigation_state").FixValue(context, NavigationState(disk=50.0).to_vector())
    simulator.AdvanceTo(0.2)
    before = diagram.GetOutputPort("out").Eval(context).copy()
    choice[0] = 1
    simulator.AdvanceTo(0.3)
    after = diagram.GetOutputPort("out").Eval(context)
    np.testing.assert_allclose(after[:2], -before[:2], atol=0.1)
