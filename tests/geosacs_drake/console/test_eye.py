"""The gripper's camera in the page: a picture for each that is asked for, small or large; the mapping follows."""

import io

import pytest
from PIL import Image
from waiting import wait_until

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from geosacs_drake.console.mapping_choice import MappingChoice, chosen_view
from models import MODELS

pytestmark = pytest.mark.browser


def jpeg(color):
    stream = io.BytesIO()
    Image.new("RGB", (32, 24), color).save(stream, "JPEG")
    return stream.getvalue()


def test_pictures_come_one_by_one_while_somebody_looks(console, server):
    server.answers.shows_pictures = True
    assert not server.picture_wanted()
    console.get_by_role("button", name="Gripper camera").click()
    for color in ("red", "green", "blue"):
        wait_until(server.picture_wanted, "the page to ask", 10)
        before = console.get_attribute("#eye-picture", "src")
        server.show_picture(jpeg(color))
        wait_until(lambda before=before: console.get_attribute("#eye-picture", "src") != before, "the picture", 10)
    assert console.get_by_role("img", name="What the gripper's camera sees").is_visible()
    for _ in range(2):  # larger, then off
        console.locator("#eye").click()
    wait_until(lambda: not console.locator("#eye-figure").is_visible(), "it to go", 10)
    if server.picture_wanted():  # what was asked for before is still answered
        server.show_picture(jpeg("red"))
    wait_until(lambda: not server.picture_wanted(), "the last picture", 10)
    console.wait_for_timeout(1500)
    assert not server.picture_wanted(), "nobody looks"


def test_where_there_is_no_camera_it_says_so(console, server):
    console.get_by_role("button", name="Gripper camera").click()
    wait_until(lambda: "no camera" in console.inner_text("#link-notice"), "the notice", 10)
    assert not server.picture_wanted()


def test_the_mapping_follows_the_camera_while_it_is_large(console, server):
    files = [MODELS / "demonstrations" / f"relocation_{k}.npz" for k in (1, 2)]
    choice = MappingChoice(learn_canal([load_demonstration(file) for file in files]), chosen_view("axes", "front"))
    asked = []
    choice.choose = lambda *words, follow=False: asked.append(follow)
    server.answers.mapping, server.answers.shows_pictures = choice, True
    console.locator("#eye").click()
    console.locator("#eye").click()
    wait_until(lambda: asked[-1:] == [True], "the camera's view", 10)
    console.locator("#eye").click()
    wait_until(lambda: asked[-1:] == [False], "the room's view", 10)
