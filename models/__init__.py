"""Data that ships with the project: robot, machine, items, demonstrations, scenarios."""

from pathlib import Path

MODELS = Path(__file__).parent
"""The folder of this package: what is named in a scenario is looked for here."""

LIO_URDF = MODELS / "lio" / "lio.urdf"
TCP_FRAME, BASE_FRAME = "tcp", "lio_base"
"""Its model, and the names there of the tool's frame T and of the base B."""
SCENARIOS = MODELS / "scenarios"
