"""The Lio among a scenario's fixtures, for the inverse kinematics to avoid collisions with."""

from dataclasses import replace

from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, MultibodyPlant
from pydrake.systems.framework import DiagramBuilder

from diagrams.ik.options import IkOptions
from diagrams.ik.solver import IkSolver
from diagrams.scene.scene import add_scene
from diagrams.scene.world import World
from diagrams.station.lio_arm import BASE_FRAME, TCP_FRAME, arm_speeds, make_arm_plant
from diagrams.station.lio_drive import SPEED_SHARE


def _within_drives(options: IkOptions, arm: MultibodyPlant) -> IkOptions:
    """The options with the speeds that the drives hold, where they give none themselves."""
    if options.speed_limits:
        return options
    return replace(options, speed_limits=(SPEED_SHARE * arm_speeds(arm)).tolist())


def make_lio_solver(world: World, options: IkOptions) -> IkSolver:
    """The solver that a scenario asks for: of the arm alone, or among the fixtures, to avoid them.

    The items to carry are left out: they move, and are there to be touched.

    Args:
        world: where the base stands, and what stands around it.
        options: of the IK.

    Raises:
        InputError: an option of the IK cannot be used.
    """
    arm = make_arm_plant()
    options = _within_drives(options, arm)
    if options.collision_avoidance is None:
        return IkSolver(arm, TCP_FRAME, options)
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    add_scene(plant=plant, scene_graph=scene_graph, world=replace(world, items=[]), seed=0)
    plant.Finalize()
    return IkSolver(plant, TCP_FRAME, options, BASE_FRAME, builder.Build())
