# SPDX-License-Identifier: MIT
"""The fuzzers' corpora, through the program: whatever the file, it is read or refused, and never a crash."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("ROOTSOIL_PROGRAM", PROJECT / "build" / "release" / "rootsoil")
CORPUS = PROJECT / "tests" / "fuzz" / "corpus"
SCENES = sorted((CORPUS / "scene").iterdir())
CELLS = sorted((CORPUS / "cells").iterdir())

BAD_SCENES = {"dotted", "empty", "not_toml", "out_of_range", "unknown", "wrong_types"}
BAD_CELLS = {"empty", "huge_label", "no_cells", "not_finite", "short_and_binary", "zero_axis"}

CELLS_SCENE = """\
[scene]
dimension = 3
duration_h = 1

[root]
cells_file = "{}"

[tissue]
E_axial_MPa = 1020

[numerics]
stepper = "symplectic"
window_steps = 1

[output]
every_h = 1
"""


def check(scene: Path) -> subprocess.CompletedProcess[bytes]:
    """`rootsoil check`."""
    done = subprocess.run(
        [PROGRAM, "check", scene],
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        capture_output=True,
        timeout=300,
    )
    assert b"internal error" not in done.stderr and done.stderr.count(b"rootsoil: ") <= 1
    done.stderr.decode()  # no broken bytes reach the terminal
    return done


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_scene(path: Path):
    """Good scenes are accepted, broken ones refused with a message."""
    assert check(path).returncode == (2 if path.stem in BAD_SCENES else 0)


@pytest.mark.parametrize("path", CELLS, ids=lambda path: path.stem)
def test_cells(tmp_path: Path, path: Path):
    """Good cell files are accepted, with any bytes for the micro sign; broken ones are refused with a message."""
    scene = tmp_path / "scene.toml"
    scene.write_text(CELLS_SCENE.format(path))
    assert check(scene).returncode == (2 if path.stem in BAD_CELLS else 0)


def test_the_corpora_are_small():
    """A few kB; files of measured cells belong elsewhere."""
    assert sum(path.stat().st_size for path in [*SCENES, *CELLS]) < 16_000
