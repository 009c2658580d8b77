# SPDX-License-Identifier: MIT
"""Work-precision diagrams and docs/accuracy_cost.md, from the rows of tools/accuracy_cost.py."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from rootsoil_tools import draw as paper
from rootsoil_tools.accuracy_table import DEFAULT_NAME, Row
from rootsoil_tools.problems import Problem

PAPER_NAME = "paper's scheme"
# which problem and measure has a row of panels in which picture
PICTURES: dict[str, list[tuple[str, str]]] = {
    "accuracy_case1": [
        ("case1_isotropic", "radial"),
        ("case1_anisotropic", "radial"),
        ("case1_balanced", "radial"),
        ("case1_irregular", "radial"),
    ],
    "accuracy_growth": [
        ("growth", "tip speed"),
        ("growth", "axial rate"),
        ("division", "axial rate"),
        ("division", "cell length"),
    ],
    "accuracy_bending_contact": [
        ("cantilever", "stiffness"),
        ("euler", "stiffness"),
        ("thrust", "arrest stress"),
        ("path", "path"),
    ],
    "accuracy_soil": [("hertz", "force"), ("penetrometer", "Q"), ("soil", "tip force"), ("soil", "elongation")],
}
# the measure that stands for a problem in tables, and what the column is called
MAIN: dict[str, tuple[str, str]] = {
    "case1_isotropic": ("radial", "Case 1 isotropic"),
    "case1_anisotropic": ("radial", "anisotropic"),
    "case1_balanced": ("radial", "balanced"),
    "case1_irregular": ("radial", "irregular cells"),
    "growth": ("axial rate", "growth rate"),
    "division": ("cell length", "cell length"),
    "cantilever": ("stiffness", "cantilever"),
    "euler": ("stiffness", "Euler load"),
    "thrust": ("arrest stress", "arrest stress"),
    "path": ("path", "path"),
    "hertz": ("force", "Hertz"),
    "penetrometer": ("Q", "Q"),
    "soil": ("tip force", "tip force"),
}
OFFERED = (DEFAULT_NAME, "step", "preset fast", "preset balanced", "preset reference")
TARGETS = (0.1, 0.03, 0.01, 0.003, 0.001, 0.0003)

# colour, marker, line width; choices of a kind share a colour
BLUE, GREEN, PURPLE, ORANGE = "#0072B2", "#009E73", "#8E5EA2", "#E69F00"
SKY, PINK, RED, GREY, OLIVE = "#56B4E9", "#CC79A7", "#C1272D", "#6A6A6A", "#7A7A00"
STYLES: dict[str, tuple[str, str, float]] = {
    DEFAULT_NAME: (BLUE, "o", 2.0),
    "step": (BLUE, "x", 0.8),
    PAPER_NAME: (RED, "s", 2.0),
    "isotropic kernel, H_bar 2": (GREEN, "^", 1.0),
    "isotropic kernel, H_bar 4.5": (GREEN, "v", 1.0),
    "isotropic kernel, H_bar 8": (GREEN, "D", 1.0),
    "eta 1.2": (PURPLE, "<", 1.0),
    "eta 2": (PURPLE, ">", 1.0),
    "plain gradient": (ORANGE, "^", 1.0),
    "linear gradient": (ORANGE, "v", 1.0),
    "quadratic gradient": (ORANGE, "D", 1.0),
    "scalar inertia": (GREY, "^", 1.0),
    "no compensation of inertia": (GREY, "v", 1.0),
    "window 5": (SKY, "<", 1.0),
    "window 80": (SKY, ">", 1.0),
    "no non-affine control": (PINK, "D", 1.0),
    "predictor-corrector": (OLIVE, "P", 1.0),
    "law pressure_deviator": (RED, "+", 0.8),
    "preset fast": ("black", "1", 0.0),
    "preset balanced": ("black", "2", 0.0),
    "preset reference": ("black", "*", 0.0),
    "interval": (SKY, "o", 1.2),
    "inertial number": (PURPLE, "s", 1.2),
    "grain stiffness": (ORANGE, "^", 1.2),
    "marker spacing": (GREEN, "D", 1.2),
}


@dataclass(frozen=True)
class Point:
    """A run in a diagram."""

    choice: str
    cost: float
    error: float
    place: float = 0.0  # along its curve: cells across, or what the curve varies


def points_of(rows: Iterable[Row], problem: str, measure: str, cost: str) -> list[Point]:
    """The runs of a problem that have an error; `cost` is a column."""
    return [
        Point(r.choice, getattr(r, cost), max(r.error, 1e-9), r.across if math.isnan(r.level) else r.level)
        for r in rows
        if (r.problem, r.measure, r.status) == (problem, measure, "done")
        and math.isfinite(r.error)
        and getattr(r, cost) > 0.0
    ]


def pareto_front(points: Sequence[Point]) -> list[Point]:
    """Those than which none is both as cheap and as exact, by cost."""
    front: list[Point] = []
    for point in sorted(points, key=lambda p: (p.cost, p.error)):
        if not front or point.error < front[-1].error:
            front.append(point)
    return front


def widen(get: Callable[[], tuple[float, float]], put: Callable[[float, float], object], factor: float) -> None:
    """Limits of a logarithmic axis that are at least a factor apart."""
    low, high = get()
    missing = math.sqrt(max(1.0, factor * low / high))
    put(low / missing, high * missing)


def draw_panel(axes: Axes, points: Sequence[Point]) -> None:
    """One curve a choice, the front as a grey band with its runs ringed."""
    front = pareto_front(points)
    if front:
        axes.step(
            [p.cost for p in front],
            [p.error for p in front],
            where="post",
            color="#D0D0D0",
            linewidth=4.0,
            zorder=0,
            solid_capstyle="round",
        )
        axes.plot(
            [p.cost for p in front],
            [p.error for p in front],
            linestyle="none",
            marker="o",
            markersize=7.5,
            markerfacecolor="none",
            markeredgecolor="black",
            markeredgewidth=0.6,
            zorder=4,
        )
    for name, (colour, marker, width) in STYLES.items():
        own = sorted((p for p in points if p.choice == name), key=lambda p: p.place)
        if own:
            axes.plot(
                [p.cost for p in own],
                [p.error for p in own],
                color=colour,
                marker=marker,
                markersize=4.0 if width else 7.0,
                linewidth=width,
                linestyle=(0, (3, 2)) if name == "step" else "-" if width else "none",
                zorder=3 if width > 1.5 else 2,
            )
    axes.set(xscale="log", yscale="log")
    widen(axes.get_xlim, axes.set_xlim, 5.0)
    widen(axes.get_ylim, axes.set_ylim, 15.0)
    low, high = axes.get_xlim()
    if high < 100.0 * low:
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}" if x < 1e4 else f"{x / 1e6:g} M"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(visible=True, which="major", color="#E8E8E8", linewidth=0.5)
    axes.set_axisbelow(True)


COSTS = {"cpu_s": "processor time (s)", "cell_steps": "cells x steps"}


def draw_picture(rows: Sequence[Row], pairs: Sequence[tuple[str, str]], problems: dict[str, Problem], path: Path) -> bool:
    """Two panels for each problem and measure that has runs, one where it has soil: there the cells are not the cost.
    False where there are none."""
    panels = [
        (problem, measure, cost)
        for problem, measure in pairs
        if problem in problems
        for cost in (("cpu_s",) if problems[problem].soil else COSTS)
        if points_of(rows, problem, measure, cost)
    ]
    if not panels:
        return False
    paper.use_style()
    height, gap, legend_mm = 42.0, 17.0, 19.0
    lines = (len(panels) + 1) // 2
    total = lines * (height + gap) + legend_mm + 1.0
    figure = paper.new_figure(180.0, total)
    names: list[str] = []
    for index, (problem, measure, cost) in enumerate(panels):
        left, bottom = 15.0 + 90.0 * (index % 2), total - (index // 2 + 1) * (height + gap) + gap - 8.0
        points = points_of(rows, problem, measure, cost)
        axes = paper.place(figure, left, bottom, 72.0, height)
        draw_panel(axes, points)
        axes.set_xlabel(COSTS[cost], labelpad=1.0)
        if left < 90.0 or problems[problem].soil:
            axes.set_ylabel("relative error")
        names += [p.choice for p in points if p.choice not in names]
        if cost == "cpu_s":
            name = f"{problems[problem].title}: {problems[problem].measure(measure).meaning}"
            wrapped = textwrap.fill(name, 52 if problems[problem].soil else 120)
            figure.text(left / 180.0, (bottom + height + 1.5) / total, wrapped, size=7.5, va="bottom")
            paper.letter(figure, left - 11.0, bottom + height + 1.0, "ABCDEFGH"[len({p[:2] for p in panels[: index + 1]}) - 1])
    handles = [
        Line2D([], [], color=c, marker=m, markersize=4.0 if w else 7.0, linewidth=w, linestyle="-" if w else "none", label=n)
        for n, (c, m, w) in STYLES.items()
        if n in names
    ]
    ring = {"marker": "o", "markersize": 7.5, "markerfacecolor": "none", "markeredgecolor": "black", "color": "#D0D0D0"}
    handles.append(Line2D([], [], linewidth=4.0, markeredgewidth=0.6, label="Pareto front", **ring))
    figure.legend(handles=handles, loc="lower center", ncol=5, frameon=False, fontsize=6.5, columnspacing=1.2)
    figure.savefig(path, dpi=200)
    plt.close(figure)
    return True


def draw(rows: Sequence[Row], problems: Sequence[Problem], folder: Path) -> list[str]:
    """All pictures; the names of those that were made."""
    by_name = {p.name: p for p in problems}
    folder.mkdir(parents=True, exist_ok=True)
    return [name for name, panels in PICTURES.items() if draw_picture(rows, panels, by_name, folder / f"{name}.png")]


# ---- the page -------------------------------------------------------------------------------------


def table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    return "\n".join(["| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *lines]]) + "\n"


def short(number: float) -> str:
    """Two digits, never 2.3e+03."""
    if not math.isfinite(number):
        return ""
    return f"{float(f'{number:.2g}'):.0f}" if abs(number) >= 99.5 else f"{number:.2g}"


def percent(error: float) -> str:
    """An error as text."""
    return f"{short(100.0 * error)} %" if math.isfinite(error) else ""


def find(rows: Sequence[Row], choice: str, problem: str, measure: str, across: int, step: float | None = None) -> Row | None:
    """The row of a run."""
    for r in rows:
        same_step = math.isnan(r.level) if step is None else r.level == step
        if (r.choice, r.problem, r.measure, r.across) == (choice, problem, measure, across) and same_step:
            return r
    return None


def order(coarse: Row, fine: Row) -> float:
    """Observed order in the cells' size."""
    return math.log(coarse.error / fine.error) / math.log(fine.across / coarse.across)


def table_of_cells(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The default's errors over the cells across, with the observed order from the coarsest to the finest."""
    counts = sorted({r.across for r in rows if r.choice == DEFAULT_NAME and not by_soil(r.problem, problems)})
    lines = []
    for p in problems:
        for m in p.measures:
            found = [find(rows, DEFAULT_NAME, p.name, m.name, n) for n in counts]
            with_error = [r for r in found if r and math.isfinite(r.error)]
            if p.soil or not with_error:
                continue
            slope = f"{order(with_error[0], with_error[-1]):.1f}" if len(with_error) > 1 else ""
            cells = [f"{percent(r.error)} ({r.cpu_s:.2g} s)" if r and percent(r.error) else "" for r in found]
            lines.append([f"{p.title}: {m.name}", *cells, slope])
    return table(["", *[f"{n} across" for n in counts], "order"], lines)


def by_soil(name: str, problems: Sequence[Problem]) -> bool:
    """Whether the problem has soil."""
    return any(p.name == name and p.soil for p in problems)


def table_of_choices(rows: Sequence[Row], problems: Sequence[Problem], across: int) -> str:
    """Each choice at some cells across: time over the default's (median), error over the default's."""
    shown = [p for p in problems if not p.soil and find(rows, DEFAULT_NAME, p.name, MAIN[p.name][0], across)]
    lines = []
    for name in STYLES:
        cells, times = [], []
        for p in shown:
            own, base = (find(rows, n, p.name, MAIN[p.name][0], across) for n in (name, DEFAULT_NAME))
            if own is None or name == DEFAULT_NAME or base is None:
                cells.append("")
            elif own.status != "done":
                cells.append(own.status)
            else:
                times.append(own.cpu_s / base.cpu_s)
                ratio = own.error / base.error
                cells.append(short(ratio))
        if any(cells):
            lines.append([name, f"{np.median(times):.2f}" if times else "", *cells])
    base_cells = [find(rows, DEFAULT_NAME, p.name, MAIN[p.name][0], across) for p in shown]
    first = [DEFAULT_NAME, "1", *[percent(r.error) if r else "" for r in base_cells]]
    return table(["choice", "time", *[MAIN[p.name][1] for p in shown]], [first, *lines])


def table_of_targets(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The cheapest run with the default's numerics that keeps an error, for each problem without soil."""
    lines = []
    for p in problems:
        measure, name = MAIN[p.name]
        own = [r for r in rows if (r.problem, r.measure, r.status) == (p.name, measure, "done") and r.choice in OFFERED]
        own = [r for r in own if math.isfinite(r.error)]
        if p.soil or not own:
            continue
        cells = []
        for target in TARGETS:
            best = min((r for r in own if r.error <= target), key=lambda r: r.cpu_s, default=None)
            step = "" if best is None or math.isnan(best.level) else f", step x {best.level:g}"
            cells.append(f"{best.across} across{step}: {best.cpu_s:.2g} s" if best else "-")
        lines.append([name, *cells])
    return table(["error at most", *[percent(t) for t in TARGETS]], lines)


def time_per_cell_hour_ms(row: Row) -> float:
    """Processor time for one cell over one simulated hour, ms."""
    return 1e3 * row.cpu_s / (row.cells * row.hours)


def table_of_presets(rows: Sequence[Row]) -> str:
    """What each preset costs and how exact it is, 8 cells across."""
    lines = []
    for name in ("fast", "balanced", "reference"):
        found = [
            find(rows, f"preset {name}", problem, measure, 8)
            for problem, measure in (
                ("division", "axial rate"),
                ("division", "tip speed"),
                ("case1_balanced", "axial"),
                ("cantilever", "stiffness"),
            )
        ]
        if not all(found):
            continue
        rate = found[0]
        assert rate is not None
        errors = [percent(r.error) for r in found if r]
        lines.append([f"`{name}`", f"{time_per_cell_hour_ms(rate):.2f} ms", percent(rate.inertia_error), *errors])
    head = ["preset", "time per cell and hour", "inertia error", "axial rate", "tip speed", "Case 1 strain", "cantilever"]
    return table(head, lines)


def table_of_steps(rows: Sequence[Row]) -> str:
    """Inertia: step against errors in growth, 8 cells across."""
    own = [r for r in rows if (r.problem, r.choice, r.measure) == ("growth", "step", "axial rate") and r.across == 8]
    lines = []
    for r in sorted(own, key=lambda r: -r.level):
        tip = find(rows, "step", "growth", "tip speed", 8, r.level)
        lines.append(
            [
                f"{r.level:g}",
                f"{r.hours / r.steps:.2g} h" if math.isfinite(r.steps) else r.status,
                percent(r.inertia_error),
                percent(r.error),
                percent(tip.error) if tip else "",
                f"{r.cpu_s:.2g} s",
            ]
        )
    return table(["step over balanced's", "step", "inertia error", "axial rate", "tip speed", "time"], lines)


def table_of_the_paper(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The paper's scheme on every problem, 6 cells across, beside the default."""
    lines = []
    for p in problems:
        measure = MAIN[p.name][0]
        own, base = (find(rows, n, p.name, measure, 6) for n in (PAPER_NAME, DEFAULT_NAME))
        if own is None or base is None:
            continue
        if own.status == "done":
            told = [f"{percent(own.error)} ({own.cpu_s:.2g} s)", ""]
        else:
            told = [own.status, own.remark.removeprefix("rootsoil: from --set: ")]
        lines.append([f"{p.title}: {measure}", *told[:1], f"{percent(base.error)} ({base.cpu_s:.2g} s)", told[1]])
    return table(["", "paper's scheme", "default", ""], lines)


def table_of_soil(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """Every run with soil."""
    lines = []
    for p in (p for p in problems if p.soil):
        for m in p.measures:
            for r in (r for r in rows if (r.problem, r.measure) == (p.name, m.name)):
                told = percent(r.error) if r.status == "done" else r.status
                level = "" if math.isnan(r.level) else f" {r.level:g}"
                lines.append([f"{p.title}: {m.name}", r.choice + level, told or "compared with", f"{r.cpu_s:.2g} s"])
    return table(["problem", "choice", "error", "time"], lines)


PAGE = """\
<!-- SPDX-License-Identifier: MIT -->
<!-- Written by tools/accuracy_cost.py. What is changed here is lost. -->
# What accuracy costs

Small problems with known answers, computed in many ways. `tools/accuracy_cost.py` runs them, an hour at most on one core,
and writes this page, its pictures and [accuracy_cost.csv](accuracy_cost.csv), a row for each run and measure; it goes on
where it was stopped. Errors are those against the closed form, and only where there is none against the finest run.
Times are processor time of one thread, starting the program included. Made with {program}.

## What to choose

`[numerics] accuracy`, or `--accuracy`, chooses a preset. They were measured on growth and division, 8 regular cells across.
The inertia error is the run's own (unbalanced axial force over p times the section) at its end.

{presets}
More cells make a run dearer by the cube of their number across in 2D: four times the cells and, because the step follows
the cell, twice the steps. The cheapest run that was found for an error:

{targets}
What the tables below say:

- **Cells across** decide the error in growth, bending and contact. The **step** decides inertia; below twice balanced's it no
  longer shows in the strain rate, so that `fast` is nearly as exact as `balanced` where nothing is touched. Strain under
  pressure is exact to 0.1 % with any number of cells.
- Keep the cell-shaped kernel: isotropic ones take 2 to 6 times the time and are less exact, in bending by far.
- Keep the corrected gradient (plain: nothing comes out right), quadratic at surfaces (linear: bending is soft). Quadratic
  everywhere has a third of the error in growth and three times that in bending.
- Keep the compensation of inertia: without it the same step has ten times the error in growth.
- The predictor-corrector takes twice the time for the same result; so do short windows, but for contact.
- Non-affine control costs less than a tenth of the time; bending needs it.
- A path along an obstacle needs the small step of a quasi-static contact first, then cells.
- In soil keep the inertial number at 0.01: at 0.1 the forces are wrong by the order of themselves.

## Cells across

The default (preset balanced) with finer cells: error, processor time, and the order observed from the first to the last.

{cells}
An order near 0 stands where the error is no longer one of the cells' size: rounding of the settled state, the step, or
the divisions' places (one layer of cells that divides a moment earlier changes the mean length of its bin).

## The step

Inertia is numerical, and its error goes with the square of the step (growth, 8 across).

{steps}
## Every choice against the default

Errors over the default's at the same number of cells across (2 is twice the error), the time as a median over the
problems. The first row has the default's own errors. Where a run has no error, its reason: refused by the program, not
measured (it did not come to rest), too long; an empty place was not run.

6 cells across:

{choices6}
10 cells across:

{choices10}
Float against double is not offered: the program computes in double. Everything here is 2D.

## The paper's scheme

`pressure_deviator`, predictor-corrector, isotropic kernel (H_bar = 2, the smallest of Table 1), linear gradient, scalar
inertia, no compensation, no non-affine control; 6 cells across. It is refused where its waves grow by themselves. Its 0.1 % in
Case 1 is the law's: its pressure is linear in the density, the closed form's strain is logarithmic.

{paper}
## Soil

Tiny soils, one sample each. Where grains move past each other, a run differs from another one by chance: errors against the
finest run are then those of another history of the same soil, not of the choice; the growth of the root under the forces
that it meets is a closed form's.

{soil}
## Diagrams

One curve a choice, its points are numbers of cells across (the dashed curve: steps). The grey band is the Pareto front;
ringed runs lie on it: none is both cheaper and more exact. A choice that fails elsewhere can lie on a front by chance (the
plain gradient on the path's).

{pictures}
"""


def page(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """docs/accuracy_cost.md."""
    titles = {
        "accuracy_case1": "Strain under pressure",
        "accuracy_growth": "Growth and division",
        "accuracy_bending_contact": "Bending and contact",
        "accuracy_soil": "Soil",
    }
    made = [n for n, panels in PICTURES.items() if any(points_of(rows, *pair, "cpu_s") for pair in panels)]
    pictures = "\n".join(f"![{titles[n]}: error against processor time and against cells times steps](images/{n}.png)" for n in made)
    soil = table_of_soil(rows, problems)
    return PAGE.format(
        program=", ".join(sorted({r.program for r in rows})),
        presets=table_of_presets(rows),
        targets=table_of_targets(rows, problems),
        cells=table_of_cells(rows, problems),
        steps=table_of_steps(rows),
        choices6=table_of_choices(rows, problems, 6),
        choices10=table_of_choices(rows, problems, 10),
        paper=table_of_the_paper(rows, problems),
        soil=soil,
        pictures=pictures,
    )
