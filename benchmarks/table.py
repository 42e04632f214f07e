"""The one form of a benchmark's results: rows of case, contender, metric, value, unit."""

import csv
import os
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple


class Row(NamedTuple):
    """One figure."""

    case: str
    contender: str
    metric: str
    value: float
    unit: str


def write_csv(path: Path, rows: Iterable[Row]) -> None:
    """Write the rows under a header, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(Row._fields)
        writer.writerows(rows)
    os.replace(temporary, path)


def print_table(rows: Iterable[Row]) -> None:
    """One table a case: contenders down, metrics across."""
    cases: dict[str, dict[str, dict[str, str]]] = {}
    for row in rows:
        metrics = cases.setdefault(row.case, {}).setdefault(row.contender, {})
        metrics[f"{row.metric} [{row.unit}]"] = f"{row.value:.3g}"
    for case, contenders in cases.items():
        columns = list(dict.fromkeys(metric for metrics in contenders.values() for metric in metrics))
        width = max(map(len, contenders)) + 2
        print(f"\n{case}")
        for column in columns:
            print(f"  {column}")
            for name, metrics in contenders.items():
                print(f"    {name:{width}}{metrics.get(column, '-'):>10}")
