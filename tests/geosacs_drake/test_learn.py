"""The learn command as a person runs it."""

import dataclasses
import os
import signal
import subprocess
import sys
import urllib.request

import numpy as np
import pytest

import models
from canal.demonstration import load_demonstration
from canal.learning import learn_canal
from canal.learning_options import LearningOptions
from canal.support_planes import SupportPlane
from canal.surface_file import load_canal
from geosacs_drake.learn import main
from geosacs_drake.learn_options import LearnOptions, parse
from geosacs_drake.results.canal_html import serve

DEMONSTRATIONS = tuple(f"{models.__path__[0]}/demonstrations/relocation_{k}.npz" for k in (1, 2))


def learn(*arguments, cwd=None):
    command = [sys.executable, "-m", "geosacs_drake.learn", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120)


def test_learn_writes_a_canal_two_pictures_and_a_page(tmp_path):
    done = learn(*DEMONSTRATIONS, "-o", "c.npz", "--plot", "c.png", "--html", "c.html", "--margin", 0.005, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    canal = load_canal(tmp_path / "c.npz")
    assert canal.n_disks >= 201
    for word in ("length", "radius", "home", "orientation", "tilt"):
        assert word in done.stdout
    for name in ("c.png", "c-frames.png"):
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "c.html").read_text()
    assert "MeshCat.Viewer" in page
    assert page.count("handle_command_bytearray(") > 10
    assert sorted(p.name for p in tmp_path.iterdir()) == ["c-frames.png", "c.html", "c.npz", "c.png"]


def _bad_files(folder):
    good = load_demonstration(DEMONSTRATIONS[0])
    position, orientation = good.position, good.orientation
    nan = position.copy()
    nan[3] = np.nan
    np.savez(folder / "nokeys.npz", foo=position)
    np.savez(folder / "nan.npz", position=nan, orientation=orientation)
    np.savez(folder / "one.npz", position=position[:1], orientation=orientation[:1])
    np.savez(folder / "zero.npz", position=position, orientation=0 * orientation)
    np.savez(folder / "back.npz", position=position[::-1], orientation=orientation[::-1])
    (folder / "empty.npz").write_bytes(b"")
    (folder / "text.npz").write_text("no archive")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["missing.npz"], "no such file"),
        (["empty.npz"], "empty"),
        (["text.npz"], "cannot be read"),
        (["nokeys.npz"], "position"),
        (["nan.npz"], "not finite"),
        (["one.npz"], "at least 4"),
        (["zero.npz"], "norm 0"),
        (["back.npz"], "opposite direction"),
        ([], "at least two"),
        (["--colour", "blue"], "--colour"),
        (["--margin", "wide"], "margin"),
        (["--margin", "-1"], "margin"),
        (["-o", "c.txt"], ".npz"),
        (["-o", "nowhere/c.npz"], "no folder"),
        (["--plot", "c.doc"], ".png"),
        (["--support-plane", "0", "0", "1", "5"], "support plane"),
        (["--n-disks", "200"], "odd"),
        (["--alpha", "nan"], "alpha"),
        (["--preset", "best"], "preset"),
        (["--units", "miles"], "units"),
        (["--port", "-1"], "--port"),
    ],
)
def test_bad_input_gives_one_line_and_status_2(tmp_path, arguments, says):
    _bad_files(tmp_path)
    files = (
        DEMONSTRATIONS[:1] if arguments in ([], ["back.npz"]) or arguments[:1][0].endswith(".npz") else DEMONSTRATIONS
    )
    done = learn(*files, *arguments, cwd=tmp_path)
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert says in lines[0]


def test_planes_and_ellipses_are_options(tmp_path, capsys):
    output = tmp_path / "c.npz"
    low = min(load_demonstration(path).position[:, 2].min() for path in DEMONSTRATIONS) - 0.005
    options = LearnOptions(
        tuple(map(tmp_path.__class__, DEMONSTRATIONS)),
        output=output,
        learning=LearningOptions(ellipse=True, support_planes=(SupportPlane((0.0, 0.0, 1.0), low),)),
    )
    assert main(options) == 0
    assert "warning: 2 demonstrations say nothing about ellipses" in capsys.readouterr().out
    canal = load_canal(output)
    assert canal.support_planes[0].offset == low
    assert min(canal.point(s, 1.0, phi)[2] for s in (0, canal.n_disks - 1) for phi in range(7)) >= low - 1e-9


def test_every_option_of_learning_can_be_typed():
    """With another value than its default, as a person would write it; none is written twice."""
    typed = {
        "step": "0.125",
        "band": "0.2",
        "warp_smoothing": "0.02",
        "margin": "0.01",
        "n_disks": "151",
        "x_global": "0 1 0",
        "y_window": "10",
        "support_planes": "0 0 1 -0.5",
        "alpha": "5",
        "beta": "0.2",
        "preset": "paper",
    }
    for field in dataclasses.fields(LearningOptions):
        default = getattr(LearningOptions(), field.name)
        flag = f"--{field.name.replace('_', '-')}"
        if isinstance(default, bool):
            words = [flag.replace("--", "--no-") if default else flag]
        else:
            words = [flag, *typed[field.name].split()]
        assert getattr(parse(words).learning, field.name) != default, field.name
    planes = parse(["a", "b", "--support-plane", *["0", "0", "1", "0.1"], "--support-plane", *["0", "1", "0", "-1"]])
    assert [plane.offset for plane in planes.learning.support_planes] == [0.1, -1]
    assert len(planes.demonstrations) == 2


def test_a_preset_on_the_command_line_gives_way_to_what_is_typed():
    learning = parse(["--preset", "paper", "--y-window", "3", "--relax-disks"]).learning
    assert learning == LearningOptions(preset="paper", y_window=3, relax_disks=True)
    assert learning.interpolate


def test_units_order_and_bad_samples_of_a_recording(tmp_path):
    for k, path in enumerate(DEMONSTRATIONS):
        d = load_demonstration(path)
        position = 100 * d.position
        position[50 + k] = np.nan
        orientation = np.roll(d.orientation, -1, axis=1)
        np.savez(tmp_path / f"{k}.npz", position=position, orientation=orientation, time=1e3 * d.time)
    files = ["0.npz", "1.npz"]
    for words, says in (
        ([], "--drop-bad-samples"),
        (["--drop-bad-samples"], "--units cm"),
        (["--drop-bad-samples", "--units", "cm"], "--time-unit ms"),
    ):
        done = learn(*files, *words, cwd=tmp_path)
        assert done.returncode == 2
        assert says in done.stderr
        assert len(done.stderr.splitlines()) == 1
    words = ["--drop-bad-samples", "--units", "cm", "--time-unit", "ms"]
    done = learn(*files, *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "--quaternion-order xyzw" in done.stdout
    done = learn(*files, *words, "--quaternion-order", "xyzw", "-o", "c.npz", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "--quaternion-order" not in done.stdout
    assert "0.npz: 1 of" in done.stdout
    plain = learn_canal([load_demonstration(path) for path in DEMONSTRATIONS])
    canal = load_canal(tmp_path / "c.npz")
    assert canal.n_disks == plain.n_disks
    assert np.abs(canal.directrix - plain.directrix).max() < 1e-3
    assert np.abs(np.sum(canal.orientations * plain.orientations, axis=1)).min() > 0.9999


def test_a_canal_that_is_far_too_short_is_said(tmp_path):
    done = learn(*DEMONSTRATIONS, "--units", "cm", cwd=tmp_path)
    assert "metres" in done.stdout


def test_view_shows_the_page_on_localhost_until_interrupted():
    command = [sys.executable, "-m", "geosacs_drake.learn", *DEMONSTRATIONS, "--view"]
    environment = {**os.environ, "BROWSER": "true"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        for line in process.stdout:
            if "http://127.0.0.1:" in line:
                break
        address = next(word for word in line.split() if word.startswith("http"))
        with urllib.request.urlopen(address, timeout=20) as answer:
            assert b"MeshCat.Viewer" in answer.read()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=20) == 0


def test_a_port_that_is_taken_gives_status_2():
    with serve("<html></html>") as server:
        done = learn(*DEMONSTRATIONS, "--view", "--port", server.server_address[1])
    assert done.returncode == 2
    assert "port" in done.stderr.splitlines()[-1]


@pytest.mark.browser
def test_the_page_draws_the_canal(tmp_path, page):
    assert main(LearnOptions(tuple(map(tmp_path.__class__, DEMONSTRATIONS)), html=tmp_path / "c.html")) == 0
    page.goto((tmp_path / "c.html").as_uri())
    page.wait_for_function(
        "typeof viewer !== 'undefined' && viewer.scene_tree.find(['meshcat', 'path']).object.children.length > 0"
    )
    page.wait_for_timeout(1500)
    shot = page.screenshot(path=os.environ.get("GEOSACS_SHOT"))
    from io import BytesIO

    from matplotlib.image import imread

    pixels = imread(BytesIO(shot))[..., :3]
    red = (pixels[..., 0] > 0.5) & (pixels[..., 1] < 0.35) & (pixels[..., 2] < 0.35)
    assert red.sum() > 200
