"""What a run leaves behind: one array a signal at the control rate, kept by Drake's own log sinks in the Context."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, OutputPort
from pydrake.systems.primitives import LogVectorOutput, VectorLogSink

from canal.navigation import FIELD_NAMES, Leg
from canal.navigation.joystick import GRIPPER, JOYSTICK_PERIOD
from diagrams.ik.system import IkStatusField
from diagrams.station.lio_drive import ARM, MOVING


class RunLog:
    """Log sinks for the signals of a run, and what they come to."""

    def __init__(
        self,
        builder: DiagramBuilder,
        signals: Mapping[str, OutputPort],
        period: float,
        samples: Mapping[str, OutputPort] | None = None,
    ) -> None:
        """Log each of `signals` every `period` seconds, and what is sampled with the joystick at each of its samples.

        Args:
            builder: where the signals are.
            signals: by name; one of them is kept as `joystick`, for example.
            period: of the log [s].
            samples: by name, kept for a replay: a control rate that is no multiple of 20 Hz misses some of them.
        """
        self._sinks: dict[str, VectorLogSink] = {
            name: LogVectorOutput(port, builder, period) for name, port in signals.items()
        }
        self._samples: dict[str, VectorLogSink] = {
            name: LogVectorOutput(port, builder, JOYSTICK_PERIOD) for name, port in (samples or {}).items()
        }

    def signals(self, root: Context) -> dict[str, np.ndarray]:
        """`time` (T,) and each signal (T, ...), raw; `sample_time` (K,) and the samples (K, ...) from then on."""
        logs = {name: sink.FindLog(root) for name, sink in self._sinks.items()}
        first = next(iter(logs.values()))
        found = {"time": first.sample_times().copy()} | {name: log.data().T.copy() for name, log in logs.items()}
        for name, sink in self._samples.items():
            log = sink.FindLog(root)
            if not log.num_samples():  # it ended before anything was sampled
                continue
            # Not by its port: what Python holds of a sink's port keeps the diagram for ever.
            last = sink.EvalVectorInput(sink.GetMyContextFromRoot(root), 0).value()
            # At a sample's time the log has what held until then. The last row only tells when it ends.
            values = np.vstack([log.data().T[1:], last, 0 * last])
            found[name] = values
            found["sample_time"] = np.append(log.sample_times(), log.sample_times()[-1] + JOYSTICK_PERIOD)
        return found


def named_signals(raw: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays of a log file from the raw signals of `RunLog`.

    A row has what was measured at its `time` (`X_BT`, `q`, `v`, `gripper`, `item_poses`, `contact_forces`), and what
    was wanted and commanded in the control period that ends then: `q_command` is where the arm was to be at `time`,
    and the row before has the `X_BT_desired` that it was computed for. Wall-clock figures are left out: two runs with
    one seed give the same file, bit for bit.
    """
    navigation = {name: raw["navigation_state"][:, i] for i, name in enumerate(FIELD_NAMES)}
    joystick, ik = raw["joystick"], raw["ik_status"]
    lio = raw["lio_state"]
    named = {
        "time": raw["time"],
        "disk": navigation["disk"],
        "eta": navigation["eta"],
        "phi": navigation["phi"],
        "leg": navigation["leg"].astype(int),
        "stick": joystick[:, :GRIPPER],
        "buttons": joystick[:, GRIPPER:],
        "person_in_charge": raw["person_in_charge"][:, 0],
        "X_BT_desired": raw["X_BT_desired"],
        "X_BT": raw["X_BT"],
        "q_command": raw["desired_state"][:, :ARM],
        "q": lio[:, :ARM],
        "v": lio[:, MOVING : MOVING + ARM],
        "gripper": lio[:, ARM],
        "gripper_command": navigation["gripper_closed"],
        "correcting": navigation["correcting"],
        "ik_status": ik[:, IkStatusField.STATUS].astype(int),
        "orientation_weight": raw["orientation_weight"][:, 0],
        "item_poses": raw["item_poses"],
        "contact_forces": raw["contact_forces"],
    }
    if "sample_time" in raw:
        named |= {
            "joystick_time": raw["sample_time"],
            "joystick": raw["joystick_samples"],
            "joystick_in_charge": raw["in_charge_samples"][:, 0],
        }
    times, kinds = events(raw)
    return named | {"event_times": times, "events": kinds}


def events(raw: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """What happened and when: times [s] (E,) and names (E,) such as `correction`, `close`, `leg pick_to_home`.

    A row has what holds since the tick before it, which is when it happened.
    """
    time, navigation = np.roll(raw["time"], 1), raw["navigation_state"]
    found: list[tuple[float, str]] = []

    def add(field: str, names: Mapping[float, str]) -> None:
        values = navigation[:, FIELD_NAMES.index(field)]
        for k in np.flatnonzero(np.diff(values)) + 1:
            if values[k] in names:
                found.append((float(time[k]), names[float(values[k])]))

    add("running", {1.0: "start", 0.0: "stop"})
    add("paused", {1.0: "pause", 0.0: "pause ends"})
    add("gripper_closed", {1.0: "close", 0.0: "open"})
    add("correcting", {1.0: "correction", 0.0: "correction ends"})
    add("alarm", {1.0: "force limit", 0.0: "freed"})
    add("leg", {float(leg): f"leg {leg.name.lower()}" for leg in Leg})
    backtracks = navigation[:, FIELD_NAMES.index("backtracks")]
    found += [(float(time[k]), "reverse") for k in np.flatnonzero(np.diff(backtracks) > 0) + 1]
    ignored = navigation[:, FIELD_NAMES.index("ignored")]
    found += [(float(time[k]), "press ignored") for k in np.flatnonzero(np.diff(ignored) > 0) + 1]
    found.sort()
    return np.array([t for t, _ in found]), np.array([name for _, name in found], dtype=np.str_)
