"""Models that a scenario brings along: what one must be, asked before anything is built from it."""

from __future__ import annotations

import json
import logging
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from pydrake.geometry import SceneGraph
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from canal.errors import InputError
from diagrams.geometry.bounds import BodyBounds, extent

ENDINGS = (".sdf", ".urdf")
LARGEST_FILE = 64 * 2**20
"""[bytes] Of a model or a mesh."""
LARGEST_MASS_KG, LARGEST_ITEM_M, LARGEST_FIXTURE_M = 100.0, 2.0, 100.0
"""More than the Lio weighs, than it reaches, than it drives to: what exceeds these was given in other units."""
POSITIVE = ("size", "radius", "length")
"""Of shapes, in SDFormat and URDF."""


def check_model(path: Path, folders: Sequence[Path], *, carried: bool) -> None:
    """Whether a file describes one body that can be touched, and, if it is carried, that has a mass.

    Args:
        path: an SDFormat or URDF file.
        folders: it, and whatever it names, must lie in one of these.
        carried: whether the robot is to carry it; else it is welded to the world.

    Raises:
        InputError: says what is wrong, and what would be right.
    """
    if path.suffix.lower() not in ENDINGS:
        raise InputError(f"{path.name} is no model; give an SDFormat file (.sdf) or a URDF (.urdf)")
    _check_paths(path, [folder.resolve() for folder in folders], set())
    _check_numbers(path)
    plant = MultibodyPlant(time_step=0.0)
    scene_graph = SceneGraph()
    plant.RegisterAsSourceForSceneGraph(scene_graph)
    log = logging.getLogger("drake")
    level = log.level
    log.setLevel(logging.ERROR)  # its warnings come when the scene is built
    try:
        models = Parser(plant).AddModels(str(path))
    except (RuntimeError, ValueError, SystemExit) as error:
        words = " ".join(str(error).replace(f"{path.parent}/", "").split()).removeprefix("error: ")
        raise InputError(f"{path.name} cannot be read ({words}); mend the file") from None
    finally:
        log.setLevel(level)
    bodies = [body for model in models for body in plant.GetBodyIndices(model)]
    if len(models) != 1 or len(bodies) != 1:
        raise InputError(f"{path.name} has {len(models)} models with {len(bodies)} bodies; give one of one body")
    joints = plant.num_joints()
    if joints:
        raise InputError(f"{path.name} is joined or welded to something; give a body without joints, not static")
    body = plant.get_body(bodies[0])
    inspector = scene_graph.model_inspector()
    shapes = [e for g in plant.GetCollisionGeometriesForBody(body) if (e := extent(inspector, g)) is not None]
    if not shapes:
        raise InputError(f"{path.name} has no collision shape of finite size; give it at least one")
    reach, most = (
        np.abs(BodyBounds([shapes])([RigidTransform()])).max(),
        LARGEST_ITEM_M if carried else LARGEST_FIXTURE_M,
    )
    if not reach <= most:
        raise InputError(f"{path.name} reaches {reach:g} m from its origin; give at most {most:g}")
    if carried and not body.default_mass() <= LARGEST_MASS_KG:
        raise InputError(f"{path.name} has a mass of {body.default_mass():g} kg; give at most {LARGEST_MASS_KG:g}")


def _elements(path: Path) -> list[tuple[str, ET.Element]]:
    """All elements of a model's file, with their names."""
    text = path.read_text(encoding="utf-8", errors="replace")
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{path.name} defines entities; write them out")
    try:
        return [(element.tag.rpartition("}")[2], element) for element in ET.fromstring(text.encode()).iter()]
    except ET.ParseError as error:
        raise InputError(f"{path.name} cannot be read as XML ({error}); mend the file") from None


def _check_numbers(path: Path) -> None:
    """Refuse masses, inertias and sizes that cannot be: the parser takes others in their place, with a warning."""
    for tag, element in _elements(path):
        if tag == "inertia":
            xx, yy, zz, xy, xz, yz = (_number(element, key) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
            matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            moments = np.linalg.eigvalsh(matrix) if np.isfinite(matrix).all() else np.full(3, np.nan)
            if not (moments[0] > 0 and moments[0] + moments[1] >= 0.999 * moments[2]):
                raise InputError(
                    f"{path.name} has the moments of inertia {', '.join(f'{m:g}' for m in moments)} kg m²; give three "
                    "above 0, none larger than the two others together"
                )
        for key, value in ((tag, element.text), *element.attrib.items()):
            if key not in POSITIVE and not (tag == "mass" and key in ("mass", "value")):
                continue
            if value and value.strip() and not all(0 < number < np.inf for number in _numbers(value)):
                raise InputError(f"{path.name} has {tag} {value.strip()!r}; give finite numbers above 0")


def _numbers(text: str) -> list[float]:
    try:
        return [float(word) for word in text.split()]
    except ValueError:
        return [np.nan]


def _number(element: ET.Element, key: str) -> float:
    """Of a child (SDFormat) or an attribute (URDF); 0 where there is neither."""
    (number, *_) = _numbers(element.findtext(key) or element.get(key) or "0") or [np.nan]
    return number


def _check_paths(path: Path, folders: Sequence[Path], seen: set[Path]) -> None:
    """Refuse a file outside the folders, and any outside that it names."""
    real = path.resolve()
    if real in seen:
        return
    seen.add(real)
    if not any(real.is_relative_to(folder) for folder in folders):
        where = " or ".join(dict.fromkeys(map(str, folders)))
        raise InputError(f"{path} is outside the scenario's folder and models/; put it into {where}")
    if not path.is_file():
        raise InputError(f"{path} does not exist; put it there")
    if path.stat().st_size > LARGEST_FILE:
        raise InputError(f"{path.name} has {path.stat().st_size} bytes; give at most {LARGEST_FILE}")
    for name in _named_files(path):
        if ":" in name:
            raise InputError(f"{path.name} names {name!r}; name a file relative to it")
        _check_paths(path.parent / name, folders, seen)


def _named_files(path: Path) -> Iterator[str]:
    """The files that a model, a mesh or a material names."""
    kind = path.suffix.lower()
    if kind not in (*ENDINGS, ".obj", ".mtl", ".gltf"):
        return
    text = path.read_text(encoding="utf-8", errors="replace")
    if kind in ENDINGS:
        for tag, element in _elements(path):
            if (tag.endswith(("uri", "filename", "_map")) or tag == "file") and element.text and element.text.strip():
                yield element.text.strip()
            yield from (value for key, value in element.attrib.items() if key in ("filename", "uri"))
    elif kind == ".gltf":
        try:
            document = json.loads(text)
            uris = [part["uri"] for key in ("buffers", "images") for part in document.get(key, []) if "uri" in part]
        except (ValueError, TypeError, AttributeError, KeyError, RecursionError):
            raise InputError(f"{path.name} cannot be read as glTF; mend the file") from None
        yield from (str(uri) for uri in uris if not str(uri).startswith("data:"))
    else:  # a line `mtllib NAME` or `map_Kd [OPTIONS] NAME`
        yield from re.findall(r"^\s*(?:mtllib|map_\w+|bump|disp|decal|norm)\s+(?:\S+\s+)*?(\S+)\s*$", text, re.M)
