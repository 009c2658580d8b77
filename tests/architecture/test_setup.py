# SPDX-License-Identifier: MIT
"""tools/setup.sh installs what the tree includes, finds and imports, and nothing else; by default what a run needs."""

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
    "python3-scipy": (set(), set(), {"scipy"}),
    "yade": (set(), set(), {"yade"}),
    "cmake": (set(), {"GoogleTest"}, set()),
}
# of the C library, which g++ brings
POSIX = {"fcntl.h", "unistd.h", "sys", "poll.h", "spawn.h", "netinet", "arpa"}
WITH_CMAKE = {"Threads"}
BUILD_TOOLS = {"g++", "cmake", "ninja-build"}
OPTIONS = {"--numprocesses": "python3-pytest-xdist"}  # of tools/test.sh, by the package that pytest has them from


def tracked(*patterns: str) -> list[Path]:
    """Files of the project."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns]
    try:
        listed = subprocess.run(command, cwd=PROJECT, check=True, capture_output=True, text=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git work tree")
    return [path for name in listed if (path := PROJECT / name).is_file()]


def is_test(path: Path) -> bool:
    return path.relative_to(PROJECT).parts[0] == "tests"


def listed(name: str) -> set[str]:
    """The packages of a list in tools/setup.sh."""
    text = (PROJECT / "tools" / "setup.sh").read_text()
    found = re.search(rf'^{name}="\n(.*?)"', text, re.M | re.S)
    assert found, f"tools/setup.sh has no list {name}"
    return {line.split()[0] for line in found[1].splitlines()}


def headers(files: list[Path]) -> set[str]:
    """The first part of every header in angle brackets that is not of the C++ library (those have no dot or slash)."""
    names = set()
    for file in files:
        if file.suffix in (".cpp", ".hpp"):
            names |= set(re.findall(r"^\s*#include <([^>]+)>", file.read_text(), re.M))
    first = {name.split("/")[0] for name in names if "/" in name or "." in name}
    return first - {"root_sph", "soil_coupling", "tests"} - POSIX


def cmake_packages(files: list[Path]) -> set[str]:
    """Every find_package."""
    text = "".join(file.read_text() for file in files if file.name == "CMakeLists.txt" or file.suffix == ".cmake")
    return set(re.findall(r"find_package\((\w+)", text)) - WITH_CMAKE


def python_modules(files: list[Path]) -> set[str]:
    """Every module that is imported and neither Python's own nor the project's."""
    names: set[str] = set()
    for file in files:
        if file.suffix != ".py":
            continue
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                names.add(node.module.split(".")[0])
    every = tracked("*.py")
    ours = {file.stem for file in every} | {file.parent.name for file in every}
    return names - set(sys.stdlib_module_names) - ours


def used(in_tests: bool) -> set[str]:
    """The packages whose headers, CMake packages or Python modules the program and the tools, or the tests, name."""
    files = [file for file in tracked() if is_test(file) == in_tests]
    packages: set[str] = set()
    for kind, names in enumerate((headers(files), cmake_packages(files), python_modules(files))):
        assert names, "the search finds nothing"
        for name in names:
            providers = [package for package, provided in PACKAGES.items() if name in provided[kind]]
            assert providers, f"{name} comes from no package that this test knows"
            packages |= set(providers)
    return packages


def test_a_run_gets_what_it_needs_and_nothing_else():
    """The list without options, and --soil, are what the program and the tools name."""
    plain, soil = listed("packages"), listed("soil_packages")
    assert not plain & soil
    assert (plain | soil) - BUILD_TOOLS == used(in_tests=False) - BUILD_TOOLS


def test_tests_get_what_they_add():
    """--test is what only the tests name, in themselves or where they are called."""
    call = (PROJECT / "tools" / "test.sh").read_text()
    plugins = {package for option, package in OPTIONS.items() if option in call}
    assert listed("test_packages") - plugins == used(in_tests=True) - used(in_tests=False) - BUILD_TOOLS
    assert plugins <= listed("test_packages")


def test_every_option_has_its_own_list():
    """What --dev installs, nothing else does."""
    others = listed("packages") | listed("soil_packages") | listed("test_packages")
    assert listed("dev_packages") and not listed("dev_packages") & others
