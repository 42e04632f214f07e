"""The path that the tool has travelled, in Meshcat."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import Meshcat, Rgba
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, EventStatus, LeafSystem, OutputPort

from canal.navigation import FIELD_NAMES
from diagrams.view.canal_meshes import tube

TRAVELLED = Rgba(0.10, 0.55, 0.25, 1.0)
CORRECTED = Rgba(0.15, 0.30, 0.95, 1.0)
"""Colours as in the paper's Fig. 6: the path green, corrections blue."""

CORRECTING = FIELD_NAMES.index("correcting")

STEP = 0.005
"""[m] Between the points that are kept."""
JUMP = 0.1
"""[m] From point to point: no arm moves so fast; a new segment begins there, not joined to the last."""
POINTS = 24
"""In a segment of the trail; only the newest segment is ever sent again."""
SEGMENTS = 32
"""That are seen (at most 3.7 m); the next one hides the oldest."""
PATHS = 1000
"""Segments that the page keeps, seen or hidden; in a recording these many have their time."""
RADIUS = 0.0035
"""[m] Of the trail."""


class TrailView(LeafSystem):
    """Draws the path travelled by the tool centre point, in segments; those under a correction in another colour.

    ```
                X_BT (7) →
        navigation_state → TrailView
    ```

    The discrete state is the newest segment: how many segments were begun, how many points it has, whether it is a
    correction, and the points. `navigation_state` may be left unconnected.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        *,
        X_WB: RigidTransform | None = None,
        path: str = "trail",
        period: float = 1 / 16,
    ) -> None:
        """Draw under `path`, in the base frame at `X_WB` (the identity by default), every `period` seconds."""
        super().__init__()
        self._meshcat = meshcat
        self._X_WB = X_WB or RigidTransform()
        self._path = path
        self._X_BT = self.DeclareVectorInputPort("X_BT", 7)
        self._state = self.DeclareVectorInputPort("navigation_state", len(FIELD_NAMES))
        self._segment = self.DeclareDiscreteState(3 + 3 * POINTS)
        self.DeclareInitializationDiscreteUpdateEvent(self._clear)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._append)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        meshcat: Meshcat,
        X_BT: OutputPort,
        navigation_state: OutputPort | None = None,
        X_WB: RigidTransform | None = None,
        name: str = "trail_view",
    ) -> TrailView:
        """Add a view of the path travelled to `builder` and connect it.

        Args:
            builder: of the diagram that it is added to.
            meshcat: that shows it.
            X_BT: port with the measured pose of the tool.
            navigation_state: port of the navigator; None: corrections look like the rest.
            X_WB: where the robot's base stands; None: in the origin.
            name: of the system.
        """
        view = builder.AddNamedSystem(name, TrailView(meshcat, X_WB=X_WB))
        builder.Connect(X_BT, view.GetInputPort("X_BT"))
        if navigation_state is not None:
            builder.Connect(navigation_state, view.GetInputPort("navigation_state"))
        return view

    def _clear(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        self._meshcat.Delete(self._path)
        self._meshcat.SetTransform(self._path, self._X_WB)
        discrete.set_value(self._segment, np.zeros(3 + 3 * POINTS))
        return EventStatus.Succeeded()

    def _append(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        segment = context.get_discrete_state(self._segment).value().copy()
        begun, count, correction = int(segment[0]), int(segment[1]), segment[2]
        points = segment[3:].reshape(POINTS, 3)
        p = self._X_BT.Eval(context)[:3]
        correcting = float(self._state.HasValue(context) and self._state.Eval(context)[CORRECTING] > 0.5)
        way = np.linalg.norm(p - points[count - 1]) if count > 0 else np.inf
        if not np.isfinite(p).all() or way < STEP:
            return EventStatus.DidNothing()
        if way > JUMP:
            begun, count = begun + 1, 0
        elif count == POINTS or (correcting != correction and count > 1):
            points[0] = points[count - 1]
            begun, count = begun + 1, 1
        points[count] = p
        count += 1
        if count > 1:
            self._draw(begun, points[:count], CORRECTED if correcting else TRAVELLED, context.get_time())
        segment[:3] = begun, count, correcting
        discrete.set_value(self._segment, segment)
        return EventStatus.Succeeded()

    def _draw(self, begun: int, points: np.ndarray, rgba: Rgba, time: float) -> None:
        path = self._segment_path(begun)
        mesh = tube(points, RADIUS)
        self._meshcat.SetTriangleMesh(path, mesh.vertices, mesh.faces, rgba, side=Meshcat.SideOfFaceToRender.kFrontSide)
        self._meshcat.SetProperty(f"{path}/<object>", "castShadow", False)
        if len(points) == 2:
            # A recording knows a path's last mesh from its first frame on: show it from when it was begun.
            self._meshcat.SetProperty(path, "visible", False, 0.0)
            self._meshcat.SetProperty(path, "visible", True, time)
            if begun > SEGMENTS:
                self._meshcat.SetProperty(self._segment_path(begun - SEGMENTS), "visible", False, time)

    def _segment_path(self, begun: int) -> str:
        return f"{self._path}/{begun % PATHS:03d}"
