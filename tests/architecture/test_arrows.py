# SPDX-License-Identifier: MIT
"""Which folder may include which (ARCHITECTURE.md), and what every file has or must not have."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
MODULES = PROJECT / "root_sph"

BASIS = {"core", "kernels", "neighbours", "tissue", "profiles"}
# folder: what it may include, besides itself
ARROWS = {
    "core": set(),
    "kernels": {"core"},
    "neighbours": {"core", "kernels"},
    "tissue": {"core"},
    "profiles": {"core"},
    "dynamics": BASIS,
    "exchange": {"core", "kernels", "neighbours"},
    "effects": BASIS | {"dynamics", "exchange"},
    "io": {"core"},
    "scene": BASIS | {"dynamics", "exchange", "effects", "io"},
}
# header: who may include it although no arrow leads there
EXCEPTIONS = {"io/frame.hpp": {"effects"}}

# In effects/: what is no effect itself, and what one effect takes from another one.
SHARED_BY_EFFECTS = {"effect", "shapes"}
TAKEN_FROM_EFFECTS = {("probe", "division")}  # longest_axis


def includes(file: Path) -> list[str]:
    """The project's headers that a file names, without root_sph/."""
    return re.findall(r'^#include [<"]root_sph/([^>"]+)[>"]', file.read_text(), re.M)


def sources(folder: Path) -> list[Path]:
    """C++ files below a folder."""
    return sorted(file for suffix in ("hpp", "cpp") for file in folder.rglob(f"*.{suffix}"))


def wrong_arrows(modules: Path) -> list[str]:
    """Every include that no arrow allows."""
    wrong = []
    for file in sources(modules):
        module = file.relative_to(modules).parts[0]
        for header in includes(file):
            target = header.split("/")[0]
            allowed = target == module or target in ARROWS[module] or module in EXCEPTIONS.get(header, ())
            if not allowed:
                wrong.append(f"{file.relative_to(modules)} includes {header}")
    return wrong


def test_arrows():
    """No folder includes what stands above or beside it."""
    assert {file.relative_to(MODULES).parts[0] for file in sources(MODULES)} == set(ARROWS)
    assert wrong_arrows(MODULES) == []


def test_a_wrong_arrow_is_found(tmp_path: Path):
    """The test above sees an include that should not be."""
    (tmp_path / "core").mkdir()
    (tmp_path / "core" / "a.hpp").write_text('#include "root_sph/core/b.hpp"\n#include "root_sph/scene/c.hpp"\n')
    assert wrong_arrows(tmp_path) == ["core/a.hpp includes scene/c.hpp"]


def test_no_way_around():
    """Headers of the project are named from its root, so that the arrows can be seen."""
    for file in sources(MODULES):
        for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M):
            assert name.startswith("root_sph/"), f"{file}: {name}"
            assert (PROJECT / name).is_file(), f"{file}: {name}"


def test_the_build_draws_the_same_arrows():
    """Every folder that is included is also named in the build's USES, directly or through another one."""
    text = (MODULES / "CMakeLists.txt").read_text()
    uses = {
        name: set(rest[rest.index("USES") + 1 : rest.index("LIBRARIES") if "LIBRARIES" in rest else None])
        for name, rest in (
            (words[0], words[1:]) for words in map(str.split, re.findall(r"rootsoil_module\(([^)]*)\)", text))
        )
        if "USES" in rest or not rest
    } | {"core": set()}

    def reachable(name: str) -> set[str]:
        return {name}.union(*(reachable(other) for other in uses[name]))

    for file in sources(MODULES):
        module = file.relative_to(MODULES).parts[0]
        used = {header.split("/")[0] for header in includes(file) if header not in EXCEPTIONS}
        assert used <= reachable(module), file


def test_effects_do_not_know_each_other():
    """An effect includes no other effect, but for the one function that is listed above."""
    folder = MODULES / "effects"
    effects = {file.stem for file in folder.glob("*.hpp")} - SHARED_BY_EFFECTS
    for file in sources(folder):
        for header in includes(file):
            other = Path(header).stem
            if header.startswith("effects/") and other in effects and other != file.stem:
                assert (file.stem, other) in TAKEN_FROM_EFFECTS, f"{file.name} includes {header}"


def test_the_root_does_not_know_the_soil():
    """root_sph never includes soil_coupling; a program without [soil] needs nothing of it."""
    for file in sources(MODULES):
        assert "soil_coupling" not in "".join(re.findall(r"^#include.*", file.read_text(), re.M)), file


def test_scenarios_only_start():
    """The program includes the scene module and the errors that it reports, nothing deeper."""
    for file in sources(PROJECT / "scenarios"):
        assert all(header.startswith(("scene/", "core/errors")) for header in includes(file)), file


# ---- every file -----------------------------------------------------------------------------------


def project_files() -> list[Path]:
    """All files that belong to the project: what git tracks or would track."""
    command = ["git", "-C", str(PROJECT), "ls-files", "--cached", "--others", "--exclude-standard"]
    try:
        listed = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git work tree")
    return [path for name in listed if (path := PROJECT / name).is_file()]


WITH_LICENCE = {".hpp", ".cpp", ".py", ".sh", ".toml", ".md", ".cmake", ".txt", ".ini", ".yml"}


def test_licence():
    """Every source file says its licence in its first lines."""
    for file in project_files():
        if file.suffix in WITH_LICENCE and "corpus" not in file.parts:
            head = file.read_text().splitlines()[:3]
            assert any("SPDX-License-Identifier: MIT" in line for line in head), file


def test_no_place_of_our_own():
    """No file knows where it was written: no absolute path of a person's or workplace's folder, no foreign host."""
    place = re.compile(r"(?<![\w.)}\"*])/(?:work|home|root|mnt|Users)/\w")
    host = re.compile(r"https?://([\w.-]+)")
    known_hosts = {"toml.io", "doi.org", "www.paraview.org", "opensource.org", "spdx.org"}
    for file in project_files():
        try:
            text = file.read_text()
        except UnicodeDecodeError:
            continue  # a picture, or a file that is broken on purpose
        assert not (found := place.search(text)), f"{file}: {found[0]}"
        assert set(host.findall(text)) <= known_hosts, f"{file}: {set(host.findall(text)) - known_hosts}"
