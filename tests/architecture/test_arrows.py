# SPDX-License-Identifier: MIT
"""Which folder may include which (ARCHITECTURE.md), and what every file has or must not have."""

from __future__ import annotations

import itertools
import re
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
MODULES = PROJECT / "root_sph"

BASIS = {"core", "kernels", "neighbours", "tissue"}
# folder: what it may include, besides itself
ARROWS = {
    "core": set(),
    "kernels": {"core"},
    "neighbours": {"core", "kernels"},
    "tissue": {"core"},
    "dynamics": BASIS,
    "exchange": {"core", "kernels", "neighbours"},
    "io": {"core"},
    "scene": {"core", "tissue", "dynamics"},
    "effects": BASIS | {"dynamics", "exchange", "io", "scene"},
    "model": BASIS | {"dynamics", "effects", "io", "scene"},
    "app": {"core", "tissue", "dynamics", "effects", "io", "scene", "model"},
}

# What lies in effects/ and is no effect itself. Every effect may include these two; the table includes every effect.
SHARED_BY_EFFECTS = {"effect", "effect_spec"}
TABLE = "table"

# What the program includes of root_sph: the application, the language and its table, and the section of the soil
# that it makes.
USED_BY_SCENARIOS = (
    "app/",
    "scene/",
    "effects/table.hpp",
    "effects/soil_contact/soil_section.hpp",
    "core/errors.hpp",
    "core/interruption.hpp",
    "core/version.hpp",
)


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
            if target != module and target not in ARROWS[module]:
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


def uses_of_the_build(text: str) -> dict[str, set[str]]:
    """The folders that each rootsoil_module(NAME ... USES ...) of a CMakeLists.txt names."""
    uses = {}
    for words in map(str.split, re.findall(r"rootsoil_module\(([^)]*)\)", text)):
        after = words[words.index("USES") + 1 :] if "USES" in words else []
        uses[words[0]] = set(itertools.takewhile(str.islower, after))  # up to the next keyword
    return uses


def test_the_build_draws_the_same_arrows():
    """The build links no folder against an arrow, and names every folder that is included, also through another."""
    uses = uses_of_the_build((MODULES / "CMakeLists.txt").read_text())
    assert uses.keys() == ARROWS.keys()
    for name, used in uses.items():
        assert used <= ARROWS[name], name

    def reachable(name: str) -> set[str]:
        return {name}.union(*(reachable(other) for other in uses[name]))

    for file in sources(MODULES):
        module = file.relative_to(MODULES).parts[0]
        assert {header.split("/")[0] for header in includes(file)} <= reachable(module), file


def test_the_builds_arrows_are_read():
    """The test above reads what a module uses, whatever comes before and after."""
    text = "rootsoil_module(a)\nrootsoil_module(b\n  SOURCES b/b.cpp\n  USES a c\n  LIBRARIES fmt::fmt\n  COLD UNITY 3)"
    assert uses_of_the_build(text) == {"a": set(), "b": {"a", "c"}}


def effect_of(file: Path) -> str:
    """The effect to which a file below effects/ belongs: its folder's name, or its own where it has no folder."""
    return file.parts[0] if len(file.parts) > 1 else file.stem


def taken_from_others(folder: Path) -> list[str]:
    """Every include by which an effect takes from another one, or from the table of all."""
    wrong = []
    for file in sources(folder):
        effect = effect_of(file.relative_to(folder))
        if effect == TABLE:
            continue
        for header in includes(file):
            if not header.startswith("effects/"):
                continue
            other = effect_of(Path(header).relative_to("effects"))
            if other not in SHARED_BY_EFFECTS | {effect}:
                wrong.append(f"{file.relative_to(folder)} includes {header}")
    return wrong


def test_effects_do_not_know_each_other():
    """An effect includes no other effect."""
    assert taken_from_others(MODULES / "effects") == []


def test_a_glance_at_another_effect_is_found(tmp_path: Path):
    """The test above sees through folders, and lets an effect's own files and shared ones pass."""
    (tmp_path / "soil").mkdir()
    own = '#include "root_sph/effects/soil/part.hpp"\n#include "root_sph/effects/effect.hpp"\n'
    (tmp_path / "soil" / "soil.hpp").write_text(own + '#include "root_sph/effects/sleep/sleep.hpp"\n')
    (tmp_path / "probe.hpp").write_text('#include "root_sph/effects/soil/part.hpp"\n')
    (tmp_path / "effect.hpp").write_text('#include "root_sph/effects/table.hpp"\n')
    (tmp_path / "table.cpp").write_text('#include "root_sph/effects/soil/soil.hpp"\n')
    assert taken_from_others(tmp_path) == [
        "effect.hpp includes effects/table.hpp",
        "probe.hpp includes effects/soil/part.hpp",
        "soil/soil.hpp includes effects/sleep/sleep.hpp",
    ]


def not_in_the_table(folder: Path) -> list[str]:
    """Everything in effects/ that is neither shared nor the folder of an effect that the table names."""
    known = SHARED_BY_EFFECTS | {TABLE}
    named = {f"{Path(header).parent.name}/{Path(header).name}" for header in includes(folder / "table.cpp")}
    return sorted(
        entry.name
        for entry in folder.iterdir()
        if (f"{entry.name}/{entry.name}.hpp" not in named if entry.is_dir() else entry.stem not in known)
    )


def test_an_effect_is_a_folder_and_a_line_in_the_table():
    """No effect is built that the table forgets, and none lies outside a folder of its own."""
    assert not_in_the_table(MODULES / "effects") == []


def test_a_forgotten_effect_is_found(tmp_path: Path):
    """The test above sees a folder that the table does not name, and a file without a folder."""
    for name in ("wind", "rain"):
        (tmp_path / name).mkdir()
    (tmp_path / "effect.hpp").touch()
    (tmp_path / "snow.hpp").touch()
    (tmp_path / "table.cpp").write_text('#include "root_sph/effects/rain/rain.hpp"\n')
    assert not_in_the_table(tmp_path) == ["snow.hpp", "wind"]


def test_the_root_does_not_know_the_soil():
    """root_sph never includes soil_coupling; a program without [soil] needs nothing of it."""
    for file in sources(MODULES):
        assert "soil_coupling" not in "".join(re.findall(r"^#include.*", file.read_text(), re.M)), file


def test_the_soil_knows_little_of_the_root():
    """soil_coupling includes the core and the port between root and soil, nothing else of root_sph."""
    folder = PROJECT / "soil_coupling"
    assert any(includes(file) for file in sources(folder))
    for file in sources(folder):
        assert {header.split("/")[0] for header in includes(file)} <= {"core", "exchange"}, file


def test_scenarios_only_start():
    """The program includes what it starts, the language, the errors that it reports and how it is interrupted, nothing
    deeper."""
    for file in sources(PROJECT / "scenarios"):
        assert all(header.startswith(USED_BY_SCENARIOS) for header in includes(file)), file


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


def licence_of(file: Path) -> str:
    """What imports YADE, which is under the GPL 2, is under a licence that agrees with it."""
    return "GPL-2.0-or-later" if "yade_side" in file.parts else "MIT"


def test_licence():
    """Every source file says its licence in its first lines."""
    for file in project_files():
        if file.suffix in WITH_LICENCE and "corpus" not in file.parts:
            head = file.read_text().splitlines()[:3]
            assert any(f"SPDX-License-Identifier: {licence_of(file)}" in line for line in head), file


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
