"""Where an item ends if the time step is halved: all kinds fall into the machine's drum, with both steps.

Measured from the default, 4 ms, to half of it: cloth ends within 6 mm over four turns of each (towel 0.8, shirt 2.6,
sock 5.6). Rigid ones over 21 turns of each: within 3 mm in 45 of 63, else within 19 mm, since a bundle that rolls may
come to lie on another of its facets.
"""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlant
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from diagrams.deformable.contact import prepare_for_cloth
from diagrams.deformable.items import add_deformable_item, deformable_positions
from diagrams.deformable.laundry import make_shape
from diagrams.scene.world import Contact
from diagrams.station.lio_station import plant_config
from models import MODELS

FALLS = 3.0
"""[s] until it lies."""
RELEASE = np.array([0.0, 0.95, 0.44])
"""Where the hand lets go, p_W [m]; the drum's floor is 14 cm lower."""


def end_of_fall(kind: str, *, deformable: bool, time_step: float, turn: float) -> np.ndarray:
    """Middle of an item [m] after it fell, let go with a turn about the vertical [rad]. Shape (3,)."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlant(plant_config(Contact(time_step=time_step).for_items(deformable)), builder)
    (machine,) = Parser(plant).AddModels(str(MODELS / "world" / "washing_machine.sdf"))
    base = plant.get_body(plant.GetBodyIndices(machine)[0]).body_frame()
    plant.WeldFrames(plant.world_frame(), base, RigidTransform([0.0, 0.79, 0.0]))
    X_WP = RigidTransform(RollPitchYaw(0.1, 0.1, turn), RELEASE)
    nobody = plant.AddModelInstance("robot")
    if deformable:
        item = add_deformable_item(plant=plant, name=kind, shape=make_shape(kind), X_WP=X_WP)
        prepare_for_cloth(plant=plant, scene_graph=scene_graph, robot=nobody, fallen_into=[machine])
    else:
        (model,) = Parser(plant).AddModels(str(MODELS / "items" / f"{kind}.sdf"))
        body = plant.get_body(plant.GetBodyIndices(model)[0])
        plant.SetDefaultFloatingBaseBodyPose(body, X_WP)
    plant.Finalize()
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(FALLS)
    context = plant.GetMyContextFromRoot(simulator.get_context())
    if deformable:
        return deformable_positions(plant, context, item).mean(axis=0)
    return plant.EvalBodyPoseInWorld(context, body).translation()


def apart(kind: str, *, deformable: bool, turns: tuple[float, ...] = (0.0, 0.4, 0.8, 1.2)) -> float:
    """Greatest distance between where an item ends with the time step and with half of it [m], over some turns."""
    time_step = Contact().time_step
    ends = [
        [end_of_fall(kind, deformable=deformable, time_step=step, turn=turn) for step in (time_step, time_step / 2)]
        for turn in turns
    ]
    return float(max(np.linalg.norm(a - b) for a, b in ends))
