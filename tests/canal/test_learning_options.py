"""Options and presets: given by name, kept in the canal's file, used by whatever makes another canal of it."""

import dataclasses
import json
from dataclasses import replace

import numpy as np
import pytest
from hard_demonstrations import hard_demonstrations

from canal.editing import add_demonstration, cut, join, own_options, reverse
from canal.errors import InputError
from canal.learning import learn_canal
from canal.learning_options import MEASURED, PAPER, LearningOptions, from_json, to_json
from canal.options import read_options
from canal.quality import canal_quality
from canal.retargeting import retarget
from canal.support_planes import SupportPlane
from canal.surface_file import load_canal, save_canal

PLANE = SupportPlane((0.0, 0.0, 1.0), -0.5)
UNUSUAL = LearningOptions(
    step=0.125,
    interpolate=True,
    band=0.3,
    margin=0.004,
    contain_raw=True,
    n_disks=151,
    x_global=(0.0, 1.0, 0.0),
    y_window=7,
    support_planes=(PLANE,),
    alpha=5.0,
    beta=0.2,
)


def test_a_preset_fills_in_what_is_not_given():
    paper = LearningOptions(preset="paper", margin=0.01, y_window=5)
    for key, value in PAPER.items():
        assert getattr(paper, key) == (5 if key == "y_window" else value)
        assert getattr(MEASURED, key) != value
    assert paper.margin == 0.01
    assert read_options(LearningOptions, {"preset": "paper", "margin": 0.01, "y_window": 5}) == paper
    assert dataclasses.replace(paper, y_window=1).y_window == 1


def test_the_constants_of_the_papers_table():
    paper = LearningOptions(preset="paper")
    assert (paper.step, paper.alpha, paper.beta, paper.y_window) == (0.1, 9.0, 0.3, 10)


@pytest.mark.parametrize("options", [MEASURED, UNUSUAL, LearningOptions(preset="paper", band=0.5)])
def test_options_come_back_from_a_file(tmp_path, options):
    assert from_json(to_json(options)) == options
    canal = learn_canal(hard_demonstrations(2), options)
    save_canal(tmp_path / "c.npz", canal)
    assert load_canal(tmp_path / "c.npz").options == options


@pytest.mark.parametrize("text", ["", "[" * 100_000, "[]", '{"alpha": "much"}', '{"colour": 1}', '{"preset": "best"}'])
def test_options_that_are_none_give_one_line(tmp_path, text):
    canal = learn_canal(hard_demonstrations(2))
    save_canal(tmp_path / "c.npz", canal)
    with np.load(tmp_path / "c.npz") as file:
        arrays = dict(file)
    np.savez(tmp_path / "c.npz", **arrays | {"options": np.array(text)})
    with pytest.raises(InputError, match=r"c\.npz") as caught:
        load_canal(tmp_path / "c.npz")
    assert "\n" not in str(caught.value)


def test_a_file_without_options_has_the_defaults(tmp_path):
    canal = learn_canal(hard_demonstrations(2), UNUSUAL)
    save_canal(tmp_path / "c.npz", canal)
    with np.load(tmp_path / "c.npz") as file:
        arrays = {key: array for key, array in file.items() if key != "options"}
    np.savez(tmp_path / "c.npz", **arrays)
    old = load_canal(tmp_path / "c.npz")
    assert old.options == MEASURED
    assert own_options(old).support_planes == (PLANE,)
    assert np.allclose(own_options(old).x_global, (0, 1, 0))


def _edited(canal):
    extra = hard_demonstrations(5, 3)[2]
    end = canal.n_disks - 1
    first = cut(canal, 0, 0.6 * end)
    yield "reverse", reverse(canal)
    yield "add", add_demonstration(canal, extra)
    yield "retarget", retarget(canal, place=canal.directrix[-1] + [0.02, 0.01, 0.0])
    yield "cut", first
    yield "join", join(first, cut(canal, 0.6 * end, end))


def test_whatever_edits_a_canal_uses_its_options():
    canal = learn_canal(hard_demonstrations(5, 3)[:2], UNUSUAL)
    for name, edited in _edited(canal):
        kept = dataclasses.replace(edited.options, n_disks=151, x_global=UNUSUAL.x_global)
        assert kept == UNUSUAL, name
        ball = np.linalg.norm(edited.demonstrations - edited.directrix, axis=2).max(axis=0)
        assert (edited.radii - ball).min() >= UNUSUAL.margin - 1e-9, name
        if name != "retarget":  # which carries the weights over
            weights = np.exp(-UNUSUAL.alpha * (edited.orientation_sd - UNUSUAL.beta))
            assert np.allclose(edited.orientation_weights, weights, atol=1e-12), name
        assert edited.support_planes == (PLANE,), name
        share = edited.length / canal.length
        assert edited.n_disks == pytest.approx(151 if name in ("add", "retarget") else 151 * share, abs=4), name


def test_a_margin_is_counted_once():
    canal = learn_canal(hard_demonstrations(5), LearningOptions(margin=0.02))
    again = retarget(retarget(canal))
    ball = np.linalg.norm(again.demonstrations - again.directrix, axis=2).max(axis=0)
    assert np.allclose(again.radii - ball, 0.02, atol=1e-3)


def test_joining_what_was_learned_differently_says_so():
    first = learn_canal(hard_demonstrations(5), LearningOptions(alpha=5.0, margin=0.02))
    second = replace(first, options=dataclasses.replace(first.options, alpha=9.0, margin=0.01))
    end = first.n_disks - 1
    joined = join(cut(first, 0, 0.5 * end), cut(second, 0.5 * end, end))
    assert any("alpha 9.0 instead of 5.0" in line for line in joined.warnings)
    assert joined.options.alpha == 5.0
    assert joined.options.margin == 0.01


def test_the_papers_rules_can_be_compared_with_ours():
    """The paper's learn from the same recordings; their disks cross and their axes jump where ours do not."""
    demonstrations = hard_demonstrations(3)
    ours, papers = learn_canal(demonstrations), learn_canal(demonstrations, LearningOptions(preset="paper"))
    for canal in (ours, papers):
        quality = canal_quality(canal)
        assert quality.outside_ball <= 1e-12
        assert np.isfinite(canal.directrix).all()
        assert np.abs(np.sum(canal.normals * canal.x_axes, axis=1)).max() < 1e-9
    assert canal_quality(papers).tilt_max < 1e-6
    assert canal_quality(ours).n_crossing == 0
    assert canal_quality(papers).n_crossing > 0
    assert canal_quality(papers).x_turn_max > canal_quality(ours).x_turn_max


def test_json_is_plain():
    assert json.loads(to_json(UNUSUAL))["support_planes"] == [{"normal": [0.0, 0.0, 1.0], "offset": -0.5}]
