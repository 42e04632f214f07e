"""Canal files: one `.npz`, bit for bit."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from canal.errors import InputError
from canal.files import read_npz, write_npz
from canal.refinement import SupportPlane

if TYPE_CHECKING:
    from canal.surface import CanalSurface

FORMAT_VERSION = 1
SHAPES = {  # of the arrays every file has; N disks, n demonstrations
    "directrix": ("N", 3),
    "radii": ("N",),
    "tangents": ("N", 3),
    "normals": ("N", 3),
    "x_axes": ("N", 3),
    "y_axes": ("N", 3),
    "orientations": ("N", 4),
    "orientation_sd": ("N",),
    "orientation_weights": ("N",),
    "demonstrations": ("n", "N", 3),
    "demonstration_orientations": ("n", "N", 4),
}


def save_canal(canal: CanalSurface, path: str | os.PathLike) -> None:
    """Write a canal by way of a temporary file."""
    arrays = {key: getattr(canal, key) for key in SHAPES}
    arrays["moving_time_s"] = np.array(canal.moving_time_s)
    arrays["format_version"] = np.array(FORMAT_VERSION)
    arrays["x_global"] = canal.x_global
    arrays["support_planes"] = np.array([(*p.normal, p.offset) for p in canal.support_planes]).reshape(-1, 4)
    arrays["warnings"] = np.array(canal.warnings, dtype=np.str_)
    if canal.ellipses is not None:
        arrays["ellipses"] = canal.ellipses
    write_npz(path, **arrays)


def read_canal_fields(path: str | os.PathLike) -> dict:
    """The fields of a `CanalSurface` from a file.

    Raises:
        InputError: it is not a canal file, with what is missing or wrong.
    """
    arrays = read_npz(Path(path), "a canal")
    missing = [key for key in (*SHAPES, "moving_time_s") if key not in arrays]
    if missing:
        raise InputError(f"{path}: is no canal file, it lacks {', '.join(missing)}; make one with learn -o")
    version = int(arrays.get("format_version", FORMAT_VERSION))
    if version > FORMAT_VERSION:
        raise InputError(f"{path}: format {version}, this program reads up to {FORMAT_VERSION}; update it")
    sizes = {"N": len(np.atleast_1d(arrays["directrix"])), "n": len(np.atleast_1d(arrays["demonstrations"]))}
    if sizes["N"] < 3 or sizes["N"] % 2 == 0:
        raise InputError(f"{path}: {sizes['N']} disks; a canal has an odd number of at least 3")
    shapes: dict[str, tuple] = {**SHAPES, "moving_time_s": ()}
    shapes |= {key: shape for key, shape in (("ellipses", ("N", 3)), ("x_global", (3,))) if key in arrays}
    for key, shape in shapes.items():
        wanted = tuple(sizes[side] if isinstance(side, str) else side for side in shape)
        if arrays[key].shape != wanted or not np.issubdtype(arrays[key].dtype, np.number):
            raise InputError(f"{path}: {key} has shape {arrays[key].shape}; it must be {wanted}, numbers")
        if not np.isfinite(arrays[key]).all():
            raise InputError(f"{path}: {key} is not finite; make the file again with learn -o")
    if arrays["moving_time_s"] <= 0 or (arrays["radii"] < 0).any():
        raise InputError(f"{path}: moving_time_s and radii must be positive; make the file again with learn -o")
    planes = arrays.get("support_planes", np.empty((0, 4)))
    return {key: arrays[key] for key in SHAPES} | {
        "moving_time_s": float(arrays["moving_time_s"]),
        "ellipses": arrays.get("ellipses"),
        "support_planes": tuple(SupportPlane((a, b, c), d) for a, b, c, d in planes.tolist()),
        "x_global": arrays.get("x_global"),
        "warnings": tuple(str(line) for line in arrays.get("warnings", ())),
    }
