# SPDX-License-Identifier: MIT
"""tools/lint.sh: the tree is formatted and spelled well, and what is not is found, with the command that mends it."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

MISSING = [tool for tool in ("git", "clang-format", "black", "codespell") if shutil.which(tool) is None]
needs_tools = pytest.mark.skipif(bool(MISSING), reason=f"not installed (tools/setup.sh --dev): {', '.join(MISSING)}")
RULES = (".clang-format", ".codespellrc", "pyproject.toml", "tools/lint.sh")


def lint(project: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [project / "tools" / "lint.sh", "--quick"], capture_output=True, text=True, env={**os.environ, **environment}
    )


@pytest.fixture
def small_project(project: Path, tmp_path: Path) -> Path:
    """A checkout with the project's rules and one clean file of each language."""
    (tmp_path / "tools").mkdir()
    for name in RULES:
        shutil.copy(project / name, tmp_path / name)
    (tmp_path / "a.cpp").write_text("int one() { return 1; }\n")
    (tmp_path / "a.py").write_text("ONE = 1\n")
    subprocess.run(["git", "init", "--quiet"], cwd=tmp_path, check=True)
    subprocess.run(["git", "add", "--all"], cwd=tmp_path, check=True)
    return tmp_path


@needs_tools
def test_tree_is_clean(project: Path):
    if not (project / ".git").exists():
        pytest.skip("not a checkout: lint.sh looks at what git tracks")
    done = lint(project)
    assert done.returncode == 0, done.stderr


@needs_tools
@pytest.mark.parametrize(
    "name, text, remedy",
    [
        ("a.cpp", "int  one(){return 1;}\n", "clang-format -i"),
        ("a.py", "ONE=1\n", "black"),
        ("a.py", "# the len" + "ght\nONE = 1\n", ".codespellrc"),
    ],
)
def test_what_is_wrong_is_found(small_project: Path, name: str, text: str, remedy: str):
    clean = lint(small_project)
    assert clean.returncode == 0, clean.stderr
    (small_project / name).write_text(text)
    done = lint(small_project)
    assert done.returncode == 1
    assert name in done.stderr and remedy in done.stderr
    (small_project / "untracked.py").write_text("TWO=2\n")
    assert "untracked" not in lint(small_project).stderr


@needs_tools
def test_missing_tool_is_said(small_project: Path, tmp_path_factory: pytest.TempPathFactory):
    bin_folder = tmp_path_factory.mktemp("bin")
    for tool in ("bash", "env", "dirname", "git", "clang-format", "codespell"):
        (bin_folder / tool).symlink_to(str(shutil.which(tool)))
    done = lint(small_project, PATH=str(bin_folder))
    assert done.returncode == 1
    assert "black is not installed" in done.stderr and "tools/setup.sh --dev" in done.stderr


def test_unknown_argument_is_refused(project: Path):
    done = subprocess.run([project / "tools" / "lint.sh", "--fast"], capture_output=True, text=True)
    assert done.returncode == 2 and "--quick" in done.stderr
