"""What a person at the table would do with the stick and the buttons; pure decisions, no Drake.

The person sees (late and a little wrong) where the items, the gripper and the drawn path are. They move the stick in
short ballistic pushes, each followed by a look at what came of it (intermittent control, as in human reaching), aim
above the item before the gripper comes down on it, check that a grip held, and go back where it did not.
"""

import math

import numpy as np

from canal.navigation import Leg, phase
from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD, JOYSTICK_SIZE, REVERSE, START, STOP
from canal.surface import CanalSurface
from diagrams.geometry.goals import Goal
from diagrams.operator.options import OperatorOptions
from diagrams.operator.state import EPSILON, HAND, NEAR_GOAL, Mode, OperatorState, Sight
from diagrams.operator.ways import Ways


class OperatorPolicy:
    """Decides, 20 times a second, what the hand does."""

    def __init__(
        self,
        canal: CanalSurface,
        goals: list[Goal],
        options: OperatorOptions,
        *,
        stick_speed: float,
        p_BG: np.ndarray,
        seed: int,
    ) -> None:
        """A person who loads by `canal`; `stick_speed` [m/s] is what full stick moves, `p_BG` (n, 3) the goals in B."""
        self.canal, self.goals, self.options = canal, goals, options
        self.stick_speed = stick_speed
        self.p_BG = p_BG
        self.seed = seed
        self.ways = Ways(canal, [goal.precise for goal in goals])

    def initial(self) -> np.ndarray:
        """State vector before anything has happened."""
        return OperatorState().pack(*np.zeros((2, len(self.goals))))

    def joystick(self, vector: np.ndarray, time: float) -> np.ndarray:
        """What the hand does now. Shape (6,).

        Args:
            vector: the state, as `OperatorState.pack` gives it.
            time: [s].
        """
        state, _, _ = OperatorState.unpack(vector, len(self.goals))
        joystick = np.zeros(JOYSTICK_SIZE)
        if time < state.stick_until - EPSILON:
            joystick[:2] = state.stick_x, state.stick_y
        if state.button and time < state.button_until - EPSILON:
            joystick[int(state.button)] = 1.0
        return joystick

    def decide(self, vector: np.ndarray, sight: Sight, time: float) -> np.ndarray:
        """The state after a look at `sight`. One look, at most one push or press.

        Args:
            vector: the state, as `OperatorState.pack` gives it.
            sight: what is seen.
            time: [s].
        """
        state, given_up, tries = OperatorState.unpack(vector, len(self.goals))
        if time < state.busy_until - EPSILON:
            return vector
        if sight.navigation.blocked:  # the arm has stopped against something: the way back is free
            self._press(state, REVERSE, time)
            return state.pack(given_up, tries)
        {
            Mode.BEGIN: self._begin,
            Mode.PICK: self._pick,
            Mode.LIFT: self._lift,
            Mode.CARRY: self._carry,
            Mode.LEAVE: self._leave,
            Mode.PUSH: self._push,
            Mode.RETREAT: self._retreat,
            Mode.FINISH: self._finish,
        }[Mode(int(state.mode))](state, given_up, tries, sight, time)
        return state.pack(given_up, tries)

    def waiting(self, vector: np.ndarray, time: float) -> np.ndarray:
        """The state while somebody else has the joystick: what was given up stays so, all else is looked at anew.

        Args:
            vector: the state, as `OperatorState.pack` gives it.
            time: [s].
        """
        _, given_up, tries = OperatorState.unpack(vector, len(self.goals))
        return OperatorState(busy_until=time + self.options.think_s + self.options.delay_s).pack(given_up, tries)

    # ---- what to do in each mode: each changes the state in place ----

    def _begin(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        nav = sight.navigation
        if not nav.running or nav.paused:
            self._press(state, START, time)
        if nav.paused:
            return
        state.mode = Mode.PICK
        held = [i for i, p in enumerate(sight.positions) if np.linalg.norm(p - sight.p_BT) < self.options.lost_m]
        if nav.gripper_closed and held:  # somebody else has begun
            state.item, state.mode, state.beside = float(held[0]), Mode.CARRY, self._room(sight, held[0])
            tries[held[0]] += 1
            if Leg(int(nav.leg)) in (Leg.HOME_TO_PICK, Leg.PLACE_TO_HOME):
                self._press(state, REVERSE, time)

    def _pick(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        nav = sight.navigation
        if state.item < 0:
            state.item = float(self._hanging(tries, sight))
            if state.item >= 0:
                tries[int(state.item)] += 1
                state.mode, state.aimed = Mode.PUSH, 0.0
                return
            self._choose(state, given_up, tries, sight)
        if state.item < 0:
            state.mode = Mode.FINISH
            return
        leg = Leg(int(nav.leg))
        if leg is Leg.PLACE_TO_HOME:
            return
        if leg is not Leg.HOME_TO_PICK:
            self._press(state, REVERSE, time)
            return
        if nav.gripper_closed:
            self._press(state, GRIPPER, time)
            return
        item = int(state.item)
        if self._aim(state, sight, sight.positions[item], end=0.0, time=time) and nav.waiting:
            self._press(state, GRIPPER, time)
            state.grip_height = float(sight.p_BT[2])
            state.mode = Mode.LIFT

    def _choose(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight) -> None:
        """The topmost item to do that lies where the canal's pick disk reaches; first what is in the way of others."""
        canal = self.canal
        state.item, state.aimed = -1.0, 0.0
        for i, position in enumerate(sight.positions):
            # Looked at anew each time: what lay well may have been knocked, or have rolled out.
            offset = position - canal.center(0.0)
            far = math.hypot(offset[0], offset[1]) > 2 * canal.radius(0.0) + 0.1 or offset[2] < -0.15
            if not sight.placed[i] and (tries[i] >= self.options.tries or far):
                given_up[i] = 1.0
        todo = [i for i in range(len(self.goals)) if not (given_up[i] or sight.placed[i])]

        def score(i: int) -> float:
            # One that was tried in vain comes late: something else may lie on it.
            across = math.hypot(*(sight.positions[i] - canal.center(0.0))[:2])
            waits_for = self.ways.waits_for(i, todo, sight.positions, self.p_BG)
            return float(sight.positions[i][2]) - 0.1 * across - float(tries[i]) - waits_for

        state.item = float(max(todo, key=score, default=-1))

    def _lift(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        risen = sight.p_BT[2] - state.grip_height > self.options.lift_m
        if not (risen or phase(self.canal, sight.navigation.disk) > -self.options.aim_from):
            return
        item = int(state.item)
        if np.linalg.norm(sight.positions[item] - sight.p_BT) < self.options.lost_m:
            state.mode, state.aimed, state.beside = Mode.CARRY, 0.0, self._room(sight, item)
        else:
            self._try_again(state, tries)

    def _carry(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        nav, item = sight.navigation, int(state.item)
        held = sight.positions[item] - sight.p_BT
        if np.linalg.norm(held) > 1.5 * self.options.lost_m:
            self._try_again(state, tries)
            return
        if Leg(int(nav.leg)) is not Leg.HOME_TO_PLACE:
            return
        goal = self.goals[item]
        # What must come to the mark is the item, which may sit off the middle of the gripper.
        target = self.p_BG[item] - held if goal.precise else self._beside(state.beside)
        aimed = self._aim(state, sight, target, end=self.canal.n_disks - 1.0, time=time)
        slip = not goal.precise and not tries[item] and phase(self.canal, nav.disk) > self.options.let_go_at
        if slip or (aimed and nav.waiting):
            self._press(state, GRIPPER, time)
            state.mode = Mode.LEAVE

    def _beside(self, side: float) -> np.ndarray:
        """A point of the last disk: near its rim, level with the middle, at one side (±1), or above it (0). (3,)."""
        end = self.canal.n_disks - 1.0
        x, y = self.canal.axes(end)
        level = math.atan2(-x[2], y[2])  # φ of y_z x - x_z y, which is horizontal
        if side == 0:
            return self.canal.point(end, math.hypot(x[2], y[2]) * self.options.lay_above, math.atan2(y[2], x[2]))
        return self.canal.point(end, self.options.lay_beside, level if side > 0 else level + math.pi)

    def _room(self, sight: Sight, item: int) -> float:
        """Where an item that may lie anywhere has most room: at a side first, above the others where both are taken."""
        there = [
            p
            for i, p in enumerate(sight.positions)
            if i != item and np.linalg.norm(p - self.canal.center(self.canal.n_disks - 1.0)) < NEAR_GOAL
        ]
        room = {}
        for side in (-1.0, 1.0, 0.0):
            spot = self._beside(side)
            room[side] = min((math.hypot(*(p - spot)[:2]) for p in there), default=math.inf)
        return max(room, key=room.__getitem__)

    def _leave(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        if Leg(int(sight.navigation.leg)) is Leg.HOME_TO_PLACE:  # let go before the end: the robot does not turn there
            self._press(state, REVERSE, time)
            return
        if phase(self.canal, sight.navigation.disk) > self.options.judge_at:
            return
        item = int(state.item)
        if not sight.placed[item]:
            tries[item] += 1
        state.item, state.aimed = float(self._hanging(tries, sight)), 0.0
        state.mode = Mode.PUSH if state.item >= 0 else Mode.PICK

    def _hanging(self, tries: np.ndarray, sight: Sight) -> int:
        """An item that is at the goal and not quite in; -1 for none."""
        end = self.canal.center(self.canal.n_disks - 1.0)
        for i, goal in enumerate(self.goals):
            near = np.linalg.norm(sight.positions[i] - end) < NEAR_GOAL
            if near and not goal.precise and not sight.placed[i] and tries[i] <= self.options.tries:
                return i
        return -1

    def _push(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        """Push in what hangs out: a closed gripper, and back along the same disks (paper VI, task 2)."""
        nav = sight.navigation
        if not nav.gripper_closed:
            self._press(state, GRIPPER, time)
        elif Leg(int(nav.leg)) in (Leg.PLACE_TO_HOME, Leg.HOME_TO_PICK):
            self._press(state, REVERSE, time)
        elif self._aim(state, sight, sight.positions[int(state.item)], self.canal.n_disks - 1.0, time) and nav.waiting:
            self._press(state, REVERSE, time)
            state.mode = Mode.RETREAT

    def _retreat(
        self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float
    ) -> None:
        if phase(self.canal, sight.navigation.disk) > self.options.judge_at:
            return
        if sight.navigation.gripper_closed:
            self._press(state, GRIPPER, time)
        state.mode = Mode.LEAVE

    def _finish(self, state: OperatorState, given_up: np.ndarray, tries: np.ndarray, sight: Sight, time: float) -> None:
        nav = sight.navigation
        if nav.running and Leg(int(nav.leg)) in (Leg.HOME_TO_PICK, Leg.HOME_TO_PLACE):
            self._press(state, STOP, time)

    # ---- the hand ----

    def _try_again(self, state: OperatorState, tries: np.ndarray) -> None:
        tries[int(state.item)] += 1
        state.item, state.mode, state.aimed = -1.0, Mode.PICK, 0.0

    def _press(self, state: OperatorState, button: int, time: float) -> None:
        state.button, state.button_until = float(button), time + self.options.press_s
        state.busy_until = time + self.options.think_s + self.options.delay_s

    def _aim(self, state: OperatorState, sight: Sight, target: np.ndarray, end: float, time: float) -> bool:
        """Push the stick where the drawn path would miss `target` (B, m) at disk `end`; whether all is well.

        The path ahead keeps (η, φ), so what is wanted on the disk at hand is the point with the (η, φ) that the
        target has on the last disk.
        """
        nav, options, canal = sight.navigation, self.options, self.canal
        d = abs(phase(canal, nav.disk))
        if d < options.aim_from:
            return False
        eta, phi = canal.disk_coordinates(end, target)
        eta = min(eta, 1.0)
        miss = canal.point(end, eta, phi) - canal.point(end, nav.eta, nav.phi)
        among = d > options.aim_until or state.aimed > 0
        if np.linalg.norm(miss) < (options.end_tolerance_m if among else options.aim_tolerance_m):
            state.aimed = 1.0
            return True
        step = canal.point(nav.disk, eta, phi) - canal.point(nav.disk, nav.eta, nav.phi)
        x, y = canal.axes(nav.disk)
        self._push_stick(state, float(step @ x), float(step @ y), time)
        return False

    def _push_stick(self, state: OperatorState, right: float, up: float, time: float) -> None:
        """One ballistic push that would move the point by (right, up) metres, as well as a hand can."""
        length = math.hypot(right, up)
        if length < 1e-4:
            return
        samples = math.ceil(length / (self.stick_speed * JOYSTICK_PERIOD))
        k = length / (self.stick_speed * JOYSTICK_PERIOD * samples)
        rng = np.random.default_rng((self.seed, HAND, round(time / JOYSTICK_PERIOD)))
        error = rng.normal(0, self.options.hand_noise, 2)
        k = min(max(k * (1 + error[0]), 0.15), 1.0)
        angle = math.atan2(up, right) + error[1]
        state.stick_x, state.stick_y = k * math.cos(angle), k * math.sin(angle)
        state.stick_until = time + samples * JOYSTICK_PERIOD
        state.busy_until = state.stick_until + self.options.delay_s + self.options.look_s
