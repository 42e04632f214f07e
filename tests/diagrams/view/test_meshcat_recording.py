"""A recording plays in a browser that has no network, and shows what happened when."""

import re

import numpy as np
import pytest
from canal_examples import NUDGE, quarter_turn, simulate_view
from waiting import wait_until

from canal.errors import InputError
from diagrams.view.meshcat_recording import Recording

WHERE = "path => viewer.scene_tree.find(path).object.position.toArray()"
SHOWN = "path => Object.values(viewer.scene_tree.find(path).children).filter(node => node.object.visible).length"


@pytest.fixture
def recorded(meshcat, tmp_path):
    """The path of a recording of 6 s, and the points on the canal at each quarter second."""
    canal = quarter_turn()
    recording = Recording(meshcat, title="A canal")
    simulator, navigator = simulate_view(meshcat, canal, NUDGE)
    points = {}
    simulator.Initialize()
    for time in np.arange(0.0, 6.01, 0.25):
        simulator.AdvanceTo(time)
        state = navigator.state(navigator.GetMyContextFromRoot(simulator.get_context()))
        points[float(time)] = canal.point(state.disk, state.eta, state.phi)
    path = tmp_path / "recording.html"
    recording.save(path)
    return path, points


@pytest.mark.browser
def test_it_plays_without_a_network(chromium, recorded):
    path, points = recorded
    context = chromium.new_context(offline=True, viewport={"width": 640, "height": 400})
    page = context.new_page()
    requests, errors = [], []
    page.on("request", lambda request: requests.append(request.url))
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(path.as_uri())
    assert page.title() == "A canal"
    wait_until(lambda: page.evaluate("viewer.animator.actions.length") > 0, "the animation")
    travelled = []
    for time, point in points.items():
        page.evaluate("time => {viewer.animator.pause(); viewer.animator.seek(time)}", time)
        # Frames are 1/32 s apart; within one the point goes 5 mm at most.
        np.testing.assert_allclose(page.evaluate(WHERE, ["drake", "canal", "point"]), point, atol=0.005)
        travelled.append(page.evaluate(SHOWN, ["drake", "trail"]))
    assert travelled[0] == 0
    assert travelled == sorted(travelled)
    assert travelled[-1] > 3
    assert requests == [path.as_uri()]
    assert not errors
    context.close()


def test_the_file_names_no_server(recorded):
    html = recorded[0].read_text()
    assert not re.search(r"<(script|link|img)[^>]*(src|href)=", html)
    assert "new WebSocket(url)" not in html


def test_nothing_half_written_remains(recorded):
    assert [path.name for path in recorded[0].parent.iterdir()] == ["recording.html"]


def test_a_place_that_cannot_be_written(meshcat, tmp_path):
    recording = Recording(meshcat)
    with pytest.raises(InputError, match="cannot be written"):
        recording.save(tmp_path / "no" / "such" / "folder.html")
