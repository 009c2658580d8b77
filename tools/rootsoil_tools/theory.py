# SPDX-License-Identifier: MIT
"""The closed form along the root as the program wrote it into run.h5.

Units: mm, h, MPa; s is the distance from the tip (mm).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


def cumulative_integral(s: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Integral of f from s[0] to each s (trapezoids)."""
    return np.concatenate([[0.0], np.cumsum(np.diff(s) * (f[1:] + f[:-1]) / 2.0)])


def growth_ends(s: np.ndarray, rate: np.ndarray) -> float:
    """Distance from the tip (mm) beyond which this rate (1/h) stays below 5 % of its peak; at most the last s."""
    low = 0.05 * np.max(rate, initial=0.0)
    growing = np.flatnonzero(rate > low)
    if growing.size == 0 or growing[-1] == s.size - 1:
        return float(s[-1])
    after, last = growing[-1] + 1, growing[-1]
    return float(np.interp(low, rate[[after, last]], s[[after, last]]))


@dataclass(frozen=True)
class ClosedForm:
    """A straight root at one length and pressure differential, in steady growth with nothing in its way.

    `columns` are those of the table `closed_form` of a frame of run.h5, a row for each of some distances from the tip.
    """

    columns: Mapping[str, np.ndarray]

    def at(self, name: str, s: np.ndarray | float) -> np.ndarray:
        """A column at these distances; beyond the root's length as at its end."""
        return np.interp(np.asarray(s), self.columns["distance_to_tip"], self.columns[name])

    @property
    def grows(self) -> bool:
        """Whether the scene has growth, and with it rates, flow and radius."""
        return "axial_strain_rate" in self.columns

    @property
    def p(self) -> float:
        """Pressure differential (MPa)."""
        return float(self.columns["pressure_differential"][0])

    @property
    def arrest_stress(self) -> float:
        """Axial compression that stops growth (MPa)."""
        return float(self.columns["arrest_stress"][0])

    def axial_rate(self, s: np.ndarray | float) -> np.ndarray:
        """Axial strain rate of growth (1/h)."""
        return self.at("axial_strain_rate", s)

    def velocity(self, s: np.ndarray | float) -> np.ndarray:
        """Velocity away from the tip (mm/h); beyond the root's length at its end's rate."""
        end = self.columns["distance_to_tip"][-1]
        return self.at("speed_from_tip", s) + self.axial_rate(end) * np.maximum(np.asarray(s) - end, 0.0)

    def tip_speed(self, length: float) -> float:
        """Speed of the tip of a root of this length (mm), mm/h."""
        return float(self.velocity(length))

    def grid(self, length: float) -> np.ndarray:
        """Distances from the tip (mm), fine enough to integrate over."""
        return np.linspace(0.0, length, 4001)

    def growth_zone(self, length: float) -> float:
        """Distance from the tip (mm) beyond which the axial rate stays below 5 % of its peak; at most the length."""
        s = self.grid(length)
        return growth_ends(s, self.axial_rate(s))

    def radius(self, s: np.ndarray, s_start: float, radius_start: float) -> np.ndarray:
        """Radius (mm) of a root in steady growth that has radius_start at s_start, in the growth zone or behind it; NaN
        before."""
        relative = self.at("relative_radius", s) / self.at("relative_radius", s_start)
        return np.where(s >= s_start, radius_start * relative, np.nan)

    def _journey(self, s_start: float, length: float) -> tuple[np.ndarray, np.ndarray]:
        """Distances from s_start on at which tissue moves, and when (h) it gets there from the first of them."""
        s = self.grid(length)
        v = self.velocity(s)
        moving = (s >= s_start) & (v > 0.0)
        return s[moving], cumulative_integral(s[moving], 1.0 / v[moving])

    def travel_time(self, s_start: float, s_end: float, length: float) -> float:
        """How long (h) tissue takes from one distance from the tip (mm) to another; NaN where it does not move."""
        s, time = self._journey(s_start, length)
        return float(np.interp(s_end, s, time)) if s.size > 1 and s[0] <= s_end <= s[-1] else float("nan")

    def carried_to(self, s_start: float, duration: float, length: float) -> float:
        """Where (mm from the tip) tissue is after `duration` h that started at s_start mm; at most the length."""
        s, time = self._journey(s_start, length)
        return float(np.interp(duration, time, s)) if s.size > 1 else s_start

    def stretch(self, s: np.ndarray, duration: float, length: float) -> np.ndarray:
        """By which factor the tissue that is now at s has become longer in the last `duration` h of steady growth."""
        way, time = self._journey(0.0, length)
        if way.size < 2:
            return np.ones_like(s)
        before = np.interp(np.interp(s, way, time) - duration, time, way)
        return np.where(s > way[0], self.velocity(s) / self.velocity(before), 1.0)
