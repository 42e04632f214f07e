"""Canal files: one `.npz`, bit for bit, checked as geometry when it is read."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from canal.errors import InputError
from canal.files import write_npz
from canal.learning.trimming import continuous_signs
from canal.learning_options import MEASURED, LearningOptions, from_json, to_json
from canal.reading import as_numbers, read_npz
from canal.support_planes import SupportPlane
from canal.surface import CanalSurface

FORMAT_VERSION = 1
"""Of the files that are written; later ones are refused."""
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
OPTIONAL_SHAPES = {"ellipses": ("N", 3), "x_global": (3,), "support_planes": ("k", 4)}
"""Of the arrays that a file may have; k support planes."""
SCALARS, TEXTS = ("moving_time_s", "format_version"), ("warnings", "options")
KEYS = (*SHAPES, *OPTIONAL_SHAPES, *SCALARS, *TEXTS)
"""Of a canal file."""
TOLERANCE = 1e-4  # of unit length and right angles: files of single floats have 1e-7
FURTHEST_M = 100.0  # no arm's canal is so long, or so far from its base
SHORTEST_M = 1e-4  # below this all disks coincide
HEAVIEST = 1e6  # an orientation weight beyond this leaves the position nothing: w_p is 100
_UNIT = ("tangents", "normals", "x_axes", "y_axes", "orientations", "demonstration_orientations")
_AGAIN = "make the file again with learn -o"


Path = str | os.PathLike[str]
"""Whatever names a file."""


def save_canal(path: Path, canal: CanalSurface) -> None:
    """Write a canal by way of a temporary file; `load_canal` gives it back bit for bit.

    Args:
        path: of the `.npz`.
        canal: any.

    Raises:
        InputError: the file cannot be written.
    """
    write_npz(path, **canal_arrays(canal))


def canal_arrays(canal: CanalSurface) -> dict[str, np.ndarray]:
    """The arrays of a canal file, by their keys."""
    arrays = {key: getattr(canal, key) for key in SHAPES}
    arrays["moving_time_s"] = np.array(canal.moving_time_s)
    arrays["format_version"] = np.array(FORMAT_VERSION)
    arrays["x_global"] = canal.x_global
    arrays["support_planes"] = np.array([(*p.normal, p.offset) for p in canal.support_planes]).reshape(-1, 4)
    arrays["warnings"] = np.array(canal.warnings, dtype=np.str_)
    arrays["options"] = np.array(to_json(canal.options))
    if canal.ellipses is not None:
        arrays["ellipses"] = canal.ellipses
    return arrays


def load_canal(path: Path) -> CanalSurface:
    """Read a canal written by `save_canal`, or by any program that writes the documented arrays.

    Raises:
        InputError: it is not a canal file, with what is missing or wrong.
    """
    return canal_of(path, read_npz(path, "a canal (.npz)", KEYS))


def canal_of(path: Path, arrays: dict[str, np.ndarray]) -> CanalSurface:
    """The canal in the arrays of a file.

    Args:
        path: the file, for messages.
        arrays: those among `KEYS` that it has.

    Raises:
        InputError: they are none of a canal, with what is missing or wrong.
    """
    missing = [key for key in (*SHAPES, "moving_time_s") if key not in arrays]
    if missing:
        raise InputError(f"{path}: is no canal file, it lacks {', '.join(missing)}; make one with learn -o")
    warnings, learned = (arrays.get(key, np.empty(0, dtype=np.str_)) for key in TEXTS)
    numbers = {key: as_numbers(array, f"{path}: {key}") for key, array in arrays.items() if key not in TEXTS}
    for key in SCALARS:
        if key in numbers and (numbers[key].shape != () or not numbers[key] > 0 or np.isinf(numbers[key])):
            raise InputError(f"{path}: {key} must be one positive number; {_AGAIN}")
    version = float(numbers.pop("format_version", np.array(FORMAT_VERSION)))
    if version > FORMAT_VERSION:
        raise InputError(f"{path}: format {version:g}, this program reads up to {FORMAT_VERSION}; update it")
    _check_shapes(path, numbers)
    _check_geometry(path, numbers)
    for key in ("orientations", "demonstration_orientations"):  # q and -q are one rotation, but not half-way between
        rows = numbers[key].reshape(-1, *numbers[key].shape[-2:])
        numbers[key] = np.stack([continuous_signs(row) for row in rows]).reshape(numbers[key].shape)
    planes = numbers.get("support_planes", np.empty((0, 4))).tolist()
    more: dict[str, Any] = {key: numbers[key] for key in ("ellipses", "x_global") if key in numbers}
    return CanalSurface(
        **{key: numbers[key] for key in SHAPES},
        moving_time_s=float(numbers["moving_time_s"]),
        support_planes=tuple(SupportPlane((a, b, c), d) for a, b, c, d in planes),
        warnings=tuple(str(line) for line in warnings.ravel()),
        options=_options(path, learned),
        **more,
    )


def _options(path: Path, learned: np.ndarray) -> LearningOptions:
    """The options in a file; the defaults in one that has none, made elsewhere or before files had them."""
    try:
        return from_json(str(learned[()])) if learned.size == 1 else MEASURED
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _check_shapes(path: Path, numbers: dict[str, np.ndarray]) -> None:
    sizes = {"N": numbers["directrix"].shape[:1], "n": numbers["demonstrations"].shape[:1]}
    sizes["k"] = numbers.get("support_planes", np.empty((0, 4))).shape[:1]
    if sizes["N"] and (sizes["N"][0] < 3 or sizes["N"][0] % 2 == 0):
        raise InputError(f"{path}: {sizes['N'][0]} disks; a canal has an odd number of at least 3")
    if sizes["n"] == (0,):
        raise InputError(f"{path}: demonstrations has none in it; {_AGAIN}")
    for key, shape in (SHAPES | OPTIONAL_SHAPES).items():
        if key not in numbers:
            continue
        wanted = tuple((sizes[side] or (side,))[0] if isinstance(side, str) else side for side in shape)
        if numbers[key].shape != wanted:
            raise InputError(f"{path}: {key} has shape {numbers[key].shape}; it must be {wanted}")
        if not np.isfinite(numbers[key]).all():
            raise InputError(f"{path}: {key} is not finite; {_AGAIN}")


def _check_geometry(path: Path, numbers: dict[str, np.ndarray]) -> None:
    """Unit vectors unit, frames orthogonal, lengths, spreads and weights no less than 0, all within a room."""
    for key in _UNIT:
        off = np.abs(np.linalg.norm(numbers[key], axis=-1) - 1.0)
        if off.max() > TOLERANCE:
            s = int(np.argmax(off.reshape(-1, off.shape[-1]).max(axis=0)))
            raise InputError(f"{path}: {key} is not of unit length at disk {s}; {_AGAIN}")
    for a, b in (("x_axes", "y_axes"), ("normals", "x_axes"), ("normals", "y_axes")):
        cosine = np.abs(np.sum(numbers[a] * numbers[b], axis=1))
        if cosine.max() > TOLERANCE:
            raise InputError(f"{path}: {a} and {b} are not at right angles at disk {int(np.argmax(cosine))}; {_AGAIN}")
    bounds = {"radii": FURTHEST_M, "orientation_sd": 2.0, "orientation_weights": HEAVIEST}
    for key, most in bounds.items():
        bad = (numbers[key] < 0) | (numbers[key] > most)
        if bad.any():
            s = int(np.argmax(bad))
            raise InputError(
                f"{path}: {key} is {numbers[key][s]:g} at disk {s}; it must lie in [0, {most:g}]; {_AGAIN}"
            )
    for key in ("directrix", "demonstrations"):
        if np.abs(numbers[key]).max() > FURTHEST_M:
            raise InputError(f"{path}: {key} reaches {np.abs(numbers[key]).max():.4g} m; give metres; {_AGAIN}")
    length = float(np.sum(np.linalg.norm(np.diff(numbers["directrix"], axis=0), axis=1)))
    if length < SHORTEST_M:
        raise InputError(f"{path}: directrix is {1e3 * length:.2g} mm long; {_AGAIN}")
    if "ellipses" in numbers and (numbers["ellipses"][:, :2] < 0).any():
        raise InputError(f"{path}: ellipses has semi-axes below 0; {_AGAIN}")
    if "x_global" in numbers and np.linalg.norm(numbers["x_global"]) < TOLERANCE:
        raise InputError(f"{path}: x_global is zero; give a direction")
