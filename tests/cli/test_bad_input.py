# SPDX-License-Identifier: MIT
"""Wrong input: one clear message, the right exit status, and nothing overwritten."""

from __future__ import annotations

import fcntl
import json
import os
import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from cli_support import FULL, PROJECT, SECTIONS, SMALL, Done, Program, digest, frames, replaced, same_results

BAD_INPUT = 2
FILE_TROUBLE = 5


def assert_one_message(done: Done, status: int, *parts: str) -> None:
    """One message on stderr with all these parts, and the exit status."""
    assert done.status == status, done.err
    assert done.err.startswith("rootsoil: ") and done.err.count("rootsoil: ") == 1, done.err
    assert "internal error" not in done.err and "Traceback" not in done.err
    assert status != FILE_TROUBLE or "\n  to do:   " in done.err, done.err
    for part in parts:
        assert part in done.err, f"'{part}' is not in:\n{done.err}"


IN_SPACE = replaced(SMALL, 'name = "small"', "dimension = 3")

SOIL = """
[numerics]
stepper = "symplectic"

[soil]
box_from_mm = [0.05, -1.5]
box_to_mm = [3.0, 1.5]
confining_pressure_MPa = 0.1
d_range_mm = [0.2, 0.3]
E_MPa = 250.0
"""
GROWING_IN_SOIL = SMALL + SECTIONS["pressure"] + SECTIONS["growth"] + SOIL


def stone(x_mm: float, y_mm: float, more: str = "") -> str:
    """A ball in the soil."""
    return f'[[soil.obstacle]]\nshape = "stone"\nposition_mm = [{x_mm}, {y_mm}]\nradius_mm = 0.3\n{more}'


# What is wrong, the scene, and what the message says: line and key, given, allowed or remedy.
SCENES: dict[str, tuple[str, tuple[str, ...]]] = {
    "not TOML": (replaced(SMALL, "[root]", "[root"), ("scene.toml:5: ",)),
    "unknown key": (
        replaced(SMALL, "radius_mm", "radus_mm"),
        ("scene.toml:7: root.radus_mm: unknown key", "did you mean radius_mm?"),
    ),
    "unknown section": (
        SMALL + "\n[grwth]\n",
        ("scene.toml:16: grwth: unknown section", "did you mean growth?"),
    ),
    "key in the wrong section": (
        replaced(SMALL, "every_h", "duration_h = 1\nevery_h"),
        ("scene.toml:14: output.duration_h: unknown key", "is a key of [scene]"),
    ),
    "missing key": (
        replaced(SMALL, "radius_mm = 0.02\n", ""),
        ("scene.toml:5: root.radius_mm: this key is missing", "allowed: a number above 0"),
    ),
    "missing section": (
        SMALL[: SMALL.index("[output]")],
        ("scene.toml: section [output] is missing", "add it"),
    ),
    "wrong type": (
        replaced(SMALL, "0.02", '"0.02"'),
        ("scene.toml:7: root.radius_mm: this is not a number", "given:   '0.02'", "without quotes"),
    ),
    "negative radius": (
        replaced(SMALL, "0.02", "-0.02"),
        ("scene.toml:7: root.radius_mm: ", "given:   -0.02", "allowed: a number above 0"),
    ),
    "not a number": (
        replaced(SMALL, "0.02", "nan"),
        ("scene.toml:7: root.radius_mm: this is not a finite number", "given:   nan"),
    ),
    "Poisson ratio": (
        replaced(SMALL, "1020.0", "1020.0\nnu_axial = 1.2"),
        ("scene.toml:12: tissue.nu_axial: ", "given:   1.2", "allowed: a number above -1, below 1"),
    ),
    "compliance not positive definite": (
        replaced(SMALL, "1020.0", "1020.0\nnu_axial = 0.9") + SECTIONS["anisotropy"],
        ("scene.toml:12: tissue.nu_axial: the compliance matrix is not positive definite", "given:   nu_axial = 0.9"),
    ),
    "zero duration": (
        replaced(SMALL, "duration_h = 0.2", "duration_h = 0"),
        ("scene.toml:3: scene.duration_h: ", "given:   0", "allowed: a number above 0"),
    ),
    "more cells than memory": (
        replaced(SMALL, "cell_size_mm = 0.01", "cell_size_mm = 1e-6"),
        ("scene.toml:8: root.cell_size_mm: ", "given:   1e-06", "are all lengths in mm?"),
    ),
    "division threshold in metres": (
        SMALL + SECTIONS["division"].replace("0.011", "1.1e-5"),
        (
            "scene.toml:17: division.l0_mm: ",
            "would divide into some",
            "times longer than the threshold at its place",
            "is the threshold in mm?",
        ),
    ),
    "obstacle in the root": (
        SMALL + '[[obstacle]]\nshape = "disc"\nposition_mm = [0.05, 0.0]\nradius_mm = 0.01\n',
        (
            'scene.toml:17: obstacle[1].position_mm: the obstacle "obstacle_1" (disc) overlaps the root at the start',
            "given:   4 of 50 cells reach into it; the deepest, at (0.055, -0.005) mm, 0.00793 mm, 0.79 of its width",
            "allowed: a root that touches it: no cell deeper than 0.2 of its width",
        ),
    ),
    "plane that faces away": (
        SMALL + '[[obstacle]]\nshape = "plane"\nposition_mm = [0.2, 0.0]\nangle_deg = -90\n',
        ("obstacle[1].position_mm: ", "50 of 50 cells reach into it", "a plane's normal towards the root?"),
    ),
    "box beside the clamp": (
        SMALL + '[[obstacle]]\nshape = "box"\nposition_mm = [-0.05, 0.0]\nhalf_size_mm = [0.04, 0.05]\n',
        ("obstacle[1].position_mm: ", "8 of 50 cells reach into it"),
    ),
    "disc smaller than a cell": (
        SMALL + '[[obstacle]]\nshape = "disc"\nposition_mm = [0.2, 0.0]\nradius_mm = 0.004\n',
        (
            'obstacle[1].radius_mm: the obstacle "obstacle_1" (disc) is smaller than a cell',
            "given:   0.004 mm; cells are 0.01 mm large",
            "allowed: at least half a cell, 0.005 mm",
        ),
    ),
    "box smaller than a cell, between the root's cells": (
        SMALL + '[[obstacle]]\nshape = "box"\nposition_mm = [0.05, 0.0]\nhalf_size_mm = [0.02, 0.001]\n',
        ("scene.toml:18: obstacle[1].half_size_mm: ", "(box) is smaller than a cell", "given:   0.001 mm"),
    ),
    "sphere between the root's cells": (
        IN_SPACE + '[[obstacle]]\nshape = "sphere"\nposition_mm = [0.05, 0.0, 0.0]\nradius_mm = 0.0052\n',
        (
            "overlaps the root at the start",
            "its centre (0.05, 0, 0) mm lies in the tissue, 0.87 cell lengths from a cell",
        ),
    ),
    "normal too short": (
        SMALL + '[[obstacle]]\nshape = "plane"\nposition_mm = [0.2, 0.0]\nnormal = [-1e-200, 0]\n',
        ("obstacle[1].normal: the normal is too short", "given:   [-1e-200, 0.0]\n", "a vector longer than 1e-12"),
    ),
    "probe far away": (
        SMALL + "[[probe]]\nposition_mm = [50, 50]\n",
        (
            'scene.toml:16: probe[1].position_mm: there is no cell near the probe "probe_1"',
            "given:   (50, 50) mm: the nearest cell is at (0.085, 0.015) mm, 70.6 mm away",
            "allowed: a point at most 3 cell lengths from a cell",
        ),
    ),
    "bin of a probe beyond the root": (
        SMALL + "[[probe]]\ndistance_to_tip_mm = [5, 6]\n",
        ("probe[1].distance_to_tip_mm: there is no cell", "given:   [5.0, 6.0]", "mm: the root does not grow"),
    ),
    "bin of a probe that growth does not reach": (
        SMALL + SECTIONS["pressure"] + SECTIONS["growth"] + "[[probe]]\ndistance_to_tip_mm = [5, 6]\n",
        ("probe[1].distance_to_tip_mm: ", "allowed: 0 to 0.125 mm now, ", "when the root has grown for 0.2 h"),
    ),
    "bin of a probe between cells": (
        SMALL + "[[probe]]\ndistance_to_tip_mm = [0.051, 0.052]\n",
        ("probe[1].distance_to_tip_mm: ", "make the bin wider than a cell"),
    ),
    "force on nothing": (
        SMALL + "[force]\naxial_N = 0.01\ndistance_to_tip_mm = [5, 6]\n",
        (
            "scene.toml:17: force.distance_to_tip_mm: the force has nothing to act on",
            "given:   [5.0, 6.0]",
            "allowed: a band within 0 to 0.095 mm",
        ),
    ),
    "force on the clamp": (
        SMALL + "[force]\naxial_N = 0.01\ndistance_to_tip_mm = [0.1, 0.2]\n",
        ("force.distance_to_tip_mm: ", "no cell that can move is in its band"),
    ),
    "response to what nothing exerts": (
        SMALL
        + SECTIONS["pressure"]
        + '[growth]\nx_g_mm = 0.05\ns_g_mm = 0.15\nc_g = -0.95\n[response]\nfollows = "perceived"\n'
        + "[response.growth]\np_MPa = [1, 0]\nlambda0_ug_mm3_h = [4e5, 3e5]\n",
        (
            "scene.toml:23: response.follows: there is nothing that the root could perceive",
            'given:   "perceived"',
            "add [soil], [[obstacle]] or [force], or take follows out",
        ),
    ),
    "kernel that reaches no cell": (
        SMALL + '[numerics]\nkernel = "isotropic"\nH_bar = 0.1\n',
        (
            "scene.toml:17: numerics.H_bar: the kernel reaches too few cells",
            "given:   0.1: it reaches 0.283 cell lengths; half of the cells have 0 partners or fewer",
            "allowed: at least 3 partners for most cells",
            "the paper takes 2 to 8",
        ),
    ),
    "kernel that reaches to the next cell's centre, where it is zero": (
        IN_SPACE + "[numerics]\neta = 0.5\n",
        (
            "numerics.eta: the kernel reaches too few cells",
            "have 0 partners or fewer",
            "allowed: at least 4 partners",
            "1.3 to 1.5",
        ),
    ),
    "time beyond measure": (
        SMALL + "[pressure]\ntable = [[-1e308, 1], [1e308, 0.5]]\n",
        (
            "scene.toml:16: pressure.table: the time is outside its range",
            "given:   -1e+308",
            "times from -1e+06 to 1e+06 h",
            "are these seconds?",
        ),
    ),
    "time of a force beyond measure": (
        SMALL + "[force]\naxial_N = 0.01\ntable = [[0, 1], [2e6, 0.5]]\n",
        ("force.table: the time is outside its range", "given:   2000000"),
    ),
    "a number that the machine hardly knows": (
        SMALL + SECTIONS["pressure"] + SECTIONS["growth"].replace("0.15", "1e-320"),
        ("growth.s_g_mm: the value is too small to compute with", "give at least 1e-300"),
    ),
    "stones that overlap": (
        SMALL + SOIL + stone(1.0, 0.6) + stone(1.2, 0.7),
        (
            "soil.obstacle[2].position_mm: 'soil.obstacle_1' and 'soil.obstacle_2' overlap",
            "only fixed boxes and plates may overlap",
        ),
    ),
    "movable stone in a box": (
        SMALL
        + SOIL
        + stone(1.0, 0.6, "movable = true\n")
        + '[[soil.obstacle]]\nshape = "box"\nposition_mm = [1.4, 0.6]\nhalf_size_mm = [0.2, 0.2]\n',
        ("'soil.obstacle_1' and 'soil.obstacle_2' overlap", "'soil.obstacle_1' reaches 0.1 mm into"),
    ),
    "inertial number of nothing": (
        GROWING_IN_SOIL + "inertial_number_max = 1e-300\n",
        ("soil.inertial_number_max: ", "given:   1e-300", "allowed: a number at least 1e-06"),
    ),
    "substeps without end": (
        GROWING_IN_SOIL + "inertial_number_max = 1e-6\nstep_safety = 1e-3\n",
        (
            "soil.step_safety: the grains would take ",
            "allowed: at most 1e+05 substeps; step_safety is usually 0.5",
            "raise inertial_number_max",
        ),
    ),
    "density of real grains": (
        SMALL + SOIL + "density_N_h2_mm4 = 2e-16\n",
        ("soil.density_N_h2_mm4: the grains would take ", "leave density_N_h2_mm4 out"),
    ),
    "density beyond measure": (
        SMALL + SOIL + "density_N_h2_mm4 = 1e308\n",
        ("soil.density_N_h2_mm4: the value is outside its range", "at least 1e-20, at most 1000"),
    ),
    "frames that fill the disk": (
        replaced(SMALL, "every_h = 0.1", "every_h = 1e-18"),
        (
            "scene.toml:14: output.every_h: 2.0e+17 frames would fill",
            "given:   1e-18",
            "at least 2e-07 h: 1e+06 frames",
        ),
    ),
    "step too short": (
        SMALL + "[numerics]\nstep_h = 1e-19\n",
        ("scene.toml:16: numerics.step_h: the step is too short", "given:   steps of 1e-19 h", "at least 1e-09 h"),
    ),
    "steps without end": (
        replaced(SMALL, "duration_h = 0.2", "duration_h = 1e4") + "[numerics]\nstep_h = 2e-9\n",
        ("numerics.step_h: the run would take 5.0e+12 steps", "at most 1e+12 of them", "take a longer step"),
    ),
    "duration too short": (
        replaced(replaced(SMALL, "duration_h = 0.2", "duration_h = 1e-300"), "every_h = 0.1", "every_h = 1e-300"),
        ("output.every_h: the step is too short", "run for longer"),
    ),
    "growth without measure": (
        SMALL + SECTIONS["pressure"] + SECTIONS["growth"].replace("1.3e6", "1e300"),
        ("growth: the step is too short", "give numerics.step_h"),
    ),
    "sleep that looks never": (
        SMALL + "[sleep]\nmean_over_h = 1e300\n",
        ("scene.toml:16: sleep.mean_over_h: ", "at most 10000"),
    ),
    "torn lattice": (
        replaced(SMALL, "cell_size_mm = 0.01", "cell_size_mm = 0.01\njitter = 0.5\nsize_variation = 0.95"),
        ("scene.toml:10: root.size_variation: ", "lower curvature, size_variation or jitter"),
    ),
    "soil": (SMALL + "\n[soil]\n", ("scene.toml:16: soil.box_from_mm: this key is missing", "Corner of the box")),
    "no such cell file": (
        replaced(SMALL, 'name = "small"', "dimension = 3").replace(
            "length_mm = 0.1\nradius_mm = 0.02\ncell_size_mm = 0.01", 'cells_file = "none.csv"'
        ),
        ("scene.toml:6: root.cells_file: there is no such file", '"none.csv"', "starts from the scene file's folder"),
    ),
    "hyperbolicity": (
        replaced(SMALL, "1020.0", '1020.0\nlaw = "pressure_deviator"')
        + replaced(SECTIONS["anisotropy"], "12000.0", "15300.0"),
        (
            "scene.toml:12: tissue.law: the law is not hyperbolic",
            "E_R/E_A",
            "E_R/E_A below 2.7",
            'law = "elastic_growth"',
        ),
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_scene(program: Program, name: str):
    """`run` and `check` refuse it in the same words; the folder is not even made."""
    text, parts = SCENES[name]
    scene = program.scene(text)
    done = program("run", scene, "--out", "out")
    assert_one_message(done, BAD_INPUT, str(scene), *parts)
    assert program("check", scene).err == done.err
    assert not (program.folder / "out").exists()


CELLS_HEADER = "Label,pos.X (um),pos.Y (um),pos.Z (um),e1.X,e1.Y,e1.Z,e2.X,e2.Y,e2.Z,r1 (um),r2 (um),r3 (um)\n"


def cell_row(label: int, x: float, y: float, r: float = 5.0, z: float = 0.0) -> str:
    """A ball."""
    return f"{label},{x},{y},{z},1,0,0,0,1,0,{r},{r},{r}\n"


TWO_ROWS = [cell_row(k, 10 * (k // 2), 10 * (k % 2)) for k in range(1, 61)]

# What is wrong, the rows, and what the message says.
NO_TISSUE: dict[str, tuple[list[str], tuple[str, ...]]] = {
    "stray cell": (
        [*TWO_ROWS, cell_row(99, 5000, 0)],
        (
            "cells.csv:62: root.cells_file: 1 of 61 cells lies apart",
            "cell 99 (line 62) is 4.7 mm from the next, cell 60",
        ),
    ),
    "cell 10 m away": ([*TWO_ROWS, cell_row(99, 0, -1e7)], ("cell 99 (line 62) is 1e+04 mm from the next",)),
    "cell given twice": (
        [*TWO_ROWS, cell_row(99, 100, 0.5)],
        (
            "cells.csv:62: ",
            "cells lie in one place: cell 20 (line 21) and cell 99 (line 62)",
            "centres 0.0005 mm apart",
        ),
    ),
    "speck of nearly no size": ([*TWO_ROWS, cell_row(99, 105, 5, 0.001)], ("cells.csv:62: cell 99 is out of prop",)),
    "cells of nearly no size": (
        [cell_row(k, 10 * (k // 2), 10 * (k % 2), 0.001) for k in range(60)],
        ("apart from the others", "0.01 mm from the next", "all in one unit?"),
    ),
    "diameters": (
        [
            cell_row(100 * i + 10 * j + k, 10 * i, 10 * j, 10.0, 10 * k)
            for i in range(12)
            for j in range(5)
            for k in range(5)
        ],
        ("the cells overlap", "semi-axes, not diameters"),
    ),
}


@pytest.mark.parametrize("name", NO_TISSUE)
def test_cells_that_are_no_tissue(program: Program, name: str):
    """Cells that are no tissue: named with label, line and distance, at once."""
    rows, parts = NO_TISSUE[name]
    (program.folder / "cells.csv").write_text(CELLS_HEADER + "".join(rows))
    scene = program.scene(
        replaced(SMALL, 'name = "small"', "dimension = 3").replace(
            "length_mm = 0.1\nradius_mm = 0.02\ncell_size_mm = 0.01", 'cells_file = "cells.csv"'
        )
        + SECTIONS["pressure"]
        + SECTIONS["growth"]
    )
    assert_one_message(program("check", scene), BAD_INPUT, *parts)
    assert_one_message(program("run", scene, "--out", "out"), BAD_INPUT, *parts)
    assert not (program.folder / "out").exists()


MEASURED = replaced(SMALL, 'name = "small"', "dimension = 3").replace(
    "length_mm = 0.1\nradius_mm = 0.02\ncell_size_mm = 0.01", 'cells_file = "cells.csv"'
)
BLOCK = [(100 * i + 10 * j + k, 10.0 * i, 10.0 * j, 10.0 * k) for i in range(12) for j in range(4) for k in range(4)]


def block_rows(cells=BLOCK) -> str:
    return "".join(cell_row(label, x, y, z=z) for label, x, y, z in cells)


def test_what_was_found_in_a_cell_file(program: Program):
    """`check` says how many cells, how large, along which axis, and what became of specks."""
    rows = block_rows() + cell_row(9999, 60, 35.5, 0.6, z=10)
    (program.folder / "cells.csv").write_text(CELLS_HEADER + rows)
    done = program("check", program.scene(MEASURED))
    assert done.status == 0, done.err
    for part in (
        "193 cells in the file, 0.12 mm long",
        "tip towards +x",
        "turned by 0.",
        "1 specks merged into the cells that they touch: 9999 (line 194) into 631",
        "volumes are multiplied by 1.9",
    ):
        assert part in done.out, done.out
    found = json.loads(program("check", program.scene(MEASURED), "--json").out)["cell_file"]
    assert found["merged"] == [{"label": 9999, "line": 194, "into": 631}]
    assert found["hull_mm3"] == pytest.approx(0.12 * 0.04 * 0.04, rel=0.06)


def test_a_cell_file_that_lies_another_way(program: Program):
    """Across the asked axis: refused, with what to write instead; a cube has no axis."""
    (program.folder / "cells.csv").write_text(CELLS_HEADER + block_rows())
    asked = replaced(MEASURED, 'cells_file = "cells.csv"', 'cells_file = "cells.csv"\ntip_axis = "+y"')
    assert_one_message(
        program("check", program.scene(asked)),
        BAD_INPUT,
        "cells.csv: root.tip_axis: the root of the cell file lies across the axis",
        "90 degrees",
        'tip_axis = "auto"',
    )
    (program.folder / "cells.csv").write_text(CELLS_HEADER + block_rows(BLOCK[: 4 * 16]))
    assert_one_message(program("check", program.scene(MEASURED)), BAD_INPUT, "no axis can be found", "give tip_axis")


def test_columns_by_other_names(program: Program):
    """A table of semicolons and decimal commas, in millimetres, with whole axes."""
    table = "nr;x;y;z;e1.X;e1.Y;e1.Z;e2.X;e2.Y;e2.Z;a;b;c\n" + "".join(
        ";".join(str(v).replace(".", ",") for v in (label, x / 1e3, y / 1e3, z / 1e3, 1, 0, 0, 0, 1, 0, *[0.01] * 3))
        + "\n"
        for label, x, y, z in BLOCK
    )
    (program.folder / "cells.csv").write_text(table)
    columns = '[root.columns]\nlabel = "nr"\nposition = ["x", "y", "z"]\ndiameters = ["a", "b", "c"]\n'
    assert_one_message(
        program("check", program.scene(MEASURED + columns)),
        BAD_INPUT,
        "cells.csv:1: column 'x': the unit",
        "[root.columns]",
    )
    done = program("check", program.scene(MEASURED + columns + 'unit = "mm"\n'))
    assert done.status == 0, done.err
    assert "192 cells in the file, 0.12 mm long" in done.out


def test_hyperbolicity_lost_at_the_ratio_of_the_paper(program: Program):
    """E_R/E_A = 15 is named, and scene.allow_unstable is a way to go on."""
    text, _ = SCENES["hyperbolicity"]
    text = replaced(text, "s_e_per_mm = 40.0", "s_e_per_mm = 0.0").replace("c_e = 0.2", "c_e = 1.0")
    assert_one_message(program("check", program.scene(text)), BAD_INPUT, "E_R/E_A = 15,", "allow_unstable = true")
    assert program("check", program.scene(text), "--set", "scene.allow_unstable=true").status == 0


def test_scene_file_missing(program: Program):
    """No file, or a folder in its place."""
    assert_one_message(program("run", "none.toml"), BAD_INPUT, "none.toml: there is no such scene file", "to do: ")
    for given in ("case1_isotropc", "Case1_isotropic.toml", "scenes/case1_isotropi.toml"):
        for command in ("run", "check"):
            assert_one_message(
                program(command, given),
                BAD_INPUT,
                f"{given}: there is no such scene file",
                "scenarios: case1_anisotropic, case1_balanced, ",
                "did you mean case1_isotropic?",
            )
    assert_one_message(program("run", "."), BAD_INPUT, "this is a folder", "to do: ")
    assert list(program.folder.iterdir()) == []


def test_what_is_not_refused(program: Program):
    """The limits' other side: two cells across with a kernel that reaches the next ones, a stone let into a fixed box,
    an obstacle as large as a cell that the root touches, a probe in front of the root."""
    two_across = SMALL.replace("radius_mm = 0.02", "radius_mm = 0.01") + "[numerics]\neta = 0.75\n"
    box = '[[soil.obstacle]]\nshape = "box"\nposition_mm = [1.4, 0.6]\nhalf_size_mm = [0.2, 0.2]\n'
    disc = '[[obstacle]]\nshape = "disc"\nposition_mm = [0.1045, 0.0]\nradius_mm = 0.005\n'
    ahead = "[[probe]]\nposition_mm = [0.115, 0.0]\n[[probe]]\ndistance_to_tip_mm = [0.05, 60]\n"
    for text in (two_across, SMALL + SOIL + stone(1.0, 0.6) + box, SMALL + disc, SMALL + ahead):
        done = program("check", program.scene(text))
        assert done.status == 0, done.err


def test_check_says_when_it_takes_long(program: Program):
    """What check does with very many cells, before it does it; nothing where it is quick."""
    many = SMALL.replace("cell_size_mm = 0.01", "cell_size_mm = 1.8e-4")
    done = program("check", program.scene(many))
    assert done.status == 0
    assert done.err == "check makes all 0.12 million cells to see what a run costs: some 4 s, and 0.26 GB of memory\n"
    assert program("check", program.scene(SMALL)).err == ""


def test_soil_alone(program: Program):
    """A file for the penetrometer is no scene, and the message says what it is for."""
    for file in sorted((PROJECT / "scenarios" / "soils").glob("*.toml")):
        for command in ("run", "check"):
            assert_one_message(
                program(command, file),
                BAD_INPUT,
                f"{file}: section [root] is missing: the file describes a soil alone",
                "rootsoil penetrometer takes such a file",
            )


def test_override(program: Program):
    """--set and --accuracy are named as the place of the mistake."""
    scene = program.scene(SMALL)
    assert_one_message(program("check", scene, "--set", "root.radus_mm=1"), BAD_INPUT, "--set", "radius_mm?")
    assert_one_message(program("check", scene, "--set", "root.radius_mm"), BAD_INPUT, "--set", "section.key=value")
    assert_one_message(
        program("check", scene, "--accuracy", "best"), BAD_INPUT, "--accuracy", "fast, balanced, reference"
    )
    # of two keys that do not go together, the one to blame
    duration, frames_ = ("--set", "scene.duration_h=0.05"), ("--set", "output.every_h=0.3")
    assert_one_message(
        program("check", scene, *duration),
        BAD_INPUT,
        "from --set: scene.duration_h: the run would end before its first frame",
        "given:   0.05",
        "at least output.every_h = 0.1",
    )
    assert_one_message(program("check", scene, *frames_), BAD_INPUT, "from --set: output.every_h: the first frame")


def test_command_line(program: Program):
    """Mistakes in the command line, and in the environment that it replaces, name what was given."""
    scene = program.scene(SMALL)
    assert_one_message(program(), BAD_INPUT, "subcommand", "--help")
    assert_one_message(program("rnu", scene), BAD_INPUT, "rnu", "did you mean run?")
    assert_one_message(program("run"), BAD_INPUT, "SCENE is required")
    assert_one_message(program("run", scene, "--thread", "2"), BAD_INPUT, "--thread")
    for threads in ("0", "1.5", "-1", "100000", "two"):
        assert_one_message(
            program("run", scene, f"--threads={threads}"), BAD_INPUT, f"{threads} is not a whole number from 1 to 256"
        )
    for until in ("0", "-1", "nan", "soon"):
        assert_one_message(program("run", scene, f"--until={until}"), BAD_INPUT, f"{until} is not a number above 0")
    for threads in ("257", "5000", "100000", "4294967295"):
        program.environment["OMP_NUM_THREADS"] = threads
        for command in ("run", "check"):
            assert_one_message(
                program(command, scene), BAD_INPUT, "OMP_NUM_THREADS: ", f"given:   {threads}", "allowed: 1 to 256"
            )
    for threads in ("0", "-3", "abc", ""):
        program.environment["OMP_NUM_THREADS"] = threads
        done = program("check", scene)  # OpenMP itself says something before us
        assert done.status == BAD_INPUT
        assert "OMP_NUM_THREADS: the environment asks for a number of threads that no machine has" in done.err
        assert f"given:   {threads or 'nothing'}\n  allowed: 1 to 256" in done.err
    assert program("run", scene, "--threads", "1", "--out", "own").status == 0  # the command line decides
    program.environment["OMP_NUM_THREADS"] = "1"
    assert_one_message(program("describe", "grwth"), BAD_INPUT, "grwth", "did you mean growth?")
    assert not (program.folder / "runs").exists()


# ---- cell files -----------------------------------------------------------------------------------

HEADER = "Label, pos.X (um), pos.Y (um), pos.Z (um), e1.X, e1.Y, e1.Z, e2.X, e2.Y, e2.Z, r1 (um), r2 (um), r3 (um)\n"
ROWS = [f"{n}, {10 * n}, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5\n" for n in range(1, 9)]
CELLS_SCENE = SCENES["no such cell file"][0].replace("none.csv", "cells.csv")


def with_row(row: str) -> str:
    """A good file with another row in line 3."""
    return HEADER + ROWS[0] + row + "\n" + "".join(ROWS[2:])


CELLS: dict[str, tuple[str, tuple[str, ...]]] = {
    "empty": ("", ("cells.csv: the file is empty", "allowed: a header: Label, pos.X (um)")),
    "0 cells": (HEADER, ("cells.csv: the file holds no cells", "allowed: one row or more")),
    "missing columns": (
        HEADER.replace(" e1.Y,", "").replace(" r3 (um)", " s3 (um)"),
        ("cells.csv:1: columns are missing: e1.Y, r3 (um)", "given:   Label, pos.X", "export position"),
    ),
    "NaN": (
        with_row("2, 20, nan, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'pos.Y (um)': ", "given:   nan", "a finite number"),
    ),
    "text": (
        with_row("2, 20, here, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'pos.Y (um)': not a number", "given:   here"),
    ),
    "short row": (with_row("2, 20, 0"), ("cells.csv:3: column 'pos.Z (um)': the value is missing", "13 values")),
    "duplicate labels": (
        with_row("1, 20, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'Label': two cells have the same label", "1, also in line 2"),
    ),
    "zero axis": (
        with_row("2, 20, 0, 0, 0, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'e1.X': ",),
    ),
    "axes not orthogonal": (
        with_row("2, 20, 0, 0, 1, 0, 0, 0.6, 0.8, 0, 5, 5, 5"),
        ("cells.csv:3: column 'e2.X': e1 and e2 are not orthogonal", "given:   e1.e2 = 0.6"),
    ),
    "negative semi-axis": (
        with_row("2, 20, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, -5"),
        ("cells.csv:3: column 'r3 (um)': a semi-axis must be positive", "given:   -5"),
    ),
    "semi-axes not in order": (
        with_row("2, 20, 0, 0, 1, 0, 0, 0, 1, 0, 5, 6, 5"),
        ("cells.csv:3: column 'r2 (um)': the semi-axes are not in descending order", "r1 >= r2 >= r3"),
    ),
    "metres": (
        with_row("2, 2e9, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'pos.X (um)': out of range", "micrometres"),
    ),
}


@pytest.mark.parametrize("name", CELLS)
def test_cells(program: Program, name: str):
    """A wrong cell file: file, line, column, given, allowed; nothing that looks like a run is left behind."""
    text, parts = CELLS[name]
    (program.folder / "cells.csv").write_text(text)
    scene = program.scene(CELLS_SCENE)
    done = program("run", scene, "--out", "out")
    assert_one_message(done, BAD_INPUT, str(program.folder / "cells.csv"), *parts)
    assert program("check", scene).err == done.err
    assert not set(digest(program.folder / "out")) - {".lock"}


def test_cells_are_right_otherwise(program: Program):
    """The file that the mistakes above are put into is accepted."""
    (program.folder / "cells.csv").write_text(HEADER + "".join(ROWS))
    done = program("check", program.scene(CELLS_SCENE), "--json")
    assert done.status == 0 and done.json()["cells"] == len(ROWS)


# ---- folders and disks ----------------------------------------------------------------------------


def test_folder_of_another_run(program: Program, full_run: Path):
    """A folder that holds a run is not touched, by the same scene or by another one, nor by a wrong --resume."""
    out = shutil.copytree(full_run, program.folder / "out")
    before = digest(out)
    for text in (FULL, SMALL):
        done = program("run", program.scene(text), "--out", out)
        assert_one_message(done, BAD_INPUT, "already holds a run; nothing was overwritten", str(out), "--resume")
    done = program("run", program.scene(SMALL), "--out", out, "--resume")
    assert_one_message(done, BAD_INPUT, "belongs to another scene", str(out / "scene.toml"))
    assert program("run", program.scene(replaced(FULL, "0.2\n", "0.25\n")), "--out", out).status == BAD_INPUT
    assert digest(out) == before


# What is changed on --resume, and what the message calls it. The run was begun with FULL.
CHANGES: dict[str, tuple[list[str], str]] = {
    "another value": (["--set", "growth.c_g=-0.9"], "growth.c_g = -0.9 (was -0.95)"),
    "two": (
        ["--set", "growth.c_g=-0.9", "--set", "root.jitter=0.2"],
        "root.jitter = 0.2 (was 0.1), growth.c_g = -0.9 (was -0.95)",
    ),
    "output times": (["--set", "output.every_h=0.05"], "output.every_h = 0.05 (was 0.1)"),
    "preset": (["--accuracy", "fast"], 'numerics.accuracy = "fast" (was "balanced")'),
    "step": (["--set", "numerics.step_h=0.0005"], "numerics.step_h = 0.0005 (was 0.001)"),
    "an obstacle's place": (["--set", "obstacle.1.friction=0.1"], "obstacle[1].friction = 0.1 (was 0.3)"),
    "seed": (["--set", "scene.seed=2"], "scene.seed = 2 (was 1)"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_resume_with_another_scene(program: Program, full_run: Path, name: str):
    """--resume names every key that differs, with both values, and touches nothing."""
    arguments, message = CHANGES[name]
    out = shutil.copytree(full_run, program.folder / "out")
    before = digest(out)
    done = program("run", program.scene(FULL), "--out", out, "--resume", *arguments)
    assert_one_message(done, BAD_INPUT, "belongs to another scene", f"given:   {message}\n", "scene.duration_h")
    assert digest(out) == before


def test_resume_without_an_effect(program: Program, full_run: Path):
    """A section that is taken out or put in is named by its keys."""
    out = shutil.copytree(full_run, program.folder / "out")
    text = FULL.replace(SECTIONS["division"], "")
    done = program("run", program.scene(text), "--out", out, "--resume")
    assert_one_message(done, BAD_INPUT, "division.l0_mm is absent (was 0.011)")


def test_resume_to_an_earlier_end(program: Program, full_run: Path):
    """A duration below what was reached is refused with its line."""
    out = shutil.copytree(full_run, program.folder / "out")
    scene = program.scene(replaced(FULL, "duration_h = 0.4", "duration_h = 0.3"))
    done = program("run", scene, "--out", out, "--resume")
    assert_one_message(
        done, BAD_INPUT, "scene.toml:3: scene.duration_h: ", "already beyond", "given:   0.3", "allowed: at least 0.4"
    )


def test_every_trace_of_a_run_protects_it(program: Program, full_run: Path):
    """One file of a run is enough for the folder to count as used."""
    scene = program.scene(SMALL)
    for name in ("scene.toml", "summary.json", "history.csv", "run.h5", "checkpoint.h5"):
        out = program.folder / name.replace(".", "_")
        out.mkdir()
        shutil.copy(full_run / name, out)
        before = digest(out)
        assert_one_message(program("run", scene, "--out", out), BAD_INPUT, "already holds a run", name)
        after = digest(out)
        assert {file: after[file] for file in before} == before


def test_folder_in_use(program: Program):
    """Two processes never write to one folder."""
    out = program.folder / "out"
    out.mkdir()
    with (out / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        done = program("run", program.scene(SMALL), "--out", out)
    assert_one_message(done, BAD_INPUT, "another process is writing", str(out), "--out")
    assert list(digest(out)) == [".lock"]


def test_resume_without_checkpoint(program: Program):
    """--resume where there is nothing to go on from."""
    done = program("run", program.scene(SMALL), "--out", "none", "--resume")
    assert_one_message(done, BAD_INPUT, "there is no checkpoint to go on from", "none", "leave --resume out")
    assert not (program.folder / "none").exists()


def test_damaged_checkpoint(program: Program, full_run: Path):
    """A checkpoint with one wrong byte, or cut short, is not believed."""
    scene = program.scene(FULL)
    whole = (full_run / "checkpoint.h5").read_bytes()
    changed = bytearray(whole)
    changed[len(whole) // 2] ^= 1
    for content in (bytes(changed), whole[:-1], b""):
        out = shutil.copytree(full_run, program.folder / "out")
        (out / "checkpoint.h5").write_bytes(content)
        before = digest(out)
        done = program("run", scene, "--out", out, "--resume")
        assert_one_message(done, FILE_TROUBLE, str(out / "checkpoint.h5"))
        assert {name: value for name, value in digest(out).items() if name != "run.log"} == {
            name: value for name, value in before.items() if name != "run.log"
        }
        shutil.rmtree(out)


def test_folder_that_cannot_be_made(program: Program):
    """A file in place of the folder, and a place where nobody can make one."""
    (program.folder / "file").write_text("mine")
    scene = program.scene(SMALL)
    for out in ("file", "file/below", "/proc/run"):
        assert_one_message(program("run", scene, "--out", out), FILE_TROUBLE, f"{out}: the run's folder cannot be")
    assert (program.folder / "file").read_text() == "mine"


def test_folder_without_permission(program: Program):
    """A folder that this user may not write to; root gives up its right to write everywhere."""
    out = program.folder / "out"
    out.mkdir(mode=0o555)
    as_anyone = ["setpriv", "--bounding-set=-dac_override"] if os.geteuid() == 0 else []
    command = [*as_anyone, *program.command("run", program.scene(SMALL), "--out", out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    found = Done(done.returncode, done.stdout, done.stderr)
    assert_one_message(found, FILE_TROUBLE, f"{out}: the run's folder cannot be written: Permission denied")
    assert list(out.iterdir()) == []


def test_export(program: Program, full_run: Path):
    """Wrong run, time and file of `export`."""
    assert_one_message(program("export", "none", "--csv", "a.csv"), BAD_INPUT, "none: there is no run here")
    for time in ("7", "-1", "soon"):
        done = program("export", full_run, f"--time={time}", "--csv", "a.csv")
        assert_one_message(done, BAD_INPUT, f"given:   {time}", "allowed: 0 to 0.4 (h), or last")
    assert_one_message(program("export", full_run, "--csv", "none/a.csv"), FILE_TROUBLE, "none/a.csv")
    (program.folder / "run.h5").write_bytes(b"not HDF5")
    assert_one_message(program("export", ".", "--csv", "a.csv"), FILE_TROUBLE, "run.h5")
    assert not (program.folder / "a.csv").exists()


def test_unknown_field(program: Program):
    """A field that the scene does not have is refused before anything of a run is written."""
    scene = program.scene(SMALL + 'fields = ["softening"]\n')
    done = program("run", scene, "--out", "out")
    assert_one_message(done, BAD_INPUT, "scene.toml:15: output.fields: ", "given:   softening", "allowed: ")
    assert program("run", program.scene(SMALL), "--out", "out").status == 0


def test_file_size_limit(program: Program, full_run: Path):
    """A file that cannot grow any further ends the run with status 5; frames stay readable and the run can go on."""
    scene, out = program.scene(FULL), program.folder / "out"
    most = sum(file.stat().st_size for file in full_run.iterdir() if file.name == "checkpoint.h5") - 8000
    done = program(
        "run", scene, "--out", out, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    )
    assert_one_message(
        Done(done.status, "", done.err[done.err.index("rootsoil: ") :]), FILE_TROUBLE, str(out), "cannot be written"
    )
    assert frames(out)
    assert program("run", scene, "--out", out, "--resume").status == 0
    same_results(out, full_run)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 400 kB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=400k", "tmpfs", disk]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode != 0:
        pytest.skip("no right to mount a small disk")
    yield disk
    subprocess.run(["umount", disk], check=True)


def test_full_disk(program: Program, small_disk: Path, full_run: Path):
    """A full disk: status 5, all frames that were reported are readable; with more room the run goes on to its end."""
    scene, out = program.scene(FULL), small_disk / "out"
    done = program("run", scene, "--out", out)
    assert done.status == FILE_TROUBLE
    assert f"rootsoil: {out}" in done.err and "No space left on device" in done.err
    written = frames(out)
    assert 0 < len(written) < len(frames(full_run))
    assert not list(out.rglob("*.tmp"))
    assert program("run", scene, "--out", out, "--resume").status == FILE_TROUBLE
    subprocess.run(["mount", "-o", "remount,size=20m", small_disk], check=True)
    done = program("run", scene, "--out", out, "--resume")
    assert done.status == 0, done.err
    same_results(out, full_run)
