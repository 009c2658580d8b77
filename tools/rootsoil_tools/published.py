# SPDX-License-Identifier: MIT
"""Published curves and numbers of measured roots, and how well a simulated curve agrees with one."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

DATA = Path(__file__).parent.parent / "data"
SOURCE = "Beemster & Baskin 1998"


def arabidopsis(quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Distance from the tip (mm), and cell_length (um), strain_rate (%/h) or division_rate (1/h)."""
    distance_um, values = np.loadtxt(
        DATA / f"arabidopsis_beemster1998_{quantity}.csv", delimiter=",", skiprows=3, unpack=True
    )
    return distance_um / 1e3, values


@dataclass(frozen=True)
class Reference:
    """A published number; low = high where it is not a range."""

    low: float
    high: float
    unit: str
    source: str


def table(name: str) -> list[dict[str, str]]:
    """The rows of a table in tools/data, without its comments."""
    with (DATA / f"{name}.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def reference(quantity: str, species: str) -> Reference:
    """The row of reference_values.csv (measured roots) or paper_values.csv; ValueError where there is none."""
    rows = [row for name in ("reference_values", "paper_values") for row in table(name)]
    for row in rows:
        if (row["quantity"], row["species"]) == (quantity, species):
            return Reference(float(row["low"]), float(row["high"]), row["unit"], row["source"])
    known = "; ".join(f"{row['quantity']} ({row['species']})" for row in rows)
    raise ValueError(f"no published value of {quantity} ({species}); there are: {known}")


@dataclass(frozen=True)
class Fit:
    """The paper's measures (its 4.9), of a simulated against a measured curve."""

    r2: float  # 1 - SSE/SST
    rmse: float  # in the unit of the curve
    relative_error: float  # mean of |difference|/|measured|, where that is not 0


def fit(measured: np.ndarray, simulated: np.ndarray) -> Fit:
    """NaN where the simulation has nothing at a point that was measured."""
    off, there = simulated - measured, measured != 0.0
    return Fit(
        r2=float(1.0 - np.sum(off**2) / np.sum((measured - measured.mean()) ** 2)),
        rmse=float(np.sqrt(np.mean(off**2))),
        relative_error=float(np.mean(np.abs(off[there] / measured[there]))),
    )
