"""Benchmarks: each prints a table and writes `build/bench-NAME.csv` (case, contender, metric, value, unit)."""
