"""What the page says a button does is what it does."""

from dataclasses import replace
from itertools import product

import pytest
from canal_examples import quarter_turn
from console_status import STATUS

from canal.navigation import NavigationState
from canal.navigation.buttons import press_buttons
from canal.navigation.options import NavigationOptions
from geosacs_drake.console.words import start_word

FLAGS = ("running", "paused", "waiting", "blocked")


@pytest.mark.parametrize("levels", list(product((0.0, 1.0), repeat=len(FLAGS))), ids=str)
def test_the_start_button_says_what_a_press_does(levels):
    before = replace(NavigationState(disk=0.0), **dict(zip(FLAGS, levels, strict=True)))
    after = press_buttons(quarter_turn(), before, (False, False, True, False), stick=False, options=NavigationOptions())
    done = "" if after.ignored > before.ignored else "Pause" if after.paused > before.paused else "it goes"
    said = start_word(before)
    assert done == ("it goes" if said in ("Start", "Go on") else said)


@pytest.mark.browser
def test_start_while_it_waits_says_waiting(console, server):
    server.show(STATUS | {"waiting": True, "start": "", "headline": "Waiting: steer, then grip"})
    button = console.get_by_role("button", name="Waiting", exact=True)
    button.wait_for()
    assert button.is_disabled()
