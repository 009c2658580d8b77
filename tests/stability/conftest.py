# SPDX-License-Identifier: MIT
"""Paths of the tool, the cases and the program."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PROJECT / "tools"), str(PROJECT / "tests" / "stability"), str(PROJECT / "tests" / "cli")]


@pytest.fixture(scope="session")
def program_path() -> Path:
    """$ROOTSOIL_PROGRAM, or what tools/build.sh built."""
    return Path(os.environ.get("ROOTSOIL_PROGRAM", PROJECT / "build" / "release" / "rootsoil")).absolute()
