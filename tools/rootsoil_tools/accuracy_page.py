# SPDX-License-Identifier: MIT
"""docs/accuracy_cost.md, from the rows of tools/accuracy_cost.py."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from rootsoil_tools.accuracy_grid import (
    DEFAULT_NAME,
    DIALS,
    PAPER_NAME,
    PRESETS,
    SLEEP,
    SWITCHES,
    USUAL_ACROSS,
    full_grid,
    place_of_task,
)
from rootsoil_tools.accuracy_table import Row, deviations, numbers, place_of
from rootsoil_tools.pages import table
from rootsoil_tools.problems import Problem
from rootsoil_tools.work_precision import PICTURES, points_of

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
}
OFFERED = (DEFAULT_NAME, "step", *(choice.name for choice in PRESETS))
TARGETS = (0.1, 0.03, 0.01, 0.003, 0.001, 0.0003)
FINE_ACROSS = 12
NamedLevel = tuple[str, float]  # of a choice; NaN where it has none


# ---- text -----------------------------------------------------------------------------------------


def short(number: float) -> str:
    """Two digits, never 2.3e+03."""
    if not math.isfinite(number):
        return ""
    return f"{float(f'{number:.2g}'):.0f}" if abs(number) >= 99.5 else f"{number:.2g}"


def percent(error: float) -> str:
    """An error as text."""
    return f"{short(100.0 * error)} %" if math.isfinite(error) else ""


def spread(values: np.ndarray, unit: str = "", sign: str = "") -> str:
    """Mean and standard deviation of samples, to a digit of the deviation."""
    deviation = float(values.std(ddof=1))
    digits = max(0, 1 - math.floor(math.log10(deviation))) if 0.0 < deviation < 10.0 else 0
    return f"{values.mean():{sign}.{digits}f} ± {deviation:.{digits}f}{unit}"


# ---- rows -----------------------------------------------------------------------------------------


def find(
    rows: Sequence[Row], choice: str, problem: str, measure: str, across: int, level: float = math.nan
) -> Row | None:
    """The row of a run."""
    for r in rows:
        same_level = r.level == level or (math.isnan(level) and math.isnan(r.level))
        if (r.choice, r.problem, r.measure, r.across) == (choice, problem, measure, across) and same_level:
            return r
    return None


def order(coarse: Row, fine: Row) -> float:
    """Observed order in the cells' size."""
    return math.log(coarse.error / fine.error) / math.log(fine.across / coarse.across)


def time_per_cell_hour_ms(row: Row) -> float:
    """Processor time for one cell over one simulated hour, ms."""
    return 1e3 * row.cpu_s / (row.cells * row.hours)


# ---- tables ---------------------------------------------------------------------------------------


def table_of_cells(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The default's errors over the cells across, with the observed order from the coarsest to the finest."""
    shown = [p for p in problems if p.name in MAIN]
    counts = sorted({r.across for r in rows if r.choice == DEFAULT_NAME and r.problem in MAIN})
    lines = []
    for p in shown:
        for m in p.measures:
            found = [find(rows, DEFAULT_NAME, p.name, m.name, n) for n in counts]
            with_error = [r for r in found if r and math.isfinite(r.error)]
            if not with_error:
                continue
            slope = f"{order(with_error[0], with_error[-1]):.1f}" if len(with_error) > 1 else ""
            cells = [f"{percent(r.error)} ({r.cpu_s:.2g} s)" if r and percent(r.error) else "" for r in found]
            lines.append([f"{p.title}: {m.name}", *cells, slope])
    return table(["", *[f"{n} across" for n in counts], "order"], lines)


def compared(own: Row | None, base: Row | None) -> tuple[str, float]:
    """A run's error over the default's, or why it has none; its time over the default's, NaN without."""
    if own is None or base is None:
        return "", math.nan
    if own.status != "done":
        return own.status, math.nan
    return short(own.error / base.error), own.cpu_s / base.cpu_s


def table_of_choices(
    rows: Sequence[Row], problems: Sequence[Problem], choices: Sequence[NamedLevel], across: int
) -> str:
    """Choices (name, level) at some cells across: time over the default's (median), error over the default's."""
    shown = [p for p in problems if p.name in MAIN and find(rows, DEFAULT_NAME, p.name, MAIN[p.name][0], across)]
    base = {p.name: find(rows, DEFAULT_NAME, p.name, MAIN[p.name][0], across) for p in shown}
    lines = [[DEFAULT_NAME, "1", *[percent(r.error) if r else "" for r in base.values()]]]
    for name, level in choices:
        found = [compared(find(rows, name, p.name, MAIN[p.name][0], across, level), base[p.name]) for p in shown]
        times = [time for _, time in found if math.isfinite(time)]
        if any(text for text, _ in found):
            label = name if math.isnan(level) else f"{name} {level:g}"
            lines.append([label, f"{np.median(times):.2f}" if times else "", *[text for text, _ in found]])
    return table(["choice", "time", *[MAIN[p.name][1] for p in shown]], lines)


def switches() -> list[NamedLevel]:
    """What is either or."""
    return [(choice.name, math.nan) for choice in SWITCHES]


def dials() -> list[NamedLevel]:
    """The levels of the choices that are numbers, of problems without soil."""
    return list(dict.fromkeys((d.name, level) for name in MAIN for d in DIALS[name] for level in d.levels))


def table_of_targets(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The cheapest run with the default's numerics that keeps an error, for each problem without soil."""
    lines = []
    for p in (p for p in problems if p.name in MAIN):
        measure, name = MAIN[p.name]
        own = [r for r in rows if (r.problem, r.measure, r.status) == (p.name, measure, "done") and r.choice in OFFERED]
        own = [r for r in own if math.isfinite(r.error)]
        if not own:
            continue
        cells = []
        for target in TARGETS:
            best = min((r for r in own if r.error <= target), key=lambda r: r.cpu_s, default=None)
            step = "" if best is None or math.isnan(best.level) else f", step x {best.level:g}"
            cells.append(f"{best.across} across{step}: {best.cpu_s:.2g} s" if best else "-")
        lines.append([name, *cells])
    return table(["error at most", *[percent(t) for t in TARGETS]], lines)


def table_of_presets(rows: Sequence[Row]) -> str:
    """What each preset costs and how exact it is."""
    columns = (
        ("division", "axial rate"),
        ("division", "tip speed"),
        ("case1_balanced", "axial"),
        ("cantilever", "stiffness"),
    )
    lines = []
    for choice in PRESETS:
        found = [find(rows, choice.name, *column, USUAL_ACROSS) for column in columns]
        rate = found[0]
        if rate is None or not all(found):
            continue
        errors = [percent(r.error) for r in found if r]
        name = choice.name.removeprefix("preset ")
        lines.append([f"`{name}`", f"{time_per_cell_hour_ms(rate):.2f} ms", percent(rate.inertia_error), *errors])
    head = [
        "preset",
        "time per cell and hour",
        "inertia error",
        "axial rate",
        "tip speed",
        "Case 1 strain",
        "cantilever",
    ]
    return table(head, lines)


def table_of_steps(rows: Sequence[Row]) -> str:
    """Inertia: step against errors in growth."""
    own = [r for r in rows if (r.problem, r.measure, r.across) == ("growth", "axial rate", USUAL_ACROSS)]
    levels = [(r.level if r.choice == "step" else 1.0, r) for r in own if r.choice in ("step", DEFAULT_NAME)]
    lines = []
    for level, r in sorted(levels, key=lambda pair: -pair[0]):
        tip = find(rows, r.choice, "growth", "tip speed", USUAL_ACROSS, r.level)
        lines.append(
            [
                f"{level:g}",
                f"{r.hours / r.steps:.2g} h" if math.isfinite(r.steps) else r.status,
                percent(r.inertia_error),
                percent(r.error),
                percent(tip.error) if tip else "",
                f"{r.cpu_s:.2g} s",
            ]
        )
    return table(["step over balanced's", "step", "inertia error", "axial rate", "tip speed", "time"], lines)


def table_of_sleep(rows: Sequence[Row]) -> str:
    """Tolerances of [sleep] against errors and time."""
    awake = find(rows, DEFAULT_NAME, "sleep", "growth", USUAL_ACROSS)
    if awake is None:
        return ""
    lines = []
    for name, level in [(DEFAULT_NAME, math.nan), *((dial.name, level) for dial in SLEEP for level in dial.levels)]:
        growth, tip = (find(rows, name, "sleep", measure, USUAL_ACROSS, level) for measure in ("growth", "tip speed"))
        if growth is None or tip is None:
            continue
        done = growth.status == "done"
        told = [percent(growth.error) or "compared with", percent(tip.error)] if done else [growth.status, ""]
        label = "without" if name == DEFAULT_NAME else f"{name.removeprefix('sleep, ')} {level:g}"
        lines.append([label, *told, f"{growth.cpu_s:.2g} s", f"{growth.cpu_s / awake.cpu_s:.2f}"])
    return table(["`[sleep]`", "growth against the run without", "tip speed", "time", "over the time without"], lines)


def table_of_the_paper(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The paper's scheme on every problem beside the default."""
    lines = []
    for p in (p for p in problems if p.name in MAIN):
        measure = MAIN[p.name][0]
        own, base = (find(rows, n, p.name, measure, USUAL_ACROSS) for n in (PAPER_NAME, DEFAULT_NAME))
        if own is None or base is None:
            continue
        told = f"{percent(own.error)} ({own.cpu_s:.2g} s)" if own.status == "done" else own.status
        remark = re.sub(r"^rootsoil: \S+\.toml(:\d+)?: ", "", own.remark)
        lines.append([f"{p.title}: {measure}", told, f"{percent(base.error)} ({base.cpu_s:.2g} s)", remark])
    return table(["", "paper's scheme", "default", ""], lines)


def table_of_soil(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """Every run with soil: the measure itself where it is compared with another run, its error, time of a sample."""
    lines = []
    for p in (p for p in problems if p.soil):
        for m in p.measures:
            for r in (r for r in rows if (r.problem, r.measure) == (p.name, m.name)):
                found, label = deviations(r, m, rows), r.choice if math.isnan(r.level) else f"{r.choice} {r.level:g}"
                value = spread(numbers(r)) if m.finest and r.status == "done" else ""
                told = "compared with" if found is None else spread(100.0 * found, " %", "+")
                error = told if r.status == "done" else r.status
                samples = max(len(numbers(r)), 1) if p.name != "hertz" else 1
                lines.append([f"{p.title}: {m.name}", label, value, error, f"{r.cpu_s / samples:.2g} s"])
    return table(["problem", "choice", "value", "error", "time of a sample"], lines)


def what_was_run(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """How many runs the grid has and what became of them."""
    planned = {place_of_task(task) for task in full_grid(problems)}
    status = {place_of(row): row.status for row in rows if place_of(row) in planned}
    counts = Counter(status.values())
    told = [f"{counts[name]} {name}" for name in sorted(counts, key=lambda n: (n != "done", n))]
    missing = len(planned) - len(status)
    return f"Of the grid's {len(planned)} runs: {', '.join(told)}{f'; {missing} not made yet' if missing else ''}."


PAGE = """\
<!-- SPDX-License-Identifier: MIT -->
<!-- Written by tools/accuracy_cost.py. What is changed here is lost. -->
# What accuracy costs

Small problems with known answers, computed in many ways. `tools/accuracy_cost.py` runs them, in 35 minutes on one core,
and writes this page, its pictures and [accuracy_cost.csv](accuracy_cost.csv), a row for each run and measure; it goes
on where it was stopped, and `--part 1/2` and `--part 2/2` share the runs between two cores. Errors are those against
the closed form, and only where there is none against the finest run. Times are processor time of one thread, starting
the program included: time on the wall where a core is free.

{runs} Made with {program}.

## What to choose

`[numerics] accuracy`, or `--accuracy`, chooses a preset. They were measured on growth and division, 8 regular cells
across. The inertia error is the run's own (unbalanced axial force over p times the section) at its end.

{presets}
More cells make a run dearer by the cube of their number across in 2D: four times the cells and, because the step
follows the cell, twice the steps. The cheapest run that was found for an error:

{targets}
What the tables below say:

- **Cells across** decide the error in growth, bending and contact. The **step** decides inertia; below twice balanced's
  it no longer shows in the strain rate, so that `fast` is nearly as exact as `balanced` where nothing is touched.
  Strain under pressure is exact to 0.1 % with any number of cells.
- Keep the cell-shaped kernel: isotropic ones take 2 to 9 times the time and are less exact, the wide ones by far. A
  larger kernel (eta 2) has a seventh to a third of the error in bending, for a third more in growth and in time.
- Keep the corrected gradient (plain: nothing comes out right), quadratic at surfaces (linear: bending is soft).
  Quadratic everywhere has three quarters of the error in growth and twice that in bending and contact.
- Keep the compensation of inertia: without it the same step has ten to twenty times the error in growth.
- The predictor-corrector takes nearly twice the time for the same result; so do short windows, of which only the
  lengths of dividing cells gain: cells divide between windows.
- Non-affine control costs a fifth of the time; bending and contact need it.
- A path along an obstacle needs cells: from 8 across on nothing else matters much to it.
- Sleep (`[sleep]`) with its default tolerances takes half the time where most of a root is mature, and changes growth
  by less than a thousandth of a percent.
- In soil keep the inertial number at 0.01 or below: at 0.1 the forces are twice as large. The other choices make no
  difference beyond the samples' scatter.

## Cells across

The default (preset balanced) with finer cells: error, processor time, and the order from the first to the last.

{cells}
An order near 0 stands where the error is no longer one of the cells' size: rounding of the settled state, or the step.

## The step

Inertia is numerical, and its error goes with the square of the step (growth, 8 across).

{steps}
## Every choice against the default

Errors over the default's at the same number of cells across (2 is twice the error), the time as a median over the
problems. The first row has the default's own errors. Where a run has no error, its reason: refused by the program, not
measured (it did not come to rest), too long (over 90 s); an empty place is one where the choice means nothing, or, on
the path, the run that the others are compared with. Wide isotropic kernels were not run at 12 across: they take 8 to 14
times the default's time there.

8 cells across, what is either or:

{switches8}
12 cells across:

{switches12}
8 cells across, numbers (the default: window 20, eta 1.5, step 1 times preset balanced's):

{dials}
Float against double is not offered: the program computes in double. Everything here is 2D.

## Sleep

A root of 4 mm of which 1.7 mm grow, 8 cells across, 3 h. Tissue that strains no faster than `strain_rate_per_h` is left
out of the computation; `stress_change` (here with a strain rate of 0.001 /h) is what wakes it again. A tolerance that
freezes tissue which still strains saves nothing: the stress of what is frozen changes, and all wakes, over and over. So
does a `stress_change` below the ripples that are always there.

{sleep}
## The paper's scheme

`pressure_deviator`, predictor-corrector, isotropic kernel (H_bar = 2, the smallest of Table 1), linear gradient, scalar
inertia, no compensation, no non-affine control; 8 cells across. It is refused where its waves grow by themselves. Its
0.1 % in Case 1 is the law's: its pressure is linear in the density, the closed form's strain is logarithmic.

{paper}
## Soil

Tiny soils, three samples of each: mean ± standard deviation over the samples; an error against the finest run is that
of the same sample (other grain stiffness: of a sample packed with it). For the grain between probe and stone, where
nothing is left to chance: over three stretches of the probe's way.

- The **inertial number** decides. The force on a grain between probe and stone goes to Hertz's with it; what is left
  are the grain's inertia and YADE's damping of its motion. Q and the force on the tip are about twice as large at 0.1
  and a third too large at 0.03; at the default 0.01 they lie within the scatter of those at a fifth of it and less.
- **Interval, substeps and marker spacing** make no difference beyond the scatter. Growth under the forces that the root
  meets follows the closed form within 1 %, and closer with markers at 0.4 of their radius.
- **Grain stiffness** belongs to the soil as much as to the numerics: stiffer grains resist more.

{soil}
## Diagrams

One curve a choice, its points are numbers of cells across or, of choices that are numbers, their values (dashed;
through the default's run). The grey band is the Pareto front; ringed runs lie on it: none is both cheaper and more
exact. A choice that fails elsewhere can lie on a front by chance.

{pictures}
"""


def page(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """docs/accuracy_cost.md."""
    titles = {
        "accuracy_case1": "Strain under pressure",
        "accuracy_growth": "Growth and division",
        "accuracy_sleep": "Sleep",
        "accuracy_bending_contact": "Bending and contact",
        "accuracy_soil": "Soil",
    }
    made = [n for n, panels in PICTURES.items() if any(points_of(rows, *pair, "cpu_s") for pair in panels)]
    pictures = "\n".join(f"![{titles[name]}: error against cost](images/{name}.png)" for name in made)
    return PAGE.format(
        program=", ".join(sorted({r.program for r in rows})),
        runs=what_was_run(rows, problems),
        presets=table_of_presets(rows),
        targets=table_of_targets(rows, problems),
        cells=table_of_cells(rows, problems),
        steps=table_of_steps(rows),
        switches8=table_of_choices(rows, problems, switches(), USUAL_ACROSS),
        switches12=table_of_choices(rows, problems, switches(), FINE_ACROSS),
        dials=table_of_choices(rows, problems, dials(), USUAL_ACROSS),
        sleep=table_of_sleep(rows),
        paper=table_of_the_paper(rows, problems),
        soil=table_of_soil(rows, problems),
        pictures=pictures,
    )
