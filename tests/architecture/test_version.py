# SPDX-License-Identifier: MIT
"""cmake/version.cmake: the version names the sources that a program was built from."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]


def git(folder: Path, *arguments: str) -> str:
    who = ["-c", "user.name=test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false"]
    done = subprocess.run(["git", *who, *arguments], cwd=folder, check=True, capture_output=True, text=True)
    return done.stdout.strip()


def version(source: Path, out: Path) -> str:
    """What the script writes for these sources."""
    template = out / "version.in"
    template.write_text("@VERSION@")
    definitions = {"SOURCE": source, "VERSION": "1.2.3", "INPUT": template, "OUTPUT": out / "version"}
    command = ["cmake", *(f"-D{name}={value}" for name, value in definitions.items())]
    subprocess.run([*command, "-P", PROJECT / "cmake" / "version.cmake"], check=True, capture_output=True, text=True)
    return (out / "version").read_text().strip()


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """A repository with one source file and one page."""
    folder = tmp_path / "source"
    for name in ("root_sph/a.cpp", "pages/a.md"):
        (folder / name).parent.mkdir(parents=True)
        (folder / name).write_text("a; b\n")
    git(folder, "init", "--quiet")
    git(folder, "add", ".")
    git(folder, "commit", "--quiet", "-m", "first")
    return folder


def test_a_commit_is_named(source: Path, tmp_path: Path):
    assert version(source, tmp_path) == f"1.2.3+{git(source, 'log', '-1', '--format=%h', '--abbrev=10')}"


def test_a_page_makes_no_other_program(source: Path, tmp_path: Path):
    before = version(source, tmp_path)
    (source / "pages" / "a.md").write_text("b\n")
    assert version(source, tmp_path) == before
    git(source, "commit", "--quiet", "-a", "-m", "page")
    assert version(source, tmp_path) == before
    (source / "root_sph" / "a.cpp").write_text("b\n")
    git(source, "commit", "--quiet", "-a", "-m", "program")
    assert version(source, tmp_path) not in ("1.2.3", before)


def test_what_is_not_committed_is_marked_and_told_apart(source: Path, tmp_path: Path):
    seen = {version(source, tmp_path)}
    for text in ("b\n", "c;\n"):
        (source / "root_sph" / "a.cpp").write_text(text)
        seen.add(version(source, tmp_path))
    git(source, "checkout", "--quiet", "root_sph/a.cpp")
    (source / "root_sph" / "new.cpp").write_text("")
    seen.add(version(source, tmp_path))
    assert len(seen) == 4
    assert sum(bool(re.fullmatch(r"1\.2\.3\+[0-9a-f]{10}-dirty-[0-9a-f]{8}", text)) for text in seen) == 3


def test_sources_without_git_have_the_plain_version(source: Path, tmp_path: Path):
    """An archive, also one that was unpacked inside a repository of something else."""
    archive = tmp_path / "archive"
    archive.mkdir()
    assert version(archive, tmp_path) == "1.2.3"
    inside = source / "vendor" / "rootsoil" / "root_sph"
    inside.mkdir(parents=True)
    (inside / "a.cpp").write_text("")
    git(source, "add", ".")
    git(source, "commit", "--quiet", "-m", "vendored")
    assert version(inside.parent, tmp_path) == "1.2.3"
