# SPDX-License-Identifier: MIT
"""tools/accuracy_cost.py: its table and diagrams, what the presets state, and no error worse than it was."""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import accuracy_cost
from rootsoil_tools import accuracy_page, answers, problems, scenes, theory, work_precision
from rootsoil_tools.accuracy_grid import full_grid, place_of_task
from rootsoil_tools.accuracy_table import Row, read_rows, with_errors, write_rows

# Of what `check` states against the table. One order in the cells across, the explicit stepper's, stands for both.
TOLERANCE = {"default": 0.1, "explicit": 0.1}


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
        unbalanced=nan,
        cpu_s=cpu_s,
        start_s=0.0,
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
        row("path", "finest", 16, "1 2 3 4 5 7", "path"),
        row("soil", "finest", 6, "2", "tip force"),
        row("soil", "default", 6, "3", "tip force"),
        row("soil", "interval", 6, "3 3", "tip force"),  # an older program's
    ]
    found = with_errors(rows, problems.all_problems())
    assert [r.error for r in found[:2]] == pytest.approx([0.03, math.sqrt(1.0 / 6.0)])
    assert math.isnan(found[2].error) and math.isnan(found[3].error)
    assert found[4].error == pytest.approx(0.5) and math.isnan(found[5].error)
    write_rows(found, tmp_path / "t.csv")
    again = read_rows(tmp_path / "t.csv")
    assert [r.key for r in again] == [r.key for r in found]
    assert [r.error for r in again[:2]] == pytest.approx([r.error for r in found[:2]], rel=1e-5)


def test_pareto_front():
    points = [work_precision.Point("a", cost, error) for cost, error in ((1, 3), (2, 4), (3, 1), (3, 2), (5, 0.5))]
    assert [(p.cost, p.error) for p in work_precision.pareto_front(points)] == [(1, 3), (3, 1), (5, 0.5)]


def test_cells_that_are_carried_stretched_and_divided():
    """Under a uniform rate e, v = e s: a cell at s is at s exp(e t), exp(e t) times as long; two halves then."""
    rate, at = 0.4, np.array([0.0, 2.0])
    columns = {
        "axial_strain_rate": np.full(2, rate),
        "speed_from_tip": rate * at,
        "division_threshold": np.full(2, 0.011),
    }
    model = theory.ClosedForm({"distance_to_tip": at, **columns})
    hours = 0.5 * math.log(2.0) / rate
    s, length = answers.divided_lengths(model, np.array([0.2]), np.array([0.01]), hours)
    whole = 0.01 * math.exp(rate * hours)
    assert length == pytest.approx([whole / 2.0] * 2, rel=1e-3)
    assert float(np.mean(s)) == pytest.approx(0.2 * math.exp(rate * hours), rel=1e-3)
    assert float(s[1] - s[0]) == pytest.approx(whole / 2.0, rel=2e-2)


def test_two_hertzian_contacts_carry_the_same_force():
    force = answers.two_contacts_N(np.array([-0.01, 0.01]), (5.0, 8.0))
    assert force[0] == 0.0
    assert (force[1] / 5.0) ** (2.0 / 3.0) + (force[1] / 8.0) ** (2.0 / 3.0) == pytest.approx(0.01)


def test_hertz_stiffness():
    """Two balls of 2 mm, E = 91 MPa, nu = 0.3: E* = 50 MPa, R = 1 mm."""
    assert answers.hertz_stiffness(91.0, 0.3, 2.0, 2.0) == pytest.approx(4.0 / 3.0 * 50.0)


def test_forces_are_averaged_over_the_way_however_often_they_are_read():
    """A grain that rings shows in every reading, not in the mean over a stretch."""
    scene = problems.HERTZ
    section = scene["penetrometer"]["diameter_mm"] * scene["soil"]["d_mean_mm"]
    for readings in (3, 12):
        edges = np.linspace(0.804, 0.816, readings + 1)
        fine = np.linspace(edges[:-1], edges[1:], 401)
        force = answers.two_contacts_N(fine - 0.8, (5.0, 8.0)).mean(axis=0) * 1.01
        ringing = 0.3 * force * (-1.0) ** np.arange(readings) if readings == 12 else 0.0
        columns = {"depth_mm": (edges[1:] + edges[:-1]) / 2.0, "Q_MPa": (force + ringing) / section}
        found = answers.hertz_errors(scene, columns, (5.0, 8.0), 0.8, problems.HERTZ_STRETCHES_MM)
        assert found == pytest.approx([0.01] * 3, abs=0.05)


def test_the_base_lies_on_the_curve_of_a_number():
    """That of each number of cells; the time is without starting the program."""

    def at(choice: str, across: int, level: float, cpu_s: float) -> Row:
        own = row("growth", choice, across, "0.01", "axial rate", cpu_s)
        return replace(own, error=0.01, level=level, start_s=0.5)

    nan = math.nan
    rows = [at("eta", 8, 1.2, 1.0), at("default", 8, nan, 2.0), at("eta", 8, 2.0, 3.0)]
    rows += [at("explicit", 8, nan, 5.0), at("explicit, step", 8, 4.0, 4.0), at("explicit, step", 6, 4.0, 3.0)]
    points = work_precision.points_of(rows, "growth", "axial rate")

    def curves(name: str) -> list[list[tuple[float, float]]]:
        found = work_precision.curves_of([p for p in points if p.choice == name])
        return [[(p.level, p.cost) for p in curve] for curve in found]

    assert curves("eta") == [[(1.2, 0.5), (1.5, 1.5), (2.0, 2.5)]]
    assert curves("explicit, step") == [[(4.0, 2.5)], [(1.0, 4.5), (4.0, 3.5)]]


@pytest.mark.parametrize("name", ["thrust", "soil"])
def test_what_moves_masses_gets_the_step_that_it_needs(programs: Path, tmp_path: Path, name: str):
    """And the default, whose steps end in balance, the program's own; a step's factor multiplies either."""
    problem = next(p for p in problems.all_problems() if p.name == name)

    def numerics(choice: problems.Choice) -> dict:
        problem.prepare(programs, tmp_path, 6, choice)
        written = sorted(tmp_path.glob("*.toml"))[0]
        return tomllib.loads(written.read_text()).get("numerics", {})

    moving = {"numerics.stepper": "symplectic"}
    own = numerics(problems.Choice("explicit", moving))
    assert own["step_h"] == problem_step_h(name) and own["stepper"] == "symplectic"
    assert ("mass_damping_per_h" in own) == (name == "thrust")
    assert not {"step_h", "stepper", "mass_damping_per_h"} & numerics(problems.Choice("default")).keys()
    assert numerics(problems.Choice("step", moving, 4.0, 4.0))["step_h"] == pytest.approx(4.0 * own["step_h"])
    assert numerics(problems.Choice("step", {}, 0.5, 0.5))["step_h"] > 10.0 * own["step_h"]


def problem_step_h(name: str) -> float:
    """Of 6 cells across."""
    return float({"thrust": 1.6e-4, "soil": 6e-4}[name] / 6)


def test_every_run_of_the_grid_has_its_place():
    grid = full_grid(problems.all_problems())
    assert len({place_of_task(task) for task in grid}) == len(grid)
    assert {task.choice.name for task in grid} == set(work_precision.STYLES)


def test_runs_that_are_missing_are_counted():
    known = problems.all_problems()
    rows = [row("growth", "default", 6, "0.01", "axial rate"), row("growth", "default", 5, "0.01", "axial rate")]
    told = accuracy_page.what_was_run([replace(rows[0], status="refused"), rows[1]], known)
    assert told == f"Of the grid's {len(full_grid(known))} runs: 1 refused; {len(full_grid(known)) - 1} not made yet."


def test_two_that_write_at_once_lose_nothing(tmp_path: Path):
    table = tmp_path / "t.csv"
    rows = [row("growth", "default", across, "0.01", "axial rate") for across in range(40)]
    code = (
        "import sys; from pathlib import Path; import accuracy_cost as a\n"
        "from rootsoil_tools.accuracy_table import read_rows\n"
        "given, table = map(Path, sys.argv[1:])\n"
        "for row in read_rows(given): a.merge([row], table, a.all_problems())\n"
    )
    started = []
    for part in (0, 1):
        write_rows(rows[part::2], tmp_path / f"{part}.csv")
        command = [sys.executable, "-c", code, tmp_path / f"{part}.csv", table]
        started.append(
            subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(Path(accuracy_cost.__file__).parent)})
        )
    assert [process.wait(timeout=60) for process in started] == [0, 0]
    assert sorted(r.across for r in read_rows(table)) == list(range(40))


def test_rows_that_the_grid_no_longer_has_are_dropped_and_that_is_said(tmp_path: Path, capsys: pytest.CaptureFixture):
    table = tmp_path / "t.csv"
    write_rows([row("growth", name, 8, "0.01", "axial rate") for name in ("default", "eta 3")], table)
    for said in ("dropped 1 rows of runs that are no longer in the grid\n", ""):
        accuracy_cost.drop_strays(table, full_grid(problems.all_problems()))
        assert [r.choice for r in read_rows(table)] == ["default"]
        assert capsys.readouterr().out == said


def test_a_part_is_a_part():
    assert accuracy_cost.part_of("2/3") == (2, 3)
    for text in ("0/2", "3/2", "2", "a/b"):
        with pytest.raises(argparse.ArgumentTypeError, match="is no part"):
            accuracy_cost.part_of(text)


def checked(programs: Path, folder: Path, across: int, *options: str) -> dict:
    """What `check` says of a root that grows."""
    scene = folder / "scene.toml"
    scene.write_text(scenes.scene_text(problems.growth_scene(1.0, across)))
    command = [programs / "rootsoil", "check", scene, "--json", *options]
    found: dict = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return found


MOVING = ("--set", "numerics.stepper=symplectic")


def measured(project: Path, choice: str, across: int = 8) -> Row:
    """The row of docs/accuracy_cost.csv that `check` cites."""
    rows = read_rows(project / "docs" / "accuracy_cost.csv")
    found = accuracy_page.find(rows, choice, "division", "axial rate", across)
    assert found is not None and found.status == "done"
    return found


EXPLICIT = {"fast": "explicit, preset fast", "balanced": "explicit", "reference": "explicit, preset reference"}


@pytest.mark.parametrize("accuracy", ["fast", "balanced", "reference"])
def test_presets_state_what_was_measured(project: Path, programs: Path, tmp_path: Path, accuracy: str):
    """`check` gives for a preset the errors of docs/accuracy_cost.csv, in balance and with inertia."""
    stated = checked(programs, tmp_path, 8, "--accuracy", accuracy)
    found = measured(project, f"preset {accuracy}")
    assert stated["discretisation_error"] == pytest.approx(found.error, rel=TOLERANCE["default"])
    stated = checked(programs, tmp_path, 8, "--accuracy", accuracy, *MOVING)
    found = measured(project, EXPLICIT[accuracy])
    assert stated["discretisation_error"] == pytest.approx(found.error, rel=TOLERANCE["explicit"])


@pytest.mark.parametrize("accuracy", ["fast", "balanced", "reference"])
def test_presets_state_the_inertia_that_was_measured(project: Path, programs: Path, tmp_path: Path, accuracy: str):
    """`check` gives for a preset of the explicit stepper the inertia error of docs/accuracy_cost.csv."""
    stated = checked(programs, tmp_path, 8, "--accuracy", accuracy, *MOVING)
    found = measured(project, EXPLICIT[accuracy])
    assert stated["preset_inertia_error"] == pytest.approx(found.unbalanced, rel=TOLERANCE["explicit"])


@pytest.mark.parametrize("across", [4, 6, 8, 12])
@pytest.mark.parametrize("choice", ["default", "explicit"])
def test_the_stated_error_follows_the_cells_across(
    project: Path, programs: Path, tmp_path: Path, across: int, choice: str
):
    """`check` gives the discretisation error that was measured with so many cells across."""
    stated = checked(programs, tmp_path, across, *(MOVING if choice == "explicit" else ()))
    assert stated["cells_across"] == across
    found = measured(project, choice, across)
    assert stated["discretisation_error"] == pytest.approx(found.error, rel=TOLERANCE[choice])


def test_the_page_is_the_table(project: Path):
    """docs/accuracy_cost.md is what tools/accuracy_cost.py makes of docs/accuracy_cost.csv."""
    known = problems.all_problems()
    rows = with_errors(read_rows(project / "docs" / "accuracy_cost.csv"), known)
    assert len({r.key for r in rows}) > 200
    assert (project / "docs" / "accuracy_cost.md").read_text() == accuracy_page.page(rows, known)


def test_a_row_is_not_run_again(project: Path, programs: Path, tmp_path: Path):
    command = [sys.executable, project / "tools" / "accuracy_cost.py", "--quick", "--out", tmp_path, "--only", "thrust"]
    command += ["--programs", programs]
    first = subprocess.run(command, capture_output=True, text=True)
    assert first.returncode == 0, first.stderr
    assert (
        "thrust, default, 6 across: done" in first.stdout
        and "thrust, paper's scheme, 6 across: refused" in first.stdout
    )
    table = (tmp_path / "accuracy_cost.csv").read_text()
    again = subprocess.run(command, capture_output=True, text=True)
    assert again.returncode == 0 and again.stdout == ""
    assert (tmp_path / "accuracy_cost.csv").read_text() == table
    assert (tmp_path / "accuracy_bending_contact.png").read_bytes().startswith(b"\x89PNG")


def floor(r: Row, recorded: dict) -> float:
    """What no error of this measure and choice has to keep below."""
    return max(recorded["floor_of"].get(name, recorded["floor"]) for name in (r.measure, r.choice))


def exceeded(rows: list[Row], recorded: dict) -> list[str]:
    """What is worse than recorded, or has another status, or is missing."""
    problems_found, seen = [], {accuracy_cost.measure_id(r): r for r in rows}
    for name, bound in recorded["errors"].items():
        r = seen.get(name)
        if r is None:
            problems_found.append(f"{name}: not run")
        elif isinstance(bound, str):
            if r.status != bound:
                problems_found.append(f"{name}: {r.status}, was {bound}")
        elif r.status != "done":
            problems_found.append(f"{name}: {r.status} ({r.remark})")
        elif not r.error <= max(recorded["factor"] * bound, floor(r, recorded)):
            problems_found.append(f"{name}: {r.error:.3g}, was {bound:.3g}")
    return problems_found


@pytest.mark.slow
def test_no_error_is_worse_than_it_was(project: Path, programs: Path, tmp_path: Path):
    """The quick study against tools/accuracy_bounds.toml; a bound that is tightened is seen."""
    command = [
        sys.executable,
        project / "tools" / "accuracy_cost.py",
        "--quick",
        "--out",
        tmp_path,
        "--programs",
        programs,
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    recorded = tomllib.loads((project / "tools" / "accuracy_bounds.toml").read_text())
    rows = read_rows(tmp_path / "accuracy_cost.csv")
    assert len(recorded["errors"]) > 30
    assert exceeded(rows, recorded) == []
    name = "cantilever, default, 6 across, stiffness"
    tightened = {**recorded, "errors": {**recorded["errors"], name: recorded["errors"][name] / 2.0}}
    assert [text.split(":")[0] for text in exceeded(rows, tightened)] == [name]
