# SPDX-License-Identifier: MIT
"""Published curves of measured roots, and how well a simulated curve agrees with one."""

from __future__ import annotations

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
class Fit:
    """The paper's measures (its 4.9), of a simulated against a measured curve."""

    r2: float  # 1 - SSE/SST
    rmse: float  # in the unit of the curve
    relative_error: float  # mean of |difference|/|measured|


def fit(measured: np.ndarray, simulated: np.ndarray) -> Fit:
    """NaN where the simulation has nothing at a point that was measured."""
    off = simulated - measured
    return Fit(
        r2=float(1.0 - np.sum(off**2) / np.sum((measured - measured.mean()) ** 2)),
        rmse=float(np.sqrt(np.mean(off**2))),
        relative_error=float(np.mean(np.abs(off / measured))),
    )
