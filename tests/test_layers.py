"""The house: which room may import which, no circle anywhere, no file and no folder too large."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("canal", "diagrams", "geosacs_drake", "models")
ROOMS = {
    "geometry": set(),
    "deformable": {"geometry"},
    "ik": set(),
    "teleop": set(),
    "teach": {"geometry", "ik"},
    "operator": {"geometry", "scene", "teleop"},
    "scene": {"geometry", "deformable", "ik"},
    "station": {"scene", "geometry", "deformable", "ik"},
    "view": {"station", "scene", "geometry"},
}
"""What each package of diagrams/ may import of the others; the files at its root may import all of them."""
MAY_IMPORT = {
    "canal": {"canal"},
    "models": {"models"},
    "diagrams": {"canal", "models", "diagrams"},
    "geosacs_drake": {"canal", "models", "diagrams", "geosacs_drake"},
}
LONGEST_FILE = 300
MOST_FILES = 15


def modules() -> dict[str, Path]:
    return {
        ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.py")
    }


def imports(path: Path, known: dict[str, Path]) -> Iterator[str]:
    """Modules of ours that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] in PACKAGES:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in known else node.module
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)


def test_packages_import_one_way() -> None:
    known = modules()
    wrong = [
        f"{name} imports {other}"
        for name, path in known.items()
        for other in imports(path, known)
        if other.split(".")[0] not in MAY_IMPORT[name.split(".")[0]]
    ]
    assert not wrong


def test_rooms_of_diagrams_import_one_way() -> None:
    known = modules()
    wrong = []
    for name, path in known.items():
        room = name.split(".")[1] if name.startswith("diagrams.") else ""
        if room in ROOMS:
            others = (other for other in imports(path, known) if other.startswith("diagrams."))
            wrong += [f"{name} imports {o}" for o in others if o.split(".")[1] not in ROOMS[room] | {room}]
    assert not wrong
    tuple(TopologicalSorter(ROOMS).static_order())  # raises CycleError where the list itself has a circle


def test_every_package_of_diagrams_is_named_here() -> None:
    assert {path.parent.name for path in (ROOT / "diagrams").glob("*/__init__.py")} == set(ROOMS)


def test_no_module_imports_itself_by_way_of_others() -> None:
    known = modules()
    # A package's __init__ only hands on: who imports the package needs what is in it, not the other way round.
    graph = {
        name: {other for other in imports(path, known) if known[other].name != "__init__.py"}
        for name, path in known.items()
        if path.name != "__init__.py"
    }
    tuple(TopologicalSorter(graph).static_order())


@pytest.mark.parametrize("package", [*PACKAGES, "benchmarks", "examples", "tests"])
def test_files_are_short_and_folders_small(package: str) -> None:
    paths = list((ROOT / package).rglob("*.py"))
    assert {str(p): n for p in paths if (n := len(p.read_text().splitlines())) > LONGEST_FILE} == {}
    folders = {p.parent for p in paths}
    counts = {str(f): sum(p.parent == f for p in paths) for f in folders}
    if package not in ("tests", "examples"):  # a file of tests for each file, and a script for each idea
        assert {f: n for f, n in counts.items() if n > MOST_FILES} == {}


def test_outputs_are_written_whole():
    """By `canal.files`, under another name first: nothing else writes a file that a person asked for."""
    past = re.compile(r"\.savefig\(|\.write_text\(|\.write_bytes\(|\.open\(\"w")
    # The last two into a temporary folder.
    writers = {"canal/files.py", "diagrams/deformable/render_mesh.py", "diagrams/view/cameras.py"}
    found = {
        path.relative_to(ROOT).as_posix()
        for package in ("canal", "diagrams", "geosacs_drake")
        for path in (ROOT / package).rglob("*.py")
        if past.search(path.read_text())
    }
    assert found <= writers
