"""The canal in Meshcat: drawn once, then only markers move."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from pydrake.geometry import Meshcat, Rgba, Sphere
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, EventStatus, LeafSystem, OutputPort

from canal.navigation import FIELD_NAMES, Leg, NavigationOptions, NavigationState, leg_end, strategy_ratio
from canal.surface import CanalSurface
from diagrams.view import canal_meshes as meshes
from diagrams.view.canal_drawing import CanalDrawing
from diagrams.view.canal_meshes import TriangleMesh
from diagrams.view.trail_view import TrailView

VIEW_PERIOD = 1 / 32
"""[s] Of the pictures, Drake's own MeshcatVisualizer's default."""

DISK = Rgba(1.0, 0.66, 0.10, 1.0)
DISK_FACE = Rgba(1.0, 0.72, 0.20, 0.28)
AXIS_X = Rgba(0.86, 0.12, 0.14, 1.0)
AXIS_Y = Rgba(0.10, 0.62, 0.22, 1.0)
POINT = Rgba(1.0, 0.35, 0.05, 1.0)
AHEAD = Rgba(1.0, 0.60, 0.05, 1.0)
"""Colours: what moves on the canal warm, the axes as everywhere red and green."""

BEAD_SPACING = 0.02
BEAD_RADIUS = 0.005
"""[m] Along the directrix between the beads of the path ahead, and of a bead."""

KEY_SIZE = 4
"""Numbers in the state by which it is told whether the picture changes."""


class CanalView(LeafSystem):
    """Draws a canal, where we are on it, and the path ahead, in Meshcat.

    ```
    navigation_state → CanalView
    ```

    At the start it publishes the surface, every k-th disk's ring, the directrix and the demonstrations. Then, at
    32 Hz, it moves markers only: the current disk, its correction axes x (red) and y (green), the point on it, and a
    string of beads for the path ahead, which is touched only where it changes. All of it lies in Meshcat under one
    path, at the robot's base. The discrete state is what the beads show. Recordings keep all of it.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        canal: CanalSurface,
        *,
        options: NavigationOptions | None = None,
        X_WB: RigidTransform | None = None,
        disk_colors: np.ndarray | None = None,
        path: str = "canal",
    ) -> None:
        """Draw `canal`.

        Args:
            meshcat: where to.
            canal: what.
            options: of the navigation, for the path ahead.
            X_WB: pose of the robot's base in the world; the identity by default.
            disk_colors: red, green and blue in [0, 1] for each disk, on the surface. Shape (N, 3).
            path: in Meshcat's tree.
        """
        super().__init__()
        self._meshcat = meshcat
        self._canal = canal
        self._options = options or NavigationOptions()
        self._X_WB = X_WB or RigidTransform()
        self._disk_colors = None if disk_colors is None else np.asarray(disk_colors, dtype=float)
        self._path = path
        self._drawing = CanalDrawing(meshcat, path)
        self._beads = np.interp(
            np.arange(BEAD_SPACING / 2, canal.length, BEAD_SPACING), canal.arc, np.arange(canal.n_disks)
        )
        self._state = self.DeclareVectorInputPort("navigation_state", len(FIELD_NAMES))
        self._key = self.DeclareDiscreteState(np.full(KEY_SIZE, np.nan))
        self._visible = self.DeclareDiscreteState(len(self._beads))
        self.DeclareInitializationDiscreteUpdateEvent(self._publish_canal)
        self.DeclarePeriodicDiscreteUpdateEvent(VIEW_PERIOD, 0.0, self._move_markers)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        meshcat: Meshcat,
        canal: CanalSurface,
        navigation_state: OutputPort,
        X_BT: OutputPort | None = None,
        options: NavigationOptions | None = None,
        X_WB: RigidTransform | None = None,
        disk_colors: np.ndarray | None = None,
        name: str = "canal_view",
    ) -> CanalView:
        """Add a view of `canal`, and with `X_BT` (7) one of the path travelled, to `builder`; connect them.

        Args:
            builder: of the diagram that it is added to.
            meshcat: that shows it.
            canal: in the robot's base frame.
            navigation_state: port of the navigator.
            X_BT: port with the measured pose of the tool; None: no trail.
            options: of navigation, for the path ahead.
            X_WB: where the robot's base stands; None: in the origin.
            disk_colors: of the surface. Shape (N, 3). None: one colour.
            name: of the system.
        """
        view = builder.AddNamedSystem(
            name, CanalView(meshcat, canal, options=options, X_WB=X_WB, disk_colors=disk_colors)
        )
        builder.Connect(navigation_state, view.GetInputPort("navigation_state"))
        if X_BT is not None:
            TrailView.AddToBuilder(
                builder=builder,
                meshcat=meshcat,
                X_BT=X_BT,
                navigation_state=navigation_state,
                X_WB=X_WB,
                name=f"{name}_trail",
            )
        return view

    def _publish_canal(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        canal, meshcat, path = self._canal, self._meshcat, self._path
        self._drawing.clear(self._X_WB)
        self._drawing.draw(canal, self._disk_colors)
        self._drawing.mesh("disk/size/ring", meshes.ring(0.04), DISK)
        self._drawing.mesh("disk/size/face", meshes.disc(), DISK_FACE, closed=False)
        self._drawing.mesh("x/size/arrow", meshes.arrow(), AXIS_X)
        self._drawing.mesh("y/size/arrow", meshes.arrow(), AXIS_Y)
        meshcat.SetObject(f"{path}/point", Sphere(0.013), POINT)
        self._drawing.set_apart("point", POINT)
        ball = meshes.bead()
        ball = TriangleMesh(BEAD_RADIUS * ball.vertices, ball.faces)
        for k in range(len(self._beads)):
            self._drawing.mesh(f"ahead/{k:03d}", ball, AHEAD)
            meshcat.SetProperty(self._bead(k), "visible", False, context.get_time())
        discrete.set_value(self._key, np.full(KEY_SIZE, np.nan))
        discrete.set_value(self._visible, np.zeros(len(self._beads)))
        return self._move_markers(context, discrete)  # what waits for somebody to begin is seen as it will be

    def _bead(self, k: int) -> str:
        return f"{self._path}/ahead/{k:03d}"

    def _move_markers(self, context: Context, discrete: DiscreteValues) -> EventStatus:
        vector = self._state.Eval(context)
        if not np.isfinite(vector).all():
            return EventStatus.DidNothing()
        state = NavigationState.from_vector(vector)
        self._move_disk(state, context.get_time())
        self._move_beads(state, context, discrete)
        return EventStatus.Succeeded()

    def _move_disk(self, state: NavigationState, time: float) -> None:
        canal, meshcat, path = self._canal, self._meshcat, self._path
        x, y = canal.axes(state.disk)
        center, radius = canal.center(state.disk), canal.radius(state.disk)
        a, b, angle = radius, radius, 0.0
        if canal.ellipses is not None:
            a, b, angle = canal.ellipses[round(state.disk)]
        along = math.cos(angle) * x + math.sin(angle) * y
        normal = np.cross(x, y)
        R_BD = RotationMatrix(np.column_stack([along, np.cross(normal, along), normal]))
        meshcat.SetTransform(f"{path}/disk", RigidTransform(R_BD, center), time)
        # A scale of its own node: a transform would reset it. Never 0, which has no normals to shade by.
        size = [max(a, 1e-3), max(b, 1e-3), max(0.5 * (a + b), 1e-3)]
        meshcat.SetProperty(f"{path}/disk/size", "scale", size, time)
        p = canal.point(state.disk, state.eta, state.phi)
        length = min(max(1.4 * radius, 0.08), 0.15)
        for name, axis, other in (("x", x, y), ("y", y, x)):
            R_BA = RotationMatrix(np.column_stack([np.cross(other, axis), other, axis]))
            meshcat.SetTransform(f"{path}/{name}", RigidTransform(R_BA, p), time)
            meshcat.SetProperty(f"{path}/{name}/size", "scale", [length] * 3, time)
        meshcat.SetTransform(f"{path}/point", RigidTransform(p), time)

    def _move_beads(self, state: NavigationState, context: Context, discrete: DiscreteValues) -> None:
        canal, meshcat, time = self._canal, self._meshcat, context.get_time()
        if state.correcting:  # released now, the path would go on from here
            state = replace(state, anchor_disk=state.disk, anchor_eta=state.eta)
        leg = Leg(int(state.leg))
        end = leg_end(canal, leg)
        ahead = (self._beads - state.disk) * leg.direction > 0
        visible = ahead & ((end - self._beads) * leg.direction >= 0)
        key = np.array([state.leg, state.anchor_disk, state.anchor_eta, state.phi])
        moved = not np.array_equal(key, context.get_discrete_state(self._key).value())
        shown = context.get_discrete_state(self._visible).value() > 0.5
        for k in np.flatnonzero(visible & (moved | ~shown)):
            disk = float(self._beads[k])
            p = canal.point(disk, strategy_ratio(canal, state, disk, self._options), state.phi)
            meshcat.SetTransform(self._bead(int(k)), RigidTransform(p), time)
        for k in np.flatnonzero(visible != shown):
            meshcat.SetProperty(self._bead(int(k)), "visible", bool(visible[k]), time)
        discrete.set_value(self._key, key)
        discrete.set_value(self._visible, visible.astype(float))
