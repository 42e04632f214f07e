"""Draws deformable items in Drake's Meshcat as the fine surfaces embedded in their tetrahedra.

Meshcat can animate transforms and visibility, not vertices. In a recording an item therefore moves as a rigid surface
while that fits, as it does where it hangs in the hand; when it has bent, a new surface takes its place: an object of
its own that is visible from its time to the next one's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import Meshcat, QueryObject
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, EventStatus, LeafSystem, State
from scipy.spatial.transform import Rotation

from diagrams.deformable.items import DeformableItem

VIEW_PERIOD = 1.0 / 30.0  # [s]
RECORD_PERIOD = 0.1  # [s]; a recording keeps every surface, some 40 kB each
_SEEN = 5e-4  # [m]: an item none of whose nodes moved farther is not drawn again
_BENT = 2e-3  # [m]: in a recording, one that fits its surface as well as this moves as a rigid body


@dataclass(frozen=True)
class _Drawn:
    """What is drawn of an item: a surface of `frame`, and since `moved`, a later frame, in pose X."""

    nodes: np.ndarray
    """When the surface was made [m], shape (N, 3)."""
    frame: int
    moved: int
    X: RigidTransform


class DeformableView(LeafSystem):
    """Publishes the surfaces of deformable items.

    ::

                        ┌────────────────┐
        query_object →  │ DeformableView │ → Meshcat, under `path`/<name>
                        └────────────────┘

    State, three groups an item, what `_Drawn` has: nodes, flat; the two frames; the pose as a 3 x 4 matrix, flat.
    """

    def __init__(
        self, *, items: Sequence[DeformableItem], meshcat: Meshcat, recording: bool = False, path: str = "deformable"
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
            frames = self.DeclareDiscreteState(np.array([-1.0, -1.0]))
            pose = self.DeclareDiscreteState(RigidTransform().GetAsMatrix34().ravel())
            self._drawn.append((nodes, frames, pose))
        self.DeclareInitializationPublishEvent(self._publish)
        self.DeclarePeriodicUnrestrictedUpdateEvent(self._period, 0.0, self._update)
        self.DeclarePeriodicPublishEvent(self._period, 0.0, self._publish)

    def _before(self, context: Context, i: int) -> _Drawn:
        nodes, frames, pose = (context.get_discrete_state(index).value() for index in self._drawn[i])
        X = pose.reshape(3, 4)
        return _Drawn(
            nodes.reshape(-1, 3), int(frames[0]), int(frames[1]), RigidTransform(RotationMatrix(X[:, :3]), X[:, 3])
        )

    def _changes(self, context: Context) -> list[tuple[int, _Drawn, _Drawn]]:
        """Number of each item that moved, what is drawn of it, and what is to be.

        Publish and update find the same: Drake publishes at t before it updates at t, and where there is cloth the
        plant's step is an unrestricted update, so that only another of these sees the plant as it was before it.
        """
        query, now = self.GetInputPort("query_object").Eval(context), round(context.get_time() / self._period)
        changes = []
        for i, item in enumerate(self._items):
            nodes = np.asarray(query.GetConfigurationsInWorld(item.geometry_id)).reshape(-1, 3)
            before = self._before(context, i)
            after = _Drawn(nodes, now, now, RigidTransform())
            if before.frame >= 0:
                if self._recording:
                    X = _rigid_fit(before.nodes, nodes)
                    if _apart(X, before.nodes, nodes) < _BENT:
                        after = _Drawn(before.nodes, before.frame, now, X)
                if _apart(before.X, before.nodes, after.X.multiply(after.nodes.T).T) < _SEEN:
                    continue
            changes.append((i, before, after))
        return changes

    def _update(self, context: Context, state: State) -> EventStatus:
        for i, _, after in self._changes(context):
            nodes, frames, pose = (state.get_mutable_discrete_state(index) for index in self._drawn[i])
            nodes.SetFromVector(after.nodes.ravel())
            frames.SetFromVector(np.array([after.frame, after.moved], dtype=float))
            pose.SetFromVector(after.X.GetAsMatrix34().ravel())
        return EventStatus.Succeeded()

    def _publish(self, context: Context) -> EventStatus:
        for i, before, after in self._changes(context):
            base = f"{self._path}/{self._items[i].name}"
            path = f"{base}/{after.frame}" if self._recording else base
            if after.frame != before.frame:
                surface = self._items[i].shape.surface
                self._meshcat.SetTriangleColorMesh(
                    path=path,
                    vertices=surface.positions(after.nodes).T,
                    faces=surface.triangles.T.astype(np.int32),
                    colors=surface.colors.T,
                )
            if self._recording:
                self._record(base, before, after, context.get_time())
        return EventStatus.Succeeded()

    def _record(self, base: str, before: _Drawn, after: _Drawn, time: float) -> None:
        """Keep one step of an item: as keys of the animation, between which Meshcat draws straight lines."""
        path = f"{base}/{after.frame}"
        if after.frame == before.frame:
            if after.moved > before.moved + 1:  # it stood still until one frame ago
                self._meshcat.SetTransform(path, before.X, (after.moved - 1) * self._period)
        else:
            if before.frame >= 0:
                self._meshcat.SetProperty(f"{base}/{before.frame}", "visible", False, time)
            if after.frame > 0:
                self._meshcat.SetProperty(path, "visible", False, 0.0)
            self._meshcat.SetProperty(path, "visible", True, time)
        self._meshcat.SetTransform(path, after.X, time)


def _rigid_fit(before: np.ndarray, after: np.ndarray) -> RigidTransform:
    """The pose that carries points (n, 3) nearest to others, in the sense of least squares (Kabsch)."""
    middle_before, middle_after = before.mean(axis=0), after.mean(axis=0)
    R = RotationMatrix(Rotation.align_vectors(after - middle_after, before - middle_before)[0].as_matrix())
    return RigidTransform(R, middle_after - R.multiply(middle_before))


def _apart(X: RigidTransform, before: np.ndarray, after: np.ndarray) -> float:
    """Greatest difference of a coordinate between points that X carries and others [m]."""
    return float(np.abs(X.multiply(before.T).T - after).max())
