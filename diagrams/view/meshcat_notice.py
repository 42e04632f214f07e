"""A line of text in the Meshcat page, which knows no text: a picture of it on a board that faces the eye."""

from __future__ import annotations

import base64
import hashlib
import io
import json
import textwrap

import numpy as np
from pydrake.common import MemoryFile
from pydrake.geometry import InMemoryMesh, Mesh, Meshcat
from pydrake.math import RigidTransform, RotationMatrix

from diagrams.view.meshcat_page import CAMERA

BOARD = (0.12, 0.23, 1.28)
"""[m] Middle of the board in the robot's base frame B, above the work space and below the upper edge of the picture."""
WIDTH_M = 1.7
LETTERS = 70
"""In a line of it."""
PIXELS = 1400, 44
"""Width of the picture, and height of a line in it."""


class MeshcatNotice:
    """Shows one text at a time. Which one is told by the caller, so that nothing is kept here."""

    def __init__(self, meshcat: Meshcat, X_WB: RigidTransform, path: str = "notice") -> None:
        """Show texts in `meshcat` under `path`; the robot's base stands at `X_WB`."""
        self._meshcat = meshcat
        self._path = path
        away = np.subtract(BOARD, CAMERA)
        side = np.array([away[1], -away[0], 0.0]) / np.hypot(away[0], away[1])
        away = away / np.linalg.norm(away)
        X_BN = RigidTransform(RotationMatrix(np.column_stack([side, away, np.cross(side, away)])), BOARD)
        self._X_WN = X_WB.multiply(X_BN)

    def show(self, before: str, text: str, time: float) -> None:
        """Take the text `before` away and show `text` instead, at `time` [s]; empty ones are no text.

        Args:
            before: text that is shown now.
            text: that is to be shown.
            time: when, [s].
        """
        if before and self._meshcat.HasPath(self._path_of(before)):
            self._meshcat.SetProperty(self._path_of(before), "visible", False, time)
        if not text:
            return
        path = self._path_of(text)
        if not self._meshcat.HasPath(path):
            board = InMemoryMesh(mesh_file=MemoryFile(_board(text), ".gltf", "notice"))
            self._meshcat.SetObject(path, Mesh(mesh_data=board))
            self._meshcat.SetTransform(path, self._X_WN)
            self._meshcat.SetProperty(path, "visible", False, 0.0)
        self._meshcat.SetProperty(path, "visible", True, time)

    def _path_of(self, text: str) -> str:
        return f"{self._path}/{hashlib.sha256(text.encode()).hexdigest()[:12]}"


def _board(text: str) -> str:
    """A rectangle with the text on it as glTF, x to the right and y up, its middle at the origin."""
    lines = textwrap.wrap(text, LETTERS)
    half, up = WIDTH_M / 2, WIDTH_M / 2 * PIXELS[1] * len(lines) / PIXELS[0]
    corners = np.array([[-half, -up, 0], [half, -up, 0], [half, up, 0], [-half, up, 0]], dtype="<f4")
    picture = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], dtype="<f4")
    faces = np.array([0, 1, 2, 0, 2, 3], dtype="<u2")
    data = corners.tobytes() + picture.tobytes() + faces.tobytes()
    views, offset = [], 0
    for part in (corners, picture, faces):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": part.nbytes})
        offset += part.nbytes
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "extensionsUsed": ["KHR_materials_unlit"],
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
            "materials": [
                {
                    "doubleSided": True,
                    "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0},
                    "extensions": {"KHR_materials_unlit": {}},
                }
            ],
            "textures": [{"source": 0}],
            "images": [{"uri": f"data:image/png;base64,{base64.b64encode(_picture(lines)).decode()}"}],
            "buffers": [
                {
                    "byteLength": len(data),
                    "uri": f"data:application/octet-stream;base64,{base64.b64encode(data).decode()}",
                }
            ],
            "bufferViews": views,
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": 4,
                    "type": "VEC3",
                    "min": corners.min(axis=0).tolist(),
                    "max": corners.max(axis=0).tolist(),
                },
                {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
            ],
        }
    )


def _picture(lines: list[str]) -> bytes:
    """The lines as a PNG: dark on yellow, as signs are."""
    from PIL import Image, ImageDraw, ImageFont  # of the films, and dear to import where nothing is to be said

    width, height = PIXELS
    image = Image.new("RGB", (width, height * len(lines)), (255, 224, 120))
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(size=0.8 * height)
    for k, line in enumerate(lines):
        draw.text((width / 2, (k + 0.5) * height), line, fill=(40, 30, 10), font=font, anchor="mm")
    stream = io.BytesIO()
    image.save(stream, "PNG")
    return stream.getvalue()
