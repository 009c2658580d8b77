# SPDX-License-Identifier: MIT
"""The shell scripts: syntax, set-up on a machine that lacks packages, and what run.sh and test.sh start."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest


def scripts(project: Path) -> list[Path]:
    return [*sorted((project / "tools").glob("*.sh")), project / ".ci" / "run"]


def test_scripts_are_sound(project: Path):
    for script in scripts(project):
        assert subprocess.run(["bash", "-n", script]).returncode == 0
        assert os.access(script, os.X_OK)
        assert "set -euo pipefail" in script.read_text()


@pytest.mark.parametrize("option", ["-h", "--help"])
def test_help_explains_and_does_nothing_else(project: Path, option: str):
    for script in sorted((project / "tools").glob("*.sh")):
        shown = subprocess.run(
            [script, option], env={"PATH": "/usr/bin:/bin"}, capture_output=True, text=True, timeout=10
        )
        assert shown.returncode == 0 and shown.stderr == "", script
        assert f"tools/{script.name} [" in shown.stdout and "cmake" not in shown.stdout, script


@pytest.mark.skipif(shutil.which("shellcheck") is None, reason="shellcheck is not installed")
def test_shellcheck(project: Path):
    done = subprocess.run(["shellcheck", *scripts(project)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def fake(folder: Path, name: str, body: str) -> None:
    path = folder / name
    path.write_text("#!/bin/bash\n" + body)
    path.chmod(0o755)


@pytest.fixture
def machine() -> Iterator[tuple[Path, dict[str, str]]]:
    """A machine with every package but two: commands that write what they were called with to `log`.

    In a folder that every user can read, unlike pytest's own.
    """
    bin_folder = Path(tempfile.mkdtemp())
    bin_folder.chmod(0o755)
    log = bin_folder / "log"
    here = Path(__file__).resolve().parents[2]
    listed = re.search(r'^packages="\n(.*?)"', (here / "tools" / "setup.sh").read_text(), re.M | re.S)
    present = [line.split()[0] for line in listed[1].splitlines() if not line.startswith(("libcli11", "g++"))]
    lines = "\\n".join(["ii " + name for name in present] + ["rc g++"])
    fake(bin_folder, "dpkg-query", f"printf '{lines}\\n'\n")
    fake(bin_folder, "apt-get", f'echo "$DEBIAN_FRONTEND apt-get $*" >>{log}\n')
    fake(bin_folder, "sudo", f'[[ "$1" == --non-interactive ]] && exit "${{NO_SUDO:-0}}"\necho sudo >>{log}\n"$@"\n')
    yield log, {**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}"}
    shutil.rmtree(bin_folder)


def test_setup_installs_only_what_is_missing(project: Path, machine):
    log, environment = machine
    done = subprocess.run([project / "tools" / "setup.sh"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "libcli11-dev         the command line" in done.stdout
    assert "cmake" not in done.stdout
    calls = [line for line in log.read_text().splitlines() if line != "sudo"]
    assert len(calls) == 2 and all(call.startswith("noninteractive apt-get --yes") for call in calls)
    assert calls[0].endswith("update") and calls[1].endswith("install --no-install-recommends g++ libcli11-dev")


@pytest.mark.skipif(os.geteuid() != 0, reason="becoming another user needs root")
def test_setup_without_rights_prints_the_line_to_run(project: Path, machine):
    log, environment = machine
    done = subprocess.run(
        ["bash", shutil.copy(project / "tools" / "setup.sh", log.parent)],
        env={**environment, "NO_SUDO": "1"},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        user="nobody",
    )
    assert done.returncode == 1
    assert "apt-get update && apt-get install --yes --no-install-recommends g++ libcli11-dev" in done.stderr
    assert not log.exists()


@pytest.fixture
def copy(project: Path, tmp_path: Path) -> Path:
    """The scripts in a folder of their own, with a build that is up to date and programs that only report."""
    for folder in ("tools", "scenarios", "build/release", "tests"):
        (tmp_path / folder).mkdir(parents=True)
    for name in ("run.sh", "test.sh"):
        shutil.copy(project / "tools" / name, tmp_path / "tools" / name)
    fake(tmp_path / "tools", "build.sh", f'echo "$*" >>{tmp_path}/build.log\nexit ${{BUILD_STATUS:-0}}\n')
    fake(tmp_path / "tools", "lint.sh", "")
    fake(tmp_path / "tools", "setup.sh", f'echo "$*" >>{tmp_path}/setup.log\n')
    fake(tmp_path / "build" / "release", "rootsoil", 'echo "$@"\nexit 3\n')
    (tmp_path / "scenarios" / "case2_arabidopsis.toml").touch()
    (tmp_path / "scenarios" / "growth_3d.toml").touch()
    return tmp_path


def test_run_finds_scenes_and_passes_arguments_and_status_on(copy: Path):
    def run(*arguments: str) -> str:
        done = subprocess.run([copy / "tools" / "run.sh", *arguments], cwd=copy, capture_output=True, text=True)
        assert done.returncode == 3
        return done.stdout.strip().replace(str(copy), "")

    assert run() == "run /scenarios/case2_arabidopsis.toml"
    assert run("--until", "3") == "run /scenarios/case2_arabidopsis.toml --until 3"
    assert run("growth_3d", "--quiet") == "run /scenarios/growth_3d.toml --quiet"
    assert run("growth_3d.toml") == "run /scenarios/growth_3d.toml"
    assert run("scenarios/growth_3d.toml") == "run scenarios/growth_3d.toml"
    assert run("no_such_scene") == "run no_such_scene"


def test_only_a_scene_with_soil_asks_for_yade(copy: Path):
    (copy / "scenarios" / "dry.toml").write_text("[root]\n# no [soil]\n")
    (copy / "scenarios" / "wet.toml").write_text("[root]\n[soil]\n")
    subprocess.run([copy / "tools" / "run.sh", "dry"], capture_output=True)
    assert not (copy / "setup.log").exists()
    subprocess.run([copy / "tools" / "run.sh", "wet"], capture_output=True)
    assert (copy / "setup.log").read_text() == "--soil\n"


@pytest.mark.parametrize("options", [[], ["--soil"], ["--test"], ["--dev"], ["--soil", "--test"], ["--dev", "--soil"]])
def test_setup_installs_only_what_is_asked_for(project: Path, machine, options: list[str]):
    log, environment = machine
    done = subprocess.run([project / "tools" / "setup.sh", *options], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    installed = log.read_text().split()
    for option, packages in {
        "--soil": {"yade"},
        "--test": {
            "libgtest-dev",
            "libgmock-dev",
            "libbenchmark-dev",
            "python3-pytest",
            "python3-pytest-xdist",
            "python3-scipy",
        },
        "--dev": {"clang-format", "clang-tidy", "cppcheck", "black", "flake8", "mypy", "codespell", "pre-commit"},
    }.items():
        assert packages & set(installed) == (packages if option in options else set())


def test_setup_refuses_unknown_arguments(project: Path):
    for arguments in (["--sol"], ["--soil", "--tests"]):
        done = subprocess.run([project / "tools" / "setup.sh", *arguments], capture_output=True, text=True)
        assert done.returncode == 2 and done.stdout == ""
        assert f"'{arguments[-1]}' (allowed: --test, --soil, --dev)" in done.stderr


def test_a_run_builds_the_program_only(copy: Path):
    subprocess.run([copy / "tools" / "run.sh", "growth_3d"], capture_output=True)
    assert (copy / "build.log").read_text() == "rootsoil\n"


@pytest.mark.parametrize("arguments, built", [([], ""), (["--quick", "--werror"], "--werror")])
def test_test_builds_everything(copy: Path, arguments: list[str], built: str):
    subprocess.run(
        [copy / "tools" / "test.sh", *arguments], env={**os.environ, "BUILD_STATUS": "7"}, capture_output=True
    )
    assert (copy / "setup.log").read_text() == "--test --soil --dev\n"
    assert (copy / "build.log").read_text() == built + "\n"


@pytest.fixture
def builder(project: Path, tmp_path: Path) -> tuple[Path, dict[str, str]]:
    """tools/build.sh among commands that write what they were called with to `log`; ninja always has work."""
    (tmp_path / "tools").mkdir()
    shutil.copy(project / "tools" / "build.sh", tmp_path / "tools" / "build.sh")
    log = tmp_path / "log"
    fake(tmp_path / "tools", "setup.sh", f'echo "setup $*" >>{log}\n')
    cache = tmp_path / "build" / "release" / "CMakeCache.txt"
    fake(
        tmp_path,
        "cmake",
        f'echo "cmake $*" >>{log}\nmkdir -p {cache.parent}\ntouch {cache.parent}/build.ninja {cache}\n',
    )
    fake(tmp_path, "ninja", f'[[ " $* " == *" -n "* ]] || echo "ninja ${{@:5}}" >>{log}\n')
    return tmp_path, {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}


def test_build_builds_its_targets_and_installs_what_they_need(builder):
    folder, environment = builder

    def build(*arguments: str) -> list[str]:
        (folder / "log").unlink(missing_ok=True)
        subprocess.run([folder / "tools" / "build.sh", *arguments], env=environment, check=True, capture_output=True)
        return [line.strip() for line in (folder / "log").read_text().splitlines()]

    configured = "cmake --preset release"
    assert build("rootsoil") == ["setup", configured, "ninja rootsoil"]
    assert build() == ["setup --test", "ninja"]
    assert build("--werror") == ["setup --test", configured + " -DROOTSOIL_WERROR=ON", "ninja"]
    # configured before GoogleTest was there: only the tests ask again
    cache = folder / "build" / "release" / "CMakeCache.txt"
    cache.write_text("GTest_DIR:PATH=GTest_DIR-NOTFOUND\n")
    assert build("rootsoil") == ["setup", "ninja rootsoil"]
    assert build() == ["setup --test", configured, "ninja"]


def test_failed_build_ends_run_and_test(copy: Path):
    for name in ("run.sh", "test.sh"):
        done = subprocess.run(
            [copy / "tools" / name], env={**os.environ, "BUILD_STATUS": "7"}, capture_output=True, text=True
        )
        assert done.returncode == 7 and done.stdout == ""


def test_test_refuses_unknown_arguments(copy: Path):
    done = subprocess.run([copy / "tools" / "test.sh", "--fast"], capture_output=True, text=True)
    assert done.returncode == 2 and "--quick" in done.stderr
