# SPDX-License-Identifier: MIT
"""README.md, ARCHITECTURE.md and the developer guide speak of what exists, and of all of it."""

from __future__ import annotations

import os
import re
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

PROJECT = Path(__file__).resolve().parents[2]
SCENES = sorted((PROJECT / "scenarios").glob("*.toml"))


def described(section: str) -> set[str]:
    """The keys that `rootsoil describe` explains."""
    program = os.environ.get("ROOTSOIL_PROGRAM", PROJECT / "build" / "release" / "rootsoil")
    text = subprocess.run([program, "describe", section], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"^  (\w+)  +(?:a|two|true|list)", text, re.M))


def keys(table: dict[str, Any], section: str = "") -> Iterator[tuple[str, str]]:
    """Section and key of everything in a scene."""
    for name, value in table.items():
        inner = f"{section}.{name}" if section else name
        if isinstance(value, dict):
            yield from keys(value, inner)
        elif isinstance(value, list) and value and all(isinstance(element, dict) for element in value):
            for element in value:
                yield from keys(element, inner)
        else:
            yield section, name


def test_every_key_in_the_scenes_is_described():
    """`describe` explains every key that a scene in scenarios/ uses."""
    used = {pair for scene in SCENES for pair in keys(tomllib.loads(scene.read_text()))}
    assert len(used) > 40
    for section in {section for section, _ in used}:
        known = described(section)
        missing = {key for where, key in used if where == section} - known
        assert not missing, f"[{section}]: {missing}"


def test_scene_headers():
    """Each scene begins with what it shows and what to expect."""
    for scene in SCENES:
        header = scene.read_text().split("\n[")[0]
        assert all(line.startswith("#") for line in header.splitlines() if line), scene.name
        assert "Expect: " in header, scene.name


def test_readme_lists_the_scenes():
    """The table of scenes has exactly the files of scenarios/."""
    table = (PROJECT / "README.md").read_text().split("## Scenes")[1].split("\n## ")[0]
    rows = [line for line in table.splitlines() if line.startswith("| `")]
    named = [name for row in rows for name in re.findall(r"`(\w+)`", row.split("|")[1])]
    assert sorted(named) == [scene.stem for scene in SCENES]


@pytest.mark.parametrize("document", ["README.md", "ARCHITECTURE.md", "docs/developer_guide.md"])
def test_named_files_exist(document: str):
    """Every file and folder that the document names exists, and nothing is left to be filled in."""
    text = (PROJECT / document).read_text()
    folders = "root_sph|soil_coupling|scenarios|tests|tools|docs"
    links = re.findall(r"\]\(([^)#:]+)\)", re.sub(r"```.*?```", "", text, flags=re.S))  # `[this](...) {` is no link
    paths = re.findall(rf"(?<![\w/])((?:{folders})/[\w./-]*\w)", text)
    short = {f"root_sph/{name}" for name in re.findall(rf"`((?!{folders})\w+/\w+)`", text)}
    named = {name for name in [*links, *paths, *short] if "NAME" not in name}
    assert len(named) > 5
    missing = [
        name
        for name in sorted(named)
        if not (PROJECT / name).exists()
        and not (PROJECT / document).parent.joinpath(name).exists()
        and not list(PROJECT.glob(f"{name}.*"))
        and not list(PROJECT.glob(f"{name}-*"))  # decisions are named by their numbers
    ]
    assert missing == []
    assert not re.search(r"\b[A-Z]+_TABLE\b|\bTODO\b|\bTBD\b", text)


def test_the_architecture_names_every_folder():
    """ARCHITECTURE.md has a line for every folder of root_sph."""
    text = (PROJECT / "ARCHITECTURE.md").read_text()
    for folder in (PROJECT / "root_sph").iterdir():
        if any(folder.glob("*.hpp")):
            assert re.search(rf"^  {folder.name}/ ", text, re.M), folder.name


def passes_of_hooks() -> list[str]:
    """The phases of root_sph/dynamics/hooks.hpp, in their order."""
    text = (PROJECT / "root_sph" / "dynamics" / "hooks.hpp").read_text()
    return re.findall(r"^  Passes<.*> (\w+);", text, re.M)


def test_the_architecture_names_every_phase_in_order():
    """ARCHITECTURE.md's table of a window goes through the phases of the hooks as the solver does."""
    named = re.findall(r"`hooks\.(\w+)`", (PROJECT / "ARCHITECTURE.md").read_text())
    assert named == passes_of_hooks() and len(named) > 10


def without_spaces(text: str) -> str:
    """The text as it is however it is broken into lines."""
    return re.sub(r"\s", "", text)


def test_the_guides_code_is_the_codes():
    """What the developer guide quotes of effects stands in their folders, but for what it leaves out with dots."""
    guide = (PROJECT / "docs" / "developer_guide.md").read_text().split("\n## Add a law")[0]
    folders = (PROJECT / "root_sph" / "effects" / name for name in ("gravity", "force"))
    source = "".join(path.read_text() for folder in folders for path in sorted(folder.iterdir()))
    quoted = [part for block in re.findall(r"```cpp\n(.*?)```", guide, re.S) for part in block.split("...")]
    assert len(quoted) > 5
    assert [part for part in quoted if without_spaces(part) not in without_spaces(source)] == []
