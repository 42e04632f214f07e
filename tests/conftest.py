"""Fixtures for tests that look through a browser: a headless Chromium, and a Meshcat page in it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from waiting import wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page
    from pydrake.geometry import Meshcat

CHROMIUM_NAMES = ("chromium", "chromium-browser", "google-chrome")
# What makes Debian's Chromium draw WebGL without a display or a graphics card.
CHROMIUM_ARGS = ("--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--ignore-gpu-blocklist")


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    """A headless Chromium that draws WebGL; the test is skipped, saying so, where there is none."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="needs Playwright")
    with sync_api.sync_playwright() as playwright:
        paths = [shutil.which(name) for name in CHROMIUM_NAMES] + [playwright.chromium.executable_path]
        path = next((path for path in paths if path and Path(path).exists()), None)
        if path is None:
            pytest.skip("needs Chromium: none of " + ", ".join(CHROMIUM_NAMES) + ", nor Playwright's own")
        browser = playwright.chromium.launch(executable_path=path, args=list(CHROMIUM_ARGS))
        yield browser
        browser.close()


@pytest.fixture
def page(chromium: Browser) -> Iterator[Page]:
    """An empty page, small for speed, that fails the test when a script in it fails."""
    page = chromium.new_page(viewport={"width": 640, "height": 400})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    page.close()
    assert not errors, errors


@pytest.fixture
def meshcat() -> Meshcat:
    """A Meshcat of the project, on a free port."""
    from diagrams.view.meshcat_page import start_meshcat

    return start_meshcat(port=0)


@pytest.fixture
def meshcat_page(meshcat: Meshcat, page: Page) -> Iterator[tuple[Meshcat, Page]]:
    """A Meshcat and a page that is connected to it."""
    page.goto(meshcat.web_url())
    wait_until(lambda: meshcat.GetNumActiveConnections() == 1, "the page to connect")
    yield meshcat, page
    # Meshcat's destructor waits for its pages.
    page.close()
    wait_until(lambda: meshcat.GetNumActiveConnections() == 0, "the page to leave")
