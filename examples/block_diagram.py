"""The block diagram of the whole, from Drake's own description of it.

`build_shared_autonomy` wires a run; Drake's `GetGraphvizString` tells its systems, their ports and what is connected.
Inputs are on the left of a block, outputs on the right; a wire has the colour of the system that it comes from. What
samples a measurement of the station once a tick (a zero-order hold for each port) is drawn as part of the wire, and
what only logs is left out.
"""

import re
from collections import defaultdict

from matplotlib.patches import FancyBboxPatch, PathPatch
from matplotlib.path import Path
from style import BLACK, BLUE, GREEN, GREY, PINK, RED, YELLOW, new_figure, save, shipped_canal

from diagrams.scenario import load_scenario
from diagrams.shared_autonomy import build_shared_autonomy

PLACES = {
    "SimulatedOperator": (0.0, 0.0, YELLOW), "JoystickSelector": (1.25, 0.35, RED), "CanalNavigator": (2.5, 0.0, BLUE),
    "OrientationWeightedIk": (3.75, 0.35, PINK), "LioStation": (5.0, 0.0, GREEN), "Monitor": (6.25, -0.65, GREY),
    "ForceAlarm": (6.25, 1.55, RED),
    "Peaks": (6.25, 0.6, GREY),
}  # fmt: skip
WIDTH, LINE = 0.86, 0.125
system = build_shared_autonomy(scenario=load_scenario("relocation"), canal=shipped_canal("relocation"))
text = system.diagram.GetGraphvizString(max_depth=1)

kinds, ports = {}, {}
for block in re.split(r"\n(?=s\d+ \[)", text)[1:]:
    key = block.split(" ", 1)[0]
    kinds[key] = re.findall(r"<B>(?:[\w:.]+[.:])?(\w+)", block)[0]
    ports |= {(key, port): label for port, label in re.findall(r'PORT="([uy]\d+)"[^>]*>([\w ]+)<', block)}
arrows = re.findall(r"(s\d+):(y\d+):\w+ -> (s\d+):(u\d+)", text)
held = {to: (key, port) for key, port, to, _ in arrows if kinds[to] == "ZeroOrderHold"}
wires = [
    (*held.get(key, (key, port)), to, entry)
    for key, port, to, entry in arrows
    if kinds[to] not in ("ZeroOrderHold", "VectorLogSink")
]

used = defaultdict(list)  # ports that are connected, by system and side
for key, port, to, entry in wires:
    for end in ((key, port), (to, entry)):
        if end not in used[end[0], end[1][0]]:
            used[end[0], end[1][0]].append(end)
for ends in used.values():
    ends.sort(key=lambda end: int(end[1][1:]))

for row, kind in enumerate(sorted({kinds[key] for key, _ in used} - set(PLACES))):
    PLACES[kind] = (2.5 + 1.25 * (row % 3), 1.5 + 0.9 * (row // 3), GREY)  # one that has come since this was laid out
figure = new_figure(14, 5.4)
axes = figure.add_subplot(xlim=(-0.75, 6.95), ylim=(-1.55, 2.1))
axes.set_axis_off()
where = {}
for key in sorted({key for key, _ in used}):
    x, y, color = PLACES[kinds[key]]
    rows = max(len(used[key, "u"]), len(used[key, "y"]), 1)
    height = LINE * (rows + 1.8)
    box = FancyBboxPatch((x - WIDTH / 2, y - height / 2), WIDTH, height, boxstyle="round,pad=0.02", zorder=3)
    box.set(facecolor="white", edgecolor=color, linewidth=1.6)
    axes.add_patch(box)
    axes.text(x, y + height / 2 - 0.6 * LINE, kinds[key], ha="center", va="center", fontsize=8, weight="bold", zorder=5)
    for side, sign, align in (("u", -1, "left"), ("y", 1, "right")):
        for row, end in enumerate(used[key, side]):
            where[end] = (x + sign * (WIDTH / 2 + 0.02), y + height / 2 - LINE * (row + 1.7))
            label = (where[end][0] - sign * 0.05, where[end][1])
            axes.text(*label, ports[end], ha=align, va="center", fontsize=6, color=BLACK, zorder=5)
for key, port, to, entry in wires:
    (x0, y0), (x1, y1) = where[key, port], where[to, entry]
    reach = 0.22 if x1 > x0 else 0.55  # a wire that leads back swings out further, and dips below the blocks
    dip = 0.0 if x1 > x0 else -0.5 - 0.18 * (x0 - x1)
    path = Path([(x0, y0), (x0 + reach, y0 + dip), (x1 - reach, y1 + dip), (x1, y1)], [1, 4, 4, 4])
    color = PLACES[kinds[key]][2]
    axes.add_patch(PathPatch(path, facecolor="none", edgecolor=color, lw=1.2, alpha=0.75, zorder=1))
    axes.plot(x1, y1, ">", color=color, ms=4, zorder=4)
sinks = sum(kind == "VectorLogSink" for kind in kinds.values())
print(f"{len(kinds)} systems: {len(held)} of them sample measurements, {sinks} log; {len(arrows)} connections")
save(figure)
