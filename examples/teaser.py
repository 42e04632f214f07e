"""Shared autonomy on a canal surface.

The robot travels the canal by itself; a person moves it on the disk where it is, along the red axis and the green
one. The scene is rendered by Drake's own renderer from the scenario of the laundry, with the arm posed by the inverse
kinematics at a disk above the basket; the canal is then drawn over it through the same camera (Fig. 1 of the paper).
"""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.sensors import CameraInfo
from style import BLUE, GREEN, RED, SKY, YELLOW, new_figure, save, shipped_canal

from canal.surface import CanalSurface
from diagrams.ik.solver import IkSolver
from diagrams.scenario import load_scenario, with_items
from diagrams.station.lio_arm import TCP_FRAME, make_arm_plant
from diagrams.station.lio_station import START_POSTURE, LioStation
from diagrams.view.cameras import VIEWS, add_camera, look_at
from geosacs_drake.results.plotting import rim_points

DISK, ETA, PHI = 62.0, 0.55, 0.9
SIZE = (1280, 800)
canal: CanalSurface = shipped_canal("laundry")
solver, q, v = IkSolver(make_arm_plant(), TCP_FRAME), START_POSTURE, np.zeros(6)
for disk in np.linspace(canal.home_disk, DISK, 60):
    for _ in range(4):
        q = solver.solve(canal.pose(disk, ETA * (disk == DISK), PHI), 10.0, q, 0.1, v).q

builder = DiagramBuilder()
station = LioStation.AddToBuilder(
    builder=builder, world=with_items(load_scenario("laundry"), "rigid"), q0=q, filmed=True
)
view = VIEWS["laundry"]
X_WC = station.X_WB.multiply(look_at(view.eye, view.target))
camera = add_camera(builder=builder, station=station, X=X_WC, size=SIZE, fov_deg=view.fov_deg)
diagram = builder.Build()
context = diagram.CreateDefaultContext()
image = camera.GetOutputPort("color_image").Eval(camera.GetMyContextFromRoot(context)).data[:, :, :3]
intrinsics = CameraInfo(*SIZE, np.deg2rad(view.fov_deg))


def pixels(points: np.ndarray) -> np.ndarray:
    """Where points (N, 3) in the robot's base frame are in the picture. Shape (N, 2)."""
    x, y, z = X_WC.inverse().multiply(station.X_WB).multiply(points.T)
    return np.column_stack(
        [
            intrinsics.center_x() + intrinsics.focal_x() * x / z,
            intrinsics.center_y() + intrinsics.focal_y() * y / z,
        ]
    )


figure = new_figure(9, 7)
axes = figure.add_subplot()
axes.set_axis_off()
axes.imshow(image)
axes.set(xlim=(160, 1000), ylim=(SIZE[1], 150))
for rim in rim_points(canal, np.linspace(0, canal.n_disks - 1, 48)):
    axes.plot(*pixels(rim).T, color=SKY, lw=1.1, alpha=0.8)
axes.plot(*pixels(canal.directrix).T, color=BLUE, ls=":", lw=1.8)
rim = rim_points(canal, np.array([DISK]))[0]
axes.fill(*pixels(rim).T, color=YELLOW, alpha=0.55)
centre = canal.center(DISK)
for axis, color in zip(canal.axes(DISK), (RED, GREEN), strict=True):
    begin, end = pixels(np.array([centre, centre + 1.25 * canal.radius(DISK) * axis]))
    axes.annotate("", end, begin, arrowprops={"arrowstyle": "-|>", "color": color, "lw": 2.5, "mutation_scale": 18})
axes.plot(*pixels(canal.point(DISK, ETA, PHI)[None]).T, "o", color=BLUE, ms=7)
print(f"disk {DISK:.0f} of {canal.n_disks}, radius {1e3 * canal.radius(DISK):.0f} mm")
save(figure)
