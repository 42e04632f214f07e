"""A bench for cloth: the Lio's hand on a gantry, over a basket floor, beside a drum. No arm, no controllers of ours."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from pydrake.geometry import AddContactMaterial, Box, ProximityProperties
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlant
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    PdControllerGains,
    PrismaticJoint,
    RevoluteJoint,
    RigidBody,
    SpatialInertia,
    UnitInertia,
    world_model_instance,
)
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from diagrams.deformable.contact import MARGIN, prepare_for_cloth
from diagrams.deformable.items import (
    DeformableMaterial,
    add_deformable_item,
    deformable_positions,
    deformable_velocities,
    node_masses,
)
from diagrams.deformable.laundry import DeformableShape
from diagrams.geometry.box_depth import FixedBoxes
from diagrams.scene.world import Contact
from diagrams.station.lio_station import plant_config

OPEN, CLOSED = 0.5236, -0.1  # [rad], as diagrams.station.lio_drive commands them
TICK = 0.01  # [s]


@dataclass(frozen=True)
class Setting:
    """What is varied: how the plant is discretized and what cloth is made of."""

    time_step: float = Contact().time_step
    approximation: str = "lagged"
    stiction_tolerance: float = Contact().stiction_tolerance
    gradient: float | None = None
    """Pressure gradient of rigid shapes [Pa/m]; None: as in the station."""
    margin: float = MARGIN
    """Of foreseen contact [m]."""
    material: DeformableMaterial = field(default_factory=DeformableMaterial)


def _box(plant: MultibodyPlant, body: RigidBody, name: str, size: tuple, X: RigidTransform, friction: float) -> None:
    properties = ProximityProperties()
    AddContactMaterial(properties=properties, friction=CoulombFriction(friction, friction))
    plant.RegisterCollisionGeometry(body, X, Box(*size), name, properties)


def add_floor_and_drum(plant: MultibodyPlant) -> None:
    """A table top with its surface at z = 0.3, and a drum behind a round door at (0, 0.85, 0.55), axis along y."""
    world, n, radius, door = plant.world_body(), 14, 0.25, np.array([0.0, 0.85, 0.55])
    _box(plant, world, "floor", (0.6, 0.6, 0.06), RigidTransform([0.45, 0.0, 0.27]), 0.6)
    for i in range(n):
        R = RotationMatrix.MakeYRotation(2.0 * np.pi * i / n)
        width = 2.0 * (radius + 0.06) * np.tan(np.pi / n)
        p = door + R.multiply(np.array([0.0, 0.165, -radius * np.cos(np.pi / n) - 0.03]))
        _box(plant, world, f"drum{i}", (width, 0.35, 0.06), RigidTransform(R, p), 0.4)
    _box(plant, world, "back", (0.6, 0.06, 0.6), RigidTransform(door + [0.0, 0.36, 0.0]), 0.4)


def add_hand(plant: MultibodyPlant) -> RigidBody:
    """Three sliding axes and a tilt about x carry a palm, whose frame is the TCP (z down), and two fingers."""
    model = plant.AddModelInstance("hand")
    inertia = SpatialInertia(mass=1.0, p_PScm_E=np.zeros(3), G_SP_E=UnitInertia.SolidSphere(0.1))
    body = plant.world_body()
    for name, axis in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1])):
        child = plant.AddRigidBody(f"slide_{name}", model, inertia)
        joint = plant.AddJoint(PrismaticJoint(name, body.body_frame(), child.body_frame(), axis))
        plant.AddJointActuator(name, joint).set_controller_gains(PdControllerGains(p=1e5, d=2e3))
        body = child
    palm = plant.AddRigidBody("palm", model, inertia)
    tilt = plant.AddJoint(RevoluteJoint("tilt", body.body_frame(), palm.body_frame(), [1, 0, 0]))
    plant.AddJointActuator("tilt", tilt).set_controller_gains(PdControllerGains(p=2000.0, d=100.0))
    down = RotationMatrix.MakeXRotation(np.pi)
    fingers = []
    for sign, name in ((1, "left"), (-1, "right")):
        unit = UnitInertia.SolidBox(0.03, 0.02, 0.15).ShiftFromCenterOfMass(np.array([0, sign * 0.01, -0.07]))
        finger = plant.AddRigidBody(name, model, SpatialInertia(0.09, np.array([0, -sign * 0.01, 0.07]), unit))
        X_PF = RigidTransform(down, down.multiply(np.array([0.0, sign * 0.03, -0.125])))
        frame = plant.AddFrame(FixedOffsetFrame(f"{name}_hinge", palm.body_frame(), X_PF))
        fingers.append(
            plant.AddJoint(RevoluteJoint(name, frame, finger.body_frame(), [-sign, 0, 0], -0.15, OPEN, damping=0.1))
        )
        X_pad = RigidTransform(RotationMatrix.MakeXRotation(sign * 0.15), [0.0, -sign * 0.0166, 0.1183])
        _box(plant, finger, f"{name}_pad", (0.03, 0.018, 0.06), X_pad, 1.0)
    grip = plant.AddJointActuator("grip", fingers[0], 3.0)
    grip.set_controller_gains(PdControllerGains(p=200.0, d=4.0))
    plant.AddCouplerConstraint(fingers[1], fingers[0], 1.0, 0.0)
    plant.set_gravity_enabled(model, False)
    return palm


class Rig:
    """A simulation of the hand and some clothes; moves by cubic steps, keeps the CPU time of each tick."""

    def __init__(self, clothes: list[tuple[str, DeformableShape, list[float], float]], setting: Setting) -> None:
        """Put (name, shape, position [m], yaw [rad]) into the scene."""
        builder = DiagramBuilder()
        contact = Contact(setting.time_step, setting.approximation, stiction_tolerance=setting.stiction_tolerance)
        self.plant, scene_graph = AddMultibodyPlant(plant_config(contact), builder)
        add_floor_and_drum(self.plant)
        self.palm = add_hand(self.plant)
        hand = self.palm.model_instance()
        self.items = [
            add_deformable_item(
                plant=self.plant,
                name=name,
                shape=shape,
                X_WP=RigidTransform(RollPitchYaw(0, 0, yaw), position),
                material=setting.material,
            )
            for name, shape, position, yaw in clothes
        ]
        gradients = {} if setting.gradient is None else {"surroundings": setting.gradient, "pads": setting.gradient}
        prepare_for_cloth(
            plant=self.plant,
            scene_graph=scene_graph,
            robot=hand,
            fallen_into=[world_model_instance()],
            margin=setting.margin,
            **gradients,
        )
        self.plant.Finalize()
        self._boxes = FixedBoxes(self.plant, scene_graph.model_inspector(), [world_model_instance()])
        builder.ExportInput(self.plant.get_desired_state_input_port(hand), "hand")
        self.diagram = builder.Build()
        self.simulator = Simulator(self.diagram)
        self.root = self.simulator.get_mutable_context()
        self.context = self.plant.GetMyMutableContextFromRoot(self.root)
        self.command = np.array([0.45, 0.0, 0.9, 0.0, OPEN])
        self.plant.SetPositions(self.context, hand, [*self.command, OPEN])

    def move(self, target: list[float], duration: float) -> None:
        """Go to (x, y, z, tilt, finger angle) in `duration` [s]."""
        start, begin = self.command, self.root.get_time()
        ticks = max(1, round(duration / TICK))
        for i in range(1, ticks + 1):
            u = i / ticks
            self.command = start + (np.array(target) - start) * u * u * (3.0 - 2.0 * u)
            rate = (np.array(target) - start) * 6.0 * u * (1.0 - u) / duration
            self.diagram.GetInputPort("hand").FixValue(self.root, np.concatenate([self.command, rate]))
            self.simulator.AdvanceTo(begin + i * TICK)

    def wait(self, duration: float) -> None:
        """Stay for `duration` [s]."""
        self.move(list(self.command), duration)

    def nodes(self, k: int) -> np.ndarray:
        """Of item k in W [m], shape (N, 3)."""
        return deformable_positions(self.plant, self.context, self.items[k])

    def nodes_in_hand(self, k: int) -> np.ndarray:
        """Of item k in the palm's frame [m], shape (N, 3)."""
        X_WP = self.plant.EvalBodyPoseInWorld(self.context, self.palm)
        return X_WP.inverse().multiply(self.nodes(k).T).T

    def depth(self, k: int) -> float:
        """Of the node of item k that lies deepest in floor or drum [m]."""
        return self._boxes.depth(self.nodes(k))

    def speed(self, k: int) -> float:
        """Of the fastest node of item k [m/s]."""
        return float(np.linalg.norm(deformable_velocities(self.plant, self.context, self.items[k]), axis=1).max())

    def kinetic_energy(self) -> float:
        """Of all items [J]."""
        energies = (
            0.5 * node_masses(i.shape) @ (deformable_velocities(self.plant, self.context, i) ** 2).sum(axis=1)
            for i in self.items
        )
        return float(sum(energies))

    def potential_energy(self) -> float:
        """Of all items in gravity [J], the floor's surface at zero."""
        return float(sum(9.81 * node_masses(i.shape) @ (self.nodes(k)[:, 2] - 0.3) for k, i in enumerate(self.items)))
