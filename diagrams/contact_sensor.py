"""Contact forces by pair, and how deep anything lies in the surroundings."""

from __future__ import annotations

import numpy as np
from pydrake.common.value import Value
from pydrake.geometry import GeometryId, QueryObject, SceneGraph
from pydrake.multibody.plant import ContactResults, MultibodyPlant
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from diagrams.contacts import each_contact
from diagrams.scene import Scene
from diagrams.soft_depth import FixedBoxes


class ContactSensor(LeafSystem):
    """Watches the robot against each thing of the surroundings.

    ```
     contact_results → ┌───────────────┐ → contact_forces (pairs) [N]
                       │ ContactSensor │
      geometry_query → └───────────────┘ → penetration (1) [m]
    ```

    A pair's force is the sum of the magnitudes of its contacts, so that a squeeze counts too. `penetration` is the
    deepest overlap of any rigid shape, or of any node of cloth, with the surroundings.
    """

    def __init__(self, plant: MultibodyPlant, scene_graph: SceneGraph, scene: Scene) -> None:
        """Watch the scene; names of the pairs are then in `contact_pairs`."""
        super().__init__()
        self.contact_pairs = [f"lio-{name}" for name in scene.things]
        self._lio = {int(b) for b in plant.GetBodyIndices(scene.lio)}
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
        self.DeclareVectorOutputPort(
            "contact_forces", len(self.contact_pairs), self._calc_forces, {self._results.ticket()}
        )
        self.DeclareVectorOutputPort("penetration", 1, self._calc_penetration, {self._query.ticket()})

    def _pair(self, a: int, b: int) -> int | None:
        if a in self._lio:
            return self._thing_of_body.get(b)
        return self._thing_of_body.get(a) if b in self._lio else None

    def _calc_forces(self, context: Context, output: BasicVector) -> None:
        forces = np.zeros(len(self.contact_pairs))
        for a, b, force in each_contact(self._results.Eval(context)):
            pair = self._pair(self._body[a], self._body[b])
            if pair is not None:
                forces[pair] += np.linalg.norm(force)
        output.SetFromVector(forces)

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
