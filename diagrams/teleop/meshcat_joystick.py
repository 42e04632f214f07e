"""A person's joystick in the Meshcat page: gamepad, keys, and controls on the screen."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.geometry import Meshcat
from pydrake.systems.framework import Context, DiagramBuilder, DiscreteValues, LeafSystem

from canal.navigation.joystick import (
    GRIPPER,
    JOYSTICK_PERIOD,
    JOYSTICK_SIZE,
    K_X,
    K_Y,
    REVERSE,
    START,
    STOP,
    clean_joystick,
)


@dataclass(frozen=True)
class Key:
    """A button in the panel that a key presses too: `axis` of the joystick gets `value`."""

    label: str
    """What the panel shows."""
    code: str
    """The browser's name of the key."""
    axis: int
    """Index in the joystick vector."""
    value: float = 1.0
    """What the axis gets while it is pressed."""


KEYS = (
    Key("→ stick along red x [right arrow]", "ArrowRight", K_X),
    Key("← stick against red x [left arrow]", "ArrowLeft", K_X, -1.0),
    Key("↑ stick along green y [up arrow]", "ArrowUp", K_Y),
    Key("↓ stick against green y [down arrow]", "ArrowDown", K_Y, -1.0),
    Key("Gripper: open or close [G]", "KeyG", GRIPPER),
    Key("Reverse: back along the canal [R]", "KeyR", REVERSE),
    Key("Start; pause, go on [Enter]", "Enter", START),
    Key("Stop: freeze until Start [Space]", "Space", STOP),
)
"""Keys and buttons of the panel; the first four are the stick."""

SLIDERS = ("hold x (red)", "hold y (green)")
"""The stick on the screen, which stays where it is put; a label of the panel has room for some 16 letters."""
SLIDER_STEP = 0.05

CENTRE = ("Centre: both sliders to 0 [C]", "KeyC")
"""Puts the sliders back to 0."""

PAD_BUTTONS = ((0, GRIPPER), (1, REVERSE), (9, START), (8, STOP))
"""Button of a gamepad in the standard mapping (A, B, start, back) → index in the joystick vector."""

CONTROLS = """\
  stick    left stick of a gamepad, or arrow keys: x along the red arrow, y along the green one
  gripper  A (lower button), or G        reverse  B (right button), or R
  start    start, or Enter               stop     back, or Space
While it travels, start pauses it on its disk, and again goes on; stop freezes everything until start.
The same as buttons and sliders under "Open Controls". Click into the picture first: keys go where the mouse clicked."""
"""The controls, for a terminal."""


def read_gamepad(axes: Sequence[float], buttons: Sequence[float], dead_zone: float) -> np.ndarray:
    """Joystick vector of a gamepad in the browsers' standard mapping (left stick, its y pointing down).

    The dead zone is round and the stick starts from 0 at its edge; a stick that is not finite or missing is centred.

    Args:
        axes: of the device, in [-1, 1].
        buttons: of the device, in [0, 1].
        dead_zone: length of the stick below which it rests, in [0, 1).
    """
    joystick = np.zeros(JOYSTICK_SIZE)
    for button, index in PAD_BUTTONS:
        if button < len(buttons):
            joystick[index] = float(buttons[button] > 0.5)
    x, y = axes[:2] if len(axes) >= 2 else (0.0, 0.0)
    norm = math.hypot(x, y)
    if dead_zone < norm < math.inf:
        beyond = (min(norm, 1.0) - dead_zone) / (1.0 - dead_zone)
        joystick[K_X], joystick[K_Y] = beyond * (x / norm), -beyond * (y / norm)
    return joystick


class MeshcatJoystick(LeafSystem):
    """Samples what a person does in the Meshcat page.

    ```
    MeshcatJoystick → joystick (6)
    ```

    - The page reports key presses (with the keyboard's repeats) and never releases: an arrow key pushes the stick
      fully for `nudge_s`, a button's level stays 1 for `hold_s` after its last press, so that a key held down is
      one press.
    - The sliders stay where they are put, until `CENTRE`.
    - A gamepad counts while its page is connected. Meshcat keeps the last reading of a page that closed: when the
      number of pages falls, the gamepad rests until its reading changes; with no page at all everything rests.

    The discrete state is the joystick vector, and the memory that this takes. Events run in the thread that runs the
    simulator, which must be the one that made the Meshcat.
    """

    def __init__(
        self,
        meshcat: Meshcat,
        *,
        dead_zone: float = 0.15,
        nudge_s: float = 0.25,
        hold_s: float = 0.7,
        period: float = JOYSTICK_PERIOD,
    ) -> None:
        """Add the controls to `meshcat`'s panel.

        Args:
            meshcat: the page.
            dead_zone: length of a gamepad's stick below which it rests, in [0, 1); worn sticks rest at up to 0.1. There
                is no other one: whatever this system puts out corrects.
            nudge_s: how long the press of an arrow key lasts [s].
            hold_s: how long the press of a button lasts [s]; above the delay of a keyboard's repeat (0.25 to 0.66 s).
            period: of the samples [s].
        """
        super().__init__()
        self._meshcat = meshcat
        self._dead_zone = dead_zone
        self._last_s = np.array([nudge_s if key.axis < GRIPPER else hold_s for key in KEYS])
        for key in KEYS:
            meshcat.AddButton(key.label, key.code)
        for slider in SLIDERS:
            meshcat.DeleteSlider(slider, strict=False)
            meshcat.AddSlider(slider, -1.0, 1.0, SLIDER_STEP, 0.0)
        meshcat.AddButton(*CENTRE)
        self._joystick = self.DeclareDiscreteState(JOYSTICK_SIZE)
        self._counts = self.DeclareDiscreteState(len(KEYS) + 1)
        self._until = self.DeclareDiscreteState(np.full(len(KEYS), -np.inf))
        self._pages = self.DeclareDiscreteState(1)
        self._stale = self.DeclareDiscreteState(np.full(JOYSTICK_SIZE, np.nan))
        self.DeclareStateOutputPort("joystick", self._joystick)
        self.DeclareInitializationDiscreteUpdateEvent(self._initialize)
        self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._sample)

    @staticmethod
    def AddToBuilder(*, builder: DiagramBuilder, meshcat: Meshcat, name: str = "meshcat_joystick") -> MeshcatJoystick:
        """Add a joystick in `meshcat`'s page to `builder`.

        Args:
            builder: of the diagram that it is added to.
            meshcat: that shows it.
            name: of the system.
        """
        return builder.AddNamedSystem(name, MeshcatJoystick(meshcat))

    def _clicks(self) -> np.ndarray:
        labels = [key.label for key in KEYS] + [CENTRE[0]]
        return np.array([float(self._meshcat.GetButtonClicks(label)) for label in labels])

    def _initialize(self, context: Context, discrete: DiscreteValues) -> None:
        # What was pressed before the run is no command.
        discrete.set_value(self._counts, self._clicks())
        discrete.set_value(self._pages, [float(self._meshcat.GetNumActiveConnections())])

    def _sample(self, context: Context, discrete: DiscreteValues) -> None:
        joystick = self._read_keys(context, discrete) + self._read_pad(context, discrete)
        for index, slider in enumerate(SLIDERS):
            joystick[index] += round(self._meshcat.GetSliderValue(slider) / SLIDER_STEP) * SLIDER_STEP  # exact zeros
        if self._meshcat.GetNumActiveConnections() == 0:
            joystick[:] = 0.0
        discrete.set_value(self._joystick, clean_joystick(joystick))

    def _read_keys(self, context: Context, discrete: DiscreteValues) -> np.ndarray:
        clicks = self._clicks()
        pressed = clicks != context.get_discrete_state(self._counts).value()
        now = context.get_time()
        until = context.get_discrete_state(self._until).value().copy()
        until[pressed[:-1]] = now + self._last_s[pressed[:-1]]
        discrete.set_value(self._counts, clicks)
        discrete.set_value(self._until, until)
        if pressed[-1] or self._meshcat.GetNumActiveConnections() == 0:
            for slider in SLIDERS:
                if self._meshcat.GetSliderValue(slider) != 0.0:
                    self._meshcat.SetSliderValue(slider, 0.0)
        joystick = np.zeros(JOYSTICK_SIZE)
        for key, end in zip(KEYS, until, strict=True):
            if now < end - 1e-9:
                joystick[key.axis] += key.value
        return joystick

    def _read_pad(self, context: Context, discrete: DiscreteValues) -> np.ndarray:
        pages = float(self._meshcat.GetNumActiveConnections())
        pad = self._meshcat.GetGamepad()
        reading = np.zeros(JOYSTICK_SIZE)
        if pad.index is not None:
            reading = read_gamepad(pad.axes, pad.button_values, self._dead_zone)
        stale = context.get_discrete_state(self._stale).value()
        fewer = pages < context.get_discrete_state(self._pages).value()[0]
        if fewer:
            stale = reading
        elif not np.array_equal(stale, reading):
            stale = np.full(JOYSTICK_SIZE, np.nan)
        discrete.set_value(self._pages, [pages])
        discrete.set_value(self._stale, stale)
        return np.zeros(JOYSTICK_SIZE) if np.array_equal(stale, reading) else reading
