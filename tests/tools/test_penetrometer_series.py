# SPDX-License-Identifier: MIT
"""The penetrometer's series: with a program that makes up its results, and a quick one with the real soil."""

from __future__ import annotations

import csv
import math
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import penetrometer_series as series

# Q/P = 5 + 10 I + 0.1 seed; writes down what it was called with.
FAKE = """#!/usr/bin/python3
import json, pathlib, sys
if sys.argv[1] == "version":
    print("rootsoil fake")
    sys.exit()
with open(__file__ + ".log", "a") as log:
    print(*sys.argv[1:], file=log)
values = dict(setting.split("=", 1) for setting in sys.argv[sys.argv.index("--set") :] if "=" in setting)
I, seed = float(values["soil.inertial_number_max"]), int(values["soil.seed"])
P = float(values.get("soil.confining_pressure_MPa", 0.1))
q = 5 + 10 * I + 0.1 * seed
out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
out.mkdir(parents=True)
header = "seed,depth_mm,Q_MPa,shaft_force_N,inertial_number,overlap_max"
(out / "penetrometer.csv").write_text(f"{header}\\n{seed},0.5,{q * P},0,{I},0.01\\n{seed},1.5,{q * P},0,{I},0.02\\n")
found = dict(Q_MPa=q * P, Q_over_P=q, Q_fluctuation_MPa=0.05, confining_pressure_MPa=P, averaged_mm=[1, 2])
(out / "penetrometer.json").write_text(json.dumps(found))
"""


@pytest.fixture
def fake(tmp_path: Path) -> Path:
    """The program."""
    path = tmp_path / "rootsoil"
    path.write_text(FAKE)
    path.chmod(0o755)
    return path


def run(project: Path, program: Path, *options: Any) -> subprocess.CompletedProcess[str]:
    """The tool, with a --program."""
    command = [project / "tools" / "penetrometer_series.py", "--program", program, *map(str, options)]
    return subprocess.run(command, capture_output=True, text=True, cwd=program.parent)


def calls(program: Path) -> list[str]:
    """What the made-up program was asked to run."""
    return Path(f"{program}.log").read_text().splitlines()


def test_seeds_become_points():
    def measured(number: float, seed: int, q: float, friction: float = math.nan) -> series.Measured:
        return series.Measured(number, 0.1, friction, seed, 0.1 * q, q, 0.01, 0.02, 1.0, 2.0)

    (points,) = series.curves([measured(0.01, 1, 5.0), measured(0.1, 1, 9.0), measured(0.01, 2, 7.0)]).values()
    assert [(p.inertial_number, p.seeds, p.mean) for p in points] == [(0.1, 1, 9.0), (0.01, 2, 6.0)]
    assert np.isnan(points[0].deviation) and points[1].deviation == pytest.approx(math.sqrt(2.0))
    both = series.curves([measured(0.01, 1, 5.0, 15.0), measured(0.01, 1, 6.0, 30.0)])
    assert [points[0].mean for points in both.values()] == [5.0, 6.0]


def test_series(project: Path, fake: Path):
    """Every run once, a row each; the same command then runs nothing, a larger one what is missing."""
    common = ("--out", "out", "--inertial-numbers", 0.1, 0.01, "--set", "soil.E_MPa=500")
    done = run(project, fake, *common, "--seeds", 1, 2)
    assert done.returncode == 0, done.stderr
    assert len(calls(fake)) == 4 and all("--set soil.E_MPa=500 " in call for call in calls(fake))
    out = fake.parent / "out"
    with (out / "penetrometer_series.csv").open() as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert [(row["inertial_number"], row["seed"]) for row in rows] == [(0.1, 1), (0.1, 2), (0.01, 1), (0.01, 2)]
    assert rows[1]["Q_over_P"] == pytest.approx(6.2) and rows[1]["overlap_max"] == 0.02 and rows[1]["to_mm"] == 2
    assert (out / "penetrometer_series.png").stat().st_size > 10_000
    lines = done.stdout.splitlines()
    assert "     0.1      2    6.15   0.07          +0.90 +- 0.07" in lines
    assert "    0.01      2    5.25   0.07" in [line.rstrip() for line in lines]

    assert run(project, fake, *common, "--seeds", 1, 2).returncode == 0 and len(calls(fake)) == 4
    assert run(project, fake, *common, "--seeds", 1, 2, 3).returncode == 0 and len(calls(fake)) == 6
    done = run(project, fake, *common, "--seeds", 1, "--pressures", 0.05, 0.2, "--friction", 15, 30)
    assert done.returncode == 0, done.stderr
    assert len(calls(fake)) == 14 and "P = 0.05 MPa, friction 15°" in done.stdout


def test_another_soil_in_the_same_folder(project: Path, fake: Path):
    choice = ("--out", "out", "--inertial-numbers", 0.1, "--seeds", 1)
    assert run(project, fake, *choice).returncode == 0
    done = run(project, fake, *choice, "--set", "soil.E_MPa=500")
    assert done.returncode == 1 and "choose another --out" in done.stderr and len(calls(fake)) == 1


def test_a_failing_program(project: Path, fake: Path):
    fake.write_text("#!/bin/bash\n[[ $1 == version ]] && exit 0\nexit 4\n")
    done = run(project, fake, "--quick", "--out", "out")
    assert done.returncode == 1 and "ended with status 4" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.slow
def test_quick_with_the_real_soil(project: Path, tmp_path: Path):
    """Fast penetration meets more: inertia (some ten seconds of processor time)."""
    os.environ.setdefault("ROOTSOIL_CACHE", str(tmp_path / "cache"))
    program = Path(os.environ.get("ROOTSOIL_PROGRAM", project / "build" / "release" / "rootsoil")).absolute()
    command = [project / "tools" / "penetrometer_series.py", "--quick", "--out", tmp_path / "out", "--program", program]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    with (tmp_path / "out" / "penetrometer_series.csv").open() as file:
        rows = list(csv.DictReader(file))
    resistance = {(float(row["inertial_number"]), row["seed"]): float(row["Q_over_P"]) for row in rows}
    for seed in ("1", "2"):
        assert 2.0 < resistance[0.03, seed] < resistance[0.1, seed] < 20.0
