# SPDX-License-Identifier: MIT
"""Every scene that comes with the program can be checked and begins to run."""

from __future__ import annotations

import pytest
from cli_support import PROJECT, Program, frames, summary

SCENES = sorted((PROJECT / "scenarios").glob("*.toml"))
PARAMETERS = [pytest.param(path, id=path.stem) for path in SCENES]
# a soil is packed first, which takes seconds, and needs YADE
RUNS = [
    pytest.param(path, id=path.stem, marks=[pytest.mark.slow] * path.stem.startswith(("soil_", "growth_3d_full")))
    for path in SCENES
    if path.stem != "soil_3d"  # its packing alone takes minutes; tests/soil_coupling packs in three dimensions
]


@pytest.mark.parametrize("scene", PARAMETERS)
def test_check(program: Program, scene):
    """`check` finds nothing wrong; the scene bears the name of its file."""
    done = program("check", scene, "--json")
    assert done.status == 0, done.err
    found = done.json()
    assert found["scene"] == scene.stem and found["hyperbolic"] is True


@pytest.mark.parametrize("scene", RUNS)
def test_begins(program: Program, scene):
    """The first window runs, and a second session takes over from it."""
    out = program.folder / "out"
    program.environment["ROOTSOIL_CACHE"] = str(program.folder / "cache")
    # a session ends with the first window that reaches its time, here after one window and after two
    assert program("run", scene, "--out", out, "--until", 1e-6).status == 0
    done = program("run", scene, "--out", out, "--resume", "--until", summary(out)["time_h"] + 1e-6)
    assert done.status == 0, done.err
    found = summary(out)
    assert found["status"] == "paused" and found["time_h"] > 0
    assert found["cells_end"] >= found["cells_start"] > 100
    assert len(frames(out)) >= 1
