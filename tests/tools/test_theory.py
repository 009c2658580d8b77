# SPDX-License-Identifier: MIT
"""The closed forms against numbers worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rootsoil_tools import theory

TISSUE = {"E_axial_MPa": 1020.0, "nu_axial": 0.06, "nu_radial": 0.3, "rho0_ug_mm3": 1000.0}
GROWTH = {"lambda0_ug_mm3_h": 4.0e5, "x_g_mm": 0.32, "s_g_mm": 0.25, "c_g": 0.1}
ANISOTROPY = {"E_radial_max_MPa": 15000.0, "x_e_mm": 0.6, "s_e_per_mm": 5.0, "c_e": 0.0}


def model(dimension: int = 2, **sections: dict) -> theory.Model:
    scene = {"scene": {"dimension": dimension}, "tissue": TISSUE, "pressure": {"differential_MPa": 1.0}}
    return theory.model_of({**scene, **sections})


def test_softening_peaks_at_lambda0_one_slope_behind_the_inflection():
    s = np.linspace(0.0, 2.0, 200001)
    values = theory.softening(s, 4.0e5, 0.32, 0.25, 0.1)
    assert s[np.argmax(values)] == pytest.approx(0.57, abs=1e-5)
    assert values.max() == pytest.approx(4.0e5)


def test_softening_to_the_letter_never_ends():
    assert theory.softening(50.0, 4.0e5, 0.32, 0.25, 0.1) == pytest.approx(0.55 * 4.0e5)


def test_softening_is_clipped_at_zero():
    assert theory.softening(0.0, 1.0, 0.32, 0.25, -1.0) == 0.0


def test_mature_factor_is_a_cubic_between_its_ends():
    s = np.array([0.0, 1.1, 1.2, 1.3, 1.4, 1.5, 2.0])
    t = 0.75
    middle = 3 * t**2 - 2 * t**3
    assert theory.mature_factor(s, 1.3, 0.4) == pytest.approx([1.0, 1.0, middle, 0.5, 1.0 - middle, 0.0, 0.0])
    assert theory.mature_factor(s, 1.3, 0.0) == pytest.approx([1, 1, 1, 0, 0, 0, 0])
    assert theory.mature_factor(s, None, 0.4) == pytest.approx(np.ones(7))


def test_radial_modulus_is_half_way_at_the_inflection():
    assert theory.radial_modulus(0.6, 1020.0, 15000.0, 0.6, 5.0, 0.0) == pytest.approx((1020.0 + 15000.0) / 2.0)
    assert theory.radial_modulus(9.0, 1020.0, 15000.0, 0.6, 5.0, 0.2) == pytest.approx(15000.0)


def test_strain_of_equation_8():
    flat, solid = model(), model(dimension=3)
    assert flat.axial_strain() == pytest.approx(0.94 / 1020.0)
    assert flat.radial_strain(0.5) == pytest.approx(0.94 / 1020.0)
    assert solid.axial_strain() == pytest.approx(0.88 / 1020.0)
    assert solid.radial_strain(0.5) == pytest.approx((0.7 - 0.06) / 1020.0)
    stiff = theory.model_of(
        {
            "scene": {"dimension": 2},
            "tissue": {**TISSUE, "anisotropy": {**ANISOTROPY, "c_e": 1.0, "s_e_per_mm": 0.0}},
            "pressure": {"table": [[0.0, 0.5]]},
        }
    )
    assert stiff.radial_strain(0.5) == pytest.approx(0.5 * (1.0 / 15000.0 - 0.06 / 1020.0))


def test_peak_rate_of_table_1_with_a_tenth_of_lambda0():
    growing = model(growth=GROWTH)
    assert growing.axial_rate(0.57) == pytest.approx(4.0e5 / 1000.0 * 0.94 / 1020.0)
    assert growing.axial_rate(0.57) == pytest.approx(0.3686, abs=1e-4)


def test_no_growth_under_suction():
    assert not model(growth=GROWTH, pressure={"differential_MPa": -0.2}).axial_rate(np.linspace(0, 1, 11)).any()


def test_velocity_and_travel_under_a_constant_rate():
    """With c_g = 1, lambda = lambda0: v = rate s, and tissue moves away exponentially."""
    uniform = model(growth={**GROWTH, "c_g": 1.0})
    rate = 400.0 * 0.94 / 1020.0
    assert uniform.tip_speed(2.0) == pytest.approx(2.0 * rate)
    assert uniform.carried_to(0.1, 3.0, 2.0) == pytest.approx(0.1 * math.exp(3.0 * rate), rel=1e-4)
    s = np.array([0.1, 0.2, 0.8])
    # isotropic tissue: dr/ds = r/s
    assert uniform.radius(s, 0.2, 0.05)[1:] == pytest.approx([0.05, 0.2], rel=1e-2)
    assert np.isnan(uniform.radius(s, 0.2, 0.05)[0])


def test_growth_zone_ends_with_the_cut_off():
    zone = model(growth={**GROWTH, "c_g": 1.0, "mature_at_mm": 1.0, "mature_width_mm": 0.01}).growth_zone(3.0)
    assert zone == pytest.approx(1.0, abs=0.01)
    assert model(growth={**GROWTH, "c_g": 1.0}).growth_zone(3.0) == pytest.approx(3.0)


def test_pressure_table_is_linear_in_time():
    scene = {"pressure": {"table": [[0.0, 1.0], [10.0, 0.5]]}}
    assert [theory.pressure_at(scene, t) for t in (-1.0, 5.0, 20.0)] == pytest.approx([1.0, 0.75, 0.5])
    assert theory.pressure_at({}, 1.0) == 0.0


def test_response_of_equation_7():
    assert theory.respond([2.0, 6.0], [1.0, 0.5], 1.0) == pytest.approx(2.0)
    assert theory.respond([2.0, 6.0], [1.0, 0.5], 0.5) == pytest.approx(6.0)
    assert theory.respond([2.0, 6.0], [1.0, 0.5], 0.4) == pytest.approx(6.8)
    assert theory.respond([2.0, 6.0], [1.0, 0.5], 0.4, extrapolate=False) == pytest.approx(6.0)
    answered = model(
        growth=GROWTH,
        response={"growth": {"p_MPa": [1.0, 0.5], "s_g_mm": [0.2, 0.4]}},
        pressure={"differential_MPa": 0.75},
    )
    assert answered.growth["s_g"] == pytest.approx(0.3)
    assert answered.growth["x_g"] == 0.32
