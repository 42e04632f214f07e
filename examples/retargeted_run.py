"""A retargeted run: the machine has moved, and the robot loads it all the same.

In the scenario `laundry-moved` basket and machine stand 12 and 10 cm from where they were when the task was shown.
The canal is bent to where they are now, and the whole system runs on it, with contact, until the first item of
clothing is in the drum: navigator, inverse kinematics, station, and a simulated person who corrects. Grey: the canal
as taught; blue: bent. Green: where the tool went, measured; solid blue: corrections. Right: how far the tool was from
where it was wanted.
"""

import numpy as np
from style import (
    BLUE,
    CORRECTION,
    DIRECTRIX,
    GREEN,
    GREY,
    PATH,
    draw_canal,
    fit,
    new_figure,
    save,
    shipped_canal,
    solid,
)

from canal.navigation import FIELD_NAMES
from canal.navigation.tour import segments
from diagrams.scenario import load_scenario, with_items
from diagrams.shared_autonomy import build_shared_autonomy
from geosacs_drake.prepare_canal import prepare_task
from geosacs_drake.run_options import RunOptions
from geosacs_drake.simulate import simulate

scenario = with_items(load_scenario("laundry-moved"), "rigid")
scenario, canal = prepare_task(scenario, RunOptions(headless=True))
system = build_shared_autonomy(scenario=scenario, canal=canal, seed=1)
names = [item.name for item in scenario.items]
done = [0]
result = simulate(
    system,
    task=scenario.task,
    seed=1,
    item_names=names,
    duration=70.0,
    report=lambda progress: done.append(progress.placed),
    asked_to_end=lambda: done[-1] > 0,
)

signals = result.signals
state = dict(zip(FIELD_NAMES, signals["navigation_state"].T, strict=True))
measured, wanted = signals["X_BT"][:, :3], signals["X_BT_desired"][:, :3]
error = 1e3 * np.linalg.norm(measured - wanted, axis=1)
corrections = segments(measured, state["correcting"] > 0)
placed = sum(time >= 0 for time in result.placed_times)
print(f"{placed} of {len(names)} placed after {signals['time'][-1]:.0f} s, {len(corrections)} corrections")
print(f"the tool was within {np.percentile(error, 95):.1f} mm of where it was wanted for 95 % of the time")

figure = new_figure(12, 4.8)
axes = solid(figure, (1, 2, 1), view=(26, -75))
rims = [draw_canal(axes, shipped_canal("laundry"), disks=24, color=GREY, rim=GREY), draw_canal(axes, canal, disks=36)]
axes.plot(*canal.directrix.T, color=DIRECTRIX, ls=":", lw=1.4, zorder=4)
axes.plot(*measured.T, color=PATH, lw=1.6, zorder=5)
for correction in corrections:
    axes.plot(*correction.T, color=CORRECTION, lw=3, zorder=6)
fit(axes, np.vstack(rims), zoom=1.3)
panels = figure.add_gridspec(2, 2)[:, 1].subgridspec(2, 1).subplots(sharex=True)
panels[0].plot(signals["time"], state["disk"], color=BLUE)
panels[0].fill_between(signals["time"], 0, canal.n_disks, where=state["correcting"] > 0, color=BLUE, alpha=0.2, lw=0)
panels[0].set(ylabel="disk; shaded: corrections", ylim=(0, canal.n_disks))
panels[1].plot(signals["time"], error, color=GREEN, lw=1.2)
panels[1].set(ylabel="tool from wanted [mm]", xlabel="time [s]", ylim=(0, None))
save(figure)
