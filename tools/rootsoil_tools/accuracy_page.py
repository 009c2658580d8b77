# SPDX-License-Identifier: MIT
"""docs/accuracy_cost.md, from the rows of tools/accuracy_cost.py."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from rootsoil_tools.accuracy_grid import (
    CORRECTOR_NAME,
    DEFAULT_NAME,
    DIALS,
    EXPLICIT_NAME,
    OF_INERTIA,
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
from rootsoil_tools.work_precision import FAMILIES, PICTURES, STEPPERS_PICTURE, points_of

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
TARGETS = (0.03, 0.01, 0.003, 0.001)
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


def seconds(time_s: float) -> str:
    """A time as text."""
    return f"{time_s:.2g} s"


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
    return 1e3 * row.time_s / (row.cells * row.hours)


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
            cells = [f"{percent(r.error)} ({seconds(r.time_s)})" if r and percent(r.error) else "" for r in found]
            lines.append([f"{p.title}: {m.name}", *cells, slope])
    return table(["", *[f"{n} across" for n in counts], "order"], lines)


def table_of_choices(
    rows: Sequence[Row],
    problems: Sequence[Problem],
    choices: Sequence[NamedLevel],
    across: int,
    base: str = DEFAULT_NAME,
) -> str:
    """Choices (name, level) at some cells across: time over the base's (median), errors, or why there is none."""
    shown = [p for p in problems if p.name in MAIN and find(rows, base, p.name, MAIN[p.name][0], across)]
    lines = []
    for name, level in [(base, math.nan), *choices]:
        found = [find(rows, name, p.name, MAIN[p.name][0], across, level) for p in shown]
        bases = [find(rows, base, p.name, MAIN[p.name][0], across) for p in shown]
        times = [r.time_s / b.time_s for r, b in zip(found, bases) if r and b and r.status == b.status == "done"]
        if any(found):
            label = name if math.isnan(level) else f"{name} {level:g}"
            told = ["" if r is None else percent(r.error) if r.status == "done" else r.status for r in found]
            lines.append([label, f"{np.median(times):.2f}" if times else "", *told])
    return table(["choice", "time", *[MAIN[p.name][1] for p in shown]], lines)


def switches() -> list[NamedLevel]:
    """What is either or."""
    return [(choice.name, math.nan) for choice in SWITCHES]


def dials(base: str) -> list[NamedLevel]:
    """The levels of the choices that are numbers, of problems without soil."""
    found = (d for name in MAIN for d in DIALS[name] if d.base == base)
    return sorted({(d.name, level) for d in found for level in d.levels})


def with_inertia() -> list[NamedLevel]:
    """What is there beside the explicit stepper, and what it has for itself."""
    names = [CORRECTOR_NAME, PAPER_NAME, *(choice.name for choice in OF_INERTIA)]
    return [(name, math.nan) for name in names] + dials(EXPLICIT_NAME)


def table_of_targets(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """For each problem without soil and each stepper the cheapest run that keeps an error."""
    lines = []
    for p in (p for p in problems if p.name in MAIN):
        measure, name = MAIN[p.name]
        for family, (names, _, _) in FAMILIES.items():
            own = [r for r in rows if (r.problem, r.measure) == (p.name, measure) and r.choice in names]
            done = [r for r in own if r.status == "done" and math.isfinite(r.error)]
            cells = []
            for target in TARGETS:
                best = min((r for r in done if r.error <= target), key=lambda r: r.time_s, default=None)
                step = "" if best is None or math.isnan(best.level) else f", step x {best.level:g}"
                cells.append(f"{seconds(best.time_s)} ({best.across} across{step})" if best else "-")
            if done:
                lines.append([name, family, *cells])
            elif own:
                lines.append([name, family, own[0].status, *[""] * (len(TARGETS) - 1)])
    return table(["error at most", "stepper", *[percent(t) for t in TARGETS]], lines)


def table_of_presets(rows: Sequence[Row]) -> str:
    """What each preset costs and how exact it is, by stepper."""
    columns = (
        ("division", "axial rate"),
        ("division", "tip speed"),
        ("division", "cell length"),
        ("thrust", "arrest stress"),
        ("cantilever", "stiffness"),
    )
    lines = []
    for prefix in ("", f"{EXPLICIT_NAME}, "):
        for choice in PRESETS:
            name = prefix + choice.name
            if name == f"{EXPLICIT_NAME}, preset balanced":
                name = EXPLICIT_NAME
            found = [find(rows, name, *column, USUAL_ACROSS) for column in columns]
            rate = found[0]
            if rate is None:
                continue
            errors = ["" if r is None else percent(r.error) if r.status == "done" else r.status for r in found]
            label = f"{prefix}`{choice.name.removeprefix('preset ')}`"
            lines.append([label, f"{time_per_cell_hour_ms(rate):.2f} ms", percent(rate.unbalanced), *errors])
    head = ["preset", "time per cell and hour", "out of balance"]
    return table([*head, "axial rate", "tip speed", "cell length", "arrest stress", "cantilever"], lines)


def table_of_steps(rows: Sequence[Row], base: str, name: str, columns: Sequence[tuple[str, str]]) -> str:
    """The step against errors: of growth and division what it costs as well."""
    lines = []
    levels = sorted({r.level for r in rows if (r.choice, r.problem) == (name, "division")} | {1.0}, reverse=True)
    for level in levels:
        own = (base, math.nan) if level == 1.0 else (name, level)
        r = find(rows, own[0], "division", "axial rate", USUAL_ACROSS, own[1])
        if r is None:
            continue
        found = [find(rows, own[0], *column, USUAL_ACROSS, own[1]) for column in columns]
        lines.append(
            [
                f"{level:g}",
                f"{r.hours / r.steps:.2g} h" if r.status == "done" else r.status,
                percent(r.unbalanced),
                *[percent(f.error) if f else "" for f in found],
                seconds(r.time_s),
            ]
        )
    titles = [f"{MAIN[problem][1]}" if measure == MAIN[problem][0] else measure for problem, measure in columns]
    return table(["step over balanced's", "step", "out of balance", *titles, "time"], lines)


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
        lines.append([label, *told, seconds(growth.time_s), f"{growth.time_s / awake.time_s:.2f}"])
    return table(["`[sleep]`", "growth against the run without", "tip speed", "time", "over the time without"], lines)


def table_of_the_paper(rows: Sequence[Row], problems: Sequence[Problem]) -> str:
    """The paper's scheme on every problem beside the default."""
    lines = []
    for p in (p for p in problems if p.name in MAIN):
        measure = MAIN[p.name][0]
        own, base = (find(rows, n, p.name, measure, USUAL_ACROSS) for n in (PAPER_NAME, DEFAULT_NAME))
        if own is None or base is None:
            continue
        told = f"{percent(own.error)} ({seconds(own.time_s)})" if own.status == "done" else own.status
        remark = re.sub(r"^rootsoil: \S+\.toml(:\d+)?: ", "", own.remark)
        lines.append([f"{p.title}: {measure}", told, f"{percent(base.error)} ({seconds(base.time_s)})", remark])
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
                lines.append([f"{p.title}: {m.name}", label, value, error, seconds(r.time_s / samples)])
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

Small problems with known answers, computed in many ways. `tools/accuracy_cost.py` runs them, in 27 minutes on one core
beside other programs, and writes this page, its pictures and [accuracy_cost.csv](accuracy_cost.csv), a row for each run
and measure; it goes on where it was stopped, and `--part 1/2` and `--part 2/2` share the runs between two cores. Errors
are those against the closed form, and only where there is none against the finest run. Times are processor time of one
thread but for starting the program (0.02 to 0.2 s with these roots); since other programs ran as well, the same run
takes a third more or less.

{runs} Made with {program}.

The **default** ends every step in balance (`stepper = "quasi_static"`). It is compared with the **explicit** stepper
(`symplectic`: masses, many small steps), with the paper's **predictor-corrector** in the place of that one, and with
the **paper's whole scheme** (a section below).

## What to choose

![The steppers against each other: error against processor time](images/{steppers_picture}.png)

Every run of each stepper with its own knobs, cells across, step and preset; lines join those than which none of the
same stepper is both cheaper and more exact. The paper's whole scheme was refused where it is missing, and did not come
to rest under Euler's load. The finest run along the obstacle is 16 across in shorter steps: what stands there for 16
across is the step's error alone. The cheapest run that was found for an error:

{targets}
`[numerics] accuracy`, or `--accuracy`, chooses a preset. They were measured on growth and division, a root on a plate
and a cantilever, 8 regular cells across. What is out of balance is the run's own number: with the default
`force_imbalance` (rms force on a cell over p times its face), with the explicit stepper `inertia_error` (unbalanced
axial force over p times the section), mean over the run's second half.

{presets}
What the tables below say:

- **Steppers.** For the same error the default takes a fifth to a tenth of the explicit stepper's time in strain under
  pressure and under Euler's load, a sixth for a cantilever, half for a root on a plate, and a fiftieth along an
  obstacle, where the explicit one needs 40,000 steps (8 across) so that contact is no impact. In free growth it takes
  two thirds: the explicit one's inertia is compensated there, and four to eight times balanced's step does. Lengths of
  dividing cells to 0.1 % cost a third. The predictor-corrector takes nearly twice the explicit one's time for the same
  result. The paper's whole scheme takes more than ten times the default's time for isotropic strain; elsewhere it is
  refused, or does not bend as it should.
- **Cells across** decide the error in growth, bending and along an obstacle. Up to 16 across the default's time goes
  with their number squared, since its step does not follow the cell (explicit: cubed). Strain under pressure is exact
  to 0.1 % with any number of cells.
- The **step** hardly matters in growth: half of balanced's (`reference`) has seven eighths of its error in the strain
  rate, and nothing is gained below that. Cell lengths do not feel it, since cells divide at the start of the step in
  which they pass their threshold, and are at its end as if each had divided in its time. A root that is stopped
  within a single step is off by 0.1 to 0.6 % of its stress; within four steps by 0.02 to 0.09 %.
- The **force tolerance** buys nothing in growth and contact between 1e-3 and 1e-6, and costs nothing. What small forces
  bend needs it: a force must be large against the tolerance times p and a cell's face. A cantilever bent by 0.2 % of
  its length needs 1e-4 (`fast` has 1e-3: every step goes on bending it), a column with a force across of 8e-5 of p on a
  cell 1e-6.
- Keep the cell-shaped kernel: isotropic ones take 2 to 11 times the time and are less exact, the wide ones by far. A
  larger kernel (eta 2) has a seventh of the error of a cantilever for a fifth more in growth and a third more time.
- Keep the corrected gradient (plain: nothing comes out right), quadratic at surfaces (linear: bending is soft).
  Quadratic everywhere has nine tenths of the error in growth and twice that and more in bending.
- Non-affine control costs a sixth of the time and more; bending needs it, and a column finds no balance without.
- A path along an obstacle needs cells, 8 across; kernel, step and tolerance hardly matter to it.
- With the explicit stepper keep the compensation of inertia: without it the same step has ten times the error in
  growth.
- Sleep (`[sleep]`) takes about half the time where most of a small root is mature. With its default
  tolerances it changes growth by a thousandth of a percent, with 0.001 /h by 0.014 %.
- In soil keep the inertial number at 0.01 or below (at 0.1 forces are about twice as large) and the interval at 0.008 h
  or below (at 0.016 h a third of the force on the tip is lost). The other choices make no difference beyond the
  samples' scatter.

## Cells across

The default (preset balanced) with finer cells: error, processor time, and the order from the first to the last.

{cells}
An order near 0 stands where the error is no longer one of the cells' size: the settled state's rounding, or the step.

## The step

Steps that end in balance, 8 cells across; time and what is out of balance are those of growth and division.

{steps}
The explicit stepper's. Its inertia is numerical, and the error of it goes with the square of the step.

{explicit_steps}
## Every choice against the default

Errors, and the time over the default's as a median over the problems. Where a run has no error, its reason: refused by
the program, not measured (it did not come to rest), unphysical (it broke), too long (over 90 s); an empty place is one
that was not run. Wide isotropic kernels were not run at 12 across, where they take ten times the default's time and
more.

8 cells across, what is either or:

{switches8}
12 cells across:

{switches12}
8 cells across, numbers (the default: eta 1.5, force tolerance 1e-4, for Euler's load 1e-7; step 1 times preset
balanced's):

{dials}
Beside the explicit stepper, 8 cells across; the times are over the explicit stepper's own:

{explicit8}
Float against double is not offered: the program computes in double. Everything here is 2D.

## Sleep

A root of 4 mm of which 1.7 mm grow, 8 cells across, 3 h. Tissue that strains no faster than `strain_rate_per_h` is left
out of the computation; `stress_change` (here with a strain rate of 0.001 /h) is what wakes it again. The defaults are
1e-4 /h and 0.05. A tolerance that freezes tissue which still strains saves little and spoils growth: the stress of
what is frozen changes, and all wakes, over and over. So does a `stress_change` below the ripples that are always there.

{sleep}
## The paper's scheme

`pressure_deviator`, predictor-corrector, isotropic kernel (H_bar = 2, the smallest of Table 1), linear gradient, scalar
inertia, no compensation, no non-affine control; 8 cells across. It is refused where its waves grow by themselves.

{paper}
## Soil

Tiny soils, three samples of each: mean ± standard deviation over the samples; an error against the finest run is that
of the same sample (other grain stiffness: of a sample packed with it). For the grain between probe and stone, where
nothing is left to chance: over three stretches of the probe's way.

- The **inertial number** decides. The force on a grain between probe and stone goes to Hertz's with it; what is left
  are the grain's inertia and YADE's damping of its motion. At 0.1 Q is twice and the force on the tip 1.7 times that
  of the finest run, at 0.03 both are a third too large; at the default 0.01 they lie within the scatter of those at
  0.003 and less.
- The **interval** between exchanges is the root's step. Up to 0.008 h it makes no difference beyond the scatter; at
  0.016 h the tip meets a quarter to a half less force in every sample, while the explicit stepper, which takes many
  steps in an interval, meets the same as at 0.004 h.
- **Substeps and marker spacing** make no difference beyond the scatter. Growth under the forces that the root meets
  follows the closed form within 1 %, and closer with markers at 0.4 of their radius. The explicit stepper's root meets
  the same forces and grows alike.
- **Grain stiffness** belongs to the soil as much as to the numerics: stiffer grains resist more.

{soil}
## Diagrams

One curve a choice, its points are numbers of cells across or, of choices that are numbers, their values (dashed;
through the run of the default, or of the explicit stepper). The grey band is the Pareto front; ringed runs lie on it:
none is both cheaper and more exact. A choice that fails elsewhere can lie on a front by chance.

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
    made = [n for n, panels in PICTURES.items() if any(points_of(rows, *pair) for pair in panels)]
    pictures = "\n".join(f"![{titles[name]}: error against cost](images/{name}.png)" for name in made)
    growth = [("division", "axial rate"), ("division", "tip speed"), ("division", "cell length")]
    return PAGE.format(
        program=", ".join(sorted({r.program for r in rows})),
        runs=what_was_run(rows, problems),
        steppers_picture=STEPPERS_PICTURE,
        presets=table_of_presets(rows),
        targets=table_of_targets(rows, problems),
        cells=table_of_cells(rows, problems),
        steps=table_of_steps(rows, DEFAULT_NAME, "step", [*growth, ("thrust", "arrest stress"), ("path", "path")]),
        explicit_steps=table_of_steps(rows, EXPLICIT_NAME, "explicit, step", [*growth, ("path", "path")]),
        switches8=table_of_choices(rows, problems, switches(), USUAL_ACROSS),
        switches12=table_of_choices(rows, problems, switches(), FINE_ACROSS),
        dials=table_of_choices(rows, problems, dials(DEFAULT_NAME), USUAL_ACROSS),
        explicit8=table_of_choices(rows, problems, with_inertia(), USUAL_ACROSS, EXPLICIT_NAME),
        sleep=table_of_sleep(rows),
        paper=table_of_the_paper(rows, problems),
        soil=table_of_soil(rows, problems),
        pictures=pictures,
    )
