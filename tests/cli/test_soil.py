# SPDX-License-Identifier: MIT
"""Soil from the command line: what is refused, what fails, and the penetrometer with the real YADE."""

from __future__ import annotations

import csv
import json
import signal
import time
from pathlib import Path

import pytest
from cli_support import SMALL, Program

SOIL = """
[soil]
box_from_mm = [0.0, -1.5]
box_to_mm = [3.0, 1.5]
confining_pressure_MPa = 0.1
d_range_mm = [0.2, 0.3]
E_MPa = 250.0
inertial_number_max = 0.05
"""

PENETROMETER = """
[penetrometer]
diameter_mm = 0.6
rate_mm_h = 0.5
depth_mm = 0.6
seeds = 2
turgor_MPa = 1.0
"""


@pytest.fixture(autouse=True)
def cache(program: Program) -> Path:
    """Samples go to the test's own folder."""
    program.environment["ROOTSOIL_CACHE"] = str(program.folder / "cache")
    return program.folder / "cache"


def test_without_soil_there_is_no_yade(program: Program):
    """A scene without [soil] runs where there is no YADE."""
    program.environment["ROOTSOIL_YADE_FOLDER"] = "/nowhere"
    done = program("run", program.scene(SMALL), "--out", "run")
    assert done.status == 0, done.err


def test_bad_input(program: Program):
    """Exit status 2, with the line, before anything starts."""
    text = SOIL + PENETROMETER.replace("depth_mm = 0.6", "depth_mm = 60")
    done = program("penetrometer", program.scene(text), "--out", "out")
    assert done.status == 2
    assert "scene.toml:13: penetrometer.depth_mm: the probe would meet the wall" in done.err
    assert not (program.folder / "out").exists()


def test_yade_missing(program: Program):
    """Exit status 4, with what to do."""
    program.environment["ROOTSOIL_YADE_FOLDER"] = "/nowhere"
    done = program("penetrometer", program.scene(SOIL + PENETROMETER), "--out", "out")
    assert done.status == 4
    assert "YADE can't be imported from /nowhere" in done.err and "tools/setup.sh --soil" in done.err


@pytest.mark.slow
def test_impossible_packing(program: Program, cache: Path):
    """What only packing can tell is the user's input, too: exit status 2, and no sample is kept."""
    done = program("penetrometer", program.scene(SOIL + "porosity = 0.11\n" + PENETROMETER), "--out", "out")
    assert done.status == 2
    assert "soil.porosity: the grains do not pack as densely" in done.err and "for these grains" in done.err
    assert list(cache.iterdir()) == []


@pytest.mark.slow
def test_penetrometer(program: Program, cache: Path):
    """Two seeds, two samples; readings down to the depth, resistance in the right order of magnitude; nothing is overwritten."""
    scene = program.scene(SOIL + PENETROMETER, "clay.toml")
    done = program("penetrometer", scene)
    assert done.status == 0, done.err
    out = program.folder / "runs" / "clay_penetrometer"
    with (out / "penetrometer.csv").open() as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert {row["seed"] for row in rows} == {1, 2} and len(list(cache.glob("*.soil"))) == 2
    assert max(row["depth_mm"] for row in rows) == pytest.approx(0.6, abs=0.01)
    found = json.loads((out / "penetrometer.json").read_text())
    assert 1 < found["Q_over_P"] < 20
    assert found["inertial_number"] == pytest.approx(0.05, rel=1e-3)
    assert found["differential_MPa"] == pytest.approx(1 - found["Q_MPa"] / 4)
    assert f"Q/P = {found['Q_over_P']:.3g}" in done.out

    again = program("penetrometer", scene)
    assert again.status == 2 and "holds results" in again.err


@pytest.mark.slow
def test_interrupted_penetrometer(program: Program, cache: Path):
    """Ctrl-C ends it with status 130; what was read so far is kept, and no mean is claimed."""
    scene = program.scene(SOIL + PENETROMETER, "clay.toml")
    running = program.start("penetrometer", scene, "--out", program.folder / "out")
    end = time.monotonic() + 120
    while not list(cache.glob("*.soil")):
        assert time.monotonic() < end and running.poll() is None
        time.sleep(0.05)
    time.sleep(2)  # the probe moves, or is about to
    running.send_signal(signal.SIGINT)
    assert running.wait(60) == 130
    assert (program.folder / "out" / "penetrometer.csv").read_text().startswith("seed,depth_mm")
    assert not (program.folder / "out" / "penetrometer.json").exists()
