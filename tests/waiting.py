"""Waiting for another thread or process."""

import time
from collections.abc import Callable

import pytest


def wait_until(condition: Callable[[], bool], what: str, limit_s: float = 30.0) -> None:
    """Wait for `condition`; the limit only ends a test that hangs."""
    end = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > end:
            pytest.fail(f"waited {limit_s} s for {what}")
        time.sleep(0.02)
