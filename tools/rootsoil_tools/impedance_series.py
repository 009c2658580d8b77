# SPDX-License-Identifier: MIT
"""What is measured in the runs of an impedance series: one scene under several pressure differentials."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rootsoil_tools import measure, published
from rootsoil_tools.runs import Run
from rootsoil_tools.theory import ClosedForm, growth_ends

PRESSURES_MPA = (1.0, 0.987, 0.825, 0.75, 0.625, 0.5, 0.4)
SOFT_MPA, HARD_MPA = 1.0, 0.5  # the paper's 4.8
MEASURED_MM = 15.0  # the authors' own profiles end here (resources/pystat_d17c.py, binLength)


@dataclass(frozen=True)
class Member:
    """One run of the series and what was measured in it."""

    p: float  # MPa
    model: ClosedForm
    s: np.ndarray  # mm
    profiles: dict[str, measure.Profile]
    tip_speed: float  # mm/h
    peak_rate: float  # 1/h
    growth_zone: float  # mm; NaN where growth goes on to the end of the profile
    fit: published.Fit  # of the axial strain rate to the closed form, Eq. 6 at this p, over its growth zone; 1/h
    mature_radius: float  # mm
    radius_drift: float  # 1/h

    @property
    def penetrometer(self) -> float:
        """The soil's resistance (MPa) to a penetrometer: p is 1 MPa of turgor less a fourth of it (the paper's 4.8)."""
        return 4.0 * (1.0 - self.p)


def measure_member(p: float, run: Run) -> Member:
    """Profiles and numbers of one run."""
    last = run.frame(-1)
    model = last.closed_form
    length = float(last["distance_to_tip"].max())
    zone = min(model.growth_zone(length), MEASURED_MM)
    edges = measure.edges_of(min(1.3 * zone, length, MEASURED_MM), measure.bin_width(last, run.dimension, zone))
    profiles = measure.growth_profiles(run, edges)
    rate = profiles["axial_strain_rate"]
    filled = np.isfinite(rate.mean)
    s, mean = rate.s_mm[filled], rate.mean[filled]
    end = growth_ends(s, mean)
    return Member(
        p=p,
        model=model,
        s=rate.s_mm,
        profiles=profiles,
        tip_speed=measure.tip_speed(run),
        peak_rate=float(mean.max()),
        growth_zone=end if end < s[-1] else float("nan"),
        fit=published.fit(model.axial_rate(s[s < zone]), mean[s < zone]),
        mature_radius=measure.mature_radius(model, run),
        radius_drift=measure.radius_drift(model, run),
    )


def halved_at(order: list[Member]) -> float:
    """Penetrometer resistance (MPa) that halves the speed of the first, the softest; NaN where none does."""
    speed = np.array([member.tip_speed / order[0].tip_speed for member in order])
    if np.any(np.diff(speed) >= 0.0) or speed[-1] > 0.5:
        return float("nan")
    return float(np.interp(0.5, speed[::-1], [member.penetrometer for member in order[::-1]]))
