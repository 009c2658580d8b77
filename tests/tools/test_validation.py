# SPDX-License-Identifier: MIT
"""Published numbers beside ours: verdicts, that no row is left out, and that ours are measured."""

from __future__ import annotations

import csv
import math
import os
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from rootsoil_tools import published, validation_page
from rootsoil_tools import validation_rows as rows
from rootsoil_tools.runs import Run
from rootsoil_tools.validation_cases import Number, mean_number, read_numbers, write_numbers

PEA = ("maximum axial growth pressure", "pea")  # .35 to .66 MPa


def number(value: float) -> Number:
    return Number("key", value, value, value, "scene", 1.0)


@pytest.mark.parametrize(
    "value, origin, expected",
    [
        (0.5, rows.PREDICTED, rows.AGREES),
        (0.72, rows.PREDICTED, rows.AGREES),  # 9 % above the range
        (0.73, rows.PREDICTED, rows.DISAGREES),
        (0.32, rows.PREDICTED, rows.AGREES),
        (0.31, rows.PREDICTED, rows.DISAGREES),
        (0.5, rows.CALIBRATED, rows.FITTED),  # never "agrees"
        (0.5, rows.INPUT, rows.FITTED),
        (0.9, rows.CALIBRATED, rows.DISAGREES),  # a fit that does not fit is said
        (math.nan, rows.PREDICTED, rows.NOT_MEASURED),
    ],
)
def test_verdict_of_a_number(value: float, origin: str, expected: str):
    assert rows.verdict(rows.Row("group", "quantity", "key", PEA, origin), number(value)) == expected


def test_verdicts_of_curves_and_errors_and_of_what_cannot_be_compared():
    curve = rows.Row("group", "quantity", "key", PEA, rows.CALIBRATED, "R^2")
    assert [rows.verdict(curve, number(v)) for v in (0.9, 0.89)] == [rows.FITTED, rows.DISAGREES]
    error = rows.Row("group", "quantity", "key", None, rows.EXACT, "error")
    assert [rows.verdict(error, number(v)) for v in (0.1, -0.1, 0.11)] == [rows.THEORY, rows.THEORY, rows.DISAGREES]
    assert rows.verdict(replace(curve, apart="for a reason"), number(1.0)) == rows.NOT_COMPARABLE
    assert rows.verdict(rows.Row("group", "quantity", "key"), number(1.0)) == rows.NO_NUMBER
    assert rows.verdict(curve, None) == rows.NOT_MEASURED


def test_distance_from_a_range():
    known = published.Reference(2.0, 4.0, "1", "here")
    assert [rows.outside(v, known) for v in (1.0, 2.0, 3.0, 5.0)] == pytest.approx([-0.5, 0.0, 0.0, 0.25])


def test_numbers_survive_their_file(tmp_path: Path):
    numbers = [mean_number("a, b", [1.0, 3.0], "scene", 2.0), mean_number("c", [math.nan], "scene", 1.0, "there")]
    write_numbers(numbers, tmp_path / "numbers.csv")
    first, second = read_numbers(tmp_path / "numbers.csv").values()
    assert first == numbers[0] and (first.value, first.low, first.high) == (2.0, 1.0, 3.0)
    assert math.isnan(second.value) and second.recorded == "there"


def test_every_published_number_has_a_row():
    """Nothing that is published is left out of the page because it does not suit."""
    named = {row.source for row in rows.all_rows()}
    for table in ("reference_values", "paper_values"):
        for known in published.table(table):
            assert (known["quantity"], known["species"]) in named, known
            assert known["source"] and float(known["low"]) <= float(known["high"])


def test_every_number_of_ours_has_a_row_and_every_row_its_number(project: Path):
    numbers = read_numbers(project / "docs" / "validation.csv")
    keys = {row.key for row in rows.all_rows() if row.key}
    assert set(numbers) == keys
    assert all(math.isfinite(found.value) for found in numbers.values())
    assert not [row.quantity for row, _, judged in rows.verdicts(numbers) if judged == rows.NOT_MEASURED]


def test_the_page_is_what_its_numbers_draw(project: Path):
    numbers = read_numbers(project / "docs" / "validation.csv")
    page = validation_page.page(numbers)
    assert (project / "docs" / "validation.md").read_text(encoding="utf-8") == page
    verdicts = [judged for _, _, judged in rows.verdicts(numbers)]
    assert f"**{len(verdicts)} rows: " in page and f"disagrees {verdicts.count(rows.DISAGREES)}, " in page
    assert page.count("| **disagrees** |") == verdicts.count(rows.DISAGREES) > 0
    other = numbers | {"pea peak rate": replace(numbers["pea peak rate"], value=0.3)}
    assert validation_page.page(other) != page


def validation(project: Path, *options: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([project / "tools" / "validation.py", *options], capture_output=True, text=True)


def test_a_page_without_numbers_is_not_drawn(project: Path, tmp_path: Path):
    done = validation(project, "--quick", "--draw-only", "--out", tmp_path)
    assert done.returncode == 1 and "validation.csv" in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def measured(project: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a quick run of everything."""
    out = tmp_path_factory.mktemp("validation")
    programs = Path(os.environ.get("ROOTSOIL_PROGRAM", project / "build" / "release" / "rootsoil")).absolute().parent
    done = validation(project, "--quick", "--out", out, "--programs", programs)
    assert done.returncode == 0, done.stderr
    return out


@pytest.mark.slow
def test_quick_measures_all_cases(measured: Path):
    numbers = read_numbers(measured / "validation.csv")
    recorded = [key for key, found in numbers.items() if found.recorded]
    assert 6 <= len(recorded) <= 8, "what is recorded is said to be"
    assert numbers["radial strain error, balanced"].value == pytest.approx(0.0037, rel=0.5)
    assert numbers["axial_strain_rate R^2"].value > 0.98  # .991
    assert numbers["pea threshold over length"].value == pytest.approx(1.0 / math.log(2.0), rel=0.01)  # .002
    # by hand from what the runs wrote
    history = Run(measured / "wall_no_yield" / "run").history()
    stress = history["contact_force_N"][-1] / (math.pi * 0.25)
    assert numbers["growth pressure, no yield"].value == pytest.approx(stress, rel=1e-5)
    text = (measured / "validation.md").read_text(encoding="utf-8")
    assert all(f"| {row.quantity} |" in text for row in rows.all_rows())
    assert (measured / "images" / "validation.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_what_a_run_came_to_is_what_is_told(project: Path, measured: Path, tmp_path: Path):
    """With a run that pushed twice as hard, the number is another: none is written down in the tool."""
    out = tmp_path / "changed"
    shutil.copytree(measured, out)
    file = out / "wall_uniform_yield" / "run" / "history.csv"
    with file.open(newline="", encoding="utf-8") as text:
        history = list(csv.DictReader(text))
    history[-1]["contact_force_N"] = str(2.0 * float(history[-1]["contact_force_N"]))
    with file.open("w", newline="", encoding="utf-8") as text:
        writer = csv.DictWriter(text, list(history[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(history)
    programs = Path(os.environ.get("ROOTSOIL_PROGRAM", project / "build" / "release" / "rootsoil")).absolute().parent
    done = validation(project, "--quick", "--only", "thrust", "--out", out, "--programs", programs)
    assert done.returncode == 0, done.stderr
    before, after = (read_numbers(folder / "validation.csv") for folder in (measured, out))
    key = "growth pressure, uniform yield"
    assert after[key].value == pytest.approx(2.0 * before[key].value, rel=1e-5)
    changed = {key for key in before if not (before[key].value == after[key].value or math.isnan(before[key].value))}
    assert changed == {key, "growth pressure error, uniform yield"}
    row = next(row for row in rows.all_rows() if row.key == key)
    assert rows.verdict(row, before[key]) == rows.FITTED and rows.verdict(row, after[key]) == rows.DISAGREES
