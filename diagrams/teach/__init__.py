"""Demonstrations taught in the simulation: the tool jogged by a hand, and what is recorded of it."""
