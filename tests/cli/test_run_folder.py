# SPDX-License-Identifier: MIT
"""What a run leaves behind, and what export, effects, describe and version say: names that users rely on."""

from __future__ import annotations

import csv
import re
import signal
import time
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest
from cli_support import FULL, SECTIONS, SMALL, TIMEOUT_S, Program, checkpoint, frames, history, same_results, summary

HISTORY = [
    "time_h", "cells", "divisions", "tip_x_mm", "tip_y_mm", "tip_z_mm", "length_mm", "tip_speed_mm_h",
    "max_axial_strain_rate_per_h", "mean_radius_mm", "kinetic_over_elastic", "inertia_error", "min_neighbours",
    "contact_force_x_N", "contact_force_y_N", "contact_force_z_N", "contact_force_N",
]  # fmt: skip
SUMMARY = {
    "status", "time_h", "steps", "cells_start", "cells_end", "divisions", "tip_mm", "length_mm", "wall_s",
    "wall_s_by_effect", "pairs", "pairs_per_s", "peak_memory_mb", "threads", "dt_h", "inertia_error_max",
    "momentum_residual", "active_effects", "fields", "inertia_error", "discretisation_error", "preset_inertia_error",
    "preset_ms_per_cell_hour", "stated_accuracy", "balance_iterations", "force_evaluations",
    "cpu_s", "cpu_start_s",
}  # fmt: skip
# name: numbers a cell, unit
FIELDS = {
    "position": (3, "mm"), "velocity": (3, "mm/h"), "volume": (1, "mm^2"), "density": (1, "ug/mm^3"),
    "stress": (6, "MPa"), "pressure": (1, "MPa"), "axial_strain_rate": (1, "1/h"), "distance_to_tip": (1, "mm"),
    "axis": (3, "1"), "cell_axes": (3, "mm"), "generation": (1, "1"), "cell_id": (1, "1"), "parent_id": (1, "1"),
    "contact_force": (3, "N"),
}  # fmt: skip


def test_files(full_run: Path):
    """The folder holds these files and no rest of what was under way."""
    names = {path.name for path in full_run.iterdir()}
    assert names - {".lock"} == {
        "scene.toml", "summary.json", "history.csv", "run.h5", "run.xmf", "checkpoint.h5", "run.log"
    }  # fmt: skip


def test_history(full_run: Path):
    """history.csv has its columns, a row for each output time, and agrees with the frames."""
    assert (full_run / "history.csv").read_text().splitlines()[0].split(",") == HISTORY
    rows = history(full_run)
    assert np.allclose([row["time_h"] for row in rows], np.linspace(0.0, 0.4, 5), atol=1e-12)
    for row, frame in zip(rows, frames(full_run), strict=True):
        assert row["time_h"] == frame["time_h"] and row["cells"] == len(frame["position"])
        assert row["cells"] - row["divisions"] == rows[0]["cells"], "a cell has gone"
        assert np.all(np.isfinite(list(row.values())))
        force = [row[f"contact_force_{axis}_N"] for axis in "xyz"]
        assert np.isclose(np.linalg.norm(force), row["contact_force_N"])
        assert np.allclose(frame["contact_force"].sum(axis=0), force, atol=1e-12)
    for before, after in zip(rows, rows[1:]):
        speed = (after["length_mm"] - before["length_mm"]) / (after["time_h"] - before["time_h"])
        assert np.isclose(after["tip_speed_mm_h"], speed)


def test_times_are_short_decimals(program: Program, full_run: Path):
    """No 0.30000000000000004 in history.csv, run.h5, run.xmf, checkpoint.h5 or summary.json."""
    expected = ["0", "0.1", "0.2", "0.3", "0.4"]
    assert [line.split(",")[0] for line in (full_run / "history.csv").read_text().splitlines()[1:]] == expected
    assert [float(frame["time_h"]) for frame in frames(full_run)] == [0.0, 0.1, 0.2, 0.3, 0.4]
    values = [node.get("Value") for node in ElementTree.parse(full_run / "run.xmf").iter("Time")]
    assert values == expected
    # a step that the program chose divides the output interval into some thousands of parts
    assert program("run", program.scene(SMALL), "--out", "out").status == 0
    assert [row["time_h"] for row in history(program.folder / "out")] == [0.0, 0.1, 0.2]
    assert summary(program.folder / "out")["time_h"] == 0.2


def test_summary(full_run: Path):
    """summary.json has its keys, and agrees with history.csv and the checkpoint."""
    found, last = summary(full_run), history(full_run)[-1]
    assert SUMMARY <= found.keys()
    assert found["status"] == "done" and found["time_h"] == 0.4 and found["steps"] == 400
    assert found["force_evaluations"] == 400 and found["balance_iterations"] == 0
    assert found["cells_end"] == last["cells"] == found["cells_start"] + found["divisions"]
    assert found["divisions"] == last["divisions"] and found["length_mm"] == last["length_mm"]
    assert found["tip_mm"] == [last["tip_x_mm"], last["tip_y_mm"], last["tip_z_mm"]]
    assert found["dt_h"].keys() == {"min", "mean", "max"} and found["dt_h"]["max"] == 0.001
    assert found["inertia_error_max"] == max(row["inertia_error"] for row in history(full_run))
    assert found["inertia_error"] == last["inertia_error"]
    assert found["cells_across"] == 6 and 0.01 < found["discretisation_error"] < 0.012  # .0116 measured
    assert found["momentum_residual"] < 1e-12
    assert {"pressure", "anisotropy", "growth", "division", "obstacle"} <= set(found["active_effects"])
    assert 0.0 < found["cpu_start_s"] < found["cpu_s"]
    assert found["threads"] == 1 and found["wall_s"] > 0 and found["pairs"] > 0 and found["peak_memory_mb"] > 0
    assert all(seconds >= 0 for seconds in found["wall_s_by_effect"].values())
    assert checkpoint(full_run)["attribute time_h"] == 0.4


def test_what_balance_takes_is_counted(program: Program):
    """Of each step: one force evaluation at the guess, one an iteration, and one for good; or one more."""
    scene = program.scene(SMALL + SECTIONS["pressure"] + SECTIONS["growth"])
    assert program("run", scene, "--out", "out").status == 0
    found = summary(program.folder / "out")
    assert found["dt_h"]["min"] == found["dt_h"]["max"], "a step was cut: its evaluations are more"
    assert found["balance_iterations"] > 0
    least = found["balance_iterations"] + 2 * found["steps"]
    assert least <= found["force_evaluations"] <= least + found["steps"]


def test_memory_is_that_of_the_program(program: Program):
    """And not of whoever starts it."""
    much = b"x" * (600 * 2**20)
    assert program("run", program.scene(SMALL), "--out", "out").status == 0
    assert 1.0 < summary(program.folder / "out")["peak_memory_mb"] < len(much) / 2**21


def test_frames(full_run: Path):
    """run.h5 has every field, each with its unit and a row a cell; ids are unique and mothers are known."""
    with h5py.File(full_run / "run.h5") as file:
        assert len(file["frames"]) == 5
        seen: set[int] = set()
        for number, (name, group) in enumerate(sorted(file["frames"].items())):
            assert name == f"{number:06}"
            assert FIELDS.keys() <= group.keys()
            for field, dataset in group.items():
                if isinstance(dataset, h5py.Group):
                    continue  # a table beside the cells
                assert dataset.attrs["unit"] and dataset.attrs["meaning"]
                assert dataset.shape[0] == group.attrs["cells"]
                if field in FIELDS:
                    components, unit = FIELDS[field]
                    assert dataset.shape[1:] == (() if components == 1 else (components,)), field
                    assert dataset.attrs["unit"] == unit, field
                assert np.all(np.isfinite(dataset[()])), field
            ids = set(group["cell_id"][()].tolist())
            assert len(ids) == len(group["cell_id"])
            assert np.all(np.diff(group["cell_axes"][()][:, :2], axis=1) <= 0)
            # a cell that divides gives way to two daughters with numbers of their own; no number comes twice
            assert np.all(group["parent_id"][()] < group["cell_id"][()])
            assert not seen or min(ids - seen) > max(seen)
            seen |= ids


def test_closed_form(full_run: Path):
    """Every frame has the closed form of its length, each column with unit and meaning; numbers worked out by hand."""
    with h5py.File(full_run / "run.h5") as file:
        for row, frame in zip(history(full_run), file["frames"].values(), strict=True):
            table = frame["closed_form"]
            assert all(dataset.attrs["unit"] and dataset.attrs["meaning"] for dataset in table.values())
            exact = {name: dataset[()] for name, dataset in table.items()}
            assert all(np.all(np.isfinite(values)) and len(values) == table.attrs["count"] for values in exact.values())
            s = exact["distance_to_tip"]
            assert s[0] == 0.0 and np.isclose(s[-1], row["length_mm"]) and np.all(np.diff(s) > 0.0)
            # Eq. 6 with the numbers of the scene, Eq. 8, and the threshold
            z = (s - 0.05) / 0.15
            softening = 1.3e6 * (0.025 + 0.975 * z * np.exp(0.5 - 0.5 * z * z))
            assert np.allclose(exact["softening"], np.maximum(softening, 0.0), rtol=1e-12)
            modulus = 1020.0 + (12000.0 - 1020.0) * (0.2 + 0.8 / (1.0 + np.exp(-40.0 * (s - 0.05))))
            assert np.allclose(exact["radial_modulus"], modulus, rtol=1e-12)
            assert np.allclose(exact["axial_strain"], 0.94 / 1020.0) and np.all(exact["arrest_stress"] == 0.94)
            assert np.allclose(exact["radial_strain"], 1.0 / modulus - 0.06 / 1020.0, rtol=1e-9)
            assert np.allclose(exact["axial_strain_rate"], exact["softening"] / 1000.0 * 0.94 / 1020.0, rtol=1e-9)
            rate = exact["axial_strain_rate"]
            flow = np.concatenate([[0.0], np.cumsum(np.diff(s) * (rate[1:] + rate[:-1]) / 2.0)])
            assert np.allclose(exact["speed_from_tip"], flow, rtol=2e-3, atol=2e-5)
            assert np.allclose(exact["division_threshold"], 0.011 * (1.0 + 4.0 * s**2), rtol=1e-12)
            longest = exact["cell_length"] / np.log(2.0)
            assert np.all(longest <= exact["division_threshold"] * (1.0 + 1e-12)) and longest[0] == 0.011
            # what the flow carries stretches with it at most
            moving = exact["speed_from_tip"] > 0.0
            carried = longest[moving] / exact["speed_from_tip"][moving]
            assert np.all(np.diff(carried) <= 1e-12 * carried[1:])


def test_the_first_frame_is_real(full_run: Path):
    """Before the first window: neighbours, and the strain rate, modulus and softening of the start."""
    first, second = frames(full_run)[:2]
    assert np.array_equal(np.sort(first["cell_id"]), np.arange(len(first["cell_id"])))
    assert first["neighbours"].min() > 0 and history(full_run)[0]["min_neighbours"] == first["neighbours"].min()
    for field in ("axial_strain_rate", "radial_modulus", "softening"):
        largest = [np.abs(frame[field]).max() for frame in (first, second)]
        assert 0.7 < largest[0] / largest[1] < 1.4, field
    moving = first["clamped"] == 0
    # closed form: lambda/rho0 p (1 - nu_A)/E_A
    theory = first["softening"][moving] / 1000.0 * (1.0 - 0.06) / 1020.0
    assert np.sqrt(np.mean((first["axial_strain_rate"][moving] - theory) ** 2)) < 0.1 * theory.max()


def test_paraview_file(full_run: Path):
    """run.xmf names, for every frame, datasets that run.h5 has."""
    tree = ElementTree.parse(full_run / "run.xmf")
    times = [float(node.get("Value", "nan")) for node in tree.iter("Time")]
    assert np.allclose(times, np.linspace(0.0, 0.4, 5), atol=1e-12)
    with h5py.File(full_run / "run.h5") as file:
        references = [node.text.strip() for node in tree.iter("DataItem") if node.text and ":" in node.text]
        assert len(references) > 5 * len(FIELDS)
        for reference in references:
            name, path = reference.split(":", 1)
            assert name == "run.h5" and path in file


def test_scene_as_used_gives_the_same_run(program: Program, full_run: Path):
    """scene.toml is TOML with the version and every value that was used; it runs to the same result."""
    text = (full_run / "scene.toml").read_text()
    assert program("version").out.strip() in text
    scene = tomllib.loads(text)
    assert scene["numerics"]["step_h"] == 0.001 and scene["tissue"]["nu_axial"] == 0.06
    assert program("run", full_run / "scene.toml", "--out", "again").status == 0
    assert (program.folder / "again" / "scene.toml").read_text() == text
    same_results(program.folder / "again", full_run)


def test_an_automatic_step_is_kept(program: Program):
    """A scene without step_h writes the step that it used, and running that scene uses the same one."""
    assert program("run", program.scene(SMALL), "--out", "once").status == 0
    assert program("run", "once/scene.toml", "--out", "twice").status == 0
    same_results(program.folder / "once", program.folder / "twice")


def test_log(full_run: Path):
    """run.log has a line with date and time for what was said."""
    lines = (full_run / "run.log").read_text().splitlines()
    assert all(re.match(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d info ", line) for line in lines)
    assert "done: " in lines[-2]
    found = summary(full_run)
    assert re.search(r"inertia error \S+ % of p at the end, at most \S+ %; discretisation error about \S+ %", lines[-1])
    assert f"at most {100 * found['inertia_error_max']:.2g} %" in lines[-1]


def test_default_folder(program: Program):
    """Without --out a run goes to runs/<name of the scene>."""
    assert program("run", program.scene(SMALL)).status == 0
    assert summary(program.folder / "runs" / "small")["status"] == "done"


def test_chosen_fields(program: Program):
    """output.fields: those, and what every frame needs."""
    assert program("run", program.scene(SMALL + 'fields = ["stress"]\n'), "--out", "out").status == 0
    for frame in frames(program.folder / "out"):
        exact = {name for name in frame if name.startswith("closed_form/")}
        assert frame.keys() - {"time_h", "step", "cells"} == {"position", "cell_id", "stress"} | exact


def test_export(program: Program, full_run: Path):
    """A row a cell, columns named as the fields; the numbers are those of run.h5, to the last bit."""
    suffixes = {1: [""], 3: ["_x", "_y", "_z"], 6: ["_xx", "_yy", "_zz", "_xy", "_yz", "_xz"]}
    for when, index in (("last", 4), ("0", 0), ("0.2", 2), ("0.31", 3)):
        assert program("export", full_run, "--time", when, "--csv", "cells.csv").status == 0
        with (program.folder / "cells.csv").open() as file:
            header, *rows = csv.reader(file)
        frame = frames(full_run)[index]
        fields = {name: values for name, values in frame.items() if values.ndim > 0 and "/" not in name}
        columns = [
            name + suffix
            for name, values in fields.items()
            for suffix in suffixes[values.shape[1] if values.ndim > 1 else 1]
        ]
        assert sorted(header) == sorted(columns)
        table = np.array(rows, dtype=float)
        for name, values in fields.items():
            wide = values.reshape(len(values), -1)
            names = [name + suffix for suffix in suffixes[wide.shape[1]]]
            assert np.array_equal(table[:, [header.index(column) for column in names]], wide), name


def test_export_of_an_unfinished_run(program: Program):
    """A run that is paused can be exported."""
    assert program("run", program.scene(FULL), "--out", "out", "--until", 0.12).status == 0
    done = program("export", "out", "--csv", "cells.csv")
    assert done.status == 0 and "at 0.121 h" in done.out  # the end of a window of 7 steps


def test_effects(program: Program):
    """Every effect, for people and for programs."""
    listed = program("effects", "--json").json()
    names = [effect["name"] for effect in listed]
    assert {
        "pressure", "anisotropy", "growth", "response", "division", "clamped base", "pair resistance", "obstacle",
        "probe",
    } <= set(names)  # fmt: skip
    text = program("effects").out
    for effect in listed:
        assert effect["what"] and effect["name"] in text and effect["section"] in text


def test_describe(program: Program):
    """Every section explains its keys; a single one can be asked for."""
    text = program("describe").out
    sections = re.findall(r"^\[+([a-z_.]+)\]+", text, re.M)
    assert {"scene", "root", "tissue", "growth", "output"} <= set(sections)
    for section in sections:
        done = program("describe", section)
        assert done.status == 0 and done.out.splitlines()[0] in text


def test_version(program: Program):
    """`version` and `--version` are the same line: the version, and the commit where git knows it."""
    said = program("version")
    assert re.fullmatch(r"rootsoil \d+\.\d+\.\d+(\+[0-9a-f]{10}(-dirty-[0-9a-f]{8})?)?\n", said.out)
    assert program("--version") == said


@pytest.mark.parametrize("file, holds", [("history.csv", "rows"), ("run.h5", "frames"), ("probe_tip.csv", "rows")])
def test_resume_says_what_is_gone(program: Program, file: str, holds: str):
    """A run goes on where one of its files has gone, and says which, on the screen and in run.log."""
    scene = program.scene(FULL + '[[probe]]\nname = "tip"\ndistance_to_tip_mm = [0.0, 0.05]\n')
    assert program("run", scene, "--out", "out", "--until", 0.2).status == 0
    out = program.folder / "out"
    (out / file).unlink()
    done = program("run", scene, "--out", "out", "--resume")
    assert done.status == 0, done.err
    message = f"{file} is gone from out: its {holds} until 0.2 h will be missing"
    assert done.err.count("is gone from") == 1 and f"warning: {message}\n" in done.err
    assert f"warning {message}\n" in (out / "run.log").read_text()
    rows = {"run.h5": frames(out), "history.csv": history(out), "probe_tip.csv": history(out, "probe_tip.csv")}
    assert {name: len(found) for name, found in rows.items()} == {name: 2 if name == file else 5 for name in rows}


def test_a_bin_that_the_root_reaches_later(program: Program):
    """As long as no cell is in a probe's bin, its row has no numbers but that of no cells."""
    text = SMALL + SECTIONS["pressure"] + SECTIONS["growth"] + "[[probe]]\ndistance_to_tip_mm = [0.126, 1]\n"
    done = program("run", program.scene(text.replace("duration_h = 0.2", "duration_h = 1")), "--out", "out")
    assert done.status == 0, done.err
    lines = (program.folder / "out" / "probe_probe_1.csv").read_text().splitlines()
    assert lines[1] == "0,0,0,,,,,,,,,"
    last = history(program.folder / "out", "probe_probe_1.csv")[-1]
    assert last["cells"] > 0 and np.all(np.isfinite(list(last.values())))


def test_interrupted_before_it_begins(program: Program):
    """Ctrl-C while the cells are made: exit status 130, and no run."""
    scene = program.scene(SMALL.replace("cell_size_mm = 0.01", "cell_size_mm = 5e-5"))  # a second or more
    running = program.start("run", scene, "--out", "out")
    time.sleep(0.5)
    running.send_signal(signal.SIGINT)
    assert running.wait(TIMEOUT_S) == 130
    assert not (program.folder / "out").exists()
