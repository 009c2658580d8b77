# SPDX-License-Identifier: MIT
"""tools/accuracy_cost.py: its table and diagrams, what the presets state, and no error worse than it was."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

from rootsoil_tools import problems, theory, work_precision
from rootsoil_tools.accuracy_table import Row, read_rows, with_errors, write_rows

TOLERANCE = 0.1  # of what a preset states against the table


@pytest.fixture(scope="module")
def programs(project: Path) -> Path:
    """The folder of the programs."""
    return Path(os.environ.get("ROOTSOIL_PROGRAM", project / "build" / "release" / "rootsoil")).absolute().parent


def row(problem: str, choice: str, across: int, values: str, measure: str, cpu_s: float = 1.0) -> Row:
    nan = math.nan
    return Row(
        key=f"{problem} {choice} {across}",
        problem=problem,
        choice=choice,
        across=across,
        level=nan,
        measure=measure,
        status="done",
        error=nan,
        inertia_error=nan,
        cpu_s=cpu_s,
        wall_s=nan,
        cells=across**2,
        steps=100.0,
        cell_steps=100.0 * across**2,
        hours=nan,
        program="test",
        values=values,
        remark="",
    )


def test_errors_are_those_against_the_closed_form_or_the_finest_run(tmp_path: Path):
    rows = [
        row("growth", "default", 6, "0.03", "axial rate"),
        row("path", "default", 6, "1 2 3 4 5 6", "path"),
        row("path", "default", 12, "1 2 3 4 5 7", "path"),
        row("soil", "finest", 6, "2", "tip force"),
        row("soil", "default", 6, "3", "tip force"),
    ]
    found = with_errors(rows, problems.all_problems())
    assert [r.error for r in found[:2]] == pytest.approx([0.03, math.sqrt(1.0 / 6.0)])
    assert math.isnan(found[2].error) and math.isnan(found[3].error)
    assert found[4].error == pytest.approx(0.5)
    write_rows(found, tmp_path / "t.csv")
    again = read_rows(tmp_path / "t.csv")
    assert [r.key for r in again] == [r.key for r in found]
    assert [r.error for r in again[:2]] == pytest.approx([r.error for r in found[:2]], rel=1e-5)


def test_pareto_front():
    points = [work_precision.Point("a", cost, error) for cost, error in ((1, 3), (2, 4), (3, 1), (3, 2), (5, 0.5))]
    assert [(p.cost, p.error) for p in work_precision.pareto_front(points)] == [(1, 3), (3, 1), (5, 0.5)]


def test_cells_that_are_carried_stretched_and_divided():
    """Under a uniform rate e, v = e s: a cell at s is at s exp(e t), its length exp(e t) times as long; two halves then."""
    scene = tomllib.loads(problems.GROWTH.format(hours=1.0, size=0.01))
    scene["growth"]["c_g"] = 1.0
    model = theory.model_of(scene)
    rate = float(model.axial_rate(0.5))
    hours = 0.5 * math.log(2.0) / rate
    s, length = problems.divided_lengths(model, lambda s: np.full_like(s, 0.011), np.array([0.2]), np.array([0.01]), hours)
    whole = 0.01 * math.exp(rate * hours)
    assert length == pytest.approx([whole / 2.0] * 2, rel=1e-3)
    assert float(np.mean(s)) == pytest.approx(0.2 * math.exp(rate * hours), rel=1e-3)
    assert float(s[1] - s[0]) == pytest.approx(whole / 2.0, rel=2e-2)


def test_two_hertzian_contacts_carry_the_same_force():
    force = problems.two_contacts_N(0.01, (5.0, 8.0))
    assert (force / 5.0) ** (2.0 / 3.0) + (force / 8.0) ** (2.0 / 3.0) == pytest.approx(0.01)
    assert problems.two_contacts_N(-0.01, (5.0, 8.0)) == 0.0


@pytest.mark.parametrize("accuracy", ["fast", "balanced", "reference"])
def test_presets_state_what_was_measured(project: Path, programs: Path, tmp_path: Path, accuracy: str):
    """`check` gives for a preset the numbers of docs/accuracy_cost.csv."""
    scene = tmp_path / "scene.toml"
    scene.write_text(problems.growth_scene(1.0, 6))
    command = [programs / "rootsoil", "check", scene, "--json", "--accuracy", accuracy]
    stated = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    rows = read_rows(project / "docs" / "accuracy_cost.csv")
    found = work_precision.find(rows, f"preset {accuracy}", "division", "axial rate", 8)
    assert found is not None and found.status == "done"
    assert stated["discretisation_error"] == pytest.approx(found.error, rel=TOLERANCE)
    assert stated["preset_inertia_error"] == pytest.approx(found.inertia_error, rel=TOLERANCE)
    assert stated["preset_ms_per_cell_hour"] == pytest.approx(work_precision.time_per_cell_hour_ms(found), rel=TOLERANCE)


def test_the_page_is_the_table(project: Path):
    """docs/accuracy_cost.md is what tools/accuracy_cost.py makes of docs/accuracy_cost.csv."""
    known = problems.all_problems()
    rows = with_errors(read_rows(project / "docs" / "accuracy_cost.csv"), known)
    assert len({r.key for r in rows}) > 200
    assert (project / "docs" / "accuracy_cost.md").read_text() == work_precision.page(rows, known)


def test_a_row_is_not_run_again(project: Path, programs: Path, tmp_path: Path):
    command = [sys.executable, project / "tools" / "accuracy_cost.py", "--quick", "--out", tmp_path, "--only", "thrust"]
    command += ["--programs", programs]
    first = subprocess.run(command, capture_output=True, text=True)
    assert first.returncode == 0, first.stderr
    assert "thrust, default, 6 across: done" in first.stdout and "thrust, paper's scheme, 6 across: refused" in first.stdout
    table = (tmp_path / "accuracy_cost.csv").read_text()
    again = subprocess.run(command, capture_output=True, text=True)
    assert again.returncode == 0 and again.stdout == ""
    assert (tmp_path / "accuracy_cost.csv").read_text() == table
    assert (tmp_path / "accuracy_bending_contact.png").read_bytes().startswith(b"\x89PNG")


def exceeded(rows: list[Row], recorded: dict) -> list[str]:
    """What is worse than recorded, or has another status, or is missing."""
    problems_found, seen = [], {}
    for r in rows:
        seen[f"{r.problem}, {r.choice}, {r.across} across, {r.measure}"] = r
    for name, bound in recorded["errors"].items():
        r = seen.get(name)
        if r is None:
            problems_found.append(f"{name}: not run")
        elif isinstance(bound, str):
            if r.status != bound:
                problems_found.append(f"{name}: {r.status}, was {bound}")
        elif r.status != "done":
            problems_found.append(f"{name}: {r.status} ({r.remark})")
        elif not r.error <= max(recorded["factor"] * bound, recorded["floor_of"].get(r.measure, recorded["floor"])):
            problems_found.append(f"{name}: {r.error:.3g}, was {bound:.3g}")
    return problems_found


@pytest.mark.slow
def test_no_error_is_worse_than_it_was(project: Path, programs: Path, tmp_path: Path):
    """The quick study against tools/accuracy_bounds.toml; a bound that is tightened is seen."""
    command = [sys.executable, project / "tools" / "accuracy_cost.py", "--quick", "--out", tmp_path, "--programs", programs]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    recorded = tomllib.loads((project / "tools" / "accuracy_bounds.toml").read_text())
    rows = read_rows(tmp_path / "accuracy_cost.csv")
    assert len(recorded["errors"]) > 30
    assert exceeded(rows, recorded) == []
    name = "cantilever, default, 6 across, stiffness"
    tightened = {**recorded, "errors": {**recorded["errors"], name: recorded["errors"][name] / 2.0}}
    assert [text.split(":")[0] for text in exceeded(rows, tightened)] == [name]
