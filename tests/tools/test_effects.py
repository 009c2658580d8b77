# SPDX-License-Identifier: MIT
"""The page on what effects cost."""

from __future__ import annotations

import csv
import subprocess
import tomllib
from pathlib import Path

import effects as tool
import pytest
from rootsoil_tools import pages


@pytest.mark.parametrize("removal", tool.REMOVALS, ids=lambda removal: removal.effect)
def test_what_is_taken_out_is_gone(removal: tool.Removal, project: Path, tmp_path: Path):
    program = project / "build" / "release" / "rootsoil"
    job = tool.JOBS["main job (2D)"]
    scene = tmp_path / "less.toml"
    scene.write_text(tool.without_sections(job.read_text(encoding="utf-8"), removal.sections), encoding="utf-8")

    def active(path: Path, settings: tuple[str, ...] = ()) -> set[str]:
        return {effect["name"] for effect in tool.examine(program, path, settings)["effects"] if effect["active"]}

    assert removal.effect in active(job)
    assert removal.effect not in active(scene, removal.settings)


def test_every_scene_is_in_the_recorded_page(project: Path):
    page = (project / "docs" / "effects.md").read_text(encoding="utf-8")
    for scene in (project / "scenarios").glob("*.toml"):
        assert f"`{scene.stem}`" in page, scene.name
        soil = "soil" in tomllib.loads(scene.read_text(encoding="utf-8"))
        (row,) = [line for line in page.splitlines() if line.startswith(f"| `{scene.stem}` |")]
        assert ("yade" in row) == soil, row


def test_what_is_written_by_hand_is_kept(tmp_path: Path):
    page = tmp_path / "effects.md"
    assert pages.kept_part(page, "effects") == ""
    page.write_text("made\n" + pages.mark_of("effects") + "by hand\n", encoding="utf-8")
    assert pages.kept_part(page, "effects") == pages.mark_of("effects") + "by hand\n"
    assert pages.kept_part(page, "another") == ""
    recorded = Path(__file__).resolve().parents[2] / "docs" / "effects.md"
    assert len(pages.kept_part(recorded, "effects")) > 1000


@pytest.mark.slow
def test_sleep_pays(project: Path, tmp_path: Path):
    """The quick study: cells fall asleep, and the length differs by what the balance leaves; times are the page's."""
    command = [project / "tools" / "effects.py", "--quick", "--out", tmp_path / "out", "--work", tmp_path / "work"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    with (tmp_path / "out" / "images" / "effects_sleep.csv").open() as file:
        assert all(
            float(row["asleep_s_per_h"]) > 0.0 and float(row["awake_s_per_h"]) > 0.0 for row in csv.DictReader(file)
        )
    history = tool.Run(tmp_path / "work" / "asleep").history()
    assert history["cells_at_rest"][-1] > 0.4 * history["cells"][-1]  # .447
    lengths = [tool.Run(tmp_path / "work" / name).history()["length_mm"][-1] for name in ("awake", "asleep")]
    # Cells of unequal length leave stresses that would bend mature tissue a little further: asleep, it is held.
    assert lengths[1] == pytest.approx(lengths[0], rel=2.1e-4)  # 1.07e-4
    assert "| pair resistance |" in (tmp_path / "out" / "effects.md").read_text(encoding="utf-8")
