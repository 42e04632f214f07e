"""Every public name says what it is: an undocumented one is not in the reference."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = sorted(path for package in ("canal", "diagrams", "geosacs_drake") for path in (ROOT / package).rglob("*.py"))
FRAMEWORK = {"get", "open", "on_message", "on_close"}
"""Methods that Tornado calls, and describes."""
AT_MOST = {"canal": 0, "diagrams": 0, "geosacs_drake": 0}
"""Constants and fields that are not documented yet, by package: fewer are welcome, more are not."""
WITHOUT_ARGUMENTS = {"canal": 0, "diagrams": 0, "geosacs_drake": 0}
"""Likewise functions of two arguments or more without a list of them."""

type Documented = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


def public(body: list[ast.stmt]) -> Iterator[Documented]:
    """Public functions and classes of a module or class, and of the classes in it."""
    for node in body:
        if isinstance(node, Documented.__value__) and not node.name.startswith("_"):
            yield node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body)


def values(body: list[ast.stmt], docstring: str, comments: set[int]) -> Iterator[tuple[str, bool]]:
    """Public constants or fields, and whether each is documented: below its group, in the class, or on its line."""
    for k, node in enumerate(body):
        if not isinstance(node, ast.Assign | ast.AnnAssign):
            continue
        group = next((after for after in body[k:] if not isinstance(after, ast.Assign | ast.AnnAssign)), None)
        below = isinstance(group, ast.Expr) and isinstance(group.value, ast.Constant)
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
            if isinstance(target, ast.Name) and not target.id.startswith("_"):
                listed = f"{target.id}:" in docstring or f"{target.id}," in docstring
                yield target.id, below or listed or node.lineno in comments


def undocumented(path: Path) -> list[str]:
    """Names of constants and fields in a module that say nothing."""
    text = path.read_text()
    module = ast.parse(text)
    lines = {number for number, line in enumerate(text.splitlines(), 1) if "#" in line}
    found = list(values(module.body, "", lines))
    for node in public(module.body):
        if isinstance(node, ast.ClassDef):
            inner = values(node.body, ast.get_docstring(node) or "", set())
            found += [(f"{node.name}.{name}", documented) for name, documented in inner]
    return [f"{path.relative_to(ROOT)}: {name}" for name, documented in found if not documented]


def without_arguments(path: Path) -> list[str]:
    """Functions of two arguments or more that do not list them."""
    found = []
    for node in public(ast.parse(path.read_text()).body):
        if isinstance(node, ast.ClassDef) or node.name in FRAMEWORK:
            continue
        names = [a.arg for a in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
        if len([n for n in names if n not in ("self", "cls")]) >= 2 and "Args:" not in (ast.get_docstring(node) or ""):
            found.append(f"{path.relative_to(ROOT)}: {node.name}")
    return found


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_modules_classes_and_functions_have_docstrings(path):
    module = ast.parse(path.read_text())
    silent = [n.name for n in public(module.body) if n.name not in FRAMEWORK and not ast.get_docstring(n)]
    assert ast.get_docstring(module)
    assert not silent


@pytest.mark.parametrize("package", AT_MOST)
def test_constants_and_fields_are_documented(package):
    silent = [name for path in MODULES if path.relative_to(ROOT).parts[0] == package for name in undocumented(path)]
    assert len(silent) <= AT_MOST[package], "\n".join(silent)


@pytest.mark.parametrize("package", WITHOUT_ARGUMENTS)
def test_functions_list_their_arguments(package):
    bare = [name for path in MODULES if path.relative_to(ROOT).parts[0] == package for name in without_arguments(path)]
    assert len(bare) <= WITHOUT_ARGUMENTS[package], "\n".join(bare)


def test_a_silent_name_is_found(tmp_path, monkeypatch):
    monkeypatch.setattr(f"{__name__}.ROOT", tmp_path)
    path = tmp_path / "a.py"
    path.write_text('"""A."""\nA, B = 1, 2\nC = 1\n"""Said."""\nD = 2\n\n\ndef f(a, b):\n    """F."""\n')
    assert undocumented(path) == ["a.py: D"]
    assert without_arguments(path) == ["a.py: f"]
