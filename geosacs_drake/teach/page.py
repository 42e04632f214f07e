"""The page of a lesson: its server, and what is drawn in it of what was taught."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import Meshcat, Rgba
from pydrake.math import RollPitchYaw
from pydrake.systems.framework import Context

from canal.rows import length_along
from diagrams.scene.world import World
from diagrams.teach.path import TaughtPath
from diagrams.teaching import Teaching
from diagrams.view.canal_drawing import CanalDrawing
from diagrams.view.canal_meshes import tube
from diagrams.view.gripper_camera import GripperCamera, can_render
from geosacs_drake.console.console import open_page
from geosacs_drake.console.mapping_choice import RIGHT_T, UP_T
from geosacs_drake.console.server import ConsoleServer
from geosacs_drake.process.run_again import earlier_address
from geosacs_drake.teach.answers import TeachAnswers
from geosacs_drake.teach.hand import TeachControl
from geosacs_drake.teach.lesson import Lesson
from geosacs_drake.teach.status import TeachReporter

RECORDED, SINCE, SAVED = Rgba(0.85, 0.16, 0.12), Rgba(0.45, 0.50, 0.52), Rgba(0.10, 0.55, 0.25)
"""Colours: what is recorded red, as every recorder has it; what was moved since grey; what is saved green."""
SPACING_M, RADIUS = 0.006, 0.004
"""[m] Between drawn points, and of the line."""


class TeachPage:
    """What a lesson holds of its page."""

    def __init__(self, control: TeachControl, meshcat: Meshcat, *, host: str, port: int | None) -> None:
        """Serve the page with `meshcat` in it.

        Args:
            control: gets the jogs.
            meshcat: shows the robot.
            host: the address to listen at.
            port: see `ConsoleServer`.

        Raises:
            InputError: the port is taken.
        """
        address = meshcat.web_url().removeprefix("http://").partition(":")
        earlier = earlier_address()
        self._again = earlier is not None
        self._control, self._meshcat = control, meshcat
        self.server = ConsoleServer(
            control,
            TeachAnswers(control),
            meshcat_address=(address[0], int(address[2])),
            host=host,
            port=port if earlier is None else earlier[0],
            token=None if earlier is None else earlier[1],
            index="teach.html",
        )
        self._drawn: dict[str, object] = {}
        self.server.start()

    @property
    def address(self) -> str:
        """Of the page."""
        return self.server.address

    @property
    def port_and_token(self) -> tuple[int, str]:
        """Of the server, for who comes after it."""
        return self.server.port, self.server.access.token

    def open_browser(self) -> None:
        """Open the page where there is a display and a terminal to close it from."""
        if not self._again:
            open_page(self.address)

    def begin(self, teaching: Teaching, lesson: Lesson, world: World, seed: int) -> None:
        """Show a lesson.

        Args:
            teaching: its diagram.
            lesson: what it comes to.
            world: that its station was built from.
            seed: likewise.
        """
        self.server.answers.shows_pictures = can_render()
        self._camera = GripperCamera(teaching.station, world, seed, self.server) if can_render() else None
        self._teaching, self._lesson = teaching, lesson
        self._reporter = TeachReporter(teaching, lesson)
        X_WB = teaching.station.X_WB
        about = {
            "teaching": True,
            "description": "Teach the robot",
            "base_yaw": float(RollPitchYaw(X_WB.rotation()).yaw_angle()),
            "base": X_WB.translation(),
            "gripper_view": {"right": RIGHT_T, "up": UP_T},
            "bindings": self.server.answers.bindings.all(),
        }
        self.server.introduce(about)
        self._meshcat.SetTransform("taught", X_WB)
        self._canal = CanalDrawing(self._meshcat, "canal")

    def show(self, root: Context, busy: str = "") -> None:
        """Show how it stands, if it is time to.

        Args:
            root: the diagram's context.
            busy: what the lesson is doing instead of moving the robot.
        """
        if self._camera is not None:
            self._camera.look(root)
        if not self._reporter.due() and not busy:
            return
        self.server.show(self._reporter.status(root, stopped=self._control.situation().stopped, busy=busy))
        path = self._teaching.recorder.path(root)
        self._draw_path(path)
        for k, demonstration in enumerate(self._lesson.demonstrations):
            self._draw(f"saved/{k}", demonstration.position, SAVED)
        if self._drawn.get("canal") is not self._lesson.canal:
            self._drawn["canal"] = self._lesson.canal
            self._canal.clear(self._teaching.station.X_WB)
            if self._lesson.canal is not None:
                self._canal.draw(self._lesson.canal)

    def tell(self, text: str, time_s: float) -> None:
        """What a person is told goes to the history.

        Args:
            text: what has happened.
            time_s: when, [s].
        """
        self.server.tell({"time_s": round(time_s, 1), "kind": "lesson", "text": text})

    def close(self) -> None:
        """Let go of the pages and the port."""
        self.server.stop()

    def _draw_path(self, path: TaughtPath) -> None:
        self._draw("recorded", path.poses[: path.kept, :3], RECORDED)
        self._draw("since", path.poses[max(path.kept - 1, 0) :, :3] if path.kept else path.poses[:0, :3], SINCE)

    def _draw(self, name: str, points: np.ndarray, color: Rgba) -> None:
        """Draw a line, where it is another one than was drawn last."""
        key = (len(points), *(points[-1].round(4).tolist() if len(points) else ()))
        if self._drawn.get(name) == key:
            return
        self._drawn[name] = key
        points = _spaced(points)
        if len(points) < 2:
            self._meshcat.Delete(f"taught/{name}")
            return
        mesh = tube(points, RADIUS)
        self._meshcat.SetTriangleMesh(f"taught/{name}", mesh.vertices, mesh.faces, color)
        self._meshcat.SetProperty(f"taught/{name}/<object>", "castShadow", False)


def _spaced(points: np.ndarray) -> np.ndarray:
    """Those that are far enough from each other to be seen apart, and the last."""
    if len(points) < 2:
        return points
    way = length_along(points)
    _, first = np.unique((way / SPACING_M).astype(int), return_index=True)
    return points[np.unique(np.append(first, len(points) - 1))]
