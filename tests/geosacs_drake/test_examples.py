"""Every example runs and draws its picture."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

EXAMPLES = Path(__file__).parents[2] / "examples"
NAMES = sorted(path.stem for path in EXAMPLES.glob("*.py") if path.stem != "style")


def test_there_is_a_gallery():
    assert len(NAMES) >= 10


@pytest.mark.parametrize("name", NAMES)
def test_an_example_runs_and_draws(name, tmp_path):
    picture = tmp_path / f"{name}.png"
    done = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py", picture], capture_output=True, text=True, cwd=tmp_path, timeout=240
    )
    assert done.returncode == 0, done.stderr
    assert "drawn to" in done.stdout
    assert "Warning" not in done.stderr
    pixels = imread(picture)[..., :3]
    assert min(pixels.shape[:2]) > 200
    assert pixels.std() > 0.03
    coloured = np.ptp(pixels, axis=2) > 0.3
    assert coloured.mean() > 1e-3  # lines and surfaces, and not text alone
