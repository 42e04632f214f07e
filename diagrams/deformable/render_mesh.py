"""What cameras see of a deformable item: its fine surface, which Drake's renderer carries along with the solid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from diagrams.deformable.laundry import DeformableShape
from diagrams.deformable.tet_mesh import TetMesh, embed

SHADES = 8
"""Steps of each colour channel: a material a colour, since the renderer knows no colours of corners."""
LEAST = 1e-4
"""Barycentric coordinate of a corner that counts as inside: the renderer refuses corners outside the solid."""


def write_render_mesh(shape: DeformableShape, path: Path) -> None:
    """Write the surface of an item at rest, in its frame, as Wavefront OBJ with normals and colours.

    Where the surface stands out of the coarse solid, it is drawn in.

    Args:
        shape: the item at rest.
        path: of the OBJ file.
    """
    surface, triangles = shape.surface, shape.surface.triangles
    points = _drawn_in(shape.mesh, surface.positions(shape.mesh.vertices))
    normals = np.zeros_like(points)
    edges = points[triangles[:, 1:]] - points[triangles[:, :1]]
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], np.cross(edges[:, 0], edges[:, 1]))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    shades = np.round(surface.colors[triangles].mean(axis=1) * SHADES) / SHADES
    colors, of_triangle = np.unique(shades, axis=0, return_inverse=True)
    path.with_suffix(".mtl").write_text(
        "".join(f"newmtl c{k}\nKd {r:.3f} {g:.3f} {b:.3f}\n" for k, (r, g, b) in enumerate(colors))
    )
    lines = [f"mtllib {path.with_suffix('.mtl').name}"]
    lines += ["v {:.6f} {:.6f} {:.6f}".format(*p) for p in points]
    lines += ["vn {:.5f} {:.5f} {:.5f}".format(*n) for n in normals]
    for k in range(len(colors)):
        lines.append(f"usemtl c{k}")
        lines += ["f " + " ".join(f"{i}//{i}" for i in triple + 1) for triple in triangles[of_triangle.ravel() == k]]
    path.write_text("\n".join(lines) + "\n")


def _drawn_in(mesh: TetMesh, points: np.ndarray) -> np.ndarray:
    """Points, and where they lie outside of the solid, the nearest towards its middle that do not. Shape (n, 3)."""
    centers = mesh.vertices[mesh.tetrahedra].mean(axis=1)
    _, near = cKDTree(centers).query(points, k=min(8, len(centers)))
    targets = centers[near].mean(axis=1)
    drawn = points.copy()
    outside = np.arange(len(points))
    for share in np.linspace(0.0, 1.0, 21):
        drawn[outside] = (1.0 - share) * points[outside] + share * targets[outside]
        outside = outside[embed(mesh, drawn[outside])[1].min(axis=1) < LEAST]
        if not len(outside):
            break
    corners, weights = embed(mesh, drawn)  # in a concave place: into the nearest tetrahedron
    weights = np.maximum(weights, LEAST)
    return np.einsum("nk,nkd->nd", weights / weights.sum(axis=1, keepdims=True), mesh.vertices[corners])
