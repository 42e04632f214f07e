"""Contact forces by pair, and how deep anything lies in the surroundings."""

from __future__ import annotations

import weakref

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.geometry import GeometryId, QueryObject, SceneGraph
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem, ValueProducer

from diagrams.contacts import each_contact
from diagrams.scene import Scene
from diagrams.soft_depth import FixedBoxes

HAND = ("lio_link_5", "lio_link_6", "lio_gripper", "lio_finger_left", "lio_finger_right", "tcp")
"""What moves with the tool: all beyond joint 5, the last one that bends."""


class ContactSensor(LeafSystem):
    """Watches the robot against each thing of the surroundings.

    ```
                       ┌───────────────┐ → contact_forces (pairs) [N]
     contact_results → │ ContactSensor │ → hand_force (3) [N]
      geometry_query → │               │ → touching_bodies (pairs)
                       └───────────────┘ → penetration (1) [m]
    ```

    A pair's force is the sum of the magnitudes of its contacts, so that a squeeze counts too. `hand_force` is the net
    force of the surroundings on what moves with the tool (`HAND`), in the base frame B. `touching_bodies` tells which
    of `robot_bodies` bears most of a pair's force. `penetration` is the deepest overlap of any rigid shape, or of any
    node of cloth, with the surroundings.
    """

    def __init__(self, plant: MultibodyPlant, scene_graph: SceneGraph, scene: Scene) -> None:
        """Watch the scene; names of the pairs are then in `contact_pairs`, of the robot's bodies in `robot_bodies`."""
        super().__init__()
        self.contact_pairs = [f"lio-{name}" for name in scene.things]
        bodies = plant.GetBodyIndices(scene.lio)
        self._lio = {int(b): k for k, b in enumerate(bodies)}
        self.robot_bodies = [plant.get_body(b).name() for b in bodies]
        self._hand = {int(b) for b in bodies if plant.get_body(b).name() in HAND}
        self._R_BW = scene.X_WB.rotation().inverse()
        self._thing_of_body: dict[int, int] = {}
        for k, models in enumerate(scene.things.values()):
            for model in models:
                self._thing_of_body.update({int(b): k for b in plant.GetBodyIndices(model)})
        inspector = scene_graph.model_inspector()
        self._body: dict[GeometryId, int] = {
            g: int(plant.GetBodyFromFrameId(inspector.GetFrameId(g)).index()) for g in inspector.GetAllGeometryIds()
        }
        self._soft = scene.soft_items
        self._boxes = FixedBoxes(plant, inspector, [model for models in scene.things.values() for model in models])
        self._results = self.DeclareAbstractInputPort("contact_results", Value[ContactResults]())
        self._query = self.DeclareAbstractInputPort("geometry_query", Value[QueryObject]())
        pairs, contacts = len(self.contact_pairs), {self._results.ticket()}
        # Looked through once for all three. Weakly: a producer is kept for ever, and with it whom it calls.
        this = weakref.ref(self)

        def calc(context: Context, touches: AbstractValue) -> None:
            sensor = this()
            if sensor is not None:
                sensor._calc_touches(context, touches)

        entry = self.DeclareCacheEntry(
            "touches",
            ValueProducer(allocate=lambda: AbstractValue.Make(np.zeros(2 * pairs + 3)), calc=calc),
            contacts,
        )
        # By its index: the entry itself would keep this system, which keeps it.
        self._touches = entry.cache_index()
        touches = {entry.ticket()}
        # Methods, not lambdas: Drake keeps a lambda for ever, and with it whom it names.
        self.DeclareVectorOutputPort("contact_forces", pairs, self._calc_forces, touches)
        self.DeclareVectorOutputPort("touching_bodies", pairs, self._calc_bodies, touches)
        self.DeclareVectorOutputPort("hand_force", 3, self._calc_hand, touches)
        self.DeclareVectorOutputPort("penetration", 1, self._calc_penetration, {self._query.ticket()})

    def _pair(self, a: int, b: int) -> int | None:
        if a in self._lio:
            return self._thing_of_body.get(b)
        return self._thing_of_body.get(a) if b in self._lio else None

    def _calc_touches(self, context: Context, touches: AbstractValue) -> None:
        pairs = len(self.contact_pairs)
        of_bodies = np.zeros((pairs, len(self.robot_bodies)))
        hand = np.zeros(3)
        for a, b, force in each_contact(self._results.Eval(context)):
            body, other = self._body[a], self._body[b]
            pair = self._pair(body, other)
            if pair is None:
                continue
            if body not in self._lio:
                body, force = other, -force
            of_bodies[pair, self._lio[body]] += np.linalg.norm(force)
            if body in self._hand:
                hand += force
        touches.set_value(np.concatenate([of_bodies.sum(axis=1), of_bodies.argmax(axis=1), self._R_BW.multiply(hand)]))

    def _calc_forces(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self.get_cache_entry(self._touches).Eval(context)[: len(self.contact_pairs)])

    def _calc_bodies(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self.get_cache_entry(self._touches).Eval(context)[len(self.contact_pairs) : -3])

    def _calc_hand(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self.get_cache_entry(self._touches).Eval(context)[-3:])

    def _calc_penetration(self, context: Context, output: BasicVector) -> None:
        query = self._query.Eval(context)
        overlaps = query.ComputePointPairPenetration()
        depths = [
            o.depth
            for o in overlaps
            if self._body[o.id_A] in self._thing_of_body or self._body[o.id_B] in self._thing_of_body
        ]
        for item in self._soft:
            depths.append(self._boxes.depth(query.GetConfigurationsInWorld(item.geometry_id).reshape(-1, 3)))
        output.SetAtIndex(0, max(depths, default=0.0))
