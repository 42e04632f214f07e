"""Jobs for the tests of the acceptance table: in a file of their own, so that their processes start fast."""

import os
import subprocess
from pathlib import Path


def square(number):
    return {"square": number * number, "good": number > 0, "threads": float(os.environ["OMP_NUM_THREADS"])}


def failing(how):
    if how == "exit":
        os._exit(0)
    raise RuntimeError(how)


def lingering(path):
    """Hangs in a command, whose process is named in a file."""
    with subprocess.Popen(["sleep", "60"]) as child:
        Path(f"{path}.part").write_text(str(child.pid))
        Path(f"{path}.part").rename(path)
        child.wait()
    return {}
