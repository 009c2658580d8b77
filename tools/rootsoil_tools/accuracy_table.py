# SPDX-License-Identifier: MIT
"""The table of tools/accuracy_cost.py: a row for each run and measure, in a CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np

from rootsoil_tools.accuracy_grid import DEFAULT_NAME, FINEST_NAME
from rootsoil_tools.problems import Measure, Problem


@dataclass(frozen=True)
class Row:
    """One measure of one run. `error` is empty where there is none (yet)."""

    key: str
    problem: str
    choice: str
    across: int
    level: float
    measure: str
    status: str
    error: float
    unbalanced: float
    cpu_s: float
    start_s: float
    wall_s: float
    cells: float
    steps: float
    cell_steps: float
    hours: float
    program: str
    values: str
    remark: str

    @property
    def time_s(self) -> float:
        """Processor time without that of starting the program, which a longer run does not have again."""
        return self.cpu_s - self.start_s


def place_of(row: Row) -> tuple[str, str, int, str]:
    """Which run of the grid it is."""
    return row.problem, row.choice, row.across, f"{row.level:g}"


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """Replaces the file as a whole."""
    partial = path.with_suffix(".partial")
    with partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([f.name for f in fields(Row)])
        for row in rows:
            values = [getattr(row, f.name) for f in fields(Row)]
            writer.writerow(["" if v != v else f"{v:.6g}" if isinstance(v, float) else v for v in values])
    partial.replace(path)


def read_rows(path: Path) -> list[Row]:
    """The rows of a file; none where there is no file."""
    if not path.is_file():
        return []
    types: dict[str, Callable] = {"float": lambda text: float(text) if text else math.nan, "int": int, "str": str}
    with path.open(newline="", encoding="utf-8") as file:
        return [Row(**{f.name: types[str(f.type)](row[f.name]) for f in fields(Row)}) for row in csv.DictReader(file)]


def numbers(row: Row) -> np.ndarray:
    """The values of a row."""
    return np.array(row.values.split(), dtype=float)


def finest(rows: Sequence[Row], row: Row) -> Row | None:
    """The run that the row is compared with, where there is no closed form: the choice "finest", or the default with
    most cells."""
    same = [r for r in rows if (r.problem, r.measure, r.status) == (row.problem, row.measure, "done")]
    named = [r for r in same if r.choice == FINEST_NAME]
    candidates = named or [r for r in same if r.choice == DEFAULT_NAME]
    return max(candidates, key=lambda r: r.cell_steps) if candidates else None


def deviations(row: Row, measure: Measure, rows: Sequence[Row]) -> np.ndarray | None:
    """The row's values as relative errors: against the closed form, which they are already, or against those of the
    finest run over the scale. Of a soil a number for each sample, against the same sample. None where there is nothing
    to compare, as with an older program's row that has other values."""
    if row.status != "done":
        return None
    values = numbers(row)
    if not measure.finest:
        return values
    reference = finest(rows, row)
    if reference is None or reference.key == row.key:
        return None
    exact = numbers(reference)
    if exact.shape != values.shape:
        return None
    return (values - exact) / (measure.scale or float(np.sqrt(np.mean(exact**2))))


def error_of(row: Row, measure: Measure, rows: Sequence[Row]) -> float:
    """Root mean square of the deviations; NaN where there are none."""
    found = deviations(row, measure, rows)
    return math.nan if found is None else float(np.sqrt(np.mean(found**2)))


def with_errors(rows: Sequence[Row], problems: Sequence[Problem]) -> list[Row]:
    """The rows with their errors, which may change when a finer run comes in."""
    by_name = {p.name: p for p in problems}
    known = [row for row in rows if row.problem in by_name]
    return [replace(r, error=error_of(r, by_name[r.problem].measure(r.measure), known)) for r in known]
