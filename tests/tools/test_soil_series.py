# SPDX-License-Identifier: MIT
"""The series of runs through soil."""

from __future__ import annotations

import csv
import subprocess
import tomllib
from pathlib import Path

import numpy as np
import pytest
import soil_series as tool


def passage(**changed: float) -> tool.Passage:
    """A root at three quarters of its free speed, with what the forces allow."""
    numbers = {
        "confining_MPa": 0.05,
        "E_axial_MPa": 1000.0,
        "seed": 1,
        "tip_speed": 0.15,
        "expected_speed": 0.15,
        "free_speed": 0.2,
        "tip_force": 0.15,
        "arresting_force": 0.6,
        "resistance_MPa": 0.2,
        "radius_mm": 0.3,
        "pressure_MPa": 1.0,
    }
    return tool.Passage(**{**numbers, **changed})


def test_ratios():
    p = passage(tip_speed=0.16)
    assert p.relative_speed == pytest.approx(0.8) and p.relative_force == pytest.approx(0.25)
    assert p.deviation == pytest.approx(0.05)
    assert tool.bridge_factor(0.8, 0.4) == pytest.approx(0.5)


def test_the_matched_scene_has_no_soil(project: Path):
    text = (project / "scenarios" / "soil_tutorial.toml").read_text()
    with_soil, alone = tomllib.loads(text), tomllib.loads(tool.without_sections(text, tool.SOIL_SECTIONS))
    assert "soil" in with_soil and "soil" not in alone
    assert {k: v for k, v in with_soil.items() if k != "soil"} == alone


def test_another_modulus_keeps_the_rates(project: Path):
    scene = tomllib.loads((project / "scenarios" / "soil_buckling.toml").read_text())
    settings = dict(s.split("=") for s in tool.scaled_root(scene, 50.0))
    assert float(settings["tissue.E_axial_MPa"]) == 50.0
    for section, key in (("growth", "lambda0_ug_mm3_h"), ("tissue.anisotropy", "E_radial_max_MPa")):
        original = scene["growth"][key] if section == "growth" else scene["tissue"]["anisotropy"][key]
        assert float(settings[f"{section}.{key}"]) == pytest.approx(0.5 * original)


def test_a_table_a_row_a_run(tmp_path: Path):
    tool.write_csv([passage(), passage(seed=2)], [{"Q": 0.3}, {"Q": 0.4}], tmp_path / "t.csv")
    with (tmp_path / "t.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["seed"] for row in rows] == ["1", "2"] and float(rows[1]["Q"]) == 0.4
    assert float(rows[0]["relative_speed"]) == pytest.approx(0.75)


@pytest.mark.slow
def test_speed_falls_with_the_soils_pressure_as_the_forces_say(project: Path, tmp_path: Path):
    command = [project / "tools" / "soil_series.py", "pressure", "--quick", "--threads", "1", "--out", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    with (tmp_path / "pressure.csv").open() as file:
        rows = list(csv.DictReader(file))
    speed = np.array([float(row["relative_speed"]) for row in rows])
    assert speed[1] < speed[0] - 0.1 and speed[0] < 1.0
    for row in rows:
        assert abs(float(row["deviation"])) < 0.05
        assert abs(float(row["matched_speed"]) - float(row["relative_speed"])) < 0.05
    assert (tmp_path / "pressure.png").stat().st_size > 10_000
