"""A lesson without a page: its files, what it refuses, who may speak, and the whole command by a script."""

import json
import subprocess
import sys

import numpy as np
import pytest

from canal.demonstration import load_demonstration
from canal.errors import InputError
from canal.surface_file import load_canal
from diagrams.scenario import load_scenario
from diagrams.teach.path import TaughtPath, Word
from geosacs_drake.console.messages import Jog, Teach
from geosacs_drake.teach.answers import TeachAnswers
from geosacs_drake.teach.hand import TeachControl, load_script
from geosacs_drake.teach.lesson import Lesson
from geosacs_drake.teach.options import TeachOptions
from models import MODELS


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def control():
    return TeachControl(person_asked=True, clock=Clock())


@pytest.fixture
def answers(control):
    return TeachAnswers(control)


def jog(**parts):
    return Jog(type="jog", n=1, **parts)


def teach(word):
    return Teach(type="teach", n=1, word=word)


def test_a_jog_that_nobody_confirms_falls_to_zero(control, answers):
    assert answers.teach("a", jog(move=(0, 0, 1)), 0.0) == ""
    assert control.jog_sample().jog.tolist() == [0, 0, 1, 0, 0, 0, 0]
    control.clock.now = 0.16
    assert not control.jog_sample().jog.any()
    answers.teach("a", jog(move=(0, 0, 1)), 0.2)  # old when it came
    assert not control.jog_sample().jog.any()


def test_a_page_that_leaves_lets_go(control, answers):
    answers.teach("a", jog(spin=1.0), 0.0)
    control.leave("a")
    assert not control.jog_sample().jog.any()


def test_another_page_watches_and_may_stop(control, answers):
    answers.teach("a", jog(move=(1, 0, 0)), 0.0)
    assert "Take control" in answers.teach("b", jog(move=(0, 1, 0)), 0.0)
    assert "Take control" in answers.teach("b", teach("record"), 0.0)
    control.press("b", "stop")
    sample = control.jog_sample()
    assert not sample.jog.any()
    assert sample.word is Word.STAND, "it goes back no further either"
    assert "Stopped" in answers.teach("a", jog(move=(1, 0, 0)), 0.0)
    control.press("a", "start")
    answers.teach("a", jog(move=(1, 0, 0)), 0.0)
    assert control.jog_sample().jog[0] == 1


def test_a_step_is_as_long_as_it_says_and_clamped(control, answers):
    answers.teach("a", jog(move=(0, 0, -1), mm=12.0), 0.0)
    moved = [control.jog_sample().jog for _ in range(5)]
    assert sum(m[2] for m in moved) * answers.full_stick_mm == pytest.approx(-12)
    assert max(abs(m).max() for m in moved) <= 1
    answers.teach("a", jog(move=(9, 9, 9), nose=(9, 0, 0), spin=-9), 0.0)
    big = control.jog_sample().jog
    assert np.linalg.norm(big[:3]) == pytest.approx(1)
    assert big[6] == -1


def test_words_reach_the_recorder_once_and_requests_the_lesson(control, answers):
    answers.teach("a", teach("record"), 0.0)
    assert [control.jog_sample().word for _ in range(2)] == [Word.RECORD, Word.NOTHING]
    assert "too late" in answers.teach("a", teach("undo"), 0.5)
    assert answers.teach("a", teach("pause"), 0.5) == "", "what moves nothing is heard however late"
    assert control.jog_sample().word is Word.PAUSE
    answers.teach("a", teach("save"), 0.0)
    answers.teach("a", teach("save"), 0.0)
    assert control.requests() == ["save"]
    control.press("a", "reverse")
    assert control.jog_sample().word is Word.UNDO


@pytest.fixture
def lesson(tmp_path):
    return Lesson(TeachOptions(output=tmp_path / "taught"), load_scenario("relocation"))


def shown(k):
    """A taught path as a shipped demonstration has it."""
    d = load_demonstration(MODELS / "demonstrations" / f"relocation_{k}.npz")
    poses = np.hstack([d.position, d.orientation])
    return TaughtPath(poses, kept=len(poses))


def test_demonstrations_are_saved_learned_and_overwrite_nothing(lesson, tmp_path):
    with pytest.raises(InputError, match="at least two"):
        lesson.learn()
    with pytest.raises(InputError, match="nothing is learned"):
        lesson.travel()
    lesson.save(shown(1))
    (tmp_path / "taught" / "demonstration_2.npz").write_text("somebody's")
    lesson.save(shown(2))
    assert [file.name for file in lesson.files] == ["demonstration_1.npz", "demonstration_3.npz"]
    assert (tmp_path / "taught" / "demonstration_2.npz").read_text() == "somebody's"
    assert load_demonstration(lesson.files[0]).position == pytest.approx(shown(1).poses[:, :3])
    assert "m long" in lesson.learn()
    assert load_canal(lesson.canal_file).length > 0.8
    command = lesson.travel()
    assert command[:2] == ["-m", "geosacs_drake.run_relocation"]
    assert command[command.index("--canal") + 1] == str(lesson.canal_file)
    lesson.save(shown(1))
    with pytest.raises(InputError, match="nothing is learned"):
        lesson.travel()


def test_what_is_no_demonstration_is_refused(lesson):
    with pytest.raises(InputError, match="nothing was recorded"):
        lesson.save(TaughtPath(np.empty((0, 7))))
    still = np.tile([0.4, 0, 0.5, 1, 0, 0, 0], (20, 1))
    with pytest.raises(InputError, match="mm only"):
        lesson.save(TaughtPath(still, kept=20))
    assert not lesson.files


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{a: 1}", "list of steps"),
        ("- {say: dance}", "dance"),
        ("- {jog: [1, 2], seconds: 1}", "jog"),
        ("- [", "script"),
    ],
)
def test_a_script_that_cannot_be_used_is_refused_in_one_line(tmp_path, text, words):
    file = tmp_path / "script.yaml"
    file.write_text(text)
    with pytest.raises(InputError, match=words) as refused:
        load_script(file)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"headless": True}, "--script"),
        ({"script": "a.yaml"}, "--headless"),
        ({"headless": True, "script": "a.yaml", "host": "0.0.0.0"}, "--host"),
        ({"realtime_rate": -1.0}, "realtime-rate"),
    ],
)
def test_options_that_exclude_each_other(options, words):
    with pytest.raises(InputError, match=words):
        TeachOptions(**options)


def test_a_script_teaches_a_pair_and_learns_it(tmp_path):
    """The whole command with nobody looking: two short demonstrations from one place, and a canal of them."""

    def step(seconds, move=(0, 0, 0)):
        return {"jog": [*map(float, move), 0.0, 0.0, 0.0, 0.0], "seconds": seconds}

    def show(aside):
        return [{"say": "record"}, step(2.5, (0, 0.97, -0.2)), step(1.5, (aside, 0.9, 0)), {"say": "save"}]

    steps = [step(2.0, (0, -1, -0.2)), *show(0.0), {"say": "back"}, step(6.0), *show(0.3), {"say": "learn"}, step(0.1)]
    script = tmp_path / "script.yaml"
    script.write_text(json.dumps(steps))
    command = [sys.executable, "-m", "geosacs_drake.run_teach", "--headless", "--script", str(script)]
    done = subprocess.run([*command, "--output", str(tmp_path / "out")], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Canal saved" in done.stderr
    first, second = (load_demonstration(tmp_path / "out" / f"demonstration_{k}.npz") for k in (1, 2))
    assert first.duration == pytest.approx(4.0, abs=0.5)
    assert second.position[0] == pytest.approx(first.position[0], abs=0.02), "it went back to where it began"
    assert second.position[-1, 0] - first.position[-1, 0] > 0.02
    assert load_canal(tmp_path / "out" / "canal_1.npz").length > 0.25
