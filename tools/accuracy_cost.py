#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What accuracy costs: small problems with known answers, computed in many ways, error against time.

Writes OUT/accuracy_cost.csv, a row for each run and measure, after every run; rows that are there are not run again.
A row's key is made of the command, the scene and the programs. Without --quick and --out the pictures and
docs/accuracy_cost.md are made anew from it. The cost of a run is the processor time that it and its children used:
a clock on the wall depends on what else the machine does.
"""

from __future__ import annotations

import argparse
import hashlib
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from rootsoil_tools import measure, problems, runs, theory, work_precision
from rootsoil_tools.accuracy_table import DEFAULT_NAME, FINEST_NAME, Row, read_rows, with_errors, write_rows
from rootsoil_tools.problems import Choice, Problem, all_problems
from rootsoil_tools.runs import RunError

PROJECT = Path(__file__).resolve().parent.parent
CPU_LIMIT_S = 60  # of one run
BOUNDS = PROJECT / "tools" / "accuracy_bounds.toml"
BOUND_FACTOR = 1.5
BOUND_FLOOR = 3e-4  # below it errors are rounding and settling, which another compiler changes
BOUND_FLOOR_OF = {"cell length": 0.06}  # one layer of cells that divides a moment earlier
STATUS_OF_EXIT = {2: "refused", 3: "unphysical", 4: "soil failed", -24: "too long"}  # 24: SIGXCPU

PAPER = Choice(
    "paper's scheme",
    {
        "numerics.kernel": "isotropic",
        "numerics.H_bar": 2.0,
        "numerics.gradient": "linear",
        "numerics.stepper": "predictor_corrector",
        "numerics.inertia": "scalar",
        "numerics.inertia_compensation": False,
        "tissue.law": "pressure_deviator",
    },
    non_affine=False,
)
DEFAULT = Choice(DEFAULT_NAME)
METHODS = [
    Choice("isotropic kernel, H_bar 2", {"numerics.kernel": "isotropic", "numerics.H_bar": 2.0}),
    Choice("isotropic kernel, H_bar 4.5", {"numerics.kernel": "isotropic", "numerics.H_bar": 4.5}),
    Choice("isotropic kernel, H_bar 8", {"numerics.kernel": "isotropic", "numerics.H_bar": 8.0}),
    Choice("eta 1.2", {"numerics.eta": 1.2}),
    Choice("eta 2", {"numerics.eta": 2.0}),
    Choice("plain gradient", {"numerics.gradient": "plain"}),
    Choice("linear gradient", {"numerics.gradient": "linear"}),
    Choice("quadratic gradient", {"numerics.gradient": "quadratic"}),
    Choice("scalar inertia", {"numerics.inertia": "scalar"}),
    Choice("no compensation of inertia", {"numerics.inertia_compensation": False}),
    Choice("window 5", {"numerics.window_steps": 5}),
    Choice("window 80", {"numerics.window_steps": 80}),
    Choice("no non-affine control", non_affine=False),
    Choice("predictor-corrector", {"numerics.stepper": "predictor_corrector"}),
    Choice("law pressure_deviator", {"tissue.law": "pressure_deviator"}),
    PAPER,
]
PRESETS = [Choice(f"preset {name}", {"numerics.accuracy": name}) for name in ("fast", "balanced", "reference")]
STEPS = [Choice("step", level=factor, step_factor=factor) for factor in (8.0, 4.0, 2.0, 1.0, 0.5)]
MOVING = ("growth", "division", "path")
IN_SOIL = {  # curve: key, levels by problem
    "interval": {
        "hertz": ("penetrometer.interval_h", (0.008, 0.002, 0.001)),
        "penetrometer": ("penetrometer.interval_h", (0.048, 0.006, 0.003)),
        "soil": ("soil.contact.interval_h", (0.016, 0.008, 0.002)),
    },
    "inertial number": {
        name: ("soil.inertial_number_max", (0.1, 0.03, 0.003)) for name in ("hertz", "penetrometer", "soil")
    },
    "grain stiffness": {
        "penetrometer": ("soil.E_MPa", (62.5, 125.0, 500.0)),
        "soil": ("soil.E_MPa", (25.0, 50.0, 200.0)),
    },
    "marker spacing": {"soil": ("soil.contact.marker_spacing", (1.0, 0.3))},
}
FINEST_IN_SOIL = {
    "penetrometer": {"penetrometer.interval_h": 0.003, "soil.inertial_number_max": 0.003, "soil.E_MPa": 500.0},
    "soil": {
        "soil.contact.interval_h": 0.002,
        "soil.inertial_number_max": 0.003,
        "soil.E_MPa": 200.0,
        "soil.contact.marker_spacing": 0.3,
    },
}


@dataclass(frozen=True)
class Task:
    """One run."""

    problem: Problem
    choice: Choice
    across: int


def full_grid(chosen: list[Problem]) -> list[Task]:
    """What matters most first, so that a study that is stopped has it."""
    plain = [p for p in chosen if not p.soil]
    still = [p for p in plain if p.name not in MOVING]
    grown = [p for p in plain if p.name in ("growth", "division")]
    path = [p for p in plain if p.name == "path"]
    cheap = still + grown
    tasks = [Task(p, DEFAULT, across) for across in (4, 6, 8, 10, 12) for p in cheap]
    tasks += [Task(p, choice, 8) for choice in PRESETS for p in cheap]
    tasks += [Task(p, choice, 8) for choice in STEPS for p in grown]
    tasks += [Task(p, choice, 6) for choice in METHODS for p in cheap if concerns(choice, p)]
    tasks += soil_grid([p for p in chosen if p.soil])
    tasks += [Task(p, DEFAULT, across) for across in (6, 8, 10) for p in path]
    tasks += [Task(p, choice, 6) for choice in (*STEPS, *METHODS) for p in path if concerns(choice, p)]
    tasks += [Task(p, DEFAULT, 16) for p in cheap]
    tasks += [Task(p, choice, 10) for choice in METHODS for p in cheap if concerns(choice, p)]
    return tasks + [Task(p, DEFAULT, 12) for p in path]


def concerns(choice: Choice, problem: Problem) -> bool:
    """Whether the choice can make a difference."""
    return choice.name != "no compensation of inertia" or problem.name in MOVING


def soil_grid(chosen: list[Problem]) -> list[Task]:
    """One choice at a time."""
    tasks = []
    for p in chosen:
        if p.name in FINEST_IN_SOIL:
            tasks.append(Task(p, Choice(FINEST_NAME, FINEST_IN_SOIL[p.name]), 6))
        tasks.append(Task(p, DEFAULT, 6))
        for name, by_problem in IN_SOIL.items():
            if p.name in by_problem:
                key, levels = by_problem[p.name]
                tasks += [Task(p, Choice(name, {key: level}, level), 6) for level in levels]
    return tasks


def quick_grid(chosen: list[Problem]) -> list[Task]:
    """What continuous integration runs."""
    cheap = [p for p in chosen if p.name != "path" and not p.soil]
    tasks = [Task(p, DEFAULT, across) for across in (6, 10) for p in cheap if across == 6 or p.name != "division"]
    tasks += [Task(p, choice, 6) for choice in PRESETS if choice.name != "preset balanced" for p in cheap]
    tasks += [Task(p, PAPER, 6) for p in cheap]
    return tasks


# ---- running --------------------------------------------------------------------------------------


MEASURING = [Path(module.__file__) for module in (measure, problems, runs, theory)]


def programs_of(folder: Path) -> str:
    """Version of the program, and a digest of the programs in the folder and of what measures here."""
    digest = hashlib.sha256()
    for path in (folder / "rootsoil", folder / "bending_problem", *MEASURING):
        digest.update(path.read_bytes())
    version = subprocess.run([folder / "rootsoil", "version"], capture_output=True, text=True, check=True).stdout
    return f"{version.strip()} {digest.hexdigest()[:12]}"


def key_of(command: list[str], folder: Path, program: str) -> str:
    """Digest of all that a run depends on: what it is called with, the files that it finds, the programs."""
    parts = [program, *command[1:], *(path.read_text() for path in sorted(folder.iterdir()))]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


def timed(command: list[str], folder: Path) -> tuple[int, float, float]:
    """Exit status, processor time (s) of the command and its children, wall time (s). Output goes to files."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT_S, CPU_LIMIT_S + 5))

    start = time.monotonic()
    with (folder / "out").open("wb") as out, (folder / "err").open("wb") as err:
        process = subprocess.Popen(  # noqa: PLW1509
            command,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            env={**os.environ, "OMP_NUM_THREADS": "1", "ROOTSOIL_CACHE": str(folder / "cache")},
            preexec_fn=limit,
        )
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_utime + usage.ru_stime, time.monotonic() - start


def run_task(task: Task, programs: Path, program: str, known: dict[str, list[Row]]) -> list[Row]:
    """The rows of a run: those that are known, or new ones."""
    with tempfile.TemporaryDirectory(prefix="accuracy_") as name:
        folder = Path(name)
        command = task.problem.prepare(programs, folder, task.across, task.choice)
        key = key_of(command, folder, program)
        if key in known:
            return known[key]
        exit_status, cpu_s, wall_s = timed(command, folder)
        status, remark, values, cost = STATUS_OF_EXIT.get(exit_status, f"exit {exit_status}"), "", {}, None
        if exit_status == 0:
            try:
                values, cost = task.problem.read(folder)
                status = "done"
            except (ValueError, RunError) as error:
                status, remark = "not measured", str(error)
        else:
            lines = [line.strip() for line in (folder / "err").read_text(errors="replace").splitlines()]
            remark = next((line for line in lines if line), "")
        nan = math.nan
        return [
            Row(
                key=key,
                problem=task.problem.name,
                choice=task.choice.name,
                across=task.across,
                level=task.choice.level,
                measure=m.name,
                status=status,
                error=nan,
                inertia_error=cost.inertia_error if cost else nan,
                cpu_s=cpu_s,
                wall_s=wall_s,
                cells=cost.cells if cost else nan,
                steps=cost.steps if cost else nan,
                cell_steps=cost.cells * cost.steps if cost else nan,
                hours=cost.hours if cost else nan,
                program=program,
                values=" ".join(f"{v:.8g}" for v in values.get(m.name, [])),
                remark=remark,
            )
            for m in task.problem.measures
        ]


def measure_id(row: Row) -> str:
    """What tells an error of the quick grid from the others."""
    return f"{row.problem}, {row.choice}, {row.across} across, {row.measure}"


def bounds_text(rows: list[Row]) -> str:
    """tools/accuracy_bounds.toml with the errors of these rows, and why a run has none."""
    lines = [
        "# SPDX-License-Identifier: MIT",
        "# Errors of tools/accuracy_cost.py --quick; tests/tools/test_accuracy_cost.py fails when one is larger than `factor`",
        "# times what stands here, and larger than its floor. Written by tools/accuracy_cost.py --quick --record-bounds.",
        f"factor = {BOUND_FACTOR}",
        f"floor = {BOUND_FLOOR}",
        "",
        "[floor_of]",
        *(f'"{measure}" = {floor}' for measure, floor in BOUND_FLOOR_OF.items()),
        "",
        "[errors]",
    ]
    for row in rows:
        if row.status != "done":
            lines.append(f'"{measure_id(row)}" = "{row.status}"')
        elif math.isfinite(row.error):
            lines.append(f'"{measure_id(row)}" = {row.error:.3g}')
    return "\n".join(lines) + "\n"


def main() -> int:
    """0; 1 where a program is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a small grid, for continuous integration")
    parser.add_argument("--out", type=Path, help="folder of the results; otherwise docs, with --quick runs/accuracy_quick")
    parser.add_argument("--programs", type=Path, default=PROJECT / "build" / "release", help="folder of the programs")
    parser.add_argument("--draw-only", action="store_true", help="runs nothing: pictures and page from the rows there are")
    parser.add_argument("--record-bounds", action="store_true", help=f"with --quick: write {BOUNDS.relative_to(PROJECT)}")
    parser.add_argument("--only", nargs="*", help="names of problems; otherwise all")
    arguments = parser.parse_args()
    folder = arguments.out or (PROJECT / "runs" / "accuracy_quick" if arguments.quick else PROJECT / "docs")
    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "accuracy_cost.csv"
    known_problems = all_problems()
    chosen = [p for p in known_problems if not arguments.only or p.name in arguments.only]
    rows = read_rows(table)
    if not arguments.draw_only:
        programs = arguments.programs.resolve()
        try:
            program = programs_of(programs)
        except OSError as error:
            print(f"accuracy_cost: {error}; build first (tools/build.sh), or give --programs", file=sys.stderr)
            return 1
        known: dict[str, list[Row]] = {}
        for row in rows:
            known.setdefault(row.key, []).append(row)
        tasks = quick_grid(chosen) if arguments.quick else full_grid(chosen)
        for number, task in enumerate(tasks, 1):
            new = run_task(task, programs, program, known)
            if new[0].key in known:
                continue
            known[new[0].key] = new
            # a row of an older program or grid makes room for that of this one
            place = lambda r: (r.problem, r.choice, r.across, str(r.level))  # noqa: E731
            rows = [r for r in rows if place(r) != place(new[0])] + new
            rows = with_errors(rows, known_problems)
            write_rows(rows, table)
            told = ", ".join(f"{r.measure} {r.error:.2e}" for r in rows if r.key == new[0].key and r.error == r.error)
            step = "" if math.isnan(task.choice.level) else f" {task.choice.level:g}"
            print(
                f"{number}/{len(tasks)} {task.problem.name}, {task.choice.name}{step}, {task.across} across: {new[0].status}, "
                f"{new[0].cpu_s:.2f} s; {told or new[0].remark}",
                flush=True,
            )
        rows = with_errors(rows, known_problems)
        write_rows(rows, table)
    if arguments.quick and arguments.record_bounds:
        BOUNDS.write_text(bounds_text(rows), encoding="utf-8")
    work_precision.draw(rows, known_problems, folder / "images" if folder == PROJECT / "docs" else folder)
    if folder == PROJECT / "docs":
        (folder / "accuracy_cost.md").write_text(work_precision.page(rows, known_problems), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
