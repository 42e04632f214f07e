"""Draws soft pieces in Drake's Meshcat as the fine surfaces embedded in their tetrahedra.

Meshcat can animate transforms and visibility, not vertices: for a recording each frame of a moving piece becomes an
object of its own that is visible from its time to the next frame's.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Meshcat, QueryObject, SceneGraph
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, EventStatus, LeafSystem

from diagrams.soft_items import SoftItem

VIEW_PERIOD = 1.0 / 30.0  # [s]
RECORD_PERIOD = 0.1  # [s]; a recording keeps every frame, some 40 kB each
_SEEN = 5e-4  # [m]: a piece none of whose nodes moved farther is not sent again
_SEEN_IN_RECORDING = 2e-3  # [m]


class SoftView(LeafSystem):
    """Publishes the surfaces of soft pieces.

    ::

                        ┌──────────┐
        query_object →  │ SoftView │ → Meshcat, under `path`/<name>
                        └──────────┘

    State, two groups a piece: the node positions last drawn in [m], flat, and the number of that frame.
    """

    def __init__(
        self, *, items: Sequence[SoftItem], meshcat: Meshcat, recording: bool = False, path: str = "soft"
    ) -> None:
        super().__init__()
        self._items = tuple(items)
        self._meshcat = meshcat
        self._recording = recording
        self._path = path
        self._period = RECORD_PERIOD if recording else VIEW_PERIOD
        self.DeclareAbstractInputPort("query_object", Value(QueryObject()))
        self._drawn = []
        for item in self._items:
            nodes = self.DeclareDiscreteState(np.full(item.shape.mesh.vertices.size, np.inf))
            frame = self.DeclareDiscreteState(np.array([-1.0]))
            self._drawn.append((nodes, frame))
        self.DeclareInitializationPublishEvent(self._publish)
        self.DeclarePeriodicDiscreteUpdateEvent(self._period, 0.0, self._update)
        self.DeclarePeriodicPublishEvent(self._period, 0.0, self._publish)

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        scene_graph: SceneGraph,
        items: Sequence[SoftItem],
        meshcat: Meshcat,
        recording: bool = False,
        path: str = "soft",
    ) -> SoftView:
        """Add a view of `items`, connected to the scene graph's query port."""
        view = builder.AddNamedSystem(
            "soft_view", SoftView(items=items, meshcat=meshcat, recording=recording, path=path)
        )
        builder.Connect(scene_graph.get_query_output_port(), view.GetInputPort("query_object"))
        return view

    def _moved(self, context: Context) -> list[tuple[int, np.ndarray]]:
        """Number and nodes (N, 3) of each piece that moved since it was last drawn.

        Drake publishes at t before it updates at t, so publish and update find the same pieces.
        """
        query = self.GetInputPort("query_object").Eval(context)
        threshold = _SEEN_IN_RECORDING if self._recording else _SEEN
        moved = []
        for i, item in enumerate(self._items):
            nodes = np.asarray(query.GetConfigurationsInWorld(item.geometry_id))
            before = context.get_discrete_state(self._drawn[i][0]).value()
            if np.abs(nodes - before).max() >= threshold:
                moved.append((i, nodes.reshape(-1, 3)))
        return moved

    def _frame(self, context: Context) -> int:
        return round(context.get_time() / self._period)

    def _update(self, context: Context, discrete_state: DiscreteValues) -> EventStatus:
        for i, nodes in self._moved(context):
            nodes_index, frame_index = self._drawn[i]
            discrete_state.set_value(nodes_index, nodes.ravel())
            discrete_state.set_value(frame_index, np.array([float(self._frame(context))]))
        return EventStatus.Succeeded()

    def _publish(self, context: Context) -> EventStatus:
        now = self._frame(context)
        for i, nodes in self._moved(context):
            item, before = self._items[i], int(context.get_discrete_state(self._drawn[i][1]).value()[0])
            surface = item.shape.surface
            base = f"{self._path}/{item.name}"
            path = f"{base}/{now}" if self._recording else base
            self._meshcat.SetTriangleColorMesh(
                path=path,
                vertices=surface.positions(nodes).T,
                faces=surface.triangles.T.astype(np.int32),
                colors=surface.colors.T,
            )
            if self._recording:
                if before not in (-1, now):
                    self._meshcat.SetProperty(f"{base}/{before}", "visible", False, context.get_time())
                if now > 0:
                    self._meshcat.SetProperty(path, "visible", False, 0.0)
                self._meshcat.SetProperty(path, "visible", True, context.get_time())
        return EventStatus.Succeeded()
