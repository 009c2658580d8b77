# SPDX-License-Identifier: MIT
"""The program under test, and runs that several tests look at."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from cli_support import FULL, PROJECT, Program  # noqa: E402


@pytest.fixture(scope="session")
def program_path() -> Path:
    """$ROOTSOIL_PROGRAM, or what tools/build.sh built."""
    path = Path(os.environ.get("ROOTSOIL_PROGRAM", PROJECT / "build" / "release" / "rootsoil")).absolute()
    assert path.is_file(), f"{path} is missing: run tools/build.sh, or set ROOTSOIL_PROGRAM"
    return path


@pytest.fixture
def program(program_path: Path, tmp_path: Path) -> Program:
    """The program, started in a folder of the test's own."""
    return Program(program_path, tmp_path)


@pytest.fixture(scope="session")
def full_run(program_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished run of FULL, uninterrupted, with one thread."""
    program = Program(program_path, tmp_path_factory.mktemp("full"))
    done = program("run", program.scene(FULL), "--out", "run", "--threads", 1)
    assert done.status == 0, done.err
    return program.folder / "run"
