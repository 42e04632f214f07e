"""A canal drawn in Meshcat: its surface, every few disks as rings, the directrix and the demonstrations."""

from __future__ import annotations

import numpy as np
from pydrake.geometry import Meshcat, Rgba
from pydrake.math import RigidTransform

from canal.surface import CanalSurface
from diagrams.view import canal_meshes as meshes
from diagrams.view.canal_meshes import TriangleMesh

SURFACE = Rgba(0.16, 0.52, 0.78, 0.16)
RINGS = Rgba(0.13, 0.33, 0.52, 0.45)
DIRECTRIX = Rgba(0.08, 0.20, 0.62, 1.0)
DEMONSTRATIONS = Rgba(0.80, 0.20, 0.18, 0.5)
"""Colours: the canal cool, what was shown red."""

COLORED_OPACITY = 0.24
"""Of the surface when its disks have colours, which have to be told apart."""
GLOW = 0.12
"""Share of its colour that a marker has without any lamp."""

MOST_RINGS, RING_EVERY = 97, 3
"""The surface is drawn through this many rims at most, and every third of them as a ring."""


class CanalDrawing:
    """Draws under one path of Meshcat; it keeps nothing of what it has drawn."""

    def __init__(self, meshcat: Meshcat, path: str) -> None:
        """Draw under `path`."""
        self._meshcat, self._path = meshcat, path

    def clear(self, X_WB: RigidTransform) -> None:
        """Begin anew.

        Args:
            X_WB: pose of the robot's base, in whose frame all is drawn.
        """
        self._meshcat.Delete(self._path)
        self._meshcat.SetTransform(self._path, X_WB)

    def draw(self, canal: CanalSurface, disk_colors: np.ndarray | None = None) -> None:
        """Draw a canal.

        Args:
            canal: in the robot's base frame.
            disk_colors: red, green and blue in [0, 1] for each disk. Shape (N, 3). None: one colour.
        """
        disks = np.unique(np.linspace(0, canal.n_disks - 1, min(canal.n_disks, MOST_RINGS)).astype(int))
        skin = meshes.canal_skin(canal, disks)
        rings = meshes.canal_rings(canal, disks[::RING_EVERY], 0.0008)
        if disk_colors is None:
            self.mesh("surface", skin, SURFACE, closed=False)
            self.mesh("rings", rings, RINGS)
        else:
            surface = f"{self._path}/surface"
            self._colored_mesh("surface", skin, disk_colors[disks])
            self._meshcat.SetProperty(f"{surface}/<object>", "opacity", COLORED_OPACITY)
            self._see_through(surface)
            # The skin is too clear for its colour to be seen at a glance.
            self._colored_mesh("rings", rings, disk_colors[disks[::RING_EVERY]])
        self.mesh("directrix", meshes.dashes(canal.directrix, 0.0025, 0.014, 0.010), DIRECTRIX)
        lines = [meshes.tube(demonstration[disks], 0.001, 4) for demonstration in canal.demonstrations]
        self.mesh("demonstrations", meshes.merge(lines), DEMONSTRATIONS)

    def mesh(self, name: str, mesh: TriangleMesh, rgba: Rgba, *, closed: bool = True) -> None:
        """Draw triangles.

        Args:
            name: below the path.
            mesh: what.
            rgba: its colour.
            closed: whether it is a body that nobody sees into.
        """
        path = f"{self._path}/{name}"
        # Both sides of a translucent face cost two passes, and nobody sees into a closed body.
        side = Meshcat.SideOfFaceToRender.kFrontSide if closed else Meshcat.SideOfFaceToRender.kDoubleSide
        self._meshcat.SetTriangleMesh(path, mesh.vertices, mesh.faces, rgba, side=side)
        self.set_apart(name, rgba)
        if rgba.a() < 1:
            self._see_through(path)

    def set_apart(self, name: str, rgba: Rgba) -> None:
        """What is drawn into the room for explanation is not in it: it casts no shadow, and shines by itself.

        Args:
            name: below the path.
            rgba: its colour.
        """
        path = f"{self._path}/{name}"
        self._meshcat.SetProperty(f"{path}/<object>", "castShadow", False)
        for channel, value in zip("rgb", (rgba.r(), rgba.g(), rgba.b()), strict=True):
            self._meshcat.SetProperty(f"{path}/<object>", f"material.emissive.{channel}", GLOW * value)

    def _see_through(self, path: str) -> None:
        # Else a translucent face hides the translucent ones behind it.
        self._meshcat.SetProperty(f"{path}/<object>", "material.depthWrite", False)

    def _colored_mesh(self, name: str, mesh: TriangleMesh, colors: np.ndarray) -> None:
        """Draw a mesh that has as many vertices for each disk, in the colours of the disks (n, 3)."""
        each = np.repeat(colors, mesh.vertices.shape[1] // len(colors), axis=0)
        self._meshcat.SetTriangleColorMesh(f"{self._path}/{name}", mesh.vertices, mesh.faces, each.T)
        self._meshcat.SetProperty(f"{self._path}/{name}/<object>", "castShadow", False)
