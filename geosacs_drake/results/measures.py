"""What each figure of a summary means: its unit and its definition, one line a key."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Measure:
    """One figure of `geosacs_drake.results.summary.summarize`."""

    key: str
    """Its place in the summary; a dot goes into a mapping."""
    unit: str
    """Empty for text, counts and truth values; `1` for ratios."""
    definition: str
    """What it means, in one or two sentences."""


MEASURES = (
    Measure("task", "", "laundry or relocation."),
    Measure("scenario", "", "The scenario as it was named: a file, or one that ships."),
    Measure("operator", "", "Who held the joystick: simulated, a person, or a recording."),
    Measure("items_kind", "", "soft, rigid, or mixed."),
    Measure("success", "", "Whether at the end every item was placed; not where something inside ended the run."),
    Measure("reason", "", "Why the run ended. Where it ended otherwise although all was placed, it says both."),
    Measure("seed", "", "Of where items lie, and of the simulated operator's errors."),
    Measure("items.name", "", "Of an item, as in the scenario."),
    Measure(
        "items.placed",
        "",
        "Whether at the end it was where it belongs, slower than monitor.rest_speed, and no finger touched it.",
    ),
    Measure(
        "items.time_s",
        "s",
        "From start until it had come to rest there and no finger touched it, to 0.05 s; it has neither moved away "
        "nor been faster since. A finger that touches it again without moving it changes nothing. Null where it is not "
        "placed.",
    ),
    Measure("task_time_s", "s", "From when start was first taken until the run ended."),
    Measure("correction_time_s", "s", "Time in which the stick moved the point on its disk."),
    Measure(
        "correction_share", "1", "correction_time_s over task_time_s: the share of the time, pauses and waiting in."
    ),
    Measure("corrections", "", "How often the stick began to move the point."),
    Measure("correction_distance_m", "m", "Length of the way that corrections commanded on the disks."),
    Measure(
        "measured_correction_distance_m",
        "m",
        "Length of the tool's way in answer to the steps of corrections, from the first of a push to its last, as much "
        "later as delay_ms says.",
    ),
    Measure("backtracks", "", "Reversals that took effect."),
    Measure("ik.p50_ms", "ms", "Median of the IK's time a tick, on the clock, where it had to solve; likewise p99_ms."),
    Measure("ik.p99_ms", "ms", "See ik.p50_ms."),
    Measure(
        "ik.bound_violations",
        "",
        "Control periods at whose end a joint of the arm was over 1e-4 rad beyond its stop, or faster than 1.001 times "
        "its speed.",
    ),
    Measure("ik.held_ticks", "", "Ticks in which the IK had no usable target and held the posture."),
    Measure(
        "peak_joint_speed_share",
        "1",
        "Greatest speed of any joint of the arm as a share of what that joint may do, at the ends of control periods.",
    ),
    Measure(
        "max_contact_force_n",
        "N",
        "By pair: greatest sum of the magnitudes of the contact forces between the robot and that part of the "
        "surroundings, of all steps of the plant.",
    ),
    Measure(
        "max_penetration_m",
        "m",
        "Greatest depth of a rigid shape, or a node of cloth, in the surroundings, looked at once a control period.",
    ),
    Measure(
        "tcp_error_m.p50",
        "m",
        "Median distance of the tool from the pose whose command ends at that tick, while started; likewise p95, max.",
    ),
    Measure("tcp_error_m.p95", "m", "See tcp_error_m.p50."),
    Measure("tcp_error_m.max", "m", "See tcp_error_m.p50."),
    Measure(
        "delay_ms",
        "ms",
        "From when the navigator wants a pose until the tool is there: the shift in time at which what was measured is "
        "nearest to what was wanted, in the mean of squares. Null where less than 10 mm were wanted.",
    ),
    Measure(
        "realtime_factor",
        "1",
        "Simulated over elapsed time, of all whole half seconds. Null in runs that are shorter.",
    ),
    Measure("realtime_factor_worst_half_second", "1", "The slowest of them."),
    Measure("version", "", "Of this program."),
    Measure("failure", "", "Only where something inside ended the run: the library's own words."),
)
"""Every figure of a summary, in its order."""
