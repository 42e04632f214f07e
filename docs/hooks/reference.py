"""The reference, made from the tree: a page for each module, the commands' own help, and the keys of a scenario."""

import ast
import dataclasses
import os
import re
import subprocess
import sys
import typing
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from mkdocs.config.defaults import MkDocsConfig  # noqa: E402
from mkdocs.structure.files import File, Files  # noqa: E402

PACKAGES = ("canal", "diagrams", "geosacs_drake")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the pages into the navigation."""
    section: list[object] = ["reference/index.md", {"Commands": "reference/commands.md"}]
    section += [{"A scenario's keys": "reference/scenario.md"}, {"Files": "reference/files.md"}]
    section += [{package: _entries(ROOT / package)} for package in PACKAGES]
    assert config.nav is not None
    next(entry for entry in config.nav if "Reference" in entry)["Reference"] = section
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Write the pages."""
    pages = {"reference/index.md": _index(), "reference/commands.md": _commands(), "reference/scenario.md": _keys()}
    for package in PACKAGES:
        for folder in _packages(ROOT / package):
            pages[_page(folder / "__init__.py")] = _package_page(folder)
            for path in _modules(folder):
                pages[_page(path)] = f"# {_name(path)}\n\n::: {_name(path)}\n"
    for uri, text in pages.items():
        files.append(File.generated(config, uri, content=text))
    return files


def on_page_markdown(markdown: str, **_: object) -> str:
    """Put the table of a summary's figures where a page asks for it."""
    if "<!-- measures -->" not in markdown:
        return markdown
    from geosacs_drake.results.measures import MEASURES

    rows = [f"| `{m.key}` | {m.unit} | {_cell(m.definition)} |" for m in MEASURES]
    return markdown.replace("<!-- measures -->", "\n".join(["| key | unit | what it is |\n|---|---|---|", *rows]))


def _packages(folder: Path) -> list[Path]:
    """A package and those in it."""
    inner = sorted(path.parent for path in folder.glob("*/__init__.py"))
    return [folder, *(package for below in inner for package in _packages(below))]


def _modules(folder: Path) -> list[Path]:
    return sorted(path for path in folder.glob("*.py") if not path.name.startswith("_"))


def _entries(folder: Path) -> list[object]:
    """A package's page, those of the packages in it, and its modules, for the navigation."""
    below = sorted(path.parent for path in folder.glob("*/__init__.py"))
    return [
        _page(folder / "__init__.py"),
        *({package.name: _entries(package)} for package in below),
        *({path.stem: _page(path)} for path in _modules(folder)),
    ]


def _name(path: Path) -> str:
    """`diagrams/ik/solver.py` as `diagrams.ik.solver`."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _page(path: Path) -> str:
    name = path.relative_to(ROOT).with_suffix("").as_posix().replace("__init__", "index")
    return f"reference/{name}.md"


def _summary(path: Path) -> str:
    docstring = ast.get_docstring(ast.parse(path.read_text())) or ""
    return " ".join(docstring.split("\n\n")[0].split())


def _package_page(folder: Path) -> str:
    docstring = ast.get_docstring(ast.parse((folder / "__init__.py").read_text())) or ""
    lines = [f"# {_name(folder / '__init__.py')}\n\n{docstring}\n"]
    below = sorted(path.parent for path in folder.glob("*/__init__.py"))
    if below:
        lines.append("| package | what lives there |\n|---|---|")
        lines += [f"| [{p.name}]({p.name}/index.md) | {_cell(_summary(p / '__init__.py'))} |" for p in below]
        lines.append("")
    if modules := _modules(folder):
        lines.append("| module | what it is about |\n|---|---|")
        lines += [f"| [{path.stem}]({path.stem}.md) | {_cell(_summary(path))} |" for path in modules]
    return "\n".join(lines)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


def _index() -> str:
    lines = ["# Reference\n", "Made from the code whenever this site is built.\n"]
    lines.append("- [Commands](commands.md): what can be typed, with all options.")
    lines.append("- [A scenario's keys](scenario.md): what a scenario file can say.")
    lines.append("- [Files](files.md): what a run and `learn` read and write.\n")
    lines.append("| package | |\n|---|---|")
    lines += [f"| [{p}]({p}/index.md) | {_cell(_summary(ROOT / p / '__init__.py'))} |" for p in PACKAGES]
    return "\n".join(lines)


def _commands() -> str:
    from geosacs_drake.geosacs import COMMANDS

    lines = [
        "# Commands\n",
        "Each starts as `geosacs NAME` from any folder, or as `python -m geosacs_drake.NAME` (with `_` for `-`).",
        "The exit status is 0 when the task was done, 1 when it was not, and 2 for input that cannot be used.\n",
    ]
    for name, (what, _) in COMMANDS.items():
        shown = subprocess.run(
            [sys.executable, "-m", "geosacs_drake.geosacs", name, "--help"],
            capture_output=True,
            text=True,
            check=True,
            cwd=ROOT,
            env=os.environ | {"COLUMNS": "84", "NO_COLOR": "1", "TERM": "dumb", "PYTHONPATH": str(ROOT)},
        ).stdout
        lines.append(f"## {name}\n\n{what[0].upper()}{what[1:]}.\n\n```text\n{_plain(shown)}\n```\n")
    return "\n".join(lines)


def _plain(text: str) -> str:
    """Terminal text without colours and frames."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", text)
    text = re.sub(r"[╭╰][─ ]*([^─╮╯]*?)[─ ]*[╮╯]", r"\1", text)
    return "\n".join(line.strip("│").rstrip() for line in text.splitlines()).strip()


def _keys() -> str:
    """Tables of a scenario's keys, from the options' fields: name, kind and bounds, default, meaning."""
    from diagrams.scenario import Scenario

    lines = [
        "# A scenario's keys\n",
        "A scenario is a YAML file; `models/scenarios/` has those that ship, with comments. Every key has a default.",
        "An unknown key, or a value out of its bounds, is refused in one line that names the key.\n",
    ]
    waiting: list[tuple[str, type]] = [("", Scenario)]
    seen: set[type] = set()
    described = {Scenario: ""}
    while waiting:
        where, schema = waiting.pop(0)
        if schema in seen:
            continue
        seen.add(schema)
        if where:
            lines.append(f"## {where}\n")
        lines.append(f"{_class_docstring(schema)}\n\n| key | what it may be | default | meaning |\n|---|---|---|---|")
        meanings, hints = _meanings(schema), typing.get_type_hints(schema, include_extras=True)
        for field in dataclasses.fields(schema):
            if field.name == "folder":  # set on loading
                continue
            kind, below = _kind(hints[field.name])
            path = f"{where}.{field.name}" if where else field.name
            waiting += [(path, inner) for inner in below]
            anchors = [described.setdefault(inner, path).replace(".", "").lower() for inner in below]
            link = f" ([keys](#{anchors[0]}))" if anchors else ""
            meaning = meanings.get(field.name) or (" ".join(_class_docstring(below[0]).split()) if below else "")
            lines.append(f"| `{field.name}` | {kind}{link} | {_default(field)} | {_cell(meaning)} |")
        lines.append("")
    return "\n".join(lines)


def _kind(hint: object) -> tuple[str, list[type]]:
    """What a field may be, in words, and the options that are among it."""
    below: list[type] = []

    def words(part: typing.Any) -> str:
        origin, arguments = typing.get_origin(part), typing.get_args(part)
        if origin is typing.Annotated:
            bounds = [_bound(b) for extra in part.__metadata__ for b in getattr(extra, "metadata", [])]
            bounds += [_bound(extra) for extra in part.__metadata__]
            return " ".join([words(arguments[0]), *filter(None, bounds)])
        if origin is typing.Literal:
            return ", ".join(f"`{value}`" for value in arguments)
        if origin in (list, tuple):
            return f"list of {words(arguments[0])}"
        if arguments:
            return " or ".join("nothing" if a is type(None) else words(a) for a in arguments)
        if dataclasses.is_dataclass(part):
            below.append(typing.cast(type, part))
            return "keys"
        return {float: "number", int: "whole number", str: "text", bool: "true, false"}.get(part, str(part))

    return words(hint), below


def _bound(extra: object) -> str:
    for sign, name in ((">", "gt"), ("≥", "ge"), ("<", "lt"), ("≤", "le")):
        if (value := getattr(extra, name, None)) is not None:
            return f"{sign} {value:g}"
    if (value := getattr(extra, "min_length", None)) is not None:
        return f"({value} of them)" if getattr(extra, "max_length", None) in (value, None) else ""
    return ""


def _default(field: "dataclasses.Field[typing.Any]") -> str:
    value = field.default
    if value is dataclasses.MISSING and field.default_factory is not dataclasses.MISSING:
        value = field.default_factory()
    if value is None or value in ("", [], (), dataclasses.MISSING) or dataclasses.is_dataclass(value):
        return ""
    return (
        f"`{value:.4g}`"
        if isinstance(value, float)
        else f"`{str(value).lower() if isinstance(value, bool) else value}`"
    )


def _class_of(schema: type) -> ast.ClassDef:
    module = ast.parse(Path(sys.modules[schema.__module__].__file__ or "").read_text())
    return next(n for n in ast.walk(module) if isinstance(n, ast.ClassDef) and n.name == schema.__name__)


def _class_docstring(schema: type) -> str:
    return (ast.get_docstring(_class_of(schema)) or "").split("Attributes:")[0].strip()


def _meanings(schema: type) -> dict[str, str]:
    """What is written below the fields, its bases' too, or in the class's list of attributes."""
    found: dict[str, str] = {}
    for base in schema.__bases__:
        if dataclasses.is_dataclass(base):
            found |= _meanings(base)
    node = _class_of(schema)
    listed = (ast.get_docstring(node) or "").partition("Attributes:")[2]
    for match in re.finditer(r"^    (\w+): (.*(?:\n {8}.*)*)", listed, re.MULTILINE):
        found[match[1]] = " ".join(match[2].split())
    for here, after in zip(node.body, node.body[1:], strict=False):
        if isinstance(here, ast.AnnAssign) and isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
            found[ast.unparse(here.target)] = " ".join(str(after.value.value).split())
    return found
