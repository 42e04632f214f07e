"""Every example runs and draws its picture."""

import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.image import imread

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize("name", ["learn_and_plot", "navigate", "own_constraints", "retarget"])
def test_an_example_runs_and_draws(name, tmp_path):
    picture = tmp_path / f"{name}.png"
    done = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py", picture], capture_output=True, text=True, cwd=tmp_path, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert "drawn to" in done.stdout
    pixels = imread(picture)[..., :3]
    assert pixels.std() > 0.05
    red = (pixels[..., 0] > 0.8) & (pixels[..., 1] < 0.3) & (pixels[..., 2] < 0.3)
    assert red.mean() > 1e-4
