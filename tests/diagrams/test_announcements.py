"""What a person is told: each change once, in words that say what to do; and what stands in the page."""

from dataclasses import replace

import numpy as np
import pytest
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from waiting import wait_until

from canal.demonstration import Demonstration
from canal.learning import learn_canal
from canal.navigation import Ignored, initial_state
from diagrams.announcements import SHOWN_S, WHY_IGNORED, Announcer, Event, body_in_words
from diagrams.view.meshcat_notice import MeshcatNotice


@pytest.fixture(scope="module")
def canal():
    t = np.linspace(0, 1, 100)
    sides = [np.column_stack([0.4 + side + 0 * t, t - 0.5, 0.6 + 0 * t]) for side in (-0.05, 0.05)]
    return learn_canal([Demonstration(p, np.tile([1.0, 0, 0, 0], (100, 1)), None, str(p[0])) for p in sides])


class Bench:
    """An announcer with its inputs fixed, and what it has said and shown."""

    def __init__(self, canal):
        self.said, self.shown = [], [""]
        self.announcer = Announcer(
            canal=canal,
            contact_pairs=["lio-floor", "lio-table"],
            robot_bodies=["lio_link_5", "lio_finger_left"],
            limit_n=150.0,
            say=self.said.append,
            show=[self._show],
        )
        self.simulator = Simulator(self.announcer)
        self.context = self.simulator.get_mutable_context()
        self.state = initial_state(canal)
        self.announcer.GetInputPort("contact_forces").FixValue(self.context, [3.0, 212.4])
        self.announcer.GetInputPort("touching_bodies").FixValue(self.context, [0.0, 1.0])
        self.now(running=1.0, travelled=-1.0)

    def _show(self, before, text, time):
        assert self.shown[-1] == before
        self.shown.append(text)

    def now(self, seconds=0.2, **changes):
        """Let some fields of the navigation state be what is given, for a while; what was said then."""
        self.said.clear()
        self.state = replace(self.state, **changes)
        self.announcer.GetInputPort("navigation_state").FixValue(self.context, self.state.to_vector())
        self.simulator.AdvanceTo(self.context.get_time() + seconds)
        return [a.event for a in self.said]


@pytest.fixture
def bench(canal):
    return Bench(canal)


def test_what_presses_on_what_with_how_many_newtons_and_what_to_do(bench):
    assert bench.now(alarm=1.0) == [Event.PRESSES]
    (told,) = bench.said
    assert told.force_n == 212.4
    for words in ("left finger presses on the table", "212 N", "limit 150 N", "Reverse", "stick", "gripper"):
        assert words in told.text
    assert bench.shown[-1] == told.text
    bench.announcer.GetInputPort("contact_forces").FixValue(bench.context, [3.0, 180.0])
    assert bench.now(seconds=2.0) == [], "once"
    assert bench.shown[-1] == told.text
    assert bench.now(alarm=0.0) == [Event.FREE]
    assert bench.shown[-1] == ""


def test_stop_and_pause(bench):
    assert bench.now(paused=1.0) == [Event.PAUSED]
    assert "Start" in bench.shown[-1]
    assert bench.now(paused=0.0) == [Event.GOES_ON]
    assert bench.shown[-1] == ""
    assert bench.now(running=0.0) == [Event.STOPPED]
    assert "until Start" in bench.shown[-1]


def test_a_press_that_does_nothing_is_said_each_time_and_shown_for_a_while(bench):
    bench.now(running=0.0)
    stopped = bench.shown[-1]
    for count in (1.0, 2.0):
        assert bench.now(ignored=count, ignored_why=float(Ignored.ALREADY_STOPPED)) == [Event.IGNORED]
        assert bench.shown[-1] == WHY_IGNORED[Ignored.ALREADY_STOPPED]
    bench.now(seconds=SHOWN_S)
    assert bench.shown[-1] == stopped


def test_every_reason_has_its_words():
    assert set(WHY_IGNORED) == set(Ignored) - {Ignored.NOTHING}


def test_bodies_in_words():
    assert body_in_words("lio_finger_left") == "left finger"
    assert body_in_words("lio_link_5") == "link 5"


@pytest.mark.browser
def test_a_notice_is_seen_in_the_page_and_goes(meshcat_page):
    meshcat, page = meshcat_page
    notice = MeshcatNotice(meshcat, RigidTransform())
    count = """() => {
        viewer.render();
        const gl = viewer.renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
        const pixels = new Uint8Array(4 * w * h);
        gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        let yellow = 0;
        for (let k = 0; k < pixels.length; k += 4)
            yellow += pixels[k] > 200 && pixels[k + 1] > 180 && pixels[k + 2] < 170;
        return yellow / (w * h);
    }"""
    notice.show("", "The left finger presses on the table with 212 N (limit 150 N): Reverse leads back.", 0.0)
    wait_until(lambda: page.evaluate(count) > 0.01, "the notice")
    notice.show("The left finger presses on the table with 212 N (limit 150 N): Reverse leads back.", "", 0.0)
    wait_until(lambda: page.evaluate(count) < 0.001, "no notice")
