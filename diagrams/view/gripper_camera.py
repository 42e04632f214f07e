"""What the camera on the gripper sees, as pictures for a person who looks: rendered only while somebody does."""

from __future__ import annotations

import ctypes
import io
import sys
import time
from functools import cache
from typing import Protocol

import numpy as np
from PIL import Image
from pydrake.systems.framework import Context, DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from diagrams.scene.world import World
from diagrams.station.lio_station import LioStation
from diagrams.view.cameras import X_GRIPPER_CAMERA, add_camera

SIZE = (320, 240)
"""[pixels] Without a graphics card 31 ms a picture in the relocation, 44 before three deformable items (20 and 35 at
240 x 180: most of it is the scene, not the pixels)."""
FOV_DEG = 70.0
"""Vertical, as the page's own view from the gripper."""
LEAST_S = 0.18
"""[s] On the wall's clock between two pictures: five and a half a second."""
SHARE = 0.25
"""Of the run's time that pictures may take: a slower machine shows fewer of them, and the run keeps its pace."""
QUALITY = 80
"""Of the JPEG: 4 to 14 kB a picture."""


class Watcher(Protocol):
    """Who may look."""

    def picture_wanted(self) -> bool:
        """Whether somebody waits for a picture."""

    def show_picture(self, jpeg: bytes) -> None:
        """Get one.

        Args:
            jpeg: the file's bytes.
        """


@cache
def can_render() -> bool:
    """Whether Drake's renderer has what it needs: on Linux the system's EGL, without which it ends the process."""
    if not sys.platform.startswith("linux"):
        return True
    try:
        ctypes.CDLL("libEGL.so.1")
    except OSError:
        return False
    return True


class GripperCamera:
    """Looks at a station through a copy of it that is never simulated.

    A renderer in the station's own scene is brought up to date at each step of the plant, whether anybody looks or not:
    with three deformable items that doubles what a run costs. The copy gets the plant's state for each picture, and
    keeps nothing else.
    """

    def __init__(self, station: LioStation, world: World, seed: int, watcher: Watcher) -> None:
        """Look at `station`.

        Args:
            station: that is simulated.
            world: that it was built from.
            seed: likewise.
            watcher: who looks.
        """
        self._plant, self._watcher = station.plant, watcher
        builder = DiagramBuilder()
        copy = LioStation.AddToBuilder(builder=builder, world=world, seed=seed, filmed=True)
        for name in ("desired_state", "gripper_command"):
            port = copy.GetInputPort(name)
            nothing = builder.AddSystem(ConstantVectorSource(np.zeros(port.size())))
            builder.Connect(nothing.get_output_port(), port)
        camera = add_camera(
            builder=builder, station=copy, X=X_GRIPPER_CAMERA, size=SIZE, fov_deg=FOV_DEG, body="lio_gripper"
        )
        self._diagram = builder.Build()
        root = self._diagram.CreateDefaultContext()
        self._state = copy.plant.GetMyMutableContextFromRoot(root)
        self._image, self._context = camera.GetOutputPort("color_image"), camera.GetMyContextFromRoot(root)
        self._next = 0.0

    def look(self, root: Context) -> None:
        """Show the watcher what it wants, if it is time to.

        Args:
            root: context of the diagram that the station is in.
        """
        now = time.perf_counter()
        if now < self._next or not self._watcher.picture_wanted():
            return
        stream = io.BytesIO()
        Image.fromarray(self.picture(root)).save(stream, "JPEG", quality=QUALITY)
        self._watcher.show_picture(stream.getvalue())
        self._next = now + max(LEAST_S, (time.perf_counter() - now) / SHARE)

    def picture(self, root: Context) -> np.ndarray:
        """What the camera sees now: red, green, blue. Shape (240, 320, 3).

        Args:
            root: context of the diagram that the station is in.
        """
        self._state.get_mutable_discrete_state().SetFrom(self._plant.GetMyContextFromRoot(root).get_discrete_state())
        return np.array(self._image.Eval(self._context).data[:, :, :3])
