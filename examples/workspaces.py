"""Both workspaces: demonstrations, directrix, disks, paths and corrections.

Left the relocation, from one table to another; right the laundry, from the basket on its table into the machine. Red:
the demonstrations. Dotted blue: the directrix. Black: disks. Green: the path that is travelled, home, pick, home,
place, home. Solid blue: corrections by a scripted thumb; outwards they are kept, on the way home they fade (Fig. 6 of
the paper).
"""

import xml.etree.ElementTree as ET

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from scipy.spatial.transform import Rotation
from style import (
    CORRECTION,
    DEMONSTRATION,
    DIRECTRIX,
    GREY,
    PATH,
    draw_canal,
    fit,
    new_figure,
    save,
    shipped_canal,
    solid,
)

from canal.navigation.tour import tour
from diagrams.scenario import Scenario, load_scenario
from models import MODELS

CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))


def furniture(scenario: Scenario) -> list[np.ndarray]:
    """Faces (4, 3) of the boxes that the tables, the basket and the machine are made of, in the robot's base frame."""
    base = Rotation.from_euler("z", scenario.robot.yaw_deg, degrees=True)
    faces = []
    for fixture in scenario.fixtures:
        turn = Rotation.from_euler("z", fixture.yaw_deg, degrees=True)
        for shape in ET.parse(MODELS / "world" / f"{fixture.model}.sdf").iter("collision"):
            size = shape.findtext("geometry/box/size")
            if size is None or fixture.name == "floor":
                continue
            x, y, z, roll, pitch, yaw = map(float, (shape.findtext("pose") or "0 0 0 0 0 0").split())
            box = Rotation.from_euler("xyz", [roll, pitch, yaw]).apply(CORNERS * np.array(size.split(), dtype=float))
            world = turn.apply(box + [x, y, z]) + fixture.position
            corners = base.inv().apply(world - scenario.robot.position)
            faces += [corners[list(face)] for face in FACES]
    return faces


figure = new_figure(13, 5.6)
for k, (task, view) in enumerate({"relocation": (20, -18), "laundry": (26, -75)}.items()):
    canal = shipped_canal(task)
    travelled = tour(canal)
    axes = solid(figure, (1, 2, k + 1), view=view)
    boxes = furniture(load_scenario(task))
    axes.add_collection3d(Poly3DCollection(boxes, facecolor="#D9C7AE", edgecolor=GREY, lw=0.15, alpha=0.13, zorder=0))
    rims = draw_canal(axes, canal, disks=45)
    for curve in canal.demonstrations:
        axes.plot(*curve.T, color=DEMONSTRATION, lw=1.4, zorder=3)
    axes.plot(*canal.directrix.T, color=DIRECTRIX, ls=":", lw=1.6, zorder=4)
    axes.plot(*travelled.position.T, color=PATH, lw=1.8, zorder=5)
    for correction in travelled.corrections:
        axes.plot(*correction.T, color=CORRECTION, lw=3, zorder=6)
    fit(axes, np.vstack([rims, *boxes]), zoom=1.2)
    axes.set_title(task)
    print(f"{task}: {canal.n_disks} disks along {canal.length:.2f} m, {len(travelled.corrections)} corrections")
save(figure)
