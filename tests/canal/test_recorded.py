"""Recordings as a person makes them: the pair that ships, and the real robot's where it lies beside the project."""

from pathlib import Path

import numpy as np
import pytest

from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.learning.disk_normals import ROOM
from canal.learning_options import LearningOptions
from canal.quality import canal_quality, deviations, undershoot
from canal.support_planes import SupportPlane, dips
from models import MODELS

PAIRS = {"shipped": [MODELS / "demonstrations" / f"tables_{k}.npz" for k in (1, 2)]}
REAL = sorted((Path(__file__).parents[3] / "shared" / "demos").glob("*.npz"))
if len(REAL) == 2:
    PAIRS["real"] = REAL
FARTHEST = {"shipped": ((0.012, 0.030), (0.012, 0.030)), "real": ((0.014, 0.040), (0.007, 0.018))}
"""Root mean square and largest deviation of a demonstration from its spline in the canal [m]."""


@pytest.fixture(scope="module", params=PAIRS)
def pair(request):
    return request.param


@pytest.fixture(scope="module")
def demonstrations(pair):
    return [load_demonstration(path) for path in PAIRS[pair]]


def test_the_canal_of_the_recordings(pair, demonstrations):
    canal = learn_canal(demonstrations)
    quality = canal_quality(canal)
    assert canal.warnings == ()
    for demonstration, (rms, most) in zip(demonstrations, FARTHEST[pair], strict=True):
        away = deviations(canal, demonstration.position)
        assert np.sqrt(np.mean(away**2)) <= rms
        assert away.max() <= most
    assert undershoot(canal, [d.position for d in demonstrations]) <= 0.001
    assert quality.end_share_max <= 1.15
    assert quality.step_ratio_max <= 2
    assert max(quality.x_turn_max, quality.y_turn_max) <= 8
    assert quality.x_to_global_mean <= 25
    assert quality.x_to_global_max <= 65
    assert quality.crossing <= ROOM
    assert quality.tilt_max <= 30
    assert quality.tangent_error_p99 <= 1.5


@pytest.mark.parametrize("below", [0.0, 0.005, 0.01, 0.02])
def test_the_tables_of_the_recordings(demonstrations, below):
    lowest = min(d.position[:, 2].min() for d in demonstrations)
    plane = SupportPlane((0, 0, 1), lowest - below)
    canal = learn_canal(demonstrations, LearningOptions(support_planes=(plane,)))
    quality = canal_quality(canal)
    assert dips(canal.directrix, canal.normals, canal.radii, plane).max() <= 1e-9
    assert quality.crossing <= ROOM
    assert quality.tilt_max <= 30


def test_a_wall_beside_the_recordings_clips_points(demonstrations):
    # The path runs alongside this wall at home, and nowhere towards it.
    canal = learn_canal(demonstrations)
    home = canal.home_disk
    wall = SupportPlane((-1, 0, 0), -(canal.directrix[home, 0] + 0.5 * canal.radii[home]))
    walled = learn_canal(demonstrations, LearningOptions(support_planes=(wall,)))
    assert np.array_equal(walled.normals[home], canal.normals[home])
    reach = max(walled.point(home, 1.0, phi)[0] for phi in np.arange(0, 6.3, 0.05))
    assert reach == pytest.approx(canal.directrix[home, 0] + 0.5 * canal.radii[home], abs=1e-6)
    assert any("clipped" in line for line in walled.warnings)
