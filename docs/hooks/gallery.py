"""The gallery: each script of `examples/` is run while the site is built, and its picture and text become a page."""

import ast
import os
import subprocess
import sys
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.plugins import get_plugin_logger
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[2]
EXAMPLES, PICTURES = ROOT / "examples", ROOT / "build" / "gallery"
log = get_plugin_logger("gallery")

SECTIONS = {
    "The figures of the paper": (
        "teaser",
        "canals",
        "frames",
        "disk_to_disk",
        "correction",
        "workspaces",
        "constants",
    ),
    "Learning a canal": ("learn_and_plot", "from_recordings", "reversal", "orientation", "support_plane"),
    "Travelling on it": ("navigate", "ratios", "mapping", "retarget"),
    "With Drake": (
        "navigator_alone",
        "moving_target",
        "own_constraints",
        "retargeted_run",
        "reach",
        "block_diagram",
    ),
}
"""The scripts in the order of the gallery; one that is missing here fails the build."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the pages into the navigation."""
    _check_sections()
    section: list[object] = ["gallery/index.md"]
    for name, scripts in SECTIONS.items():
        pages = [f"gallery/{script}.md" for script in scripts if script != "constants"]
        section.append({name: pages})
    assert config.nav is not None
    next(entry for entry in config.nav if "Gallery" in entry)["Gallery"] = section
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Run the scripts, and add a page and a picture for each."""
    overview = [
        "# Gallery\n\nEach picture is drawn by a short script in `examples/`, anew whenever this site is built.\n"
    ]
    for section, scripts in SECTIONS.items():
        overview.append(f'## {section}\n\n<div class="gallery" markdown>\n')
        for script in scripts:
            title, text, code = _parts(EXAMPLES / f"{script}.py")
            printed, picture = _run(script)
            files.append(File.generated(config, f"gallery/{script}.png", abs_src_path=str(picture)))
            page = [f"# {title}\n", f"![{title}]({script}.png)\n", text]
            if printed.startswith("| "):
                page.append(f"{printed}\n")
            elif printed:
                page.append(f"It prints:\n\n```text\n{printed}\n```\n")
            page.append(f"## The script\n\n`python examples/{script}.py [OUT.png]`\n\n```python\n{code}\n```\n")
            files.append(File.generated(config, f"gallery/{script}.md", content="\n".join(page)))
            overview.append(f"[![{title}]({script}.png) {title}]({script}.md)\n")
        overview.append("</div>\n")
    files.append(File.generated(config, "gallery/index.md", content="\n".join(overview)))
    return files


def _check_sections() -> None:
    listed = {script for scripts in SECTIONS.values() for script in scripts}
    there = {path.stem for path in EXAMPLES.glob("*.py")} - {"style"}
    if listed != there:
        raise PluginError(f"docs/hooks/gallery.py and examples/ disagree about {', '.join(sorted(listed ^ there))}")


def _parts(path: Path) -> tuple[str, str, str]:
    """Title, text and code of a script: the first line of its docstring, the rest of it, what follows."""
    source = path.read_text()
    module = ast.parse(source)
    title, _, text = (ast.get_docstring(module) or "").partition("\n")
    code = "\n".join(source.splitlines()[module.body[0].end_lineno or 0 :])
    return title.rstrip("."), text.strip() + "\n", code.strip()


def _run(script: str) -> tuple[str, Path]:
    """What a script prints, and its picture; not again if nothing that it may depend on has changed since."""
    picture, printed = PICTURES / f"{script}.png", PICTURES / f"{script}.txt"
    newest = max(
        path.stat().st_mtime
        for package in ("canal", "diagrams", "geosacs_drake", "models", "examples")
        for path in (ROOT / package).rglob("*")
        if path.suffix in (".py", ".yaml", ".npz", ".sdf", ".urdf")
        and (package != "examples" or path.stem in (script, "style"))
    )
    if not (printed.exists() and printed.stat().st_mtime > newest):
        log.info("drawing %s", script)
        PICTURES.mkdir(parents=True, exist_ok=True)
        done = subprocess.run(
            [sys.executable, EXAMPLES / f"{script}.py", picture],
            capture_output=True,
            text=True,
            check=False,
            env=os.environ | {"OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)},
        )
        if done.returncode:
            raise PluginError(f"examples/{script}.py fails: {done.stderr.strip()}")
        lines = [line for line in done.stdout.splitlines() if not line.startswith("drawn to")]
        printed.write_text("\n".join(lines))
    return printed.read_text(), picture
