"""A console's server without a robot behind it, and its page in a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from console_status import STATUS
from waiting import wait_until

from geosacs_drake.console.bindings import BindingFiles
from geosacs_drake.console.control import Control
from geosacs_drake.console.link import Answers
from geosacs_drake.console.server import ConsoleServer

if TYPE_CHECKING:
    from playwright.sync_api import Page


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
