"""Which way the stick points: chosen by the page while the run goes on, computed beside it."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from pydrake.math import RollPitchYaw, RotationMatrix
from scipy.spatial.transform import Rotation

from canal.navigation.stick_directions import SEATS, View, stick_directions, view_from
from canal.surface import CanalSurface
from diagrams.view.cameras import X_GRIPPER_CAMERA


class MappingChoice:
    """The directions that were chosen last. All methods may be called from any thread, and none waits."""

    def __init__(self, canal: CanalSurface, view: View | None) -> None:
        """Begin with the directions for `view`; None: the correction axes of `canal`."""
        self._canal = canal
        self._lock = threading.Lock()
        self._number = 0
        self._asked: View | None = view
        self._directions = None if view is None else stick_directions(canal, view)
        self._worker = ThreadPoolExecutor(1, "mapping")

    def current(self) -> tuple[int, np.ndarray | None]:
        """A number that grows with each choice, and the directions (N, 2, 3), or None for the correction axes."""
        with self._lock:
            return self._number, self._directions

    def ask(self, view: View | None) -> None:
        """Choose the directions for a view; they hold once they are computed, a fifth of a second later."""
        with self._lock:
            self._asked = view
        self._worker.submit(self._compute, view)

    def choose(
        self,
        mapping: str,
        seat: str,
        right: tuple[float, float, float] | None = None,
        up: tuple[float, float, float] | None = None,
        *,
        follow: bool = False,
    ) -> None:
        """Choose as a page says it; `follow` is the gripper's own view, which turns along the canal.

        Args:
            mapping: axes, seat or view.
            seat: where the person sits.
            right: of the camera's picture, in B. Shape (3,).
            up: of the camera's picture, in B. Shape (3,).
            follow: whether the view is followed as it turns.
        """
        if follow and mapping == "view":
            self.ask(gripper_view(self._canal))
        else:
            self.ask(chosen_view(mapping, seat, right, up))

    def _compute(self, view: View | None) -> None:
        with self._lock:
            if view is not self._asked:  # another choice has been made since
                return
        directions = None if view is None else stick_directions(self._canal, view)
        with self._lock:
            if view is self._asked:
                self._number += 1
                self._directions = directions


def gripper_view(canal: CanalSurface) -> View:
    """What is right and up in the picture of the gripper's camera, on each disk of a canal."""
    R_BT = Rotation.from_quat(canal.orientations, scalar_first=True)
    return View(R_BT.apply(RIGHT_T), R_BT.apply(UP_T))


_R_TG = RotationMatrix(RollPitchYaw(0.0, -np.pi / 2, np.pi)).inverse()
_R_TC = _R_TG.multiply(X_GRIPPER_CAMERA.rotation())
RIGHT_T, UP_T = _R_TC.col(0), -_R_TC.col(1)
"""Right and up of that picture in the tool's frame T; the gripper stands as link 6 does, the tool as lio.urdf says."""


def chosen_view(mapping: str, seat: str, right: tuple | None = None, up: tuple | None = None) -> View | None:
    """The view that a mapping means.

    Args:
        mapping: `axes`, `seat` or `view`.
        seat: where the person sits.
        right: of the camera's picture, in the robot's base frame; for `view`.
        up: likewise.

    Returns:
        The view, or None for the correction axes, and where a camera tells nothing of use.
    """
    if mapping == "axes":
        return None
    if mapping == "seat" or right is None or up is None:
        return SEATS[seat]
    one, other = np.array(right), np.array(up)
    if not 0.1 < np.linalg.norm(one) < 10 or np.linalg.norm(np.cross(one, other)) < 0.1:
        return SEATS[seat]
    return view_from(one, other)
