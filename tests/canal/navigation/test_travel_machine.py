"""Whatever a thumb, the buttons and the contacts do, in any order, at any rate: what always holds of a travel."""

import math

import numpy as np
import pytest
from canals import canal_above_tables, elliptic_canal, hard_canal, pinched_canal
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule

from canal.navigation import NavigationOptions, disks_per_second, initial_state, step
from canal.navigation.joystick import in_unit_disc
from canal.navigation.pressing import GLANCING
from canal.surface import MIN_RADIUS

CANALS = (
    lambda: pinched_canal(0.1),
    lambda: pinched_canal(0.3),
    lambda: pinched_canal(0.0),
    canal_above_tables,
    lambda: hard_canal(3),
    lambda: hard_canal(5, 3, "hairpin"),
    elliptic_canal,
)
COUNTERS = ("corrections", "backtracks", "correction_time_s", "correction_distance_m", "ignored")
AXIS = st.floats(-1, 1)
FORCES = st.one_of(
    st.just(None), st.tuples(st.floats(1, 1000), AXIS, AXIS, AXIS), st.floats(1, 1000).map(lambda n: (n, 0, 0, 0))
)
BUTTONS = st.tuples(*[st.booleans()] * 4)
REST = (0.0, 0.0)


class Travel(RuleBasedStateMachine):
    """A canal, and what a person and the world do to who travels it."""

    @initialize(
        canal=st.sampled_from(CANALS),
        decay=st.sampled_from(["leg", "paper"]),
        decay_lambda=st.sampled_from([5e-4, 0.1, 3.0]),
        eta_f=st.sampled_from([0.0, 0.3, 1.0]),
        wait=st.booleans(),
        speed_scale=st.sampled_from([0.3, 1.0, 4.0]),
        rate=st.sampled_from([17, 20, 23, 50, 60, 100]),
    )
    def begin(self, canal, decay, decay_lambda, eta_f, wait, speed_scale, rate):
        self.canal = canal()
        self.options = NavigationOptions(
            speed_scale=speed_scale, decay=decay, decay_lambda=decay_lambda, eta_f=eta_f, wait_at_ends=wait
        )
        self.state = initial_state(self.canal)
        self.dt = 1 / rate
        self.alarm, self.force = 0.0, (0.0, 0.0, 0.0)
        self.spacing = float(np.diff(self.canal.arc).max())
        self.hold((0.0, 0.0), (False, False, True, False), 1)

    @rule(stick=st.one_of(st.just(REST), st.tuples(AXIS, AXIS)), buttons=BUTTONS, steps=st.integers(1, 30))
    def hold(self, stick, buttons, steps):
        """The same stick and buttons for a while."""
        for _ in range(steps):
            self.go(in_unit_disc(*stick), buttons)

    @rule(seconds=st.floats(0, 8))
    def let_go(self, seconds):
        """Nobody touches anything."""
        self.hold(REST, (False,) * 4, round(seconds / self.dt))

    @rule(button=st.integers(0, 2), seconds=st.floats(0, 8))
    def press(self, button, seconds):
        """One button, not the stop, and then nothing for a while: this leads far."""
        self.go(REST, tuple(k == button for k in range(4)))
        self.let_go(seconds)

    @rule(force=FORCES)
    def touch(self, force):
        """A contact force rises above its limit, or falls below it."""
        self.alarm, *self.force = force or (0.0, 0.0, 0.0, 0.0)

    @precondition(lambda self: hasattr(self, "state"))
    @rule(stick=st.tuples(AXIS, AXIS))
    def something_helps(self, stick):
        """From here, some button or some direction of the stick moves the robot, as long as it does press."""
        canal, before = self.canal, self.state
        at_end = before.disk in (0, canal.n_disks - 1)
        if at_end and before.alarm and canal.radius(before.disk) < MIN_RADIUS:
            return  # a point, and what there is of a way presses: only the gripper can open
        directions = [(math.cos(a), math.sin(a)) for a in np.arange(8) * math.pi / 4]
        for first in ((), (2,), (1,), (2, 1), (1, 2)):
            for k_x, k_y in (REST, *directions):
                state = before
                for joystick in ([0.0] * 6, *[[0.0] * 2 + [float(k == b) for k in range(4)] for b in first]):
                    state = self.stepped(state, joystick, self.dt)
                    state = self.stepped(state, [0.0] * 6, self.dt)
                for _ in range(5):
                    state = self.stepped(state, [k_x, k_y, 0, 0, 0, 0], 0.6)  # longer than fingers may hold it up
                if np.linalg.norm(self.point(state) - self.point(before)) > 1e-4:
                    return
        pytest.fail(f"stuck: {before}")

    def stepped(self, state, joystick, dt):
        return step(self.canal, state, np.array(joystick), dt, alarm=self.alarm, force=self.force, options=self.options)

    def point(self, state):
        return self.canal.point(state.disk, state.eta, state.phi)

    def go(self, stick, buttons):
        canal, before, dt = self.canal, self.state, self.dt
        after = self.state = self.stepped(before, (*stick, *map(float, buttons)), dt)
        assert np.isfinite(after.to_vector()).all()
        assert 0 <= after.eta <= 1
        assert 0 <= after.disk <= canal.n_disks - 1
        offset = np.linalg.norm(self.point(after) - canal.center(after.disk))
        assert offset <= canal.extent(after.disk, after.phi) + 1e-9
        for name in COUNTERS:
            assert getattr(after, name) >= getattr(before, name), name
        moved = self.point(after) - self.point(before)
        if not after.running:
            assert not moved.any()
            assert after.gripper_closed == before.gripper_closed
        if after.paused and before.paused:
            assert after.disk == before.disk
        # Along the canal no faster than told, and what the strategy or the stick moves, no faster than they may.
        travel = disks_per_second(canal, self.options) * dt
        assert abs(after.disk - before.disk) <= travel + 1e-9
        across = np.linalg.norm(self.point(after) - canal.point(after.disk, before.eta, before.phi))
        if after.disk != before.disk:
            assert across <= travel * self.spacing * (1 + 1e-6) + 1e-9
        else:
            assert across <= 20 / self.options.delta * dt * math.hypot(*stick) * (1 + 1e-6) + 1e-9
            press = (after.press_x, after.press_y, after.press_z)
            assert moved @ press <= GLANCING * np.linalg.norm(moved) + 1e-12
        if after.alarm and after.disk != before.disk and not any(self.force):
            assert np.sign(after.disk - before.disk) != after.press_way


Travel.TestCase.settings = settings(max_examples=40, stateful_step_count=30, deadline=None)
TestTravel = Travel.TestCase
