"""Distances of the arm to itself and to what is solid around it, with their Jacobian in the joints."""

import math

import numpy as np
from pydrake.geometry import CollisionFilterDeclaration, GeometryId, GeometrySet, QueryObject, Role, SceneGraph
from pydrake.multibody.tree import JointIndex, ModelInstanceIndex, RigidBody
from pydrake.systems.framework import Context, Diagram

from canal.errors import InputError
from diagrams.ik.kinematics import ArmKinematics
from diagrams.ik.options import CollisionAvoidanceOptions

# Price of a metre of missing clearance [cost] / [m]: a start inside an obstacle has a way out, and wherever the margin
# can be kept it is.
SLACK_PRICE = 1e4
"""[cost] / [m] of missing clearance."""
# Kept beyond the margin [m], so that what the linearisation leaves over stays on the safe side.
_PAD = 2e-6
# Rows are formed for pairs within this of the margin [m]; the step is checked against all.
_NEAR = 0.01
_KEPT = 4
_AT_MARGIN = 1e-5  # [m], nearer than this beyond the margin counts as at it
_POSTURES = 40  # random ones, to tell pairs that can part from pairs that never do


class CollisionDistance:
    """Signed distances d(q) of watched pairs, and n rows ∂d/∂q, at the posture that the kinematics was set to.

    Pairs: every collision geometry that the arm's joints move, against every solid one that they do not, and against
    those that they move on other bodies. Pairs that never come apart by the margin (neighbouring links) are left out
    by construction, so that no query sees them.

    Attributes:
        options: as given.
        pairs: how many are watched.
    """

    def __init__(
        self, kinematics: ArmKinematics, diagram: Diagram, root_context: Context, options: CollisionAvoidanceOptions
    ) -> None:
        self.options = options
        self._kinematics = kinematics
        plant = kinematics.plant
        (scene_graph,) = (system for system in diagram.GetSystems() if isinstance(system, SceneGraph))
        self._port = plant.get_geometry_query_input_port()
        self._inspector = scene_graph.model_inspector()
        self._root_context = root_context
        manager = scene_graph.collision_filter_manager(scene_graph.GetMyMutableContextFromRoot(root_context))
        joints = [plant.GetJointByName(name).index() for name in kinematics.joint_names]
        moving = _moving_bodies(kinematics, joints)
        solid = _solid_bodies(kinematics, moving, options.solid_bodies)
        owners = {g: body for body in (*moving, *solid) for g in plant.GetCollisionGeometriesForBody(body)}
        moved = [g for body in moving for g in plant.GetCollisionGeometriesForBody(body)]
        still = [g for body in solid for g in plant.GetCollisionGeometriesForBody(body)]
        candidates = [(a, b) for a in moved for b in still]
        candidates += [
            (a, b) for i, a in enumerate(moved) for b in moved[i + 1 :] if owners[a].index() != owners[b].index()
        ]
        everything = GeometrySet(list(self._inspector.GetAllGeometryIds(Role.kProximity)))
        manager.Apply(CollisionFilterDeclaration().ExcludeWithin(everything))
        watched = self._can_part(candidates)
        declaration = CollisionFilterDeclaration()
        for a, b in watched:
            declaration.AllowBetween(GeometrySet([a]), GeometrySet([b]))
        manager.Apply(declaration)
        self.pairs = len(watched)
        # By pair: +1 for the joints that move its first geometry, -1 for those that move its second.
        moved_by = {g: np.zeros(kinematics.n) for g in owners}
        for column, joint in enumerate(joints):
            affected = set(plant.GetBodiesKinematicallyAffectedBy([joint]))
            for g, body in owners.items():
                moved_by[g][column] = body.index() in affected
        self._moved = {}
        for a, b in watched:
            self._moved[a, b], self._moved[b, a] = moved_by[a] - moved_by[b], moved_by[b] - moved_by[a]

    def _query(self):
        return self._port.Eval(self._kinematics.context)

    def _can_part(self, candidates: list[tuple[GeometryId, GeometryId]]) -> list[tuple[GeometryId, GeometryId]]:
        """Those that are further apart than the margin in one of many random postures at least."""
        rng = np.random.default_rng(0)
        arm = self._kinematics
        low, high = np.maximum(arm.q_min, -np.pi), np.minimum(arm.q_max, np.pi)
        left, parted = list(candidates), set()
        for q in rng.uniform(low, high, size=(_POSTURES, arm.n)):
            arm.set(q)
            query = self._query()
            for pair in left:
                if query.ComputeSignedDistancePairClosestPoints(*pair).distance > self.options.margin:
                    parted.add(pair)
            left = [pair for pair in left if pair not in parted]
            if not left:
                break
        return [pair for pair in candidates if pair in parted]

    def near(self, reach: float) -> "NearPairs":
        """Pairs nearer than margin + reach [m], at the posture that was set."""
        query = self._query()
        return NearPairs(query, query.ComputeSignedDistancePairwiseClosestPoints(self.options.margin + reach))

    def at_margin(self, distance: float) -> bool:
        """Whether a least distance [m] is (nearly) the margin, or below."""
        return distance < self.options.margin + _AT_MARGIN

    def jacobian(self, near: "NearPairs") -> np.ndarray:
        """∂d/∂q of near pairs (k, n) [m/rad]; the posture must still be set.

        Both closest points lie on the line along the normal n, so a joint with axis ω and velocity v of the tool at
        p_T changes the distance by ± (n · v + (p - p_T) × n · ω), with either point as p, if it moves one of them.
        """
        if not near.pairs:
            return np.empty((0, self._kinematics.n))
        omega, v, (tx, ty, tz) = self._kinematics.world_axes()
        screws, moved = [], []
        for pair in near.pairs:
            nx, ny, nz = pair.nhat_BA_W.tolist()
            pose = near.query.GetPoseInWorld(pair.id_A).GetAsMatrix34()
            x, y, z = (pose[:, :3].dot(pair.p_ACa) + pose[:, 3]).tolist()
            x, y, z = x - tx, y - ty, z - tz
            screws.append((nx, ny, nz, y * nz - z * ny, z * nx - x * nz, x * ny - y * nx))
            moved.append(self._moved[pair.id_A, pair.id_B])
        return np.array(moved) * np.array(screws).dot(np.vstack((v, omega)))


class NearPairs:
    """The answer to one distance query: pairs, and distances (k,) [m]."""

    __slots__ = ("distances", "pairs", "query")

    def __init__(self, query: QueryObject, pairs: list) -> None:
        self.query, self.pairs = query, pairs
        self.distances = np.array([pair.distance for pair in pairs])


class Cuts:
    """What the distances demand of one tick's step s = q - q_prev: rows A s ≥ a, from each posture that was tried.

    A flat pair's nearest corner jumps to and fro, so the last few linearisations stay.

    Attributes:
        rows: pairs of A (k, n) [m/rad] and a (k,) [m]; none without a clearance.
        least: smallest distance where `add` was last called [m], or as far as it looked; NaN without a clearance.
    """

    def __init__(self, clearance: CollisionDistance | None, q_prev: np.ndarray) -> None:
        self._clearance, self._q_prev = clearance, q_prev
        self.rows: list[tuple[np.ndarray, np.ndarray]] = []
        self.least = math.nan

    def add(self, q: np.ndarray) -> float:
        """Linearise at q (n,), to which the kinematics was set, and return the price of what is missing there."""
        if self._clearance is None:
            return 0.0
        near, margin = self._clearance.near(_NEAR), self._clearance.options.margin
        A = self._clearance.jacobian(near)
        self.rows = [*self.rows[1 - _KEPT :], (A, margin + _PAD - near.distances + A.dot(q - self._q_prev))]
        self.least = float(near.distances.min(initial=margin + _NEAR))
        return self.price(margin + _PAD - self.least)

    def price(self, lack: float) -> float:
        """Of a clearance that lacks this [m] of the margin and the pad; half of the pad is free."""
        return SLACK_PRICE * max(lack - 0.5 * _PAD, 0.0)


def _moving_bodies(kinematics: ArmKinematics, joints: list[JointIndex]) -> list[RigidBody]:
    plant = kinematics.plant
    return [plant.get_body(index) for index in plant.GetBodiesKinematicallyAffectedBy(joints)]


def _solid_bodies(kinematics: ArmKinematics, moving: list[RigidBody], names: list[str]) -> list[RigidBody]:
    """Bodies that the arm does not move: all, or those whose own or whose model's name is given."""
    plant = kinematics.plant
    moved = {body.index() for body in moving}
    bodies = [
        plant.get_body(index)
        for model in range(plant.num_model_instances())
        for index in plant.GetBodyIndices(ModelInstanceIndex(model))
        if index not in moved
    ]
    if not names:
        return bodies

    def known_as(body: RigidBody) -> tuple[str, str]:
        return body.name(), plant.GetModelInstanceName(body.model_instance())

    unknown = [name for name in names if not any(name in known_as(body) for body in bodies)]
    if unknown:
        known = sorted({name for body in bodies for name in known_as(body)})
        raise InputError(f"collision_avoidance: no solid body '{unknown[0]}'; there are {', '.join(known)}")
    return [body for body in bodies if any(name in known_as(body) for name in names)]
