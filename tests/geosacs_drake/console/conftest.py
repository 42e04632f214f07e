"""A console's server without a robot behind it, and its page in a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from waiting import wait_until

from geosacs_drake.console.bindings import BindingFiles
from geosacs_drake.console.control import Control
from geosacs_drake.console.link import Answers
from geosacs_drake.console.server import ConsoleServer

if TYPE_CHECKING:
    from playwright.sync_api import Page

STATUS: dict[str, Any] = {
    "time_s": 12.0,
    "headline": "Going to pick",
    "sentence": "The stick shifts its path to the side.",
    "tone": "go",
    "leg": "to pick",
    "progress": 0.4,
    "phase": -0.4,
    "eta": 0.5,
    "phi": 0.3,
    "radius_mm": 90.0,
    "axes": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    "correcting": False,
    "corrections": 2,
    "correction_s": 1.5,
    "correction_mm": 80.0,
    "task_s": 12.0,
    "closed": False,
    "running": True,
    "paused": False,
    "waiting": False,
    "alarm": False,
    "stick": [0.0, 0.0],
    "items": [{"name": "sock", "placed": False}],
    "rate": 1.0,
}


@pytest.fixture
def server(tmp_path: Path) -> Iterator[ConsoleServer]:
    """A server on a free port; Meshcat is not there."""
    answers = Answers(BindingFiles(tmp_path / "controllers"))
    server = ConsoleServer(Control(), answers, port=0, meshcat_address=("127.0.0.1", 9))
    server.start()
    yield server
    server.stop()


@pytest.fixture
def console(server: ConsoleServer, page: Page) -> Page:
    """The console's page, which shows a run."""
    page.set_viewport_size({"width": 1280, "height": 800})
    server.show(STATUS)
    page.goto(server.address)
    wait_until(lambda: page.inner_text("#headline") == STATUS["headline"], "the status", 30)
    return page
