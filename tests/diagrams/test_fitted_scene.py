"""A scene fitted to a canal: the gripper comes down on items at the right height, wherever they are drawn."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from canal.demonstration import Demonstration, load_demonstration
from canal.errors import InputError
from canal.learning import learn_canal
from canal.surface import CanalSurface
from diagrams.fitted_scene import GRIP_HEIGHT, FittedScene, fit_scene
from diagrams.scenario import load_scenario
from diagrams.scene.layout import draw_layout
from diagrams.scene.leads_to import check_leads_to_items
from diagrams.scene.open_gripper import gripper_depth, lean, opens_towards
from diagrams.station.lio_ik import make_lio_solver
from diagrams.station.lio_station import LioStation
from models import MODELS

TEMPLATE = replace(load_scenario("relocation"), support_planes=[])
TABLES = [load_demonstration(MODELS / "demonstrations" / f"tables_{k}.npz") for k in (1, 2)]


@pytest.fixture(scope="module")
def canal() -> CanalSurface:
    return learn_canal(TABLES)


@pytest.fixture(scope="module")
def fitted(canal: CanalSurface) -> FittedScene:
    return fit_scene(canal, TEMPLATE, make_lio_solver(TEMPLATE, TEMPLATE.ik))


def test_tables_stand_where_the_gripper_closes(fitted: FittedScene) -> None:
    _, pick, place = fitted.scenario.fixtures
    for table, disk in ((pick, 0), (place, -1)):
        assert fitted.canal.directrix[disk, 2] - table.position[2] == pytest.approx(GRIP_HEIGHT, abs=0.006)
        assert gripper_depth(fitted.canal.orientations[disk]) < GRIP_HEIGHT - 0.008, "the fingertips are clear of it"


def test_the_last_disks_are_level_with_the_tables(canal: CanalSurface, fitted: FittedScene) -> None:
    assert abs(canal.normals[0, 2]) < 1 - 1e-6, "as shown, it is not"
    for disk in (0, -1):
        assert abs(fitted.canal.normals[disk, 2]) == pytest.approx(1.0)


def test_starts_and_marks_spread_over_the_disks(fitted: FittedScene) -> None:
    layouts = [draw_layout(fitted.scenario, seed) for seed in range(40)]
    for end, disk in ((0, 0), (1, -1)):
        at = np.array([[spot.position[:2] for spot in layout[end]] for layout in layouts])
        away = np.linalg.norm(at - fitted.canal.directrix[disk, :2], axis=2)
        assert away.max() <= fitted.canal.radii[disk]
        assert away.max() > 0.8 * fitted.canal.radii[disk]
        assert np.ptp(at.reshape(-1, 2), axis=0).min() > 1.3 * fitted.canal.radii[disk]


def test_open_fingers_have_room(fitted: FittedScene) -> None:
    for seed in range(20):
        for spots, disk in zip(draw_layout(fitted.scenario, seed), (0, -1), strict=True):
            turn = Rotation.from_euler("z", -opens_towards(fitted.canal.orientations[disk]))
            for i, one in enumerate(spots):
                for other in spots[i + 1 :]:
                    along, across, _ = np.abs(turn.apply(other.position - one.position))
                    # A finger: 0.055 to 0.094 m to the side when open, 0.015 wide; a cup: 0.036.
                    assert along > 0.094 + 0.036 or across > 0.015 + 0.036


def test_the_handle_points_where_no_finger_comes(fitted: FittedScene) -> None:
    cup = next(k for k, item in enumerate(fitted.scenario.items) if item.name == "cup")
    fingers = opens_towards(fitted.canal.orientations[0])
    for seed in range(10):
        handle = draw_layout(fitted.scenario, seed)[0][cup].yaw
        assert abs(np.sin(handle - fingers)) > np.cos(np.radians(16))


def test_the_canal_leads_to_the_items_and_nothing_overlaps(fitted: FittedScene) -> None:
    for seed in range(5):
        check_leads_to_items(fitted.scenario, fitted.canal, seed)
    LioStation(fitted.scenario, seed=0)


def test_what_cannot_be_reached_is_said_with_how_much(fitted: FittedScene) -> None:
    assert any("% of the pick disk (radius 140 mm) can be used" in line for line in fitted.lines)


def moved(demonstration: Demonstration, by: list[float], turn: Rotation | None = None) -> Demonstration:
    q = (Rotation.from_quat(demonstration.orientation, scalar_first=True) * (turn or Rotation.identity())).as_quat(
        scalar_first=True
    )
    return Demonstration(demonstration.position + by, q, demonstration.time, demonstration.name)


def test_a_canal_out_of_reach_is_refused() -> None:
    far = learn_canal([moved(d, [0.2, 0.0, 0.0]) for d in TABLES])
    with pytest.raises(InputError, match=r"the arm follows \d+ % of the canal"):
        fit_scene(far, TEMPLATE, make_lio_solver(TEMPLATE, TEMPLATE.ik))


def test_a_gripper_that_does_not_point_down_is_refused() -> None:
    level = learn_canal([moved(d, [0, 0, 0], Rotation.from_euler("y", -85, degrees=True)) for d in TABLES])
    assert np.degrees(lean(level.orientations[0])) > 50
    with pytest.raises(InputError, match=r"at pick the gripper points \d+° off straight down"):
        fit_scene(level, TEMPLATE, make_lio_solver(TEMPLATE, TEMPLATE.ik))


def test_a_small_disk_gets_what_there_is_room_for() -> None:
    middle = np.mean([d.position[0] for d in TABLES], axis=0), np.mean([d.position[-1] for d in TABLES], axis=0)

    def narrowed(demonstration: Demonstration) -> Demonstration:
        path = np.array(demonstration.position)
        share = np.linspace(0, 1, len(path))[:, None]
        offset = (1 - share) * (path[0] - middle[0]) + share * (path[-1] - middle[1])
        return Demonstration(path - 0.8 * offset, demonstration.orientation, demonstration.time, demonstration.name)

    narrow = learn_canal([narrowed(d) for d in TABLES])
    assert narrow.radii[0] < 0.04
    fitted = fit_scene(narrow, TEMPLATE, make_lio_solver(TEMPLATE, TEMPLATE.ik))
    assert 0 < len(fitted.scenario.items) < 3
    assert any("of 3 items" in line for line in fitted.lines)
