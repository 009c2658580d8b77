#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What accuracy costs: small problems with known answers, computed in many ways, error against time.

Writes OUT/accuracy_cost.csv, a row for each run and measure, after every run; rows that are there are not run again.
A row's key is made of the command, the scene and the programs. Without --quick and --out the pictures and
docs/accuracy_cost.md are made anew from it. The cost of a run is the processor time that it and its children used but
for starting the program, the time on the wall where a core is free; --part 1/2 and --part 2/2 may run at once.
"""

from __future__ import annotations

import argparse
import fcntl
import hashlib
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import tomli_w

from rootsoil_tools import accuracy_page, answers, measure, problems, runs, theory, work_precision
from rootsoil_tools.accuracy_grid import EXPLICIT_NAME, PAPER_NAME, Task, full_grid, place_of_task, quick_grid
from rootsoil_tools.accuracy_table import Row, place_of, read_rows, with_errors, write_rows
from rootsoil_tools.problems import Problem, all_problems
from rootsoil_tools.runs import RunError

PROJECT = Path(__file__).resolve().parent.parent
CPU_LIMIT_S = 90  # of one run
BOUNDS = PROJECT / "tools" / "accuracy_bounds.toml"
BOUND_FACTOR = 1.5
BOUND_FLOOR = 1e-5  # below it errors are what the force tolerance leaves, which another compiler changes
# Of measures and choices: layers of cells that divide a moment earlier; settling with inertia.
BOUND_FLOOR_OF = {"cell length": 0.02, EXPLICIT_NAME: 3e-4, PAPER_NAME: 3e-4}
STATUS_OF_EXIT = {2: "refused", 3: "unphysical", 4: "soil failed", -24: "too long"}  # 24: SIGXCPU

MEASURING = [Path(str(module.__file__)) for module in (answers, measure, problems, runs, theory)]
SOIL = sorted((PROJECT / "soil_coupling" / "yade_side").glob("*.py"))


def programs_of(folder: Path) -> str:
    """Version of the program, and a digest of the programs in the folder, of the soil and of what measures here."""
    digest = hashlib.sha256()
    for path in (folder / "rootsoil", folder / "bending_problem", *SOIL, *MEASURING):
        digest.update(path.read_bytes())
    version = subprocess.run([folder / "rootsoil", "version"], capture_output=True, text=True, check=True).stdout
    return f"{version.strip()} {digest.hexdigest()[:12]}"


def key_of(commands: Sequence[Sequence[str]], folder: Path, program: str) -> str:
    """Digest of all that a run depends on: what it is called with, the files that it finds, the programs."""
    called = [part for command in commands for part in command[1:]]
    parts = [program, *called, *(path.read_text() for path in sorted(folder.iterdir()))]
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


def error_line(folder: Path) -> str:
    """The first line that the last command complained with."""
    lines = (line.strip() for line in (folder / "err").read_text(errors="replace").splitlines())
    return next((line for line in lines if line), "")


def run_task(task: Task, programs: Path, program: str, known: set[str]) -> list[Row]:
    """The rows of a run, one after the other of each sample; none where its key is known."""
    with tempfile.TemporaryDirectory(prefix="accuracy_") as name:
        folder = Path(name)
        commands = task.problem.prepare(programs, folder, task.across, task.choice)
        key = key_of(commands, folder, program)
        if key in known:
            return []
        status, remark, cost, cpu_s, wall_s = "done", "", None, 0.0, 0.0
        values: dict = {}
        for command in commands:
            exit_status, own_cpu_s, own_wall_s = timed(command, folder)
            cpu_s, wall_s = cpu_s + own_cpu_s, wall_s + own_wall_s
            if exit_status != 0:
                status, remark = STATUS_OF_EXIT.get(exit_status, f"exit {exit_status}"), error_line(folder)
                break
        if status == "done":
            try:
                values, cost = task.problem.read(folder)
            except (ValueError, RunError) as error:
                status, remark = "not measured", str(error)
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
                unbalanced=cost.unbalanced if cost else nan,
                cpu_s=cpu_s,
                start_s=cost.start_s if cost else 0.0,
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


@contextmanager
def locked(table: Path) -> Iterator[None]:
    """Nobody else changes the table meanwhile."""
    folder = os.open(table.parent, os.O_RDONLY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        yield
    finally:
        os.close(folder)


def merge(new: Sequence[Row], table: Path, known_problems: Sequence[Problem]) -> list[Row]:
    """All rows, with the new ones in the place of those that an older program left; the table is written."""
    with locked(table):
        places = {place_of(row) for row in new}
        rows = with_errors([row for row in read_rows(table) if place_of(row) not in places] + [*new], known_problems)
        write_rows(rows, table)
    return rows


def drop_strays(table: Path, grid: Sequence[Task]) -> None:
    """Rows of runs that the grid no longer has go, and that is said."""
    places = {place_of_task(task) for task in grid}
    with locked(table):
        rows = read_rows(table)
        kept = [row for row in rows if place_of(row) in places]
        if len(kept) < len(rows):
            print(f"dropped {len(rows) - len(kept)} rows of runs that are no longer in the grid", flush=True)
            write_rows(kept, table)


def run_grid(
    tasks: Sequence[Task], programs: Path, program: str, table: Path, known_problems: Sequence[Problem]
) -> None:
    """Runs what the table does not hold yet."""
    known = {row.key for row in read_rows(table)}
    for number, task in enumerate(tasks, 1):
        new = run_task(task, programs, program, known)
        if not new:
            continue
        rows = merge(new, table, known_problems)
        told = ", ".join(f"{r.measure} {r.error:.2e}" for r in rows if r.key == new[0].key and r.error == r.error)
        level = "" if math.isnan(task.choice.level) else f" {task.choice.level:g}"
        print(
            f"{number}/{len(tasks)} {task.problem.name}, {task.choice.name}{level}, {task.across} across: "
            f"{new[0].status}, {new[0].cpu_s:.2f} s; {told or new[0].remark}",
            flush=True,
        )


def part_of(text: str) -> tuple[int, int]:
    """ "1/2" as (1, 2)."""
    number, _, count = text.partition("/")
    if not (number.isdigit() and count.isdigit() and 1 <= int(number) <= int(count)):
        raise argparse.ArgumentTypeError(f"'{text}' is no part; 1/2 and 2/2 are the halves")
    return int(number), int(count)


def measure_id(row: Row) -> str:
    """What tells an error of the quick grid from the others."""
    level = "" if math.isnan(row.level) else f" {row.level:g}"
    return f"{row.problem}, {row.choice}{level}, {row.across} across, {row.measure}"


BOUNDS_HEADER = """\
# SPDX-License-Identifier: MIT
# Errors of tools/accuracy_cost.py --quick; tests/tools/test_accuracy_cost.py fails when one is larger than `factor`
# times what stands here, and larger than its floor. Written by tools/accuracy_cost.py --quick --record-bounds.
"""


def bounds_text(rows: Sequence[Row]) -> str:
    """tools/accuracy_bounds.toml with the errors of these rows, and why a run has none."""
    errors: dict[str, float | str] = {}
    for row in rows:
        if row.status != "done":
            errors[measure_id(row)] = row.status
        elif math.isfinite(row.error):
            errors[measure_id(row)] = float(f"{row.error:.3g}")
    recorded = {"factor": BOUND_FACTOR, "floor": BOUND_FLOOR, "floor_of": BOUND_FLOOR_OF, "errors": errors}
    return BOUNDS_HEADER + tomli_w.dumps(recorded)


def main() -> int:
    """0; 1 where a program is missing."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a small grid, for continuous integration")
    parser.add_argument(
        "--out", type=Path, help="folder of the results; otherwise docs, with --quick runs/accuracy_quick"
    )
    parser.add_argument("--programs", type=Path, default=PROJECT / "build" / "release", help="folder of the programs")
    parser.add_argument(
        "--draw-only", action="store_true", help="runs nothing: pictures and page from the rows there are"
    )
    parser.add_argument(
        "--record-bounds", action="store_true", help=f"with --quick: write {BOUNDS.relative_to(PROJECT)}"
    )
    parser.add_argument("--only", nargs="*", help="names of problems; otherwise all")
    parser.add_argument(
        "--part", type=part_of, default=(1, 1), metavar="I/N", help="every N-th run only, from the I-th on"
    )
    arguments = parser.parse_args()
    in_docs = not (arguments.out or arguments.quick)
    folder = PROJECT / "docs" if in_docs else arguments.out or PROJECT / "runs" / "accuracy_quick"
    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "accuracy_cost.csv"
    known_problems = all_problems()
    names = {p.name for p in known_problems}
    if unknown := set(arguments.only or []) - names:
        parser.error(f"no such problem: {', '.join(sorted(unknown))} (there are: {', '.join(sorted(names))})")
    make_grid = quick_grid if arguments.quick else full_grid
    grid = make_grid([p for p in known_problems if not arguments.only or p.name in arguments.only])
    if not arguments.draw_only:
        programs = arguments.programs.resolve()
        try:
            program = programs_of(programs)
        except OSError as error:
            print(f"accuracy_cost: {error}; build first (tools/build.sh), or give --programs", file=sys.stderr)
            return 1
        drop_strays(table, make_grid(known_problems))
        number, count = arguments.part
        run_grid(grid[number - 1 :: count], programs, program, table, known_problems)
    rows = with_errors(read_rows(table), known_problems)
    if arguments.quick and arguments.record_bounds:
        BOUNDS.write_text(bounds_text(rows), encoding="utf-8")
    work_precision.draw(rows, known_problems, folder / "images" if in_docs else folder)
    if not arguments.quick:
        page = accuracy_page.page(rows, known_problems)
        (folder / "accuracy_cost.md").write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
