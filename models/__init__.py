"""Data that ships with the project: robot, machine, things, demonstrations, scenarios."""
