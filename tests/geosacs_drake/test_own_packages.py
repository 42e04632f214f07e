"""Started from anywhere, beside packages of the same names, the commands find their own."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def folder(tmp_path):
    """A folder with a `models.py`, a `canal/` and a `diagrams/` of its own."""
    (tmp_path / "models.py").write_text("raise SystemExit('the wrong models')\n")
    for name in ("canal", "diagrams"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text(f"raise SystemExit('the wrong {name}')\n")
    return tmp_path


def run(folder, *command, path=None):
    # As in an installation, where the project is not in the folder that it is started from.
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, [*([path] if path else []), ROOT]))}
    return subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True, timeout=120
    )


@pytest.mark.parametrize("module", ["learn", "run_relocation", "geosacs"])
def test_python_m_in_such_a_folder(folder, module):
    done = run(folder, "-m", f"geosacs_drake.{module}", "--help")
    assert done.returncode == 0, done.stderr
    assert "usage" in done.stdout
    assert done.stderr == ""


def test_beside_a_package_of_pypi(folder, tmp_path_factory):
    # A `diagrams` that is found before ours, as the one in site-packages is before an editable installation.
    done = run(tmp_path_factory.mktemp("empty"), "-m", "geosacs_drake.run_laundry", "--help", path=folder)
    assert done.returncode == 0, done.stderr


def test_the_console_script_starts_the_same_commands(folder, tmp_path_factory):
    module, function = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"]["geosacs"].split(":")
    script = tmp_path_factory.mktemp("bin") / "geosacs"
    script.write_text(f"import sys\nfrom {module} import {function}\nsys.exit({function}())\n")  # as pip writes it
    demos = [str(ROOT / "models" / "demonstrations" / f"relocation_{k}.npz") for k in (1, 2)]
    done = run(folder, script, "learn", *demos, "-o", "c.npz")
    assert done.returncode == 0, done.stderr
    assert (folder / "c.npz").is_file()
    for words, status, says in (
        (["run", "laundry", "--headless", "--duration", "0"], 2, "geosacs run-laundry: --duration"),
        (["run-relocation", "--seed", "-1"], 2, "geosacs run-relocation: --seed"),
        (["teach", "--headless"], 2, "geosacs run-teach: --headless needs a hand: give --script"),
        (["dance"], 2, "geosacs: there is no command 'dance'; use run-laundry, run-relocation, run-teach, learn"),
    ):
        done = run(folder, script, *words)
        assert done.returncode == status
        assert len(done.stderr.splitlines()) == 1
        assert done.stderr.startswith(says)
    done = run(folder, script, "--help")
    assert done.returncode == 0
    assert "run-relocation" in done.stdout


def test_what_was_imported_before_is_named(folder):
    (folder / "models.py").write_text("")
    done = run(folder, "-c", f"import models, sys; sys.path.append({str(ROOT)!r}); import geosacs_drake")
    assert done.returncode == 1
    assert f"needs its own 'models', but {folder}/models.py was imported" in done.stderr.splitlines()[-1]
