# SPDX-License-Identifier: MIT
"""The figure of a penetrometer, from made-up readings."""

from __future__ import annotations

import importlib.util
import json
import subprocess
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest


@pytest.fixture
def tool(project: Path) -> ModuleType:
    """tools/penetrometer.py as a module."""
    spec = importlib.util.spec_from_file_location("penetrometer_tool", project / "tools" / "penetrometer.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Two seeds of a resistance that rises and stays."""
    rows = ["seed,depth_mm,Q_MPa,shaft_force_N,inertial_number,overlap_max"]
    for seed in (4, 5):
        for k in range(100):
            depth = 0.02 * (k + 0.5)
            rows.append(f"{seed},{depth},{min(depth, 1.0) * (0.6 + 0.1 * (seed - 4))},0.1,0.01,0.02")
    (tmp_path / "penetrometer.csv").write_text("\n".join(rows) + "\n")
    found = {
        "Q_MPa": 0.65,
        "Q_deviation_MPa": 0.07,
        "Q_over_P": 6.5,
        "confining_pressure_MPa": 0.1,
        "inertial_number": 0.01,
        "averaged_mm": [1.0, 2.0],
    }
    (tmp_path / "penetrometer.json").write_text(json.dumps(found))
    return tmp_path


def test_readings_are_told_apart_by_seed(tool: ModuleType, results: Path):
    seeds = tool.read_csv(results / "penetrometer.csv")
    assert list(seeds) == [4, 5]
    assert seeds[5]["Q_MPa"][-1] == pytest.approx(0.7) and len(seeds[4]["depth_mm"]) == 100


def test_smoothing_keeps_a_straight_line(tool: ModuleType):
    depth = np.linspace(0, 1, 101)
    inner = tool.smoothed(depth, 2 * depth, 0.095)[10:-10]
    np.testing.assert_allclose(inner, 2 * depth[10:-10], atol=1e-12)
    assert tool.smoothed(depth, np.where(depth > 0.5, 1.0, 0.0), 0.2)[50] == pytest.approx(0.5, abs=0.03)


def test_figure(project: Path, results: Path):
    done = subprocess.run([project / "tools" / "penetrometer.py", results], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (results / "penetrometer.png").stat().st_size > 10_000


def test_a_folder_without_results(project: Path, tmp_path: Path):
    done = subprocess.run([project / "tools" / "penetrometer.py", tmp_path], capture_output=True, text=True)
    assert done.returncode == 1 and "holds no results of a penetrometer" in done.stderr
