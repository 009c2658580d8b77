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
    listed = re.search(r'packages="\n(.*?)"', (here / "tools" / "setup.sh").read_text(), re.S)
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


def test_setup_lists_what_the_build_asks_for(project: Path):
    """Every find_package of the build has its Debian package in the one list."""
    listed = (project / "tools" / "setup.sh").read_text()
    package_of = {
        "Eigen3": "libeigen3-dev",
        "HDF5": "libhdf5-dev",
        "fmt": "libfmt-dev",
        "spdlog": "libspdlog-dev",
        "tomlplusplus": "libtomlplusplus-dev",
        "CLI11": "libcli11-dev",
        "nlohmann_json": "nlohmann-json3-dev",
        "GTest": "libgtest-dev",
        "benchmark": "libbenchmark-dev",
        "OpenMP": "g++",
        "Threads": "g++",
    }
    files = [project / "CMakeLists.txt", *(project / "cmake").glob("*.cmake"), *project.glob("*/**/CMakeLists.txt")]
    for file in files:
        if "build" in file.relative_to(project).parts:
            continue
        for name in re.findall(r"find_package\((\w+)", file.read_text()):
            assert package_of[name] + " " in listed, f"{file}: {name}"


@pytest.fixture
def copy(project: Path, tmp_path: Path) -> Path:
    """The scripts in a folder of their own, with a build that is up to date and programs that only report."""
    for folder in ("tools", "scenarios", "build/release", "tests"):
        (tmp_path / folder).mkdir(parents=True)
    for name in ("run.sh", "test.sh"):
        shutil.copy(project / "tools" / name, tmp_path / "tools" / name)
    fake(tmp_path / "tools", "build.sh", "exit ${BUILD_STATUS:-0}\n")
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


def test_setup_installs_yade_only_when_asked(project: Path, machine):
    log, environment = machine
    for arguments in ([], ["--soil"]):
        log.unlink(missing_ok=True)
        done = subprocess.run([project / "tools" / "setup.sh", *arguments], env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert ("yade" in log.read_text().split()) == bool(arguments)
    assert subprocess.run([project / "tools" / "setup.sh", "--sol"], capture_output=True).returncode == 2


def test_failed_build_ends_run_and_test(copy: Path):
    for name in ("run.sh", "test.sh"):
        done = subprocess.run(
            [copy / "tools" / name], env={**os.environ, "BUILD_STATUS": "7"}, capture_output=True, text=True
        )
        assert done.returncode == 7 and done.stdout == ""


def test_test_refuses_unknown_arguments(copy: Path):
    done = subprocess.run([copy / "tools" / "test.sh", "--fast"], capture_output=True, text=True)
    assert done.returncode == 2 and "--quick" in done.stderr
