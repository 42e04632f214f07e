"""A canal that does not lead to a scenario's items is refused, one that does is not."""

from dataclasses import replace

import numpy as np
import pytest

from canal.editing import cut
from canal.errors import InputError
from diagrams.scenario import load_scenario, shipped_scenarios, with_items
from diagrams.scene.leads_to import check_leads_to_items
from geosacs_drake.prepare_canal import prepare_canal
from geosacs_drake.run_options import RunOptions


@pytest.mark.parametrize("name", shipped_scenarios())
def test_shipped_canals_lead_to_the_items(name):
    canal = prepare_canal(load_scenario(name), RunOptions())
    for kind in ("soft", "rigid"):
        scenario = with_items(load_scenario(name), kind)
        for seed in range(10):
            check_leads_to_items(scenario, canal, seed)


@pytest.mark.parametrize(
    ("name", "by", "says"),
    [
        ("relocation", (0, 0, 0.05), r"(apple|cup|cube) lies \d+ mm .* too low for its pick disk"),
        ("relocation", (0, 0, -0.05), r"(apple|cup|cube) lies \d+ mm .* too high for its pick disk"),
        ("relocation", (0.3, 0, 0), r"(apple|cup|cube) lies 0\.\d\d m beside the reach of .* its pick disk"),
        ("laundry", (0.0, 0.4, 0.0), r"lies 0\.\d\d m beside"),
        ("laundry", (0.0, 0.0, 0.02), None),
    ],
)
def test_a_canal_elsewhere_is_refused_with_distance_and_remedy(name, by, says):
    scenario = load_scenario(name)
    canal = prepare_canal(scenario, RunOptions())
    there = replace(canal, directrix=canal.directrix + np.array(by), support_planes=())
    if says is None:
        check_leads_to_items(scenario, there, 0)
        return
    with pytest.raises(InputError, match=says) as error:
        check_leads_to_items(scenario, there, 0)
    assert "retarget" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_canal_that_ends_before_the_drum_is_refused():
    scenario = load_scenario("laundry")
    canal = prepare_canal(scenario, RunOptions())
    short = cut(canal, 0.0, 0.6 * (canal.n_disks - 1))
    with pytest.raises(InputError, match=r"the drum is 0\.\d\d m .* its place disk"):
        check_leads_to_items(scenario, short, 0)
