# SPDX-License-Identifier: MIT
"""The error that a run states for its preset is the one that it has against the closed form."""

from __future__ import annotations

import pytest
from cli_support import Program, history, summary

GROWTH = """\
[scene]
name = "growth"
duration_h = 3
[root]
length_mm = 0.8
radius_mm = 0.04
cell_size_mm = 0.01
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.51
s_e_per_mm = 6
c_e = 0.2
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.37
c_g = -1
[non_affine_control]
[output]
every_h = 1
"""


@pytest.mark.parametrize(
    "accuracy", ["fast", pytest.param("balanced", marks=pytest.mark.slow), pytest.param("reference", marks=pytest.mark.slow)]
)
def test_the_stated_error(program: Program, accuracy: str):
    """The tip's way between 1 and 3 h differs from the closed form's by what the summary states, give or take a fifth."""
    scene = program.scene(GROWTH)
    assert program("run", scene, "--out", "out", "--accuracy", accuracy).status == 0
    length = [row["length_mm"] for row in history(program.folder / "out")]

    def closed_form_mm_h(length_mm: float) -> float:
        found = program("check", scene, "--set", f"root.length_mm={length_mm}", "--json").json()
        return found["closed_form_tip_speed_mm_h"]

    v = [closed_form_mm_h(length[hour]) for hour in (1, 2, 3)]
    error = (length[3] - length[1]) / ((v[0] + 4.0 * v[1] + v[2]) / 3.0) - 1.0  # Simpson's rule over 2 h
    stated = summary(program.folder / "out")["discretisation_error"]
    assert 0.8 * stated < abs(error) < 1.2 * stated, error
