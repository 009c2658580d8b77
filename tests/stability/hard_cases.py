# SPDX-License-Identifier: MIT
"""The hard cases: one small root each, with changes to a common base. The only place where they are defined.

A case is a scene, how long it runs (short for tests, long for tools/stability.py) and what it must come to, so that it
is as hard as its name says. mm, h, MPa.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rootsoil_tools import scenes
from rootsoil_tools.scenes import Changes, with_changes

PROJECT = Path(__file__).resolve().parents[2]
FRAMES = 6  # of a run, after the first

# 180 cells, 6 across. Softening peaks at 0.40 /h 0.2 mm from the tip and ends at 0.4 mm; the tip grows at 0.10 mm/h and
# cells divide at 1.5 times their size.
BASE: dict[str, Any] = {
    "scene": {"name": "base", "dimension": 2, "duration_h": 1.0, "seed": 3},
    "root": {"length_mm": 0.6, "radius_mm": 0.06, "cell_size_mm": 0.02},
    "tissue": {"E_axial_MPa": 1020.0, "nu_axial": 0.06, "nu_radial": 0.3,
               "anisotropy": {"E_radial_max_MPa": 15000.0, "x_e_mm": 0.05, "s_e_per_mm": 40.0, "c_e": 0.2}},
    "pressure": {"differential_MPa": 1.0},
    "growth": {"lambda0_ug_mm3_h": 4.34e5, "x_g_mm": 0.05, "s_g_mm": 0.15, "c_g": -0.95,
               "mature_at_mm": 0.4, "mature_width_mm": 0.1},
    "division": {"l0_mm": 0.03, "c_d": 1.0, "s_d_per_mm2": 10.0, "x_d_mm": 0.1, "constant_beyond_mm": 0.4},
    "non_affine_control": {},
    "output": {},
}  # fmt: skip

# Softening is the same everywhere: all tissue stretches at 0.40 /h. E_R is nearly such that the root keeps its radius.
# Centres are disturbed a little: a symmetric lattice stays symmetric where nothing else is stable.
UNIFORM: Changes = {
    "growth": {"lambda0_ug_mm3_h": 4.34e5, "x_g_mm": 0.05, "s_g_mm": 0.15, "c_g": 1.0},
    "tissue.anisotropy": {"E_radial_max_MPa": 15300.0, "x_e_mm": 0.0, "s_e_per_mm": 0.0, "c_e": 1.0},
    "root.length_mm": 0.2,
    "root.jitter": 0.02,
    "root.base": "free",  # a held base inside a growth zone is strained without end
}
# 3D: 4 across, and E_R that keeps the radius there
SPACE: Changes = {
    "scene.dimension": 3,
    "root.length_mm": 0.5,
    "root.radius_mm": 0.04,
    "tissue.anisotropy.E_radial_max_MPa": 12000.0,
}


@dataclass(frozen=True)
class Scheme:
    """A way to compute, as changes to a scene."""

    name: str
    changes: Changes


DEFAULT = Scheme("default", {})
PAPER = Scheme("paper", {**scenes.PAPER, "scene.allow_unstable": True})
SCHEMES = (DEFAULT, PAPER)


@dataclass(frozen=True)
class Case:
    """One hard case. `reaches`: what of the run must be at least how large, in a short and in a long run."""

    name: str
    meaning: str
    changes: Changes
    short_h: float
    long_h: float
    reaches: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    stress_MPa: float | None = None  # that the case itself calls for, where it is more than p
    neighbours: float | None = None  # that are enough, where 6 (3D: 12) are not to be had
    twin: tuple[str, ...] | None = None  # runs against the plate of tests/stability/twin_soil.cpp, with these arguments
    needs_yade: bool = False
    with_inertia: Changes = field(default_factory=dict)  # what a scheme with inertia, the paper's, needs besides
    remark: str = ""  # why it fails, where it does and is known
    restart: bool = False  # also interrupted in the middle and resumed, in the tests


def scene_text(case: Case, scheme: Scheme, hours: float, more: Changes | None = None) -> str:
    """The scene file of a case under a scheme that runs for some hours."""
    run = {"scene.name": case.name, "scene.duration_h": hours, "output.every_h": hours / FRAMES}
    scene = with_changes(BASE, {**case.changes, **run})
    needs = case.with_inertia if scheme is PAPER else {}
    return scenes.scene_text(with_changes(with_changes(scene, scheme.changes), {**needs, **(more or {})}))


def plane(x_mm: float, angle_deg: float, y_mm: float = 0.0, friction: float = 0.2) -> dict[str, Any]:
    """An obstacle: 90 degrees faces the root."""
    return {"shape": "plane", "position_mm": [x_mm, y_mm], "angle_deg": angle_deg, "friction": friction}


def corner(x_mm: float, y_mm: float) -> dict[str, Any]:
    """An obstacle: a square box that points a corner at the root, at this place."""
    half_mm = 0.2
    return {"shape": "box", "position_mm": [x_mm + half_mm * 2**0.5, y_mm], "half_size_mm": [half_mm, half_mm],
            "angle_deg": 45.0, "friction": 0.2}  # fmt: skip


def in_contact(*obstacles: dict[str, Any]) -> Changes:
    """Obstacles."""
    return {"obstacle": list(obstacles)}


def moduli(ratio: float) -> Changes:
    """E_R/E_A the same along the whole root."""
    return {"tissue.anisotropy": {"E_radial_max_MPa": 1020.0 * ratio, "x_e_mm": 0.0, "s_e_per_mm": 0.0, "c_e": 1.0}}


def width(cells: int) -> Changes:
    """A root some cells wide."""
    return {"root.radius_mm": 0.01 * cells}


SLENDER: Changes = {
    "root.radius_mm": 0.03,
    "root.curvature_per_mm": 0.02,
}
# A free end that a plane pushes along the axis with p (1 - nu_A) W buckles beyond
# pi/2 sqrt(E_A W^3/12/(p (1 - nu_A) W)) = 0.90 mm. Growing tissue yields: pressed for hours, it folds at any length.


def slender(length_mm: float, friction: float) -> Changes:
    """A root three cells wide and a little bent that grows onto a plane 0.01 mm away."""
    return {**SLENDER, "root.length_mm": length_mm, "obstacle": [plane(length_mm + 0.01, 90.0, friction=friction)]}


# A window an interval for a scheme with inertia at soil's plate; steps that end in balance take the usual interval.
AT_THE_PLATE: Changes = {"numerics.step_h": 1e-4}

# A root 6 across among some 50 grains of a third of its width, as scenarios/soil_tutorial.toml: a step an interval.
GRAINS: Changes = {
    "root.length_mm": 1.2,
    "root.radius_mm": 0.3,
    "root.cell_size_mm": 0.1,
    "growth": {"lambda0_ug_mm3_h": 3.0e5, "x_g_mm": 0.3, "s_g_mm": 0.5, "c_g": -0.95},
    "division": None,
    "soil": {"box_from_mm": [0.4, -1.2], "box_to_mm": [2.6, 1.2], "walls": "mixed", "confining_pressure_MPa": 0.04,
             "d_range_mm": [0.3, 0.4], "E_MPa": 250.0, "friction_deg": 30.0, "root_friction_deg": 20.0,
             "contact": {"interval_h": 4e-3, "ramp_h": 0.005}},
}  # fmt: skip
AMONG_GRAINS: Changes = {"numerics.step_h": 2e-4, "soil.contact.interval_h": 2e-3}  # with inertia


def cases() -> list[Case]:
    """Every hard case."""
    free = {"root.base": "clamped"}
    return [
        Case("base", "growth and division, nothing hard", free, 2.0, 20.0, {"divisions": (20, 200)}, restart=True),
        Case("stretch_10_division", "all tissue stretched 10-fold, cells divide", UNIFORM, 2.9, 5.76,
             {"stretch": (3.0, 9.5), "divisions": (60, 200)}, restart=True),
        Case("stretch_10_no_division", "all tissue stretched 10-fold, cells get 10 times as long",
             {**UNIFORM, "division": None}, 2.9, 5.76, {"stretch": (3.0, 9.5)}),
        Case("burst", "every free cell divides in the same window",
             {**UNIFORM, "root.length_mm": 0.3,
              "division": {"l0_mm": 0.0202, "c_d": 1.0, "s_d_per_mm2": 0.0, "x_d_mm": 0.0}},
             0.3, 2.0, {"divisions": (60, 60)}, restart=True),
        Case("ratio_1", "E_R/E_A = 1, all tissue grows and swells alike", {**UNIFORM, **moduli(1.0)}, 2.4, 5.0),
        Case("bulge", "E_R/E_A = 1 in the growth zone, which swells between tissue that does not",
             moduli(1.0), 1.0, 2.0),
        Case("ratio_4", "E_R/E_A = 4", moduli(4.0), 1.0, 10.0),
        Case("ratio_15", "E_R/E_A = 15", moduli(15.0), 1.0, 10.0),
        Case("ratio_50", "E_R/E_A = 50", moduli(50.0), 1.0, 10.0),
        Case("pressure_none", "p = 0", {"pressure.differential_MPa": 0.0}, 0.5, 10.0),
        Case("pressure_negative", "p = -1 MPa", {"pressure.differential_MPa": -1.0}, 0.5, 10.0),
        Case("pressure_stepped", "p = 1, 0.2, 1, 0 MPa, each change within 3.6 s",
             {"pressure": {"table": [[0.0, 1.0], [0.3, 1.0], [0.301, 0.2], [0.6, 0.2], [0.601, 1.0], [0.8, 1.0],
                                     [0.801, 0.0]]}}, 1.0, 4.0, restart=True),
        Case("pressure_at_once", "p rises from 0 to 1 MPa within one step",
             {"pressure": {"table": [[0.0, 0.0], [0.1, 0.0], [0.1000001, 1.0]]}}, 0.5, 4.0),
        Case("lambda_100", "lambda0 times 100: 40 /h", {"growth.lambda0_ug_mm3_h": 4.34e7}, 0.05, 0.2,
             {"divisions": (20, 100)}),
        Case("lambda_001", "lambda0 times 0.01: 0.004 /h", {"growth.lambda0_ug_mm3_h": 4.34e3}, 2.0, 20.0),
        Case("irregular", "volumes vary 10-fold, centres jittered by 0.3 of the spacing",
             {"root.size_variation": 0.82, "root.jitter": 0.3}, 2.0, 20.0, {"divisions": (20, 200)}, restart=True,
             remark="quiet for 17 h (0.31); then it has curled until it nearly meets itself"),
        Case("one_wide", "one cell wide", width(1), 2.0, 20.0, {"divisions": (3, 30)}),
        Case("two_wide", "two cells wide", width(2), 2.0, 20.0, {"divisions": (6, 60)},
             neighbours=5.0),  # a corner's on the lattice: two in its row, three in the other
        Case("three_wide", "three cells wide", width(3), 2.0, 20.0, {"divisions": (9, 90)}),
        Case("oblique_base", "base cut at 60 degrees", {"root.base_obliquity_deg": 60.0}, 2.0, 20.0),
        Case("curved", "bent to a radius of 0.2 mm; later it meets itself", {"root.curvature_per_mm": 5.0}, 2.0, 18.0),
        Case("head_on", "grows straight onto a wall", in_contact(plane(0.62, 90.0)), 0.6, 4.0,
             {"contact_N": (0.05, 0.05)}, restart=True),
        Case("glancing", "meets a wall at 15 degrees", in_contact(plane(0.62, 15.0, -0.08)), 1.8, 6.0,
             {"contact_N": (1e-4, 1e-4)}),
        Case("corner_on_axis", "grows onto the sharp corner of a box", in_contact(corner(0.62, 0.0)), 0.6, 4.0,
             {"contact_N": (0.01, 0.01)}),
        Case("corner_beside_axis", "the corner lies a cell beside the axis", in_contact(corner(0.62, 0.02)), 0.6, 4.0,
             {"contact_N": (1e-3, 1e-3)}),  # the corner presses the tip aside and the growth zone folds
        Case("appears_in_contact", "a wall that reaches a tenth of a cell into the tip at the start",
             in_contact(plane(0.598, 90.0)), 0.3, 4.0, {"contact_N": (0.05, 0.05)},
             stress_MPa=1020.0 * 0.002 / 0.6),
        Case("below_euler", "long and thin onto a wall, half of Euler's length", slender(0.45, 0.2), 0.6, 1.0,
             {"contact_N": (0.05, 0.05)}),
        # bent by 0.1 mm under Euler's load, pi^2 E W^3/12/(4 L^2): three cells across differ by what bends them
        Case("above_euler", "long and thin onto a wall, twice Euler's length", slender(1.8, 0.0), 1.5, 6.0,
             {"bend_mm": (0.02, 0.1)}, restart=True,
             stress_MPa=0.1 * (math.pi**2 * 1020.0 * 0.06**3 / 12.0 / (4.0 * 1.8**2)) / (0.06**2 / 6.0)),
        Case("generations_8", "8 generations of division: the very tip grows, all tissue descends from its few cells",
             {**moduli(15.0), "growth.x_g_mm": -0.1}, 5.0, 18.0, {"generation": (2, 8)}),
        Case("hours_100", "100 h", free, 6.0, 100.0,
             {"divisions": (60, 1000)}),
        Case("base_3d", "3D: growth and division", SPACE, 2.0, 8.0, {"divisions": (30, 100)}, restart=True),
        Case("stretch_3d", "3D: all tissue stretched, cells divide",
             # A round tip would become a spike of 2 x 2 cells.
             {**UNIFORM, **SPACE, "root.length_mm": 0.12, "root.cap": False,
              "tissue.anisotropy": {"E_radial_max_MPa": 11900.0, "x_e_mm": 0.0, "s_e_per_mm": 0.0, "c_e": 1.0}},
             2.0, 5.76, {"stretch": (1.9, 8.0)}),
        Case("irregular_3d", "3D: volumes vary 10-fold, centres jittered by 0.3",
             {**SPACE, "root.size_variation": 0.82, "root.jitter": 0.3}, 0.5, 6.0),
        Case("microscopy_3d", "3D: 1500 irregular cells from a microscopy file, neighbours touch",
             {**SPACE, "root": {"cells_file": str(PROJECT / "scenarios" / "cells" / "root_tip.csv"), "tip_axis": "+x"}},
             0.05, 1.5),
        Case("soil_arrested", "soil's plate arrests the root for 10 h", {}, 0.6, 10.5,
             {"contact_N": (0.1, 0.1)}, twin=(), restart=True, with_inertia=AT_THE_PLATE),
        Case("soil_release", "soil's plate arrests the root for 0.2 h and lets go at once", {},
             0.6, 2.0, {"contact_N": (0.1, 0.1), "stretch": (1.03, 1.2)}, twin=("--gone-at", "0.35"),
             with_inertia=AT_THE_PLATE),
        Case("soil_stiff", "YADE: grains 20 times as stiff as usual, root in contact from the start",
             {**GRAINS, "soil.E_MPa": 5000.0}, 0.02, 0.5, {"contact_N": (1e-3, 0.01)}, needs_yade=True,
             with_inertia=AMONG_GRAINS),
        Case("soil_squeezed", "YADE: grains between the tip and a wall that stands still two grains ahead",
             # the force varies as grains give way, up to 0.10 to 0.18 N/mm with any interval, and with inertia
             {**GRAINS, "soil.box_to_mm": [2.0, 1.2]}, 0.02, 2.0, {"contact_N": (1e-3, 0.08)}, needs_yade=True,
             with_inertia=AMONG_GRAINS),
        Case("soil_servo", "YADE: servo walls on all sides of some 50 grains, at a tenth of the usual pressure",
             {**GRAINS, "soil.walls": "servo", "soil.confining_pressure_MPa": 0.004}, 0.02, 0.5, needs_yade=True,
             with_inertia=AMONG_GRAINS),
    ]  # fmt: skip
