"""Contact forces by pair, and how deep anything lies in the surroundings."""

from __future__ import annotations

import weakref

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.geometry import GeometryId, QueryObject, SceneGraph
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem, ValueProducer

from diagrams.deformable.items import DeformableItem
from diagrams.geometry.box_depth import FixedBoxes
from diagrams.geometry.contacts import each_contact, is_contact
from diagrams.scene.scene import RigidItem, Scene
from models import TCP_FRAME

FINGERS = ("lio_finger_left", "lio_finger_right")
HAND = ("lio_link_5", "lio_link_6", "lio_gripper", "lio_finger_left", "lio_finger_right", TCP_FRAME)
"""What moves with the tool: all beyond joint 5, the last one that bends."""


class ContactSensor(LeafSystem):
    """Watches the robot against each fixture.

    ```
                       ┌───────────────┐ → contact_forces (pairs) [N]
     contact_results → │               │ → hand_force (3) [N]
                       │ ContactSensor │ → touching_bodies (pairs)
      geometry_query → │               │ → grip_forces (n) [N]
                       └───────────────┘ → penetration (1) [m]
    ```

    A pair's force is the sum of the magnitudes of its contacts, so that a squeeze counts too. `hand_force` is the net
    force of the surroundings on what moves with the tool (`HAND`), in the base frame B. `touching_bodies` tells which
    of `robot_bodies` bears most of a pair's force. `grip_forces` are those between the fingers and each item, in the
    scenario's order: 0 where they do not touch it. `penetration` is the deepest overlap of any rigid shape, or of any
    node of cloth, with the surroundings.
    """

    def __init__(self, plant: MultibodyPlant, scene_graph: SceneGraph, scene: Scene) -> None:
        """Watch the scene; names of the pairs are then in `contact_pairs`, of the robot's bodies in `robot_bodies`."""
        super().__init__()
        self.contact_pairs = [f"lio-{name}" for name in scene.fixtures]
        bodies = plant.GetBodyIndices(scene.lio)
        self._lio = {int(b): k for k, b in enumerate(bodies)}
        self.robot_bodies = [plant.get_body(b).name() for b in bodies]
        self._hand = {int(b) for b in bodies if plant.get_body(b).name() in HAND}
        self._fingers = {int(b) for b in bodies if plant.get_body(b).name() in FINGERS}
        self._R_BW = scene.X_WB.rotation().inverse()
        self._fixture_of_body: dict[int, int] = {}
        for k, models in enumerate(scene.fixtures.values()):
            for model in models:
                self._fixture_of_body.update({int(b): k for b in plant.GetBodyIndices(model)})
        inspector = scene_graph.model_inspector()
        self._body: dict[GeometryId, int] = {
            g: int(plant.GetBodyFromFrameId(inspector.GetFrameId(g)).index()) for g in inspector.GetAllGeometryIds()
        }
        # Not by the plant's `GetCollisionGeometriesForBody`: the ids that it gives keep the plant, and with it this.
        item_of_body = {int(item.index): k for k, item in enumerate(scene.items) if isinstance(item, RigidItem)}
        self._item_of = {g: item_of_body[body] for g, body in self._body.items() if body in item_of_body}
        self._item_of |= {item.geometry_id: k for k, item in enumerate(scene.items) if isinstance(item, DeformableItem)}
        self._deformable = scene.deformable_items
        self._boxes = FixedBoxes(plant, inspector, [model for models in scene.fixtures.values() for model in models])
        self._results = self.DeclareAbstractInputPort("contact_results", Value[ContactResults]())
        self._query = self.DeclareAbstractInputPort("geometry_query", Value[QueryObject]())
        pairs, n, contacts = len(self.contact_pairs), len(scene.items), {self._results.ticket()}
        self._nothing = np.zeros(2 * pairs + 3 + n)
        # Looked through once for all four. Weakly: a producer is kept for ever, and with it whom it calls.
        this = weakref.ref(self)

        def calc(context: Context, touches: AbstractValue) -> None:
            sensor = this()
            if sensor is not None:
                sensor._calc_touches(context, touches)

        entry = self.DeclareCacheEntry(
            "touches",
            ValueProducer(allocate=lambda: AbstractValue.Make(np.zeros(2 * pairs + 3 + n)), calc=calc),
            contacts,
        )
        # By its index: the entry itself would keep this system, which keeps it.
        self._touches = entry.cache_index()
        touches = {entry.ticket()}
        # Methods, not lambdas: Drake keeps a lambda for ever, and with it whom it names.
        self.DeclareVectorOutputPort("contact_forces", pairs, self._calc_forces, touches)
        self.DeclareVectorOutputPort("touching_bodies", pairs, self._calc_bodies, touches)
        self.DeclareVectorOutputPort("hand_force", 3, self._calc_hand, touches)
        self.DeclareVectorOutputPort("grip_forces", n, self._calc_grips, touches)
        self.DeclareVectorOutputPort("penetration", 1, self._calc_penetration, {self._query.ticket()})

    def _calc_touches(self, context: Context, touches: AbstractValue) -> None:
        results = self._results.Eval(context)
        if not is_contact(results):
            touches.set_value(self._nothing)
            return
        pairs = len(self.contact_pairs)
        values = self._nothing.copy()
        hand, grips = values[2 * pairs : 2 * pairs + 3], values[2 * pairs + 3 :]
        of_bodies: dict[int, np.ndarray] = {}
        for a, b, force in each_contact(results, self._concerns):
            body, other = self._body[a], self._body[b]
            item = self._item_of.get(b, self._item_of.get(a))
            if item is not None:
                grips[item] += np.linalg.norm(force)
                continue
            pair = self._fixture_of_body[other if body in self._lio else body]
            if body not in self._lio:
                body, force = other, -force
            of_bodies.setdefault(pair, np.zeros(len(self.robot_bodies)))[self._lio[body]] += np.linalg.norm(force)
            if body in self._hand:
                hand += force
        for pair, forces in of_bodies.items():
            values[pair], values[pairs + pair] = forces.sum(), forces.argmax()
        hand[:] = self._R_BW.multiply(hand)
        touches.set_value(values)

    def _concerns(self, a: GeometryId, b: GeometryId) -> bool:
        """Whether it matters that these two touch: robot and surroundings, or finger and item."""
        body, other = self._body[a], self._body[b]
        if a in self._item_of:
            return other in self._fingers
        if b in self._item_of:
            return body in self._fingers
        return (body in self._lio and other in self._fixture_of_body) or (
            other in self._lio and body in self._fixture_of_body
        )

    def _part(self, context: Context, begin: int, end: int) -> np.ndarray:
        return self.get_cache_entry(self._touches).Eval(context)[begin:end]

    def _calc_forces(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._part(context, 0, len(self.contact_pairs)))

    def _calc_bodies(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._part(context, len(self.contact_pairs), 2 * len(self.contact_pairs)))

    def _calc_hand(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._part(context, 2 * len(self.contact_pairs), 2 * len(self.contact_pairs) + 3))

    def _calc_grips(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._part(context, 2 * len(self.contact_pairs) + 3, len(self._nothing)))

    def _calc_penetration(self, context: Context, output: BasicVector) -> None:
        query = self._query.Eval(context)
        overlaps = query.ComputePointPairPenetration()
        depths = [
            o.depth
            for o in overlaps
            if self._body[o.id_A] in self._fixture_of_body or self._body[o.id_B] in self._fixture_of_body
        ]
        for item in self._deformable:
            depths.append(self._boxes.depth(query.GetConfigurationsInWorld(item.geometry_id).reshape(-1, 3)))
        output.SetAtIndex(0, max(depths, default=0.0))
