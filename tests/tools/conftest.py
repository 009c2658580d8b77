# SPDX-License-Identifier: MIT
"""Paths and markers for the tests of tools/."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PROJECT / "tools"), str(PROJECT / "tests" / "tools")]


@pytest.fixture(scope="session")
def project() -> Path:
    """The project's folder."""
    return PROJECT
