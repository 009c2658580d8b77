# SPDX-License-Identifier: MIT
"""The page on speed: its counts, its table, and that the tool measures what it lists. No time is asserted."""

from __future__ import annotations

import json
import math
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import bench as tool
import numpy as np
import pytest
from rootsoil_tools import pages, performance_page, roofline
from rootsoil_tools.performance_page import Row
from rootsoil_tools.runs import RunError
from synthetic import make_growing_run


class Counted:
    """A number that counts what is done with it."""

    operations = 0

    def _count(self, other: object) -> Counted:
        Counted.operations += 1
        return Counted()

    __add__ = __sub__ = __mul__ = _count


def array(*shape: int) -> np.ndarray:
    return np.array([Counted() for _ in range(math.prod(shape))], dtype=object).reshape(shape)


def gradient_pair(n: int) -> None:
    """The body of compute_velocity_gradients."""
    du = array(n) - array(n)
    array(n, n) + np.outer(du, array(n))
    array(n, n) - np.outer(du, array(n))


def force_pair(n: int, damped: bool) -> None:
    """The bodies of resist_slips, with growth, and of add_stress_forces without artificial viscosity."""
    one, r, du = Counted(), array(n) - array(n), array(n) - array(n)
    v_i, v_j = du - array(n, n) @ r, du - array(n, n) @ r
    elastic = one * one * one * one
    viscous = elastic * one
    if damped:
        viscous = viscous + one * one * one * (one + one)
    slip_i, slip_j = array(n), array(n)
    f_i, f_j = slip_i * elastic + v_i * viscous, slip_j * elastic + v_j * viscous
    if damped:  # with inertia every pass keeps its slips
        slip_i, slip_j = (slip_i + v_i * one) * one, (slip_j + v_j * one) * one
    both = f_i + f_j
    array(n) + both
    array(n) - both
    array(n, n) + np.outer(f_i, r)
    array(n, n) - np.outer(f_j, r)
    f = array(n, n) @ array(n) - array(n, n) @ array(n)
    array(n) + f
    array(n) - f


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("damped", [False, True])
def test_operations_are_those_of_the_source(n: int, damped: bool):
    def counted(pair: Callable[[], None]) -> int:
        Counted.operations = 0
        pair()
        return Counted.operations

    assert roofline.gradient_loop(n).operations == counted(lambda: gradient_pair(n))
    assert roofline.force_loop(n, damped).operations == counted(lambda: force_pair(n, damped))


def test_bytes_of_a_pair_hold_what_check_lists(project: Path):
    """`check` says what a pair has in memory; the loops read all of it but the kernel, its cells twice."""
    program = project / "build" / "release" / "rootsoil"
    found = tool.examine(program, tool.SCENARIOS / "growth_3d.toml")
    kernel, cells, slips = 8, 8, 48
    assert roofline.force_loop(3, damped=False).bytes_of_pair == found["bytes_per_pair"] - kernel + cells
    assert roofline.force_loop(3, damped=True).bytes_of_pair == found["bytes_per_pair"] - kernel + cells + slips


def rows_of(part: str, case: str, **values: float) -> list[Row]:
    return [Row(part, case, quantity, value) for quantity, value in values.items()]


ROWS = [
    *rows_of("jobs", "main job (1 thread)", dimension=2, hours=50, cells_start=2594, cells_end=4874, cell_hours=2e5,
             cpu_s=10.7, wall_s=10.5, steps=500, iterations=1000, memory_mb=55),
    *rows_of("full", "S3 (2 threads)", dimension=3, hours=55, cells_start=45000, cells_end=2e5, cell_hours=5e6,
             cpu_s=7000, wall_s=3600, steps=700, iterations=math.nan, memory_mb=1500),
    *rows_of("phases", "main job", balance=0.6, forces=0.2),
    *rows_of("ratios", "main job", hours=10, inertia_cpu_s=17, balance_cpu_s=1.7, ratio=10),
    *rows_of("hours", "40-50", cpu_s_per_h=0.2, over_early=1.05),
    *rows_of("scaling", "8 across", cells=3000, pairs=9e4, steps=12, step_h=0.1, step_cpu_s=0.12, step_iterations=7,
             memory_mb=48, across=8, layers=60),
    *rows_of("scaling", "25 across", cells=1e5, pairs=3e6, steps=3, step_h=0.1, step_cpu_s=5, step_iterations=8,
             memory_mb=800, across=25, layers=187),
    *rows_of("machine", "one core", triad_GB_s=20, matrix_product_GFLOP_s=40, in_cache_GFLOP_s=7),
    *rows_of("roofline", "quasi_static: forces", cells=1e5, operations=100, bytes=125, ns_per_pair=25),
]  # fmt: skip


def test_a_table_comes_back_as_it_was(tmp_path: Path):
    performance_page.write_rows(ROWS, tmp_path / "t.csv")
    again = performance_page.read_rows(tmp_path / "t.csv")
    assert [repr(row) for row in again] == [repr(Row(*row_names(r), float(r.value))) for r in ROWS]
    assert performance_page.read_rows(tmp_path / "none.csv") == []


def row_names(row: Row) -> tuple[str, str, str]:
    return row.part, row.case, row.quantity


def test_the_page_says_what_the_rows_say(tmp_path: Path):
    page = performance_page.page(ROWS)
    # 0.0214 x 2e5 / 10.7 = 400; 10.7 s / 2e5 = 53.5 us; two iterations a step
    assert "| main job (1 thread) | 50 | 2594-4874 | 10.7 | 10.5 | 500 | 2 | 55 | 53.5 | 400 |" in page
    # 0.0687 x 5e6 / 7000 = 49.1; what an older program did not count is left out
    assert "| S3 (2 threads) | 55 | 45000-200000 | 7,000 | 3,600 | 700 |  | 1,500 | 1,400 | 49.1 |" in page
    # 100 operations in 25 ns under min(20 x 0.8, 40)
    assert "| quasi_static: forces | 100 | 125 | 0.8 | 25 | 4 | 5 | 25 % |" in page
    # 800 MB x 100; 500 s a step and ten steps an hour; 187 x 100^(1/3) layers
    assert "| 1 | 868 | 83.9 | 500 | 1.39 |" in page
    assert "| 25 | 100,000 | 30 | 5 | 50 | 8 | 800 | 8.39 |" in page
    assert "over the early one: 1.05" in page
    for draw in (performance_page.draw_scaling, performance_page.draw_roofline):
        draw(ROWS, tmp_path / "picture.png")
        assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
        (tmp_path / "picture.png").unlink()


def test_the_recorded_page_is_the_table(project: Path):
    """docs/performance.md is what tools/bench.py makes of docs/performance.csv, and what is written by hand."""
    docs = project / "docs"
    kept = pages.kept_part(docs / "performance.md", "bench")
    made = performance_page.page(performance_page.read_rows(docs / "performance.csv"))
    assert len(kept) > 1000 and (docs / "performance.md").read_text(encoding="utf-8") == made + kept


def test_a_run_that_was_resumed_is_refused(tmp_path: Path):
    """Its summary has the time of the last session only."""
    folder = make_growing_run(tmp_path / "run")
    told = {
        "cells_start": 2,
        "cells_end": 3,
        "cpu_s": 7.0,
        "wall_s": 8.0,
        "steps": 9,
        "peak_memory_mb": 1,
        "threads": 2,
    }
    (folder / "summary.json").write_text(json.dumps({"time_h": 12.0, "length_mm": 7.0, **told}))
    (folder / "run.log").write_text("small: 12 h in 9 steps\n")
    found = {row.quantity: row.value for row in tool.full_rows(folder)}
    cells = tool.Run(folder).history()["cells"]
    assert cells[0] * 12.0 < found["cell_hours"] < cells[-1] * 12.0
    assert found["cpu_s"] == 7.0 and math.isnan(found["iterations"])
    (folder / "run.log").write_text("resumed at 3 h\n")
    with pytest.raises(RunError, match="was resumed"):
        tool.full_rows(folder)


@pytest.mark.slow
def test_the_quick_bench_measures_everything(project: Path, tmp_path: Path):
    """Every row and picture is there, counts are right, docs/ is left alone."""
    page = project / "docs" / "performance.md"
    before = page.read_bytes()
    program = os.environ.get("ROOTSOIL_PROGRAM", project / "build" / "release" / "rootsoil")
    command = [project / "tools" / "bench.py", "--quick", "--out", tmp_path / "out", "--work", tmp_path / "work"]
    done = subprocess.run([*command, "--program", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert page.read_bytes() == before and not (tmp_path / "out" / "performance.md").exists()
    rows = performance_page.read_rows(tmp_path / "out" / "performance.csv")
    assert all(math.isfinite(row.value) for row in rows)
    jobs, ratios = (performance_page.cases(rows, part) for part in ("jobs", "ratios"))
    assert len(jobs) == 4 and len(ratios) == 3 and len(performance_page.cases(rows, "hours")) == 2
    one, two = (jobs[f"main job ({n})"] for n in ("1 thread", "2 threads"))
    assert [job["threads"] for job in (one, two)] == [1, 2]
    for count in ("cells_end", "steps", "iterations", "length_mm"):
        assert one[count] == two[count]
    for across, point in zip(tool.QUICK.across, performance_page.cases(rows, "scaling").values(), strict=True):
        scene = tmp_path / "work" / f"growth_3d_{across}_across.toml"
        assert point["cells"] == tool.examine(program, scene)["cells"]
        # one evaluation at the guess, one an iteration, one for good; more where the guess is doubtful
        least = point["steps"] * (point["step_iterations"] + 2)
        assert 0.999 * least <= point["evaluations"] <= 1.5 * least
    loops = performance_page.cases(rows, "roofline")
    assert len(loops) == 4 and all(loop["bytes"] > 0 for loop in loops.values())
    for name in ("performance_scaling.png", "performance_roofline.png"):
        assert (tmp_path / "out" / "images" / name).read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("arguments", [["--repeat", "0"], ["--only", "everything"]])
def test_what_cannot_be_meant_is_refused(project: Path, tmp_path: Path, arguments: list[str]):
    command = [project / "tools" / "bench.py", "--out", tmp_path, *arguments]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and arguments[0] in done.stderr
    assert not list(tmp_path.iterdir())
