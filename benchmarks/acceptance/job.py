"""One job in its own process: python -m benchmarks.acceptance.job MODULE:FUNCTION ARGUMENTS ANSWER."""

import importlib
import json
import sys
from pathlib import Path


def main(where: str, arguments: str, answer: str) -> None:
    """Call the function with the arguments (JSON), and write the figures that it returns (JSON) to `answer`."""
    module, function = where.split(":")
    figures = getattr(importlib.import_module(module), function)(*json.loads(arguments))
    plain = {name: float(value) for name, value in figures.items()}
    print(json.dumps(plain, indent=2), flush=True)
    Path(answer).write_text(json.dumps(plain))


if __name__ == "__main__":
    main(*sys.argv[1:])
