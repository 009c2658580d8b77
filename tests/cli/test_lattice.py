# SPDX-License-Identifier: MIT
"""A lattice that does not fit the asked root: what results is what was asked, and is said."""

from __future__ import annotations

from pathlib import Path

import pytest
from cli_support import SMALL, Program, history, replaced, summary

MISFIT = replaced(
    SMALL,
    "length_mm = 0.1\nradius_mm = 0.02\ncell_size_mm = 0.01",
    "length_mm = 1.05\nradius_mm = 0.1\ncell_size_mm = 0.08",
)


def test_misfit(program: Program):
    """2.5 cells would fit across: three narrower ones give the asked width, and run.log says so."""
    scene = program.scene(MISFIT)
    assert program("run", scene, "--out", "out", "--until", 0.1).status == 0
    out = program.folder / "out"
    first = history(out)[0]
    capsule_mm2 = 0.2 * 0.95 + 0.5 * 3.14159265 * 0.1**2
    assert first["length_mm"] == pytest.approx(1.05, rel=1e-9)
    # the mean section of a capsule, which 3 cells across do not round off at all: 2.1 % more
    assert first["mean_radius_mm"] == pytest.approx(0.5 * capsule_mm2 / 1.05, rel=0.03)
    said = (out / "run.log").read_text()
    assert "13 layers of cells, 3 across, each 0.08077 mm long and 0.06667 mm wide (asked 0.08)" in said
    lattice = summary(out)["lattice"]
    assert (lattice["width_mm"], lattice["asked_width_mm"]) == (0.2, 0.2)
    assert lattice["cell_width_mm"] == pytest.approx(0.2 / 3)


def test_fit(program: Program):
    """Where the asked size fits, only `check` states it."""
    scene = program.scene(SMALL)
    assert program("run", scene, "--out", "out", "--until", 0.1).status == 0
    said: Path = program.folder / "out" / "run.log"
    assert "lattice: " not in said.read_text()
    assert "lattice: 10 layers of cells, 4 across, each 0.01 mm long and 0.01 mm wide" in program("check", scene).out
    assert program("check", scene, "--json").json()["lattice"]["layers"] == 10
