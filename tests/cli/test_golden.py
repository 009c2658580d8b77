# SPDX-License-Identifier: MIT
"""The first minutes of every scene that comes with the program, against numbers that were recorded: golden_runs.csv.

They are right because the physics tests say so; here a change that should have changed nothing is found, in any scene.
$ROOTSOIL_RECORD=1 writes the numbers anew.
"""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from cli_support import PROJECT, Program, history

SCENES = PROJECT / "scenarios"
RECORDED = Path(__file__).with_name("golden_runs.csv")
COLUMNS = ("scene", "column", "value")
# What is left of a step's balance depends on the last digits, and they on the vector width: little is left here, and
# not compared.
BALANCE = "numerics.force_tolerance=1e-9"
RELATIVE, ABSOLUTE = 1e-6, 1e-8


@dataclass(frozen=True)
class Family:
    """Scenes that run alike: for so many hours, with these settings. `plate`: in place of grains that YADE moves."""

    hours: float
    settings: tuple[str, ...] = ()
    plate: bool = False


def coarse(cell_size_mm: float, divides_at_mm: float) -> tuple[str, ...]:
    """Settings for larger cells that divide early."""
    return f"root.cell_size_mm={cell_size_mm}", f"division.l0_mm={divides_at_mm}"


AT_REST = Family(0.32)
ARABIDOPSIS = Family(0.5, ("root.cell_size_mm=0.021",))
PEA = Family(2.0, coarse(0.16, 0.12))
GRAINS = Family(0.1, plate=True)
FAMILIES = {
    "case1_anisotropic": AT_REST,
    "case1_balanced": AT_REST,
    "case1_isotropic": AT_REST,
    "case2_arabidopsis": ARABIDOPSIS,
    "case2_as_printed": Family(0.05, coarse(0.025, 0.025)),
    "case3_as_printed": PEA,
    "case3_pea_hard": PEA,
    "case3_pea_soft": PEA,
    "cells_from_microscopy": Family(0.1, ("division.l0_mm=0.019",)),
    "growth_3d": Family(0.3, coarse(0.03, 0.026)),
    "growth_3d_full": Family(0.3, coarse(0.042, 0.036)),
    "obstacle_tilted": Family(0.5, ("root.length_mm=2.5", "division.l0_mm=0.021")),
    "soil_3d": replace(GRAINS, hours=0.08),
    "soil_buckling": replace(GRAINS, hours=0.08),
    "soil_hard": GRAINS,
    "soil_obstacle_s4": replace(GRAINS, hours=0.04),
    "soil_perceived": GRAINS,
    "soil_soft": GRAINS,
    "soil_tutorial": GRAINS,
}


def last_row(program: Program, scene: str) -> dict[str, float]:
    """The last row of history.csv."""
    family, path = FAMILIES[scene], SCENES / f"{scene}.toml"
    if family.plate:
        program.path = program.path.with_name("twin_soil")
        text = path.read_text().replace("picture = true", "picture = false")
        if "[numerics]" not in text:
            text += "\n[numerics]\n"
        path = program.scene(text.replace("[numerics]", f"[numerics]\n{BALANCE.removeprefix('numerics.')}"))
        settings: list[str] = []
    else:
        changes = (*family.settings, BALANCE, "output.picture=false")
        settings = [word for value in changes for word in ("--set", value)]
    done = program("run", path, "--out", "out", "--until", family.hours, "--threads", 1, *settings)
    assert done.status == 0, done.err
    row = history(program.folder / "out")[-1]
    row.pop("force_imbalance", None)
    return row


def recorded() -> dict[str, dict[str, float]]:
    """The golden numbers, by scene and column."""
    found: dict[str, dict[str, float]] = {}
    if RECORDED.exists():
        with RECORDED.open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                found.setdefault(row["scene"], {})[row["column"]] = float(row["value"])
    return found


def record(scene: str, row: dict[str, float]) -> None:
    """Replaces the numbers of a scene."""
    found = {**recorded(), scene: row}
    with RECORDED.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(COLUMNS)
        lines.writerows((name, column, repr(x)) for name in sorted(found) for column, x in found[name].items())


def test_every_scene_is_recorded():
    """No scene can be added, or taken away, without its golden numbers."""
    scenes = {path.stem for path in SCENES.glob("*.toml")}
    assert FAMILIES.keys() == scenes
    assert recorded().keys() == scenes


@pytest.mark.parametrize("scene", FAMILIES)
def test_golden(program: Program, scene: str):
    """Every number of the last row is the recorded one."""
    found = last_row(program, scene)
    if os.environ.get("ROOTSOIL_RECORD"):
        record(scene, found)
    assert found == pytest.approx(recorded()[scene], rel=RELATIVE, abs=ABSOLUTE)


def test_they_do_what_they_are_for():
    """The recorded runs grow, divide and touch, wherever their scenes can."""
    for scene, row in recorded().items():
        if scene.startswith("case1"):
            continue
        assert row["tip_speed_mm_h"] > 0.0, scene
        if not FAMILIES[scene].plate:
            assert row["divisions"] > 0, scene
        if FAMILIES[scene].plate or scene == "obstacle_tilted":
            assert row["contact_force_N"] > 0.0, scene
