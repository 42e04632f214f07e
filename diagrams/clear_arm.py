"""The Lio among a scenario's solid things, for the inverse kinematics to keep clear of."""

from dataclasses import replace

from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.framework import DiagramBuilder

from diagrams.ik_solver import IkSolver
from diagrams.lio_arm import BASE_FRAME, TCP_FRAME, make_arm_plant
from diagrams.scenario import Scenario
from diagrams.scene import add_scene


def make_lio_solver(scenario: Scenario) -> IkSolver:
    """The solver that a scenario asks for: of the arm alone, or of the arm among its things when it keeps clear.

    The things to carry are left out: they move, and are there to be touched.

    Raises:
        InputError: an option of the IK cannot be used.
    """
    if scenario.ik.keep_clear is None:
        return IkSolver(make_arm_plant(), TCP_FRAME, scenario.ik)
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, 0.0)
    add_scene(plant=plant, scene_graph=scene_graph, scenario=replace(scenario, items=[]), seed=0)
    plant.Finalize()
    return IkSolver(plant, TCP_FRAME, scenario.ik, BASE_FRAME, builder.Build())
