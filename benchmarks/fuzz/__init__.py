"""Random sticks, canals, scenarios and runs: `python -m benchmarks.fuzz`."""
