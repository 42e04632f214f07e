"""What the documentation names is there: files and folders, and options of the commands."""

import re
from pathlib import Path

import pytest

from geosacs_drake.learn_options import LearnOptions
from geosacs_drake.run_options import RunOptions
from geosacs_drake.teach.options import TeachOptions

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")], key=lambda page: page.as_posix()
)
FOLDERS = r"(?:canal|diagrams|geosacs_drake|models|tests|benchmarks|examples|docs)"


def named_paths(text: str) -> set[str]:
    """Files and folders of the repository that a page names in code: `diagrams/ik/solver.py`, `canal/`."""
    return set(re.findall(rf"`({FOLDERS}/[\w./-]*)`", text))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_named_paths_exist(page):
    missing = sorted(path for path in named_paths(page.read_text()) if not (ROOT / path).exists())
    assert not missing


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_named_options_exist(page):
    fields = set(RunOptions.__dataclass_fields__) | set(LearnOptions.__dataclass_fields__)
    fields |= set(TeachOptions.__dataclass_fields__)
    for command in (LearnOptions.__dataclass_fields__["recorded"], LearnOptions.__dataclass_fields__["learning"]):
        fields |= set(type(command.default).__dataclass_fields__)
    fields |= {f"no_{name}" for name in fields} | {"list", "only", "quick", "seconds", "seeds"}
    fields |= {"help", "without_orientation"}
    text = page.read_text()
    named = {option.replace("-", "_") for option in re.findall(r"(?<![\w-])--([a-z][a-z-]+)", text)}
    assert named <= fields


def test_paths_are_found():
    assert named_paths("see `canal/learning/frames.py` and `diagrams/`, not `a.npz`") == {
        "canal/learning/frames.py",
        "diagrams/",
    }
