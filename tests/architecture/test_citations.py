# SPDX-License-Identifier: MIT
"""Sources that the program, its comments and its tools cite are there: docs/physics.md 5.9, docs/decisions/0003."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
FOLDERS = ("root_sph", "soil_coupling", "scenarios", "tools", "tests")
CITED = re.compile(r"\bdocs/[\w/.-]*\w")
SECTIONS = re.compile(r"\s(\d+(?:\.\d+)?(?:, \d+\.\d+)*)(?![\w.]*\w)")


def numbered(page: Path) -> set[str]:
    """The sections of a page: 5 of "## 5. Numerics", 5.9 of the item "9." below it."""
    found: set[str] = set()
    section = ""
    for line in page.read_text().splitlines():
        if line.startswith("#"):
            heading = re.match(r"#+ (\d+)\. ", line)
            section = heading[1] if heading else ""
            found |= {section} - {""}
        elif section and (item := re.match(r"(\d+)\. ", line)):
            found.add(f"{section}.{item[1]}")
    return found


def exists(name: str) -> bool:
    """Decisions are named by their numbers."""
    return (PROJECT / name).exists() or any(PROJECT.glob(f"{name}-*.md"))


def wrong_citations(text: str) -> list[str]:
    """What is cited and is not there."""
    wrong = []
    for cited in CITED.finditer(text):
        name = cited[0]
        if not exists(name):
            wrong.append(name)
        elif name.endswith(".md") and (sections := SECTIONS.match(text, cited.end())):
            known = numbered(PROJECT / name)
            wrong += [f"{name} {number}" for number in sections[1].split(", ") if known and number not in known]
    return wrong


def test_the_check_sees_what_is_wrong():
    text = "docs/physics.md 5.9, 99 docs/physics.md 5.2, 5.99 docs/physics.md 42 docs/none.md docs/decisions/0003"
    assert wrong_citations(text) == ["docs/physics.md 5.99", "docs/physics.md 42", "docs/none.md"]


def test_describe_cites_what_exists():
    program = os.environ.get("ROOTSOIL_PROGRAM", PROJECT / "build" / "release" / "rootsoil")
    text = subprocess.run([program, "describe"], check=True, capture_output=True, text=True).stdout
    assert text.count("docs/physics.md ") > 10
    assert wrong_citations(text) == []


@pytest.mark.parametrize("folder", FOLDERS)
def test_sources_cite_what_exists(folder: str):
    files = [f for f in (PROJECT / folder).rglob("*") if f.suffix in (".cpp", ".hpp", ".py", ".toml", ".sh")]
    assert files
    wrong = {str(f): found for f in files if f != Path(__file__) and (found := wrong_citations(f.read_text()))}
    assert wrong == {}
