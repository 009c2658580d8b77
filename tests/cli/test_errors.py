# SPDX-License-Identifier: MIT
"""The error that a run states for its preset is the one that it has against the closed form."""

from __future__ import annotations

import csv
import math

import pytest
from cli_support import Program, summary

GROWTH = """\
[scene]
name = "growth"
duration_h = 3
[root]
length_mm = 1.6
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
[division]
l0_mm = 0.015
c_d = 1
s_d_per_mm2 = 5
x_d_mm = 0.12
constant_beyond_mm = 0.5
[non_affine_control]
[output]
every_h = 0.5
"""


@pytest.mark.parametrize(
    "accuracy",
    ["fast", pytest.param("balanced", marks=pytest.mark.slow), pytest.param("reference", marks=pytest.mark.slow)],
)
def test_the_stated_error(program: Program, accuracy: str):
    """Axial strain rates of cells, where they are over a tenth of the peak, differ from the closed form's by what the
    summary states (rms, four frames), give or take a third."""
    scene = program.scene(GROWTH)
    assert program("run", scene, "--out", "out", "--accuracy", accuracy).status == 0
    peak = 4.3e5 / 1000.0 * (1.0 - 0.06) / 1020.0  # lambda0/rho0 p (1 - nu_A)/E_A
    errors = []
    for hour in (1.5, 2.0, 2.5, 3.0):
        assert program("export", "out", "--time", str(hour), "--csv", "cells.csv").status == 0
        with open(program.folder / "cells.csv", newline="") as file:
            for cell in csv.DictReader(file):
                s = float(cell["distance_to_tip"])
                z = (s + 0.05) / 0.37
                theory = peak * z * math.exp(0.5 - 0.5 * z * z)
                if theory > 0.1 * peak and cell["clamped"] == "0":
                    errors.append(float(cell["axial_strain_rate"]) / theory - 1.0)
    error = math.sqrt(sum(e * e for e in errors) / len(errors))
    stated = summary(program.folder / "out")["discretisation_error"]
    assert 0.67 * stated < error < 1.33 * stated, error


def test_few_cells_across_are_said(program: Program):
    """Below four cells across nothing was measured, and both `check` and the run say so."""
    text = GROWTH.replace("duration_h = 3", "duration_h = 0.5")
    scene = program.scene(text[: text.index("[division]")] + text[text.index("[non_affine_control]") :])
    for across, said in ((2, True), (8, False)):
        size = ("--set", f"root.cell_size_mm={0.08 / across}")
        assert ("fewer than four cells across" in program("check", scene, *size).out) == said
        done = program("run", scene, "--out", f"out_{across}", *size)
        assert done.status == 0 and ("fewer than four cells across" in done.err) == said, done.err
