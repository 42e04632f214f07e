"""Videos: rendered without a display, and refused where they cannot be written."""

import shutil

import numpy as np
import pytest
from PIL import Image
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from canal.errors import InputError
from diagrams.scenario import load_scenario
from diagrams.station.lio_station import START_POSTURE, LioStation
from diagrams.view.cameras import FRAME_PERIOD, SIZE, VideoRecorder, look_at


def test_look_at_is_upright():
    X = look_at((2.0, -1.0, 1.5), (0.0, 0.5, 0.5))
    x, y, z = X.rotation().matrix().T
    assert z == pytest.approx(np.array([-2.0, 1.5, -1.0]) / np.linalg.norm([-2.0, 1.5, -1.0]))
    assert x[2] == pytest.approx(0)
    assert y[2] < 0  # down in the picture is down in the room


@pytest.mark.parametrize("name", ["film.avi", "film"])
def test_other_endings_are_refused(tmp_path, name):
    with pytest.raises(InputError, match=r"neither \.gif nor \.mp4"):
        VideoRecorder(tmp_path / name)


def test_mp4_without_ffmpeg_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda _: None)
    with pytest.raises(InputError, match="needs ffmpeg"):
        VideoRecorder(tmp_path / "film.mp4")


def test_a_gif_of_the_room(tmp_path):
    builder = DiagramBuilder()
    station = LioStation.AddToBuilder(builder=builder, world=load_scenario("relocation"))
    path = tmp_path / "film.gif"
    recorder = VideoRecorder.AddToBuilder(builder=builder, station=station, task="relocation", path=path)
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = station.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    station.GetInputPort("desired_state").FixValue(context, np.concatenate([START_POSTURE, np.zeros(6)]))
    station.GetInputPort("gripper_command").FixValue(context, [0.0])
    simulator.AdvanceTo(FRAME_PERIOD)
    assert not path.exists()
    recorder.save()
    with Image.open(path) as film:
        assert film.size == SIZE
        picture = np.asarray(film.convert("RGB"), dtype=float)
    assert [p.name for p in tmp_path.iterdir()] == ["film.gif"]
    red = (picture[:, :, 0] > 120) & (picture[:, :, 1:].max(axis=2) < 80)
    assert red.sum() > 50  # the apple
    assert picture.std() > 20
