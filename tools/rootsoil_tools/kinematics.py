# SPDX-License-Identifier: MIT
"""The curves of the paper's Fig. 4B for a run: axial strain rate, cell length and division rate over the distance from
the tip, means over the last 40 outputs as in the paper's 4.9, and how well they agree with those of Beemster & Baskin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rootsoil_tools import measure, published
from rootsoil_tools.runs import Run

OUTPUTS = 40
HALF_WIDTH_MM = {"axial_strain_rate": 0.014, "cell_length": 0.014, "division_rate": 0.028}  # divisions are few
UNITS = {"axial_strain_rate": "1/h", "cell_length": "µm", "division_rate": "1/h", "radius": "mm"}
MEASURED = tuple(HALF_WIDTH_MM)  # quantities that Beemster & Baskin measured
END_MM = 1.2  # of the profile of the radius


@dataclass(frozen=True)
class Curve:
    """A quantity over the distance from the tip, a row for each output."""

    name: str
    s_mm: np.ndarray
    values: np.ndarray

    @property
    def label(self) -> str:
        """Name and unit, for an axis."""
        return f"{self.name.replace('_', ' ')} ({UNITS[self.name]})"

    def mean(self) -> np.ndarray:
        """NaN where no output has a cell."""
        there = np.isfinite(self.values).any(axis=0)
        mean = np.full(self.values.shape[1], np.nan)
        mean[there] = np.nanmean(self.values[:, there], axis=0)
        return mean

    def standard_error(self) -> np.ndarray:
        """Of the mean; outputs in succession are not independent, so it is a lower bound."""
        return np.nanstd(self.values, axis=0) / np.sqrt(np.isfinite(self.values).sum(axis=0))


def last_outputs(run: Run) -> list[int]:
    """Indices of the frames that curves are means of."""
    return list(range(max(0, len(run.times_h) - OUTPUTS), len(run.times_h)))


def span_h(run: Run) -> tuple[float, float]:
    """First and last time of these frames (h)."""
    return float(run.times_h[last_outputs(run)[0]]), float(run.times_h[-1])


def curve(run: Run, quantity: str, s_mm: np.ndarray) -> Curve:
    """Axial strain rate (1/h), cell length (um), division rate (1/h) or radius (mm) of the last outputs at places."""
    frames = last_outputs(run)
    if quantity == "radius":
        edges = np.linspace(0.0, END_MM, 25)
        rows = np.array([measure.radii(run.frame(index), run.dimension, edges) for index in frames])
        return Curve(quantity, (edges[1:] + edges[:-1]) / 2.0, rows)
    half = HALF_WIDTH_MM[quantity]
    if quantity == "division_rate":
        before = [max(0, frames[0] - 1), *frames]
        return Curve(quantity, s_mm, measure.division_rates(run, sorted(set(before)), s_mm, half))
    return Curve(quantity, s_mm, measure.near_points(run, frames, quantity, s_mm, half))


def published_curve(quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Beemster & Baskin's curve in our units: distance from the tip (mm), values."""
    if quantity != "axial_strain_rate":
        return published.arabidopsis(quantity)
    at_mm, percent_per_h = published.arabidopsis("strain_rate")
    return at_mm, percent_per_h / 100.0


def fit_to_published(run: Run, quantity: str) -> published.Fit:
    """How well the run's curve agrees with Beemster & Baskin's where they measured and the root has tissue. NaN with
    fewer than two such points, or a single output where divisions are asked for."""
    at_mm, values = published_curve(quantity)
    mean = curve(run, quantity, at_mm).mean()
    there = np.isfinite(mean)
    if np.count_nonzero(there) < 2:
        return published.Fit(float("nan"), float("nan"), float("nan"))
    return published.fit(values[there], mean[there])
