"""The README's block of Python runs as it stands, in an empty folder."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_block_runs(tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert blocks
    for k, block in enumerate(blocks):
        script = tmp_path / f"block_{k}.py"
        script.write_text(block)
        done = subprocess.run(
            [sys.executable, script], capture_output=True, text=True, cwd=tmp_path, timeout=120, check=False
        )
        assert done.returncode == 0, done.stderr
        numbers = re.findall(r"-?\d+\.\d*", done.stdout)
        assert len(numbers) == 6  # a posture, and not that of the start
        assert [float(n) for n in numbers] != [-1.54, -0.35, 1.13, -0.03, 1.68, 0.03]
