"""A canal to travel, and a run on it that was started."""

import pytest
from travelling import START, arch

from canal.learning import learn_canal
from canal.navigation import NavigationState, initial_state, step
from canal.surface import CanalSurface


@pytest.fixture(scope="module")
def canal() -> CanalSurface:
    return learn_canal([arch(-0.1), arch(0.1)])


@pytest.fixture
def started(canal) -> NavigationState:
    return step(canal, initial_state(canal), START, 0.0)
