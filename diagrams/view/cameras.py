"""Videos without a display: a camera that stands in the room, the gripper's own in a corner of its picture.

Drake's `VideoWriter` records one camera a file, writes the file in place, and needs OpenCV for an `.mp4`. Here two
pictures make one, the file appears whole or not at all, and `ffmpeg` makes the `.mp4`; hence a recorder of our own.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from PIL import Image
from pydrake.common.value import Value
from pydrake.geometry import (
    ClippingRange,
    ColorRenderCamera,
    DepthRange,
    DepthRenderCamera,
    LightParameter,
    MakeRenderEngineVtk,
    RenderCameraCore,
    RenderEngineVtkParams,
    SceneGraph,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, DiagramBuilder, LeafSystem
from pydrake.systems.sensors import CameraInfo, ImageRgba8U, RgbdSensor

from canal.errors import InputError
from canal.files import write_and_rename
from diagrams.station.lio_station import LioStation

RENDERER = "vtk"
SIZE, INSET = (640, 480), (192, 144)
"""Of the picture, and of the gripper's in its corner [pixels]."""
FRAME_PERIOD = 0.2
"""Simulated time between pictures [s]; each takes 0.1 s to render."""
FRAME_RATE = 15.0
"""Of the video [1/s]: three times as fast as the run."""
COLORS = 128
"""Of a frame's palette: GIF files allow 256."""


@dataclass(frozen=True)
class View:
    """Where a camera stands in the frame of the robot's base, and what it looks at [m]."""

    eye: tuple[float, float, float]
    """Where the camera stands in B, [m]. Shape (3,)."""
    target: tuple[float, float, float]
    """What it looks at in B, [m]. Shape (3,)."""
    fov_deg: float = 42.0
    """Vertical field of view, [°]."""


VIEWS = {
    "laundry": View((1.75, -0.75, 1.45), (0.10, 0.38, 0.60)),
    "relocation": View((2.0, 0.25, 1.35), (0.12, 0.0, 0.55)),
}
X_GRIPPER_CAMERA = RigidTransform(
    RotationMatrix(np.column_stack([(0, -1, 0), (np.cos(0.30), 0, -np.sin(0.30)), (np.sin(0.30), 0, np.cos(0.30))])),
    [-0.075, 0.0, 0.085],
)
"""On link `lio_gripper`: above the fingers, looking down on them by 17°; z forward, y down in the picture."""


def film_kind(path: Path) -> str:
    """`.gif`, or `.mp4` where ffmpeg is installed: what a file for a film is.

    Raises:
        InputError: another ending, or mp4 without ffmpeg.
    """
    kind = path.suffix.lower()
    if kind not in (".gif", ".mp4"):
        raise InputError(f"{path}: is neither .gif nor .mp4; give one of these endings")
    if kind == ".mp4" and shutil.which("ffmpeg") is None:
        raise InputError(f"{path}: needs ffmpeg, which is not installed; install it or give a .gif")
    return kind


def look_at(eye: Sequence[float], target: Sequence[float]) -> RigidTransform:
    """The pose of a camera (z forward, y down) that looks from one point at another, upright.

    Args:
        eye: where it stands, [m]. Shape (3,).
        target: what it looks at, [m]. Shape (3,).
    """
    z = np.subtract(target, eye)
    z = z / np.linalg.norm(z)
    x = np.cross(z, (0.0, 0.0, 1.0))
    x = x / np.linalg.norm(x)
    return RigidTransform(RotationMatrix(np.column_stack([x, np.cross(z, x), z])), np.asarray(eye, dtype=float))


def add_renderer(scene_graph: SceneGraph) -> None:
    """Give a scene graph the renderer that the cameras here use, once."""
    if scene_graph.HasRenderer(RENDERER):
        return
    lights = [
        LightParameter(type="directional", direction=(-0.5, 0.45, -1.0), frame="world", intensity=0.85),
        LightParameter(type="directional", direction=(-0.15, 0.95, -0.35), frame="world", intensity=0.5),
        LightParameter(type="directional", direction=(-0.9, -0.5, -0.3), frame="world", intensity=0.25),
    ]
    params = RenderEngineVtkParams(default_clear_color=(0.93, 0.945, 0.96), lights=lights)
    scene_graph.AddRenderer(RENDERER, MakeRenderEngineVtk(params))


def add_camera(
    *, builder: DiagramBuilder, station: LioStation, X: RigidTransform, size: tuple[int, int], fov_deg: float,
    body: str | None = None,
) -> RgbdSensor:  # fmt: skip
    """Add a colour camera at `X` in the world, or on a body of the Lio.

    Args:
        builder: of the diagram that it is added to.
        station: that is filmed.
        X: pose of the camera.
        size: of the picture, width and height in pixels.
        fov_deg: vertical field of view, [°].
        body: of the Lio that carries it; None: it stands in the world.
    """
    add_renderer(station.scene_graph)
    core = RenderCameraCore(
        RENDERER, CameraInfo(*size, np.deg2rad(fov_deg)), ClippingRange(0.01, 12.0), RigidTransform()
    )
    plant = station.plant
    frame = plant.world_body() if body is None else plant.GetBodyByName(body, station.scene.lio)
    sensor = builder.AddSystem(
        RgbdSensor(
            plant.GetBodyFrameIdOrThrow(frame.index()),
            X,
            ColorRenderCamera(core),
            DepthRenderCamera(core, DepthRange(0.02, 10.0)),
        )
    )
    builder.Connect(station.GetOutputPort("geometry_query"), sensor.GetInputPort("geometry_query"))
    return sensor


class VideoRecorder(LeafSystem):
    """Collects pictures, and writes them when asked.

    ```
      room_image → ┌───────────────┐
                   │ VideoRecorder │
    gripper_image → └───────────────┘
    ```

    The frames are an output of the run, like what Meshcat shows, and no state of the diagram.
    """

    def __init__(self, path: Path) -> None:
        """Record for a file `.gif`, or `.mp4` where ffmpeg is installed.

        Raises:
            InputError: another ending, or mp4 without ffmpeg.
        """
        super().__init__()
        self._path, self._kind = path, film_kind(path)
        self._frames: list[Image.Image] = []
        self._room = self.DeclareAbstractInputPort("room_image", Value(ImageRgba8U()))
        self._gripper = self.DeclareAbstractInputPort("gripper_image", Value(ImageRgba8U()))
        self.DeclarePeriodicPublishEvent(FRAME_PERIOD, 0.0, self._publish)

    def _publish(self, context: Context) -> None:
        picture = np.array(self._room.Eval(context).data[:, :, :3])
        inset = self._gripper.Eval(context).data[:, :, :3]
        h, w = inset.shape[:2]
        margin = 10
        picture[margin - 2 : margin + h + 2, -margin - w - 2 : -margin + 2] = 255
        picture[margin : margin + h, -margin - w : -margin] = inset
        frame = Image.fromarray(picture)
        self._frames.append(frame.quantize(COLORS, dither=Image.Dither.NONE) if self._kind == ".gif" else frame)

    def save(self) -> None:
        """Write the file, whole or not at all; none where no picture was taken.

        Raises:
            InputError: it cannot be written, or ffmpeg fails.
        """
        if not self._frames:
            return
        if self._kind == ".gif":
            write_and_rename(self._path, lambda stream: self._write(stream, "GIF"))
            return
        with tempfile.TemporaryDirectory() as folder:
            pictures, film = Path(folder) / "frames.png", Path(folder) / "film.mp4"
            with pictures.open("wb") as stream:
                self._write(stream, "PNG")
            command = ["ffmpeg", "-y", "-loglevel", "error", "-i", str(pictures), "-pix_fmt", "yuv420p", str(film)]
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
            if done.returncode or not film.is_file():
                words = done.stderr.decode(errors="replace").strip() or f"status {done.returncode}"
                raise InputError(f"{self._path}: ffmpeg failed ({words}); give a .gif")
            with film.open("rb") as made:
                write_and_rename(self._path, lambda stream: shutil.copyfileobj(made, stream))

    def _write(self, stream: BinaryIO, form: str) -> None:
        first, *rest = self._frames
        first.save(stream, form, save_all=True, append_images=rest, duration=round(1000 / FRAME_RATE), loop=0)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, station: LioStation, task: str, path: Path) -> VideoRecorder:
        """Add the room's camera, where it sees the `task` (a key of `VIEWS`), the gripper's, and the recorder.

        Call `save` after the run.

        Args:
            builder: of the diagram that it is added to.
            station: that is filmed.
            task: key of `VIEWS`.
            path: of the film.
        """
        view = VIEWS[task]
        recorder = builder.AddNamedSystem("video_recorder", VideoRecorder(path))
        X = station.X_WB.multiply(look_at(view.eye, view.target))
        room = add_camera(builder=builder, station=station, X=X, size=SIZE, fov_deg=view.fov_deg)
        hand = add_camera(
            builder=builder, station=station, X=X_GRIPPER_CAMERA, size=INSET, fov_deg=70.0, body="lio_gripper"
        )
        builder.Connect(room.GetOutputPort("color_image"), recorder.GetInputPort("room_image"))
        builder.Connect(hand.GetOutputPort("color_image"), recorder.GetInputPort("gripper_image"))
        return recorder
