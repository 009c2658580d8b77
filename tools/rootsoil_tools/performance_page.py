# SPDX-License-Identifier: MIT
"""What tools/bench.py measured: its table, its pictures and docs/performance.md."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from rootsoil_tools import draw
from rootsoil_tools.pages import table

# Of the authors' own code, CPU s for a cell and an hour, by dimension: taken over from issue 11, not measured here.
AUTHORS_CPU_S = {2: 0.0214, 3: 0.0687}
PAPER_CELLS = 1e7  # of the last table


@dataclass(frozen=True)
class Row:
    """One number. What is not known is NaN, and an empty place in the file."""

    part: str
    case: str
    quantity: str
    value: float


def write_rows(rows: Sequence[Row], path: Path) -> None:
    """Replaces the file as a whole."""
    partial = path.with_suffix(".partial")
    with partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([field.name for field in fields(Row)])
        for row in rows:
            *names, value = astuple(row)
            writer.writerow([*names, "" if math.isnan(value) else f"{value:.6g}"])
    partial.replace(path)


def read_rows(path: Path) -> list[Row]:
    """The rows of a file; none where there is no file."""
    if not path.is_file():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return [Row(r["part"], r["case"], r["quantity"], float(r["value"] or "nan")) for r in csv.DictReader(file)]


def cases(rows: Sequence[Row], part: str) -> dict[str, dict[str, float]]:
    """Case: quantity: value of a part."""
    found: dict[str, dict[str, float]] = {}
    for row in rows:
        if row.part == part:
            found.setdefault(row.case, {})[row.quantity] = row.value
    return found


def number(value: float, unit: str = "") -> str:
    """Three digits, without an exponent; nothing where it is not known."""
    if not math.isfinite(value):
        return ""
    rounded = float(f"{value:.3g}")
    return f"{rounded:,.0f}{unit}" if abs(rounded) >= 100 else f"{rounded:g}{unit}"


# ---- tables -----------------------------------------------------------------------------------------


def authors_ratio(job: dict[str, float]) -> float:
    """How many times less processor time a cell-hour takes than in the authors' code."""
    return AUTHORS_CPU_S[int(job["dimension"])] * job["cell_hours"] / job["cpu_s"]


def table_of_jobs(rows: Sequence[Row]) -> str:
    """Every job as a whole, and S3 where its folder was given."""
    lines = [
        [
            name,
            number(job["hours"]),
            f"{job['cells_start']:.0f}-{job['cells_end']:.0f}",
            number(job["cpu_s"]),
            number(job["wall_s"]),
            number(job["steps"]),
            number(job["iterations"] / job["steps"]),
            number(job["memory_mb"]),
            number(1e6 * job["cpu_s"] / job["cell_hours"]),
            number(authors_ratio(job)),
        ]
        for name, job in [*cases(rows, "jobs").items(), *cases(rows, "full").items()]
    ]
    head = ["job", "h", "cells", "processor s", "wall s", "steps", "iterations a step", "MB", "us a cell-hour"]
    return table([*head, "authors' time over it"], lines)


def table_of_ratios(rows: Sequence[Row]) -> str:
    """The first hours with inertia and without."""
    lines = [
        [name, number(r["hours"]), number(r["inertia_cpu_s"]), number(r["balance_cpu_s"]), number(r["ratio"])]
        for name, r in cases(rows, "ratios").items()
    ]
    return table(["job", "first h", "`symplectic`, processor s", "`quasi_static`, processor s", "ratio"], lines)


def table_of_hours(rows: Sequence[Row]) -> str:
    """What an hour of the main job costs, early and late."""
    lines = [[stretch, number(r["cpu_s_per_h"])] for stretch, r in cases(rows, "hours").items()]
    return table(["hours", "processor s an hour"], lines)


def table_of_phases(rows: Sequence[Row], most: int = 8) -> str:
    """Where the steps of each job spend their time: the largest shares. `balance` holds those of its passes."""
    jobs = cases(rows, "phases")
    names = sorted(
        {name for job in jobs.values() for name in job}, key=lambda n: -max(j.get(n, 0) for j in jobs.values())
    )
    lines = [[name, *[f"{100 * job.get(name, 0):.0f} %" for job in jobs.values()]] for name in names[:most]]
    return table(["phase", *jobs], lines)


def table_of_scaling(rows: Sequence[Row]) -> str:
    """Roots of more and more cells."""
    lines = [
        [
            f"{r['across']:.0f}",
            number(r["cells"]),
            number(r["pairs"] / r["cells"]),
            number(r["step_cpu_s"]),
            number(1e6 * r["step_cpu_s"] / r["cells"]),
            number(r["step_iterations"]),
            number(r["memory_mb"]),
            number(bytes_per_cell(r) / 1e3),
        ]
        for r in cases(rows, "scaling").values()
    ]
    head = ["across", "cells", "pairs a cell", "processor s a step", "us a cell and step", "iterations a step", "MB"]
    return table([*head, "kB a cell"], lines)


def bytes_per_cell(point: dict[str, float]) -> float:
    """Peak memory over cells, the program's own included."""
    return point["memory_mb"] * 2**20 / point["cells"]


def table_of_roofline(rows: Sequence[Row]) -> str:
    """Each pair loop against the machine."""
    machine = cases(rows, "machine").get("one core", {})
    lines = []
    for name, r in cases(rows, "roofline").items():
        rate = r["operations"] / r["ns_per_pair"]
        bandwidth = r["bytes"] / r["ns_per_pair"]
        roof = min(machine["triad_GB_s"] * r["operations"] / r["bytes"], machine["matrix_product_GFLOP_s"])
        cells = [number(v) for v in (r["operations"], r["bytes"], r["operations"] / r["bytes"], r["ns_per_pair"])]
        lines.append([name, *cells, number(rate), number(bandwidth), f"{100 * rate / roof:.0f} %"])
    head = [
        "loop",
        "operations a pair",
        "bytes a pair",
        "operations a byte",
        "ns a pair",
        "GFLOP/s",
        "GB/s",
        "of the roof",
    ]
    return table(head, lines)


def text_of_machine(rows: Sequence[Row]) -> str:
    """What one core does."""
    machine = cases(rows, "machine").get("one core")
    if not machine:
        return ""
    return (
        f"One core: {machine['triad_GB_s']:.0f} GB/s from and to memory (triad), "
        f"{machine['matrix_product_GFLOP_s']:.0f} GFLOP/s in a product of matrices (fused multiply-add,\n"
        f"all in cache), {machine['in_cache_GFLOP_s']:.1f} GFLOP/s in x + a y by numpy within the cache."
    )


def table_on_paper(rows: Sequence[Row], ranks: Sequence[int] = (1, 16, 64)) -> str:
    """Ten million cells, from the largest root that was measured."""
    measured = cases(rows, "scaling")
    if not measured:
        return ""
    largest = max(measured.values(), key=lambda r: r["cells"])
    across = largest["across"] * (PAPER_CELLS / largest["cells"]) ** (1 / 3)
    layers = PAPER_CELLS / largest["cells"] * largest["layers"] * (largest["across"] / across) ** 2
    halo = 3  # layers: the reach of a kernel, 2 x 1.3 cells, rounded up
    step_s = largest["step_cpu_s"] / largest["cells"] * PAPER_CELLS
    lines = []
    for n in ranks:
        share = (layers / n + (2 * halo if n > 1 else 0)) / layers
        hour_s = step_s * share / largest["step_h"]
        memory_GB = bytes_per_cell(largest) * PAPER_CELLS * share / 1e9
        lines.append([str(n), number(layers / n), number(memory_GB), number(step_s * share), number(hour_s / 3600)])
    head = ["ranks of one core", "layers of cells a rank", "GB a rank", "s a step", "h for an hour of growth"]
    return table(head, lines)


# ---- pictures ---------------------------------------------------------------------------------------


def draw_scaling(rows: Sequence[Row], path: Path) -> None:
    """Time, iterations and memory over cells."""
    points = sorted(cases(rows, "scaling").values(), key=lambda r: r["cells"])
    cells = [r["cells"] for r in points]
    draw.use_style()
    figure = draw.new_figure(180.0, 62.0)
    panels = (
        ("processor time a step (s)", [r["step_cpu_s"] for r in points]),
        ("iterations a step", [r["step_iterations"] for r in points]),
        ("peak memory a cell (kB)", [bytes_per_cell(r) / 1e3 for r in points]),
    )
    for column, (label, values) in enumerate(panels):
        axes = draw.place(figure, 13.0 + 60.0 * column, 11.0, 44.0, 46.0)
        axes.plot(cells, values, color=draw.SIMULATION, marker="o", markersize=3.5, linewidth=1.0)
        axes.set(xscale="log", xlabel="cells", ylabel=label)
        if column == 0:
            axes.set_yscale("log")
            line = [values[-1] * n / cells[-1] for n in cells]
            axes.plot(cells, line, label="proportional to cells", **draw.THEORY_LINE)
            axes.legend(frameon=False, loc="upper left")
        else:
            axes.set_ylim(bottom=0.0)
    figure.savefig(path, dpi=draw.DOTS_PER_INCH)


def draw_roofline(rows: Sequence[Row], path: Path) -> None:
    """The loops under the machine's roof."""
    (machine,) = cases(rows, "machine").values()
    peak, bandwidth = machine["matrix_product_GFLOP_s"], machine["triad_GB_s"]
    draw.use_style()
    figure = draw.new_figure(110.0, 72.0)
    axes = draw.place(figure, 14.0, 11.0, 92.0, 56.0)
    left, right = 0.05, 30.0
    ridge = peak / bandwidth
    axes.plot([left, ridge, right], [left * bandwidth, peak, peak], color=draw.THEORY, linewidth=1.3)
    axes.axhline(machine["in_cache_GFLOP_s"], **draw.THEORY_LINE)
    note = {"ha": "right", "va": "bottom", "fontsize": 6.5}
    axes.text(right, peak, f"product of matrices {peak:.0f} GFLOP/s", **note)
    axes.text(right, machine["in_cache_GFLOP_s"], "x + a y by numpy, in cache", **note)
    axes.text(0.35 * ridge, 0.4 * peak, f"{bandwidth:.0f} GB/s", ha="right", va="bottom", fontsize=6.5)
    for name, r in cases(rows, "roofline").items():
        axes.plot(
            r["operations"] / r["bytes"],
            r["operations"] / r["ns_per_pair"],
            linestyle="none",
            marker="o" if "forces" in name else "s",
            color=draw.SIMULATION if "quasi_static" in name else draw.DATA,
            markersize=5,
            label=name,
        )
    axes.set(
        xscale="log",
        yscale="log",
        xlim=(left, right),
        ylim=(0.2, 2 * peak),
        xlabel="operations a byte",
        ylabel="GFLOP/s, one core",
    )
    axes.legend(frameon=False, loc="lower right")
    figure.savefig(path, dpi=draw.DOTS_PER_INCH)


# ---- the page ---------------------------------------------------------------------------------------

PAGE = """\
<!-- SPDX-License-Identifier: MIT -->
<!-- Written by tools/bench.py. What is changed here is lost. -->
# How fast it is

`tools/bench.py` measures this page, its pictures and [performance.csv](performance.csv), with `--only` a part of them.
{repeat}
Processor time is the run's own (`cpu_s` of summary.json): starting included, the picture not. One thread where
nothing else is said. No test asserts a time.

## Jobs

{jobs}
A cell-hour is a cell that lives for an hour, at rest or not. The authors' own code takes {authors_2d} s of processor
time for one in 2D and {authors_3d} s in 3D: numbers that are taken over, not measured here. Iterations are left out
where an older program made the run.

Where the steps spend their time, as shares of all of it (wall, one thread). `balance` holds all but the last of the
passes `forces`, `material`, `velocity gradients` and of contacts, which are listed as well: a column adds up to more
than 100 %.

{phases}
## Against steps with inertia

The same scene with `--set numerics.stepper=symplectic` and without, in turn, both from the start to the same hour:
medians of the times without starting, and of the ratios. Only the beginning is run, because a whole job with inertia
takes minutes. What it says of the whole is no more than that; cells are fewer in the beginning, and all are awake.

{ratios}
## Early and late

The main job again, in one run that is paused in between. With `[sleep]` an hour costs what the part that grows costs:

{hours}
The late hour over the early one: {late}.

## More cells

The root of `growth_3d` with smaller cells in all directions: the same growth, no divisions, 3 to 12 steps from the
second on, one thread. Memory is the peak of the whole program over the cells, with a frame and a checkpoint.

![Time, iterations and memory over cells](images/performance_scaling.png)

{scaling}
## The machine's roof

{machine}
The pair loops of a 3D root of {roofline_cells} cells, one thread. Operations and bytes of a pair are counted by hand,
as tools/rootsoil_tools/roofline.py says: every addition and multiplication of the source once, every byte that must
pass at least once. Times are those of `forces` and `velocity gradients` in `wall_s_by_effect`. The roof is the lower of
two: operations a byte times the triad's bytes, and the product of matrices.

![Pair loops under the machine's roof](images/performance_roofline.png)

{roofline}
## On paper: ten million cells

The same root again, scaled from the largest that was measured: a slice along the root for each rank. What is assumed
stands below.

{on_paper}
"""


def page(rows: Sequence[Row]) -> str:
    """docs/performance.md, without what is written by hand. A part that was not measured has an empty table."""
    hours, settings = cases(rows, "hours"), cases(rows, "settings").get("", {})
    roofline = cases(rows, "roofline")
    late = [r["over_early"] for r in hours.values() if "over_early" in r]
    return PAGE.format(
        repeat=f"Medians of {settings['repeat']:.0f}." if settings else "Nothing is measured yet.",
        jobs=table_of_jobs(rows),
        authors_2d=AUTHORS_CPU_S[2],
        authors_3d=AUTHORS_CPU_S[3],
        phases=table_of_phases(rows),
        ratios=table_of_ratios(rows),
        hours=table_of_hours(rows),
        late=number(late[0]) if late else "not measured",
        scaling=table_of_scaling(rows),
        machine=text_of_machine(rows),
        roofline_cells=number(next(iter(roofline.values()))["cells"]) if roofline else "many",
        roofline=table_of_roofline(rows),
        on_paper=table_on_paper(rows),
    )
