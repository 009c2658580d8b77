# SPDX-License-Identifier: MIT
"""tools/setup.sh installs what the tree includes, finds and imports, and nothing else."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]

# Debian package: the first part of its headers' names, its CMake packages, its Python modules
PACKAGES: dict[str, tuple[set[str], set[str], set[str]]] = {
    "g++": ({"omp.h"}, {"OpenMP"}, set()),
    "libeigen3-dev": ({"Eigen"}, {"Eigen3"}, set()),
    "libhdf5-dev": ({"hdf5.h"}, {"HDF5"}, set()),
    "libtomlplusplus-dev": ({"toml++"}, {"tomlplusplus"}, set()),
    "libcli11-dev": ({"CLI"}, {"CLI11"}, set()),
    "libfmt-dev": ({"fmt"}, {"fmt"}, set()),
    "libspdlog-dev": ({"spdlog"}, {"spdlog"}, set()),
    "nlohmann-json3-dev": ({"nlohmann"}, {"nlohmann_json"}, set()),
    "libgtest-dev": ({"gtest"}, {"GTest"}, set()),
    "libgmock-dev": ({"gmock"}, set(), set()),
    "libbenchmark-dev": ({"benchmark"}, {"benchmark"}, set()),
    "python3-h5py": (set(), set(), {"h5py"}),
    "python3-numpy": (set(), set(), {"numpy"}),
    "python3-matplotlib": (set(), set(), {"matplotlib"}),
    "python3-tomli-w": (set(), set(), {"tomli_w"}),
    "python3-pytest": (set(), set(), {"pytest"}),
    "yade": (set(), set(), {"yade"}),
    "cmake": (set(), {"GoogleTest"}, set()),
}
# of the C library, which g++ brings
POSIX = {"fcntl.h", "unistd.h", "sys", "poll.h", "spawn.h", "netinet", "arpa"}
WITH_CMAKE = {"Threads"}
BUILD_TOOLS = {"g++", "cmake", "ninja-build"}


def tracked(*patterns: str) -> list[Path]:
    """Files of the project."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns]
    try:
        listed = subprocess.run(command, cwd=PROJECT, check=True, capture_output=True, text=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git work tree")
    return [path for name in listed if (path := PROJECT / name).is_file()]


def installed() -> set[str]:
    """The packages that tools/setup.sh lists."""
    text = (PROJECT / "tools" / "setup.sh").read_text()
    lines = [line for part in text.split('packages="\n')[1:] for line in part.split('"\n', 1)[0].splitlines()]
    return {line.split()[0] for line in lines}


def headers() -> set[str]:
    """The first part of every header in angle brackets that is not of the C++ library (those have no dot or slash)."""
    names = set()
    for file in tracked("*.cpp", "*.hpp"):
        names |= set(re.findall(r"^\s*#include <([^>]+)>", file.read_text(), re.M))
    return {name.split("/")[0] for name in names if "/" in name or "." in name} - {"root_sph", "soil_coupling", "tests"}


def cmake_packages() -> set[str]:
    """Every find_package."""
    text = "".join(file.read_text() for file in tracked("CMakeLists.txt", "*/CMakeLists.txt", "*.cmake"))
    return set(re.findall(r"find_package\((\w+)", text))


def python_modules() -> set[str]:
    """Every module that is imported and neither Python's own nor the project's."""
    names: set[str] = set()
    files = tracked("*.py")
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                names.add(node.module.split(".")[0])
    ours = {file.stem for file in files} | {file.parent.name for file in files}
    return names - set(sys.stdlib_module_names) - ours


def providers(kind: int) -> dict[str, str]:
    """Name: package."""
    return {name: package for package, provided in PACKAGES.items() for name in provided[kind]}


def test_everything_used_is_installed():
    """Each header, CMake package and Python module has its package in tools/setup.sh."""
    listed = installed()
    for kind, used in enumerate((headers() - POSIX, cmake_packages() - WITH_CMAKE, python_modules())):
        assert used, "the search finds nothing"
        for name in used:
            package = providers(kind).get(name)
            assert package, f"{name} comes from no package that this test knows"
            assert package in listed, f"{name} needs {package}, which tools/setup.sh does not install"


def test_everything_installed_is_used():
    """No package is installed for nothing."""
    used = {providers(0).get(name) for name in headers()}
    used |= {providers(1).get(name) for name in cmake_packages()}
    used |= {providers(2).get(name) for name in python_modules()}
    assert installed() - used - BUILD_TOOLS == set()
