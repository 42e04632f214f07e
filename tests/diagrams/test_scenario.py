"""Scenarios: those that ship are sound; what cannot be used is refused in one clear line."""

import re

import numpy as np
import pytest
import yaml

from canal.errors import InputError
from diagrams.scenario import RENAMED, load_scenario, shipped_scenarios, with_items
from diagrams.scene.layout import draw_layout, reach_at, yaw_pose
from diagrams.scene.world import Contact, Region, Room
from models import SCENARIOS

NAMED = [
    "laundry",
    "laundry-straight",
    "laundry-crowded",
    "laundry-hanging",
    "laundry-moved",
    "laundry-narrow",
    "laundry-turned",
    "relocation",
    "relocation-far",
]


def test_those_named_ship():
    assert set(NAMED) <= set(shipped_scenarios())


@pytest.mark.parametrize("name", NAMED)
def test_shipped_ones_load_and_leave_room(name):
    scenario = load_scenario(name)
    for seed in range(20):
        starts, marks = draw_layout(scenario, seed)
        for spots in (starts, [m for m in marks if m is not None]):
            at = np.array([s.position for s in spots])
            gaps = [np.linalg.norm(a - b) for i, a in enumerate(at) for b in at[i + 1 :]]
            assert min(gaps, default=1.0) >= scenario.item_spacing


def test_starts_and_marks_of_the_relocation_vary_over_the_disks():
    scenario = load_scenario("relocation")
    layouts = [draw_layout(scenario, seed) for seed in range(60)]
    for end, y in ((0, -0.455), (1, 0.455)):
        away = np.array([[spot.position[:2] - (0.235, y) for spot in layout[end]] for layout in layouts])
        assert np.linalg.norm(away, axis=2).max() <= 0.12
        for of_item in away.transpose(1, 0, 2):
            assert np.ptp(of_item, axis=0).min() > 0.19


def test_a_region_reaches_as_far_as_it_says_in_each_direction():
    scenario = load_scenario("relocation")
    scenario.items = scenario.items[:1]
    scenario.items[0].start = Region(center=[1.0, 2.0, 0.4], reach=[0.3, 0.1, 0.2, 0.1])
    at = np.array([draw_layout(scenario, seed)[0][0].position for seed in range(400)]) - [1.0, 2.0, 0.4]
    distance, angle = np.hypot(at[:, 0], at[:, 1]), np.arctan2(at[:, 1], at[:, 0])
    assert all(d <= reach_at([0.3, 0.1, 0.2, 0.1], a) for d, a in zip(distance, angle, strict=True))
    assert at[:, 0].max() > 0.2
    assert -0.2 < at[:, 0].min() < -0.12
    assert np.abs(at[:, 1]).max() < 0.15
    assert np.all(at[:, 2] == 0.0)


def test_nothing_lies_where_fingers_open():
    room = Room(yaw_deg=90.0, along=0.2, across=0.05)
    scenario = load_scenario("relocation")
    for item in scenario.items:
        item.start = Region(reach=[0.25], room=room)
    for seed in range(30):
        at = np.array([spot.position for spot in draw_layout(scenario, seed)[0]])
        apart = np.abs(at[:, None] - at[None])[np.triu_indices(3, 1)]
        assert np.all((apart[:, 1] >= 0.2) | (apart[:, 0] >= 0.05))


def test_layout_is_the_seeds():
    scenario = load_scenario("laundry")
    same = [draw_layout(scenario, 3)[0][0].position for _ in range(2)]
    other = draw_layout(scenario, 4)[0][0].position
    assert np.array_equal(*same)
    assert not np.array_equal(same[0], other)


def test_what_lies_in_a_basket_goes_where_the_basket_goes():
    scenario = load_scenario("laundry")
    basket = next(fixture for fixture in scenario.fixtures if fixture.name == "basket")
    before = draw_layout(scenario, 3)[0]
    old = yaw_pose(basket.position, np.deg2rad(basket.yaw_deg))
    basket.position, basket.yaw_deg = [0.1, 0.2, 0.5], 70.0
    new = yaw_pose(basket.position, np.deg2rad(basket.yaw_deg))
    for one, two in zip(before, draw_layout(scenario, 3)[0], strict=True):
        assert new.inverse().multiply(two.position) == pytest.approx(old.inverse().multiply(one.position))
        assert two.yaw - one.yaw == pytest.approx(np.deg2rad(105.0))


def test_contact_suits_what_there_is_unless_told():
    deformable, rigid = (Contact().for_items(kind) for kind in (True, False))
    assert (deformable.approximation, rigid.approximation) == ("lagged", "sap")
    told = Contact(time_step=0.002, approximation="similar")
    assert told.for_items(True) == told.for_items(False) == told


def test_a_region_too_small_is_refused():
    scenario = load_scenario("laundry")
    scenario.item_spacing = 0.5
    with pytest.raises(InputError, match=r"items\.tshirt\.deformable_start leaves no position that is 0\.5 m"):
        draw_layout(scenario, 0)


def test_items_kind_of_laundry_only():
    assert {i.kind for i in load_scenario("laundry").items} == {"soft"}  # unless asked otherwise
    assert {i.kind for i in with_items(load_scenario("laundry"), "rigid").items} == {"rigid"}
    assert {i.kind for i in with_items(load_scenario("relocation"), "soft").items} == {"rigid"}


def test_unknown_name_lists_those_that_ship():
    with pytest.raises(InputError, match=r"'landry' does not exist; .*laundry, .*laundry-crowded"):
        load_scenario("landry")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"foo": 3}, "foo is not known; use robot, "),
        ({"task": "cook"}, "task is 'cook'; give one of laundry or relocation"),
        ({"item_spacing": "abc"}, "item_spacing is 'abc'; give a number"),
        ({"drum": 7}, "drum is 7; give keys among center"),
        ({"drum": {"depth": "deep"}}, "drum.depth is 'deep'; give a number"),
        ({"drum": {"inward": [0.5, 0.866, 0.0]}}, "drum.inward is [0.5, 0.866, 0.0]; give a unit vector along an axis"),
        ({"retarget": {"pick": [0.4, 0.1]}}, "retarget.pick is [0.4, 0.1]; give a position (3 numbers)"),
        ({"retarget": {"pick_yaw_deg": float("inf")}}, "retarget.pick_yaw_deg is inf; give a finite number"),
        ({"fixtures": 5}, "fixtures is 5; give a list"),
        ({"fixtures": [{"name": "a", "model": "nothing"}]}, "'nothing' does not exist; give a file or one of basket"),
        ({"items": []}, "items is empty"),
        ({"items": [{"nam": "x"}]}, "items[0].nam is not known"),
        (
            {"items": [{"name": "a", "model": "towel", "kind": "firm"}]},
            "items[0].kind is 'firm'; give one of soft or rigid",
        ),
        ({"items": [{"name": "a", "model": "anvil"}]}, "'anvil' does not exist"),
        (
            {"items": [{"name": "a", "model": "towel", "start": {"frame": "bucket"}}]},
            "items.a.start.frame is 'bucket'; use one of floor, table, basket, machine",
        ),
        ({"robot": {"position": [0, 0]}}, "robot.position is [0, 0]; give 3 of them"),
        ({"robot": {"position": [0, 0, float("nan")]}}, "robot.position[2] is nan; give a finite number"),
        ({"contact": {"time_step": 0.02}}, "contact.time_step is 0.02"),
        ({"contact": {"approximation": "magic"}}, "contact.approximation is 'magic'"),
        ({"control_rate_hz": [1]}, "control_rate_hz is [1]; give a number"),
        ({"learning": {"stepp": 0.1}}, "learning.stepp is not known; use preset, step, "),
        ({"navigation": {"speed_scale": -2}}, "navigation.speed_scale is -2;"),
        ({"navigation": {"decay_lambda": -0.01}}, "navigation.decay_lambda is -0.01; give a number of 0 or more"),
        ({"navigation": {"speed_scale": float("inf")}}, "navigation.speed_scale is inf; give a finite number"),
        ({"robot": {"yaw_deg": float("nan")}}, "robot.yaw_deg is nan; give a finite number"),
        ({"ik": {"position_weight": 1e300}}, "ik.position_weight is 1e+300; give a number of at most 1e+06"),
        ({"operator": {"noise_m": -0.1}}, "operator.noise_m is -0.1"),
        ({"operator": {"delay_s": 1e9}}, "operator.delay_s is 1000000000.0; give a number of at most 5"),
        ({"learning": {"alpha": float("nan")}}, "learning.alpha is nan; give a finite number"),
        ({"learning": {"n_disks": 200}}, "learning.n_disks is 200; give an odd number"),
        ({"learning": {"x_global": 1.0}}, "learning.x_global is 1.0; give a list"),
        ({"retarget": {"pick": [0.4, 0.1, 0.5, 0, 0, 0, 0]}}, "give a unit quaternion"),
        ({"support_planes": [{"normal": [0, 0, 0], "offset": 1}]}, "support_planes[0]: the normal is (0.0, 0.0, 0.0)"),
        ({"item_spacing": 10**400}, "item_spacing is 100000000000000000...0000000000000000000; give a number"),
        ({"monitor": {"force_limit_n": 0}}, "monitor.force_limit_n is 0"),
        ({"demonstrations": ["no.npz"]}, "'no.npz' does not exist; give a file or one of laundry_1.npz"),
        ({"demonstrations": []}, "neither canal nor demonstrations"),
    ],
)
def test_what_cannot_be_used(tmp_path, change, message):
    document = yaml.safe_load((SCENARIOS / "laundry.yaml").read_text()) | change
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(document))
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        load_scenario(path)
    assert str(caught.value).startswith("scenario mine.yaml: ")
    assert "\n" not in str(caught.value)


def _with_key(data, new, old):
    """The document with a key called otherwise, and its path; at its first holder."""
    keys = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in keys:
        if key == new:
            return {(old if k == new else k): v for k, v in data.items()}, old
        if (found := _with_key(value, new, old)) is not None:
            changed, path = found
            rest = data | {key: changed} if isinstance(data, dict) else [*data[:key], changed, *data[key + 1 :]]
            return rest, f"{key}[{path}" if isinstance(value, list) else f"{key}.{path}"
    return None


@pytest.mark.parametrize(("old", "new"), RENAMED.items())
def test_a_key_of_an_earlier_version_is_met_with_the_name_it_has_now(tmp_path, old, new):
    document = yaml.safe_load((SCENARIOS / "laundry.yaml").read_text()) | {"ik": {"collision_avoidance": {}}}
    renamed, key = _with_key(document, new, old)
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(renamed))
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    key = key.replace("[0.", "[0].")
    assert str(caught.value) == f"scenario mine.yaml: {key} is now called {new}; write that"


@pytest.mark.parametrize("text", ["task: [", "- 1", "", "\x00"])
def test_what_is_no_scenario_at_all(tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_scenario(path)
    assert "\n" not in str(caught.value)
