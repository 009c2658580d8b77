# SPDX-License-Identifier: MIT
"""What is made of the closed form that a run wrote, against numbers worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rootsoil_tools.theory import ClosedForm


def uniform(rate: float = 0.4, length: float = 3.0) -> ClosedForm:
    """Isotropic tissue that grows alike everywhere: v = rate s, and dr/ds = r/s."""
    s = np.linspace(0.0, length, 301)
    return ClosedForm(
        {
            "distance_to_tip": s,
            "axial_strain_rate": np.full_like(s, rate),
            "speed_from_tip": rate * s,
            "relative_radius": np.maximum(s, 0.1) / 0.1,
        }
    )


def test_flow_and_travel_under_a_constant_rate():
    model = uniform()
    assert model.tip_speed(2.0) == pytest.approx(0.8)
    assert model.tip_speed(4.0) == pytest.approx(1.6), "beyond the root's length at its end's rate"
    assert model.carried_to(0.1, 3.0, 2.0) == pytest.approx(0.1 * math.exp(1.2), rel=1e-4)
    assert model.travel_time(0.1, 0.1 * math.exp(1.2), 2.0) == pytest.approx(3.0, rel=1e-4)
    assert math.isnan(model.travel_time(0.1, 2.5, 2.0)), "beyond the root"
    assert model.stretch(np.array([0.5, 1.0]), 3.0, 3.0) == pytest.approx(math.exp(1.2), rel=1e-3)
    assert model.radius(np.array([0.1, 0.2, 0.8]), 0.2, 0.05)[1:] == pytest.approx([0.05, 0.2])
    assert np.isnan(model.radius(np.array([0.1]), 0.2, 0.05)[0])


def test_growth_zone_ends_where_the_rate_falls():
    s = np.linspace(0.0, 3.0, 601)
    columns = {"distance_to_tip": s, "axial_strain_rate": np.where(s < 1.0, 0.4, 0.0)}
    assert ClosedForm(columns).growth_zone(3.0) == pytest.approx(1.0, abs=0.01)
    assert uniform().growth_zone(3.0) == pytest.approx(3.0)
