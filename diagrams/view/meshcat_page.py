"""Drake's Meshcat, on this machine only, lit and framed for the task; and how to leave while a browser looks on."""

from __future__ import annotations

import contextlib
import functools
import logging
import os
import secrets
import socket
import sys
from collections.abc import Iterator, Sequence
from typing import NoReturn

import numpy as np
from pydrake.common import use_native_cpp_logging
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.math import RigidTransform

from canal.errors import InputError

CAMERA = (2.4, -1.5, 1.9)
"""[m] Where the eye stands, in the robot's base frame B: in front of it, to its right, taller than the machine."""
TARGET = (0.12, 0.23, 0.43)
"""[m] What the eye looks at, in B: the middle of the work space."""
FIELD_OF_VIEW = 40.0
"""[deg] Vertical; Meshcat's own 75° bends what stands at the edge."""

LOWEST_PORT, HIGHEST_PORT = 1024, 65535
"""Ports that a program without privileges may take."""

DEAF_MS = 10_000
"""[ms] A client that reads nothing for so long is cut off: what it does not take waits in memory, 1 MB a second."""

LAMP = "/Lights/SpotLight/<object>"
LOOK: tuple[tuple[str, str, bool | float | list[float]], ...] = (
    # A light room: white shells and the translucent canal both stand out against it.
    ("/Background/<object>", "top_color", [0.72, 0.80, 0.88]),
    ("/Background/<object>", "bottom_color", [0.95, 0.95, 0.94]),
    ("/Grid", "visible", False),
    ("/Axes", "visible", False),
    # One lamp over the eye's shoulder casts the shadows that show heights; the others only fill.
    ("/Lights/SpotLight", "visible", True),
    (LAMP, "position", [1.2, -1.5, 3.2]),
    (LAMP, "intensity", 5.5),
    (LAMP, "decay", 1.0),
    (LAMP, "angle", 0.85),
    (LAMP, "penumbra", 0.6),
    (LAMP, "castShadow", True),
    (LAMP, "shadow.mapSize.x", 1024.0),
    (LAMP, "shadow.mapSize.y", 1024.0),
    (LAMP, "shadow.radius", 4.0),
    (LAMP, "shadow.bias", -0.0005),
    (LAMP, "shadow.normalBias", 0.01),
    ("/Lights/FillLight/<object>", "intensity", 1.0),
    ("/Lights/FillLight/<object>", "position", [-4.0, -6.0, 8.0]),
    ("/Lights/AmbientLight/<object>", "intensity", 1.2),
    # Each light is paid for at every pixel; a browser without a graphics card notices.
    ("/Lights/PointLightNegativeX", "visible", False),
    ("/Lights/PointLightPositiveX", "visible", False),
)
"""Part of the page, its property, the value."""


def start_meshcat(
    *,
    port: int | None = None,
    X_WB: RigidTransform | None = None,
    camera: Sequence[float] = CAMERA,
    target: Sequence[float] = TARGET,
    hidden: bool = False,
) -> Meshcat:
    """Serve a Meshcat page on localhost, for browsers on this machine.

    Args:
        port: TCP port; None takes the first free one from 7000 on, 0 any free one.
        X_WB: where the robot's base stands; None: at the world's origin.
        camera: where the eye stands, in B [m]. Shape (3,).
        target: what it looks at, in B [m]. Shape (3,).
        hidden: for a recording: at an address that nobody knows, since a single malformed message from any client ends
            a Meshcat with all that it has recorded.

    Returns:
        The Meshcat; `web_url()` is its address. Only the thread that made it may call it.

    Raises:
        InputError: the port is taken or out of range.
    """
    if port is not None and port != 0 and not LOWEST_PORT <= port <= HIGHEST_PORT:
        raise InputError(
            f"port {port} is outside {LOWEST_PORT}..{HIGHEST_PORT}: give one inside, or 0 for any free one"
        )
    _log_without_python()
    params = MeshcatParams(
        # Drake's default listens on every interface.
        host=_secret_host() if hidden else "localhost",
        port=0 if hidden else port,
        initial_properties=[
            MeshcatParams.PropertyTuple(path=path, property=name, value=value) for path, name, value in LOOK
        ],
    )
    try:
        meshcat = Meshcat(params)
    except RuntimeError as error:
        if "DRAKE_ALLOW_NETWORK" in str(error):
            raise InputError("DRAKE_ALLOW_NETWORK forbids Meshcat: unset it, or run with --headless") from error
        which = "every port in 7000..7999 on localhost is" if port is None else f"port {port} on localhost is"
        remedy = "give a free one with --port, or end the program that listens there"
        raise InputError(f"{which} taken: {remedy}") from error
    _cut_off_deaf_clients(meshcat.port())
    meshcat.SetCamera(Meshcat.PerspectiveCamera(fov=FIELD_OF_VIEW, aspect=1.6))
    X_WB = RigidTransform() if X_WB is None else X_WB
    meshcat.SetCameraPose(
        X_WB.multiply(np.asarray(camera, dtype=float)), X_WB.multiply(np.asarray(target, dtype=float))
    )
    return meshcat


@functools.cache
def _log_without_python() -> None:
    """Let Drake write its log itself, errors only.

    Its default hands each line to Python. Meshcat's thread then waits for the interpreter's lock, which the main thread
    holds while it waits for Meshcat: for good, after a few messages from a client that Meshcat complains about.
    """
    logging.getLogger("drake").setLevel(logging.ERROR)  # who sends what Meshcat does not know fills no terminal
    with contextlib.suppress(RuntimeError):  # somebody has set up Drake's log otherwise
        use_native_cpp_logging()


def _secret_host() -> str:
    """One of the 16 million addresses of this machine that Linux has and nobody outside it reaches."""
    host = ".".join(str(n) for n in (127, *(1 + secrets.randbelow(254) for _ in range(3))))
    with socket.socket() as probe:
        try:
            probe.bind((host, 0))
        except OSError:  # other systems have 127.0.0.1 alone
            return "localhost"
    return host


def _cut_off_deaf_clients(port: int) -> None:
    """Have the kernel end each connection to `port` whose client does not read; Meshcat keeps all it cannot send."""
    if not hasattr(socket, "TCP_USER_TIMEOUT"):
        return
    for listener in _listeners(port):
        # Connections inherit it from the socket that they come in by.
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, DEAF_MS)


def _socket(number: int) -> socket.socket:
    """A socket of this process by a copy of its file descriptor; the copy is closed where it is none."""
    copy = os.dup(number)
    try:
        return socket.socket(fileno=copy)
    except OSError:
        os.close(copy)
        raise


def _listeners(port: int) -> Iterator[socket.socket]:
    """This process's sockets that listen at a port."""
    with contextlib.suppress(OSError):  # no /proc
        for name in os.listdir("/proc/self/fd"):
            with contextlib.suppress(OSError), _socket(int(name)) as found:
                if found.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN) and found.getsockname()[1] == port:
                    yield found


def _is_watched(meshcat: Meshcat) -> bool:
    """Whether a browser is connected, or Meshcat has failed, so that its destructor is not to be waited for."""
    try:
        watched = meshcat.GetNumActiveConnections() > 0
        if watched:
            meshcat.Flush()
    except RuntimeError:  # its thread has ended
        return True
    return watched


def leave(status: int, meshcat: Meshcat | None = None, *, at_once: bool = False) -> NoReturn:
    """End the process with `status`; at once even while a browser is connected. Write files before.

    Meshcat's destructor waits for its browsers (10 s); with one connected the process ends without destructors.

    Args:
        status: of the process.
        meshcat: that browsers may be connected to.
        at_once: end without destructors in any case: they take a second or two, while somebody looks on.
    """
    if at_once or (meshcat is not None and _is_watched(meshcat)):
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)
