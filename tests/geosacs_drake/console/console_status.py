"""The status of a run that a page shows in the tests."""

from typing import Any

STATUS: dict[str, Any] = {
    "time_s": 12.0,
    "headline": "Going to pick",
    "sentence": "The stick shifts its path to the side.",
    "tone": "go",
    "start": "Pause",
    "leg": "to pick",
    "progress": 0.4,
    "phase": -0.4,
    "eta": 0.5,
    "phi": 0.3,
    "radius_mm": 90.0,
    "axes": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    "correcting": False,
    "corrections": 2,
    "correction_s": 1.5,
    "correction_mm": 80.0,
    "task_s": 12.0,
    "closed": False,
    "running": True,
    "paused": False,
    "waiting": False,
    "alarm": False,
    "stick": [0.0, 0.0],
    "items": [{"name": "sock", "placed": False}],
    "rate": 1.0,
}
