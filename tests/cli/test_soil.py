# SPDX-License-Identifier: MIT
"""Soil from the command line: what is refused, what fails, and the penetrometer with the real YADE."""

from __future__ import annotations

import csv
import json
import shlex
import signal
import subprocess
import time
from pathlib import Path

import pytest
from cli_support import SMALL, TIMEOUT_S, Program

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


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("depth_mm = 0.6", "depth_mm = 60", "scene.toml:13: penetrometer.depth_mm: the probe would meet the wall"),
        ("0.05", "1e-6", "scene.toml:8: soil.inertial_number_max: the grains would take 2.5e+06 substeps"),
    ],
)
def test_bad_input(program: Program, old: str, new: str, message: str):
    """Exit status 2, with the line, before anything starts."""
    done = program("penetrometer", program.scene((SOIL + PENETROMETER).replace(old, new)), "--out", "out")
    assert done.status == 2
    assert message in done.err
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
    """Two seeds, two samples; readings down to the depth, resistance of the right magnitude; nothing is overwritten."""
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


# Some grains in a rigid box without pressure, a probe that hardly moves: nothing is packed, a second or two of YADE.
LISTED = """
[soil]
box_from_mm = [0.0, -1.5]
box_to_mm = [3.0, 1.5]
walls = "rigid"
confining_pressure_MPa = 0.0
d_range_mm = [0.2, 0.3]
grains_file = "grains.csv"
density_N_h2_mm4 = 1e-4
E_MPa = 250.0
damping = 0.0

[penetrometer]
diameter_mm = 0.6
rate_mm_h = 0.5
depth_mm = 0.02
interval_h = 0.01
seeds = 1
"""
GRAINS = "x_mm,y_mm,z_mm,radius_mm\n" + "".join(
    f"{0.5 + 0.3 * k},{0.3 * j},0,0.14\n" for k in range(8) for j in range(-4, 5)
)


@pytest.fixture
def listed(program: Program) -> Path:
    """A scene whose grains are listed in a file beside it."""
    (program.folder / "grains.csv").write_text(GRAINS)
    return program.scene(LISTED)


def test_listed_grains_are_checked_before_anything_starts(program: Program, listed: Path):
    """Exit status 2 with the file's name and line, when the scene is read: there is no YADE here."""
    program.environment["ROOTSOIL_YADE_FOLDER"] = "/nowhere"
    (program.folder / "grains.csv").write_text(GRAINS + "1.0,1.4,0.5,0.14\n")
    done = program("penetrometer", listed, "--out", "out")
    assert done.status == 2
    assert "grains.csv:74: column 'z_mm': in two dimensions all grains lie in the plane z = 0" in done.err
    assert not (program.folder / "out").exists()


def test_packing_without_damping_is_refused(program: Program):
    """It would never come to rest; grains that are listed need not."""
    done = program("penetrometer", program.scene(SOIL + "damping = 0\n" + PENETROMETER), "--out", "out")
    assert done.status == 2 and "soil.damping: " in done.err and "0.01 to 0.95" in done.err


READ_ONLY = """
mount --rbind "$0" "$0" && mount --rbind "$PWD" "$PWD" && cd "$PWD" && mount -o remount,ro,bind "$0" || exit 77
! touch "$0/rootsoil_writable" 2>/dev/null || exit 78
exec "$@"
"""


def where_read_only(program: Program, folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Runs the program where `folder` can't be written, but for the test's folder in it: root may write anywhere."""
    done = subprocess.run(
        ["unshare", "-m", "sh", "-c", READ_ONLY, str(folder), *program.command(*arguments)],
        cwd=program.folder,
        env=program.environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
    )
    if done.returncode == 77 or "unshare failed" in done.stderr:
        pytest.skip(f"no private mounts here: {done.stderr.strip()}")
    return done


def test_cache_that_cannot_be_written(program: Program, cache: Path):
    """Exit status 5 before anything is packed (there is no YADE here), with what to do."""
    program.environment["ROOTSOIL_YADE_FOLDER"] = "/nowhere"
    cache.mkdir()
    done = where_read_only(program, cache, "penetrometer", program.scene(SOIL + PENETROMETER), "--out", "out")
    assert done.returncode == 5, done.stderr
    assert str(cache) in done.stderr and "set ROOTSOIL_CACHE to a folder" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("grains", [GRAINS, "\ufeff" + GRAINS.replace("\n", "\r\n")], ids=["plain", "of a spreadsheet"])
def test_bare_environment(program: Program, listed: Path, grains: str):
    """YADE's process needs no HOME, no PATH, no locale and no standard input; a spreadsheet's bytes change nothing."""
    (program.folder / "grains.csv").write_text(grains)
    program.environment = {"OMP_NUM_THREADS": "1"}
    done = program("penetrometer", listed, "--out", "out with spaces, é")
    assert done.status == 0, done.err
    assert (program.folder / "out with spaces, é" / "penetrometer.json").exists()


@pytest.mark.slow
def test_home_is_left_alone(program: Program, listed: Path):
    """YADE by itself moves an old configuration from ~/.yade-double to its present place."""
    home = program.folder / "home"
    (home / ".yade-double").mkdir(parents=True)
    program.environment["HOME"] = str(home)
    done = program("penetrometer", listed, "--out", "out")
    assert done.status == 0, done.err
    assert [path.name for path in home.rglob("*")] == [".yade-double"]


@pytest.mark.slow
def test_tmp_that_cannot_be_written(program: Program, listed: Path):
    """YADE by itself makes a folder in /tmp, whatever TMPDIR says, and dies where it can't."""
    done = where_read_only(program, Path("/tmp"), "penetrometer", listed, "--out", "out")
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_closed_standard_input(program: Program, listed: Path):
    """The socket to YADE's process then has the number 0 in the program, and must not be lost on its way."""
    command = shlex.join(program.command("penetrometer", listed, "--out", "out"))
    done = subprocess.run(
        ["sh", "-c", f"{command} <&-"],
        cwd=program.folder,
        env=program.environment,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
    )
    assert done.returncode == 0, done.stderr
