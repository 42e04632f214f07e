"""A canal as a page: drawn by the meshcat package, without Drake, a server or a network."""

from __future__ import annotations

import os
from collections.abc import Sequence
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np

from canal.errors import InputError
from canal.files import write_and_rename
from canal.rows import length_along
from canal.surface import CanalSurface
from diagrams.view.canal_meshes import TriangleMesh, canal_rings, canal_skin, dashes, merge, tube

_RED, _BLUE, _BLACK, _GREEN, _SKIN, _GREY = 0xD62020, 0x1540E0, 0x202020, 0x1C9A3C, 0x4A90D9, 0x9A9A9A
_AXIS_M = 0.05
_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<style>body {{ margin: 0; font: 14px sans-serif; }}
#meshcat-pane {{ width: 100vw; height: 100vh; overflow: hidden; }}
#about {{ position: fixed; left: 12px; bottom: 10px; background: #ffffffcc; padding: 6px 10px; border-radius: 6px; }}
b {{ font-weight: 600; }}</style></head>
<body><div id="meshcat-pane"></div><div id="about">{about}</div>
<script>{viewer}</script>
<script>var viewer = new MeshCat.Viewer(document.getElementById("meshcat-pane"));
{commands}</script></body></html>
"""


class _Commands:
    """Stands for a window of the meshcat package: keeps what would be sent to a browser."""

    def __init__(self) -> None:
        self.packed: list[bytes] = []

    def send(self, command) -> None:
        import umsgpack  # type: ignore[import-untyped]

        self.packed.append(umsgpack.packb(command.lower()))


def canal_page(
    canal: CanalSurface,
    *,
    recorded: Sequence[np.ndarray] = (),
    path: np.ndarray | None = None,
    corrections: Sequence[np.ndarray] = (),
    title: str = "canal",
) -> str:
    """One HTML page with the canal in it, that needs nothing else.

    Args:
        canal: the surface.
        recorded: positions of the demonstrations as recorded, each (N, 3), [m]; the aligned ones if empty.
        path: positions that were travelled, (T, 3), [m].
        corrections: parts of the path on which a thumb corrected, each (k, 3), [m].
        title: of the page.
    """
    import html

    import meshcat
    import meshcat.geometry as g
    from meshcat.servers.zmqserver import VIEWER_ROOT, create_command

    commands = _Commands()
    scene = meshcat.Visualizer(window=commands)

    def draw(name: str, mesh: TriangleMesh, color: int, opacity: float = 1.0) -> None:
        geometry = g.TriangularMeshGeometry(mesh.vertices.T, mesh.faces.T)
        scene[name].set_object(geometry, g.MeshLambertMaterial(color=color, opacity=opacity))

    disks = np.unique(np.linspace(0, canal.n_disks - 1, 140).round().astype(int))
    draw("canal/surface", canal_skin(canal, disks), _SKIN, 0.25)
    draw("canal/disks", canal_rings(canal, disks[::3], 0.0008), _BLACK)
    draw("canal/directrix", dashes(canal.directrix, 0.003, 0.015, 0.012), _BLUE)
    for k, curve in enumerate(recorded or canal.demonstrations):
        draw(f"demonstrations/{k}", tube(_thinned(curve), 0.002), _RED)
    for name, axes, color in (("x", canal.x_axes, _RED), ("y", canal.y_axes, _GREEN)):
        arrows = [tube(np.stack([c, c + _AXIS_M * a]), 0.0012) for c, a in zip(canal.directrix, axes, strict=True)]
        draw(f"canal/correction axes/{name}", merge(arrows[:: max(1, canal.n_disks // 40)]), color)
    if path is not None:
        draw("path", tube(_thinned(path), 0.003), _GREEN)
    for k, curve in enumerate(corrections):
        draw(f"corrections/{k}", tube(_thinned(curve), 0.0045), _BLUE)
    for k, plane in enumerate(canal.support_planes):
        draw(f"planes/{k}", _patch(canal, np.array(plane.normal), plane.offset), _GREY, 0.4)
    scene["/Background"].set_property("top_color", [0.95, 0.96, 0.98])
    scene["/Background"].set_property("bottom_color", [1.0, 1.0, 1.0])
    for name in ("/Grid", "/Axes"):  # the viewer's own, which would lie at the canal's middle
        scene[name].set_property("visible", False)
    _look_at(scene, canal)

    viewer = (Path(VIEWER_ROOT) / "main.min.js").read_text(encoding="utf-8")
    return _PAGE.format(
        title=html.escape(title),
        about=f"<b>{html.escape(title)}</b> · demonstrations red, directrix dotted blue, disks black, "
        "correction axes x red, y green · drag to turn, scroll to zoom",
        viewer=viewer.replace("</script", "<\\/script"),
        commands="".join(create_command(packed) for packed in commands.packed),
    )


def write_html(output: str | os.PathLike, page: str) -> None:
    """Write a page by way of a temporary file.

    Args:
        output: the file, `.html`.
        page: its whole text.
    """
    write_and_rename(Path(output), lambda stream: stream.write(page.encode("utf-8")))


def serve(page: str, port: int = 0) -> ThreadingHTTPServer:
    """A server on localhost that shows one page; run it with `serve_forever`.

    Args:
        page: the whole text of the page.
        port: TCP port on localhost; 0 picks a free one.

    Raises:
        InputError: the port is taken.
    """
    body = page.encode("utf-8")

    class OnePage(BaseHTTPRequestHandler):
        """Answers with the page, whatever is asked for."""

        def do_GET(self) -> None:
            """Send the page."""
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args) -> None:
            """Say nothing."""

    try:
        return ThreadingHTTPServer(("127.0.0.1", port), OnePage)
    except (OSError, OverflowError):
        raise InputError(f"port {port} on localhost cannot be used; give a free one, or 0 for any") from None


def _thinned(curve: np.ndarray, spacing: float = 0.004) -> np.ndarray:
    """A polyline at most as dense as the eye needs; at least two points. Shape (k, 3)."""
    curve = np.asarray(curve, dtype=float)
    arc = length_along(curve)
    keep = np.unique(np.searchsorted(arc, np.arange(0.0, arc[-1], spacing)))
    return curve[np.unique(np.concatenate([[0], keep, [len(curve) - 1]]))]


def _patch(canal: CanalSurface, normal: np.ndarray, offset: float) -> TriangleMesh:
    """The part of a plane near the canal."""
    across = np.linalg.svd(normal[None])[2][1:]
    along = canal.directrix @ across.T
    low, high = along.min(axis=0) - 0.2, along.max(axis=0) + 0.2
    corners = [low, [high[0], low[1]], high, [low[0], high[1]]]
    points = np.array([offset * normal + np.asarray(corner) @ across for corner in corners])
    return TriangleMesh(points.T, np.array([[0, 0], [1, 2], [2, 3]], dtype=np.int32))


def _look_at(scene, canal: CanalSurface) -> None:
    """Put the canal's middle at the viewer's centre, and the eye before it."""
    low, high = canal.directrix.min(axis=0), canal.directrix.max(axis=0)
    middle, size = 0.5 * (low + high), float(np.linalg.norm(high - low))
    # The viewer turns about its origin, with y up: x, y, z of the scene are x, -z, y of the viewer.
    shift = np.eye(4)
    shift[:3, 3] = -middle
    scene.set_transform(shift)
    scene["/Cameras/default/rotated/<object>"].set_property("position", [0.75 * size, 0.4 * size, 0.45 * size])
