"""The Lio station: the robot with its controllers, in a scene with contact."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlant, MultibodyPlant, MultibodyPlantConfig
from pydrake.multibody.tree import ModelInstanceIndex, PdControllerGains
from pydrake.systems.framework import Context, Diagram, DiagramBuilder

from canal.errors import InputError
from canal.navigation.joystick import in_step
from diagrams.deformable.contact import prepare_for_cloth
from diagrams.geometry.goals import Goal
from diagrams.scene.layout import make_goals
from diagrams.scene.overlaps import check_overlaps
from diagrams.scene.scene import Scene, add_scene
from diagrams.scene.world import Contact, World
from diagrams.station.contact_sensor import ContactSensor
from diagrams.station.item_sensor import ItemSensor
from diagrams.station.lio_arm import arm_joints, arm_speeds
from diagrams.station.lio_drive import ARM, DAMPING, STIFFNESS, LioDrive
from diagrams.station.lio_sensors import LioSensor
from diagrams.station.sleeping_arm import Standing

START_POSTURE = np.array([-1.62113, -1.19688, 1.27447, 0.02532, 1.48154, -0.05674])
"""[rad] (docs/method.md, 6)."""

GRIP_STIFFNESS, GRIP_DAMPING = 200.0, 4.0
"""Of the gripper's drive [N m/rad], [N m s/rad]."""
GRIP_EFFORT = 4.0
"""[N m] of the 50 that the drive has: 32 N at the fingertips hold all that is here, and hurt nobody."""
ROTOR_INERTIA = 0.02
"""Of arm drives, at the joint [kg m²]: a stand-in for gears that are not published, small beside the links."""


class LioStation(Diagram):
    """The robot among fixtures and items, to be commanded like the real one.

    ```
     desired_state (12: q, v) → ┌────────────┐ → q (6), v (6), gripper_state (2: angle, rate), X_BT (7)
                                │            │ → item_poses (7 n), item_bounds (6 n), item_speeds (n)
                                │            │ → lio_state (16: q, v of arm and both fingers), contact_results
                                │ LioStation │ → contact_forces (pairs) [N], touching_bodies (pairs), hand_force (3) [N]
       gripper_command (1)    → └────────────┘ → grip_forces (n) [N], penetration (1) [m]
    ```

    The gripper closes at a command of 1, opens at 0. Items are in the scenario's order, in W; `contact_pairs` names
    the pairs. Gravity does not act on the arm's model: ideal compensation, as the real drives have it.
    """

    def __init__(self, world: World, *, seed: int = 0, q0: np.ndarray = START_POSTURE, filmed: bool = False) -> None:
        """Build the scene of a world, its items drawn from `seed`, the arm in posture `q0` (6,) [rad].

        `filmed`: whether cameras will look at it.

        Raises:
            InputError: a model does not exist, items do not fit, items overlap, or `q0` is beyond a limit.
        """
        super().__init__()
        builder = DiagramBuilder()
        deformable = any(item.kind == "soft" for item in world.items)
        plant, scene_graph = AddMultibodyPlant(plant_config(world.contact.for_items(deformable)), builder)
        self.plant: MultibodyPlant = plant
        self.scene_graph: SceneGraph = scene_graph
        self.scene: Scene = add_scene(plant=plant, scene_graph=scene_graph, world=world, seed=seed, filmed=filmed)
        self.goals: list[Goal] = make_goals(world, self.scene.marks, self.scene.rest_heights)
        lio = self.scene.lio
        set_drives(plant, lio)
        plant.set_gravity_enabled(lio, False)
        if self.scene.deformable_items:
            machine = self.scene.fixtures.get("machine", [])
            prepare_for_cloth(plant=plant, scene_graph=scene_graph, robot=lio, fallen_into=machine)
        plant.Finalize()
        drive = make_drive(plant, q0, period=in_step(1.0 / world.control_rate_hz))
        builder.AddNamedSystem("lio_drive", drive)
        plant.SetDefaultPositions(lio, drive.start_positions())

        standing = Standing(
            desired=drive.GetInputPort("desired_state").size(), actuated=drive.GetOutputPort("actuator_state").size()
        )
        self.standing: Standing = builder.AddNamedSystem("standing", standing)
        sensor = builder.AddNamedSystem("lio_sensor", LioSensor(plant, lio, self.scene.X_WB))
        items = builder.AddNamedSystem("item_sensor", ItemSensor(self.scene))
        touch = builder.AddNamedSystem("contact_sensor", ContactSensor(plant, scene_graph, self.scene))
        self.contact_pairs: list[str] = touch.contact_pairs
        self.robot_bodies: list[str] = touch.robot_bodies

        builder.Connect(drive.GetOutputPort("actuator_state"), standing.GetInputPort("actuator_state"))
        builder.Connect(plant.get_contact_results_output_port(), standing.GetInputPort("contact_results"))
        builder.Connect(standing.GetOutputPort("actuator_state"), plant.get_desired_state_input_port(lio))
        for system in (sensor, drive):
            builder.Connect(plant.get_state_output_port(lio), system.GetInputPort("lio_state"))
        poses, query = plant.get_body_poses_output_port(), scene_graph.get_query_output_port()
        builder.Connect(poses, sensor.GetInputPort("body_poses"))
        builder.Connect(poses, items.GetInputPort("body_poses"))
        builder.Connect(plant.get_body_spatial_velocities_output_port(), items.GetInputPort("body_velocities"))
        builder.Connect(query, items.GetInputPort("geometry_query"))
        builder.Connect(query, touch.GetInputPort("geometry_query"))
        builder.Connect(standing.GetOutputPort("contact_results"), touch.GetInputPort("contact_results"))
        for name in ("desired_state", "gripper_command"):
            builder.ExportInput(drive.GetInputPort(name), name)
            builder.ConnectInput(name, standing.GetInputPort(name))
        for system in (sensor, items, touch):
            for k in range(system.num_output_ports()):
                port = system.get_output_port(k)
                builder.ExportOutput(port, port.get_name())
        builder.ExportOutput(query, "geometry_query")
        builder.ExportOutput(plant.get_state_output_port(lio), "lio_state")
        builder.ExportOutput(plant.get_contact_results_output_port(), "contact_results")
        builder.BuildInto(self)
        self.set_name("lio_station")
        check_overlaps(plant=plant, scene_graph=scene_graph, root=self.CreateDefaultContext(), scene=self.scene)

    @property
    def X_WB(self) -> RigidTransform:
        """Where the base stands."""
        return self.scene.X_WB

    @staticmethod
    def AddToBuilder(
        *,
        builder: DiagramBuilder,
        world: World,
        seed: int = 0,
        q0: np.ndarray = START_POSTURE,
        filmed: bool = False,
    ) -> LioStation:
        """Build a station and add it; its inputs are left to connect.

        Args:
            builder: of the diagram that it is added to.
            world: what stands where.
            seed: of where the items lie.
            q0: posture at the start, [rad]. Shape (6,).
            filmed: whether cameras will look at it.
        """
        return builder.AddNamedSystem("lio_station", LioStation(world, seed=seed, q0=q0, filmed=filmed))

    def plant_context(self, context: Context) -> Context:
        """The plant's part of the context of any diagram that this station is in."""
        return self.plant.GetMyContextFromRoot(context)


def plant_config(contact: Contact) -> MultibodyPlantConfig:
    """How Drake is to compute contact; the approximation is given (`Contact.for_items`)."""
    return MultibodyPlantConfig(
        time_step=in_step(contact.time_step),
        discrete_contact_approximation=contact.approximation,
        contact_model=contact.model,
        contact_surface_representation="polygon",
        stiction_tolerance=contact.stiction_tolerance,
    )


def set_drives(plant: MultibodyPlant, lio: ModelInstanceIndex) -> None:
    """Give each actuator of the Lio its controller; before the plant is finalized.

    Args:
        plant: before it is finalized.
        lio: the Lio's model.
    """
    for k in range(ARM):
        drive = plant.GetJointActuatorByName(f"lio_joint_{k + 1}", lio)
        drive.set_controller_gains(PdControllerGains(p=STIFFNESS[k], d=DAMPING[k]))
        drive.set_default_rotor_inertia(ROTOR_INERTIA)
    grip = plant.GetJointActuatorByName("lio_finger_left", lio)
    grip.set_controller_gains(PdControllerGains(p=GRIP_STIFFNESS, d=GRIP_DAMPING))
    grip.set_effort_limit(GRIP_EFFORT)


def make_drive(plant: MultibodyPlant, q0: np.ndarray, period: float) -> LioDrive:
    """The drives of the arm and the gripper of a finalized plant.

    Args:
        plant: with the Lio in it.
        q0: where they hold the arm at first, [rad]. Shape (6,).
        period: of what they are told, [s].

    Raises:
        InputError: `q0` is beyond a joint's stop.
    """
    stops = arm_stops(plant)
    return LioDrive(
        checked_posture(q0, stops),
        period=period,
        time_step=plant.time_step(),
        stops=stops,
        speeds=arm_speeds(plant),
        friction=np.array([joint.default_damping() for joint in arm_joints(plant)]),
    )


def arm_stops(plant: MultibodyPlant) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest angle of each joint of the arm [rad], two of (6,)."""
    joints = arm_joints(plant)
    return (
        np.array([joint.position_lower_limit() for joint in joints]),
        np.array([joint.position_upper_limit() for joint in joints]),
    )


def checked_posture(q0: np.ndarray, stops: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """The arm's posture `q0` (6,) [rad] as it was given, within `stops`.

    Args:
        q0: [rad]. Shape (6,).
        stops: least and largest angles, [rad]. Shapes (6,).

    Raises:
        InputError: a joint is beyond its limits, or not finite.
    """
    q0 = np.asarray(q0, dtype=float)
    if q0.shape != (ARM,) or not np.isfinite(q0).all():
        raise InputError(f"start posture {q0.tolist()} is not {ARM} finite numbers; give one angle a joint in radians")
    for k, (value, low, high) in enumerate(zip(q0, *stops, strict=True)):
        if not low <= value <= high:
            raise InputError(f"start posture: joint {k + 1} at {value:.3f} rad is not within {low:.3f} .. {high:.3f}")
    return q0
