# SPDX-License-Identifier: MIT
"""Wrong input: one clear message, the right exit status, and nothing overwritten."""

from __future__ import annotations

import fcntl
import os
import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from cli_support import FULL, SECTIONS, SMALL, Done, Program, digest, frames, replaced, same_results

BAD_INPUT = 2
FILE_TROUBLE = 5


def assert_one_message(done: Done, status: int, *parts: str) -> None:
    """One message on stderr with all these parts, and the exit status."""
    assert done.status == status, done.err
    assert done.err.startswith("rootsoil: ") and done.err.count("rootsoil: ") == 1, done.err
    assert "internal error" not in done.err
    for part in parts:
        assert part in done.err, f"'{part}' is not in:\n{done.err}"


# What is wrong, the scene, and what the message says: line and key, given, allowed or remedy.
SCENES: dict[str, tuple[str, tuple[str, ...]]] = {
    "not TOML": (replaced(SMALL, "[root]", "[root"), ("scene.toml:5: ",)),
    "unknown key": (
        replaced(SMALL, "radius_mm", "radus_mm"),
        ("scene.toml:7: root.radus_mm: unknown key", "did you mean radius_mm?"),
    ),
    "unknown section": (
        SMALL + "\n[grwth]\n",
        ("scene.toml:16: grwth: unknown section", "did you mean growth?"),
    ),
    "key in the wrong section": (
        replaced(SMALL, "every_h", "duration_h = 1\nevery_h"),
        ("scene.toml:14: output.duration_h: unknown key", "is a key of [scene]"),
    ),
    "missing key": (
        replaced(SMALL, "radius_mm = 0.02\n", ""),
        ("scene.toml:5: root.radius_mm: this key is missing", "allowed: a number above 0"),
    ),
    "missing section": (
        SMALL[: SMALL.index("[output]")],
        ("scene.toml: section [output] is missing", "add it"),
    ),
    "wrong type": (
        replaced(SMALL, "0.02", '"0.02"'),
        ("scene.toml:7: root.radius_mm: this is not a number", "given:   '0.02'", "without quotes"),
    ),
    "negative radius": (
        replaced(SMALL, "0.02", "-0.02"),
        ("scene.toml:7: root.radius_mm: ", "given:   -0.02", "allowed: a number above 0"),
    ),
    "not a number": (
        replaced(SMALL, "0.02", "nan"),
        ("scene.toml:7: root.radius_mm: this is not a finite number", "given:   nan"),
    ),
    "Poisson ratio": (
        replaced(SMALL, "1020.0", "1020.0\nnu_axial = 1.2"),
        ("scene.toml:12: tissue.nu_axial: ", "given:   1.2", "allowed: a number above -1, below 1"),
    ),
    "compliance not positive definite": (
        replaced(SMALL, "1020.0", "1020.0\nnu_axial = 0.9") + SECTIONS["anisotropy"],
        ("scene.toml:12: tissue.nu_axial: the compliance matrix is not positive definite", "given:   nu_axial = 0.9"),
    ),
    "zero duration": (
        replaced(SMALL, "duration_h = 0.2", "duration_h = 0"),
        ("scene.toml:3: scene.duration_h: ", "given:   0", "allowed: a number above 0"),
    ),
    "more cells than memory": (
        replaced(SMALL, "cell_size_mm = 0.01", "cell_size_mm = 1e-6"),
        ("scene.toml:8: root.cell_size_mm: ", "given:   1e-06", "are all lengths in mm?"),
    ),
    "soil": (SMALL + "\n[soil]\n", ("scene.toml:16: soil.box_from_mm: this key is missing",)),
    "no such cell file": (
        replaced(SMALL, 'name = "small"', "dimension = 3").replace(
            "length_mm = 0.1\nradius_mm = 0.02\ncell_size_mm = 0.01", 'cells_file = "none.csv"'
        ),
        ("scene.toml:6: root.cells_file: there is no such file", '"none.csv"', "starts from the scene file's folder"),
    ),
    "hyperbolicity": (
        replaced(SMALL, "1020.0", '1020.0\nlaw = "pressure_deviator"')
        + replaced(SECTIONS["anisotropy"], "12000.0", "15300.0"),
        ("tissue.law: the law is not hyperbolic", "E_R/E_A", "below about 4", 'law = "elastic_growth"'),
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_scene(program: Program, name: str):
    """`run` and `check` refuse it in the same words; the folder is not even made."""
    text, parts = SCENES[name]
    scene = program.scene(text)
    done = program("run", scene, "--out", "out")
    assert_one_message(done, BAD_INPUT, str(scene), *parts)
    assert program("check", scene).err == done.err
    assert not (program.folder / "out").exists()


def test_hyperbolicity_lost_at_the_ratio_of_the_paper(program: Program):
    """E_R/E_A = 15 is named, and scene.allow_unstable is a way to go on."""
    text, _ = SCENES["hyperbolicity"]
    text = replaced(text, "s_e_per_mm = 40.0", "s_e_per_mm = 0.0").replace("c_e = 0.2", "c_e = 1.0")
    assert_one_message(program("check", program.scene(text)), BAD_INPUT, "E_R/E_A = 15,", "allow_unstable = true")
    assert program("check", program.scene(text), "--set", "scene.allow_unstable=true").status == 0


def test_scene_file_missing(program: Program):
    """No file, or a folder in its place."""
    assert_one_message(program("run", "none.toml"), BAD_INPUT, "none.toml: there is no such scene file", "to do: ")
    assert_one_message(program("run", "."), BAD_INPUT, "this is a folder", "to do: ")
    assert list(program.folder.iterdir()) == []


def test_override(program: Program):
    """--set and --accuracy are named as the place of the mistake."""
    scene = program.scene(SMALL)
    assert_one_message(program("check", scene, "--set", "root.radus_mm=1"), BAD_INPUT, "--set", "radius_mm?")
    assert_one_message(program("check", scene, "--set", "root.radius_mm"), BAD_INPUT, "--set", "section.key=value")
    assert_one_message(
        program("check", scene, "--accuracy", "best"), BAD_INPUT, "--accuracy", "fast, balanced, reference"
    )


def test_command_line(program: Program):
    """Mistakes in the command line name what was given."""
    scene = program.scene(SMALL)
    assert_one_message(program(), BAD_INPUT, "subcommand", "--help")
    assert_one_message(program("rnu", scene), BAD_INPUT, "rnu", "did you mean run?")
    assert_one_message(program("run"), BAD_INPUT, "SCENE is required")
    assert_one_message(program("run", scene, "--thread", "2"), BAD_INPUT, "--thread")
    for threads in ("0", "1.5", "-1", "100000", "two"):
        assert_one_message(
            program("run", scene, f"--threads={threads}"), BAD_INPUT, f"{threads} is not a whole number from 1 to 256"
        )
    for until in ("0", "-1", "nan", "soon"):
        assert_one_message(program("run", scene, f"--until={until}"), BAD_INPUT, f"{until} is not a number above 0")
    assert_one_message(program("describe", "grwth"), BAD_INPUT, "grwth", "did you mean growth?")
    assert not (program.folder / "runs").exists()


# ---- cell files -----------------------------------------------------------------------------------

HEADER = (
    "Label, pos.X (um), pos.Y (um), pos.Z (um), e1.X, e1.Y, e1.Z, e2.X, e2.Y, e2.Z, r1 (um), r2 (um), r3 (um)\n"
)
ROWS = [f"{n}, {10 * n}, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5\n" for n in range(1, 9)]
CELLS_SCENE = SCENES["no such cell file"][0].replace("none.csv", "cells.csv")


def with_row(row: str) -> str:
    """A good file with another row in line 3."""
    return HEADER + ROWS[0] + row + "\n" + "".join(ROWS[2:])


CELLS: dict[str, tuple[str, tuple[str, ...]]] = {
    "empty": ("", ("cells.csv: the file is empty", "allowed: a header: Label, pos.X (um)")),
    "0 cells": (HEADER, ("cells.csv: the file holds no cells", "allowed: one row or more")),
    "missing columns": (
        HEADER.replace(" e1.Y,", "").replace(" r3 (um)", " s3 (um)"),
        ("cells.csv:1: columns are missing: e1.Y, r3 (um)", "given:   Label, pos.X", "export position"),
    ),
    "NaN": (
        with_row("2, 20, nan, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'pos.Y (um)': ", "given:   nan", "a finite number"),
    ),
    "text": (
        with_row("2, 20, here, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'pos.Y (um)': not a number", "given:   here"),
    ),
    "short row": (with_row("2, 20, 0"), ("cells.csv:3: column 'pos.Z (um)': the value is missing", "13 values")),
    "duplicate labels": (
        with_row("1, 20, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'Label': two cells have the same label", "1, also in line 2"),
    ),
    "zero axis": (
        with_row("2, 20, 0, 0, 0, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'e1.X': ",),
    ),
    "axes not orthogonal": (
        with_row("2, 20, 0, 0, 1, 0, 0, 0.6, 0.8, 0, 5, 5, 5"),
        ("cells.csv:3: column 'e2.X': e1 and e2 are not orthogonal", "given:   e1.e2 = 0.6"),
    ),
    "negative semi-axis": (
        with_row("2, 20, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, -5"),
        ("cells.csv:3: column 'r3 (um)': a semi-axis must be positive", "given:   -5"),
    ),
    "semi-axes not in order": (
        with_row("2, 20, 0, 0, 1, 0, 0, 0, 1, 0, 5, 6, 5"),
        ("cells.csv:3: column 'r2 (um)': the semi-axes are not in descending order", "r1 >= r2 >= r3"),
    ),
    "metres": (
        with_row("2, 2e9, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5"),
        ("cells.csv:3: column 'pos.X (um)': out of range", "micrometres"),
    ),
}


@pytest.mark.parametrize("name", CELLS)
def test_cells(program: Program, name: str):
    """A wrong cell file: file, line, column, given, allowed; nothing that looks like a run is left behind."""
    text, parts = CELLS[name]
    (program.folder / "cells.csv").write_text(text)
    scene = program.scene(CELLS_SCENE)
    done = program("run", scene, "--out", "out")
    assert_one_message(done, BAD_INPUT, str(program.folder / "cells.csv"), *parts)
    assert program("check", scene).err == done.err
    assert not set(digest(program.folder / "out")) - {".lock"}


def test_cells_are_right_otherwise(program: Program):
    """The file that the mistakes above are put into is accepted."""
    (program.folder / "cells.csv").write_text(HEADER + "".join(ROWS))
    done = program("check", program.scene(CELLS_SCENE), "--json")
    assert done.status == 0 and done.json()["cells"] == len(ROWS)


# ---- folders and disks ----------------------------------------------------------------------------


def test_folder_of_another_run(program: Program, full_run: Path):
    """A folder that holds a run is not touched, by the same scene or by another one, nor by a wrong --resume."""
    out = shutil.copytree(full_run, program.folder / "out")
    before = digest(out)
    for text in (FULL, SMALL):
        done = program("run", program.scene(text), "--out", out)
        assert_one_message(done, BAD_INPUT, "already holds a run; nothing was overwritten", str(out), "--resume")
    done = program("run", program.scene(SMALL), "--out", out, "--resume")
    assert_one_message(done, BAD_INPUT, "belongs to another scene", str(out / "scene.toml"))
    assert program("run", program.scene(replaced(FULL, "0.2\n", "0.25\n")), "--out", out).status == BAD_INPUT
    assert digest(out) == before


def test_every_trace_of_a_run_protects_it(program: Program, full_run: Path):
    """One file of a run is enough for the folder to count as used."""
    scene = program.scene(SMALL)
    for name in ("scene.toml", "summary.json", "history.csv", "run.h5", "checkpoint.h5"):
        out = program.folder / name.replace(".", "_")
        out.mkdir()
        shutil.copy(full_run / name, out)
        before = digest(out)
        assert_one_message(program("run", scene, "--out", out), BAD_INPUT, "already holds a run", name)
        after = digest(out)
        assert {file: after[file] for file in before} == before


def test_folder_in_use(program: Program):
    """Two processes never write to one folder."""
    out = program.folder / "out"
    out.mkdir()
    with (out / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        done = program("run", program.scene(SMALL), "--out", out)
    assert_one_message(done, BAD_INPUT, "another process is writing", str(out), "--out")
    assert list(digest(out)) == [".lock"]


def test_resume_without_checkpoint(program: Program):
    """--resume where there is nothing to go on from."""
    done = program("run", program.scene(SMALL), "--out", "none", "--resume")
    assert_one_message(done, BAD_INPUT, "there is no checkpoint to go on from", "none", "leave --resume out")
    assert not (program.folder / "none").exists()


def test_damaged_checkpoint(program: Program, full_run: Path):
    """A checkpoint with one wrong byte, or cut short, is not believed."""
    scene = program.scene(FULL)
    whole = (full_run / "checkpoint.h5").read_bytes()
    changed = bytearray(whole)
    changed[len(whole) // 2] ^= 1
    for content in (bytes(changed), whole[:-1], b""):
        out = shutil.copytree(full_run, program.folder / "out")
        (out / "checkpoint.h5").write_bytes(content)
        before = digest(out)
        done = program("run", scene, "--out", out, "--resume")
        assert_one_message(done, FILE_TROUBLE, str(out / "checkpoint.h5"))
        assert {name: value for name, value in digest(out).items() if name != "run.log"} == {
            name: value for name, value in before.items() if name != "run.log"
        }
        shutil.rmtree(out)


def test_folder_that_cannot_be_made(program: Program):
    """A file in place of the folder, and a place where nobody can make one."""
    (program.folder / "file").write_text("mine")
    scene = program.scene(SMALL)
    for out in ("file", "file/below", "/proc/run"):
        assert_one_message(program("run", scene, "--out", out), FILE_TROUBLE, f"{out}: the run's folder cannot be")
    assert (program.folder / "file").read_text() == "mine"


@pytest.mark.skipif(os.geteuid() == 0, reason="root can write everywhere")
def test_folder_without_permission(program: Program):
    """A folder that this user may not write to."""
    out = program.folder / "out"
    out.mkdir(mode=0o555)
    assert_one_message(program("run", program.scene(SMALL), "--out", out), FILE_TROUBLE, str(out), "ermission")


def test_export(program: Program, full_run: Path):
    """Wrong run, time and file of `export`."""
    assert_one_message(program("export", "none", "--csv", "a.csv"), BAD_INPUT, "none: there is no run here")
    for time in ("7", "-1", "soon"):
        done = program("export", full_run, f"--time={time}", "--csv", "a.csv")
        assert_one_message(done, BAD_INPUT, f"given:   {time}", "allowed: 0 to 0.4 (h), or last")
    assert_one_message(program("export", full_run, "--csv", "none/a.csv"), FILE_TROUBLE, "none/a.csv")
    (program.folder / "run.h5").write_bytes(b"not HDF5")
    assert_one_message(program("export", ".", "--csv", "a.csv"), FILE_TROUBLE, "run.h5")
    assert not (program.folder / "a.csv").exists()


def test_unknown_field(program: Program):
    """A field that the scene does not have is refused before anything of a run is written."""
    scene = program.scene(SMALL + 'fields = ["softening"]\n')
    done = program("run", scene, "--out", "out")
    assert_one_message(done, BAD_INPUT, "output.fields: ", "given:   softening", "allowed: ")
    assert program("run", program.scene(SMALL), "--out", "out").status == 0


def test_file_size_limit(program: Program, full_run: Path):
    """A file that cannot grow any further ends the run with status 5; frames stay readable and the run can go on."""
    scene, out = program.scene(FULL), program.folder / "out"
    most = sum(file.stat().st_size for file in full_run.iterdir() if file.name == "checkpoint.h5") - 8000
    done = program(
        "run", scene, "--out", out, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    )
    assert_one_message(
        Done(done.status, "", done.err[done.err.index("rootsoil: ") :]), FILE_TROUBLE, str(out), "cannot be written"
    )
    assert frames(out)
    assert program("run", scene, "--out", out, "--resume").status == 0
    same_results(out, full_run)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 400 kB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=400k", "tmpfs", disk]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode != 0:
        pytest.skip("no right to mount a small disk")
    yield disk
    subprocess.run(["umount", disk], check=True)


def test_full_disk(program: Program, small_disk: Path, full_run: Path):
    """A full disk: status 5, all frames that were reported are readable; with more room the run goes on to its end."""
    scene, out = program.scene(FULL), small_disk / "out"
    done = program("run", scene, "--out", out)
    assert done.status == FILE_TROUBLE
    assert f"rootsoil: {out}" in done.err and "No space left on device" in done.err
    written = frames(out)
    assert 0 < len(written) < len(frames(full_run))
    assert not list(out.rglob("*.tmp"))
    assert program("run", scene, "--out", out, "--resume").status == FILE_TROUBLE
    subprocess.run(["mount", "-o", "remount,size=20m", small_disk], check=True)
    done = program("run", scene, "--out", out, "--resume")
    assert done.status == 0, done.err
    same_results(out, full_run)
