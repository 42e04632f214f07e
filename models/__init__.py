"""Data that ships with the project: robot, machine, items, demonstrations, scenarios."""

from pathlib import Path

MODELS = Path(__file__).parent
"""The folder of this package: what is named in a scenario is looked for here."""

LIO_URDF = MODELS / "lio" / "lio.urdf"
SCENARIOS = MODELS / "scenarios"
