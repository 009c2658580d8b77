# SPDX-License-Identifier: MIT
"""What tools/stability.py found: rows, CSV files, the map as a picture, docs/stability.md."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap

from rootsoil_tools import draw
from rootsoil_tools.criteria import GENERAL, Finding

BINARY = ("finished", "finite", "cells_kept", "restart")  # kept or not: a margin has no middle
MOST_RECORDED = 100.0  # a margin beyond is not guarded more tightly
ROOM = 0.7  # recorded over measured
BASE_RATE_PER_H = 0.40  # largest strain rate of the base case
USUAL_STEP_H = 0.1  # that the program takes for it
REFUSED, TOO_LONG = "refused", "not finished"  # how what is said of an edge begins where no criterion failed
PASSES, FAILS = "#2C7FB8", "#D55E00"


@dataclass(frozen=True)
class CaseRow:
    """A hard case under one scheme and criterion. `message`: what the program said where it broke off."""

    case: str
    meaning: str
    scheme: str
    hours: float
    criterion: str
    value: float
    bound: float
    margin: float
    passed: bool
    message: str

    @classmethod
    def of(cls, case: str, meaning: str, scheme: str, hours: float, finding: Finding, message: str) -> CaseRow:
        """The row of a finding."""
        criterion = finding.criterion
        return cls(case, meaning, scheme, hours, criterion.name, finding.value, criterion.bound, finding.margin,
                   finding.passed, message)  # fmt: skip


@dataclass(frozen=True)
class EdgeRow:
    """How far the stable region reaches from `start` to `furthest`: stable at `good`, not at `bad` for `failed`."""

    edge: str
    unit: str
    meaning: str
    scheme: str
    start: float
    furthest: float
    good: float | None = None
    bad: float | None = None
    failed: str = ""

    def ended(self, good: float | None, bad: float | None, failed: str) -> EdgeRow:
        """The row with the search's end."""
        return replace(self, good=good, bad=bad, failed=failed)

    def text(self) -> str:
        """A line."""
        return f"{self.meaning} ({self.scheme}): {self.verdict()}"

    def verdict(self) -> str:
        """The end in words."""
        unit = "" if self.unit == "-" else f" {self.unit}"
        if self.good is None:
            return f"not stable at {self.start:.3g}{unit} ({self.failed})"
        if self.bad is None:
            return f"stable to {self.good:.3g}{unit}, the furthest tried"
        told = self.failed.startswith((REFUSED, TOO_LONG))
        end = self.failed if told else f"fails: {self.failed}"
        return f"stable to {self.good:.3g}{unit}; at {self.bad:.3g} {end}"


@dataclass(frozen=True)
class Bound:
    """The least margin (edges: the least reach, times `start`) that tests accept."""

    case: str
    criterion: str
    least: float


def write_rows(path: Path, rows: Sequence[Any]) -> None:
    """Dataclasses of one kind as a CSV file."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(rows[0])], lineterminator="\n")
        writer.writeheader()
        for row in rows:
            values = asdict(row).items()
            writer.writerow({name: f"{value:.4g}" if isinstance(value, float) else value for name, value in values})


def read_rows(path: Path) -> list[dict[str, str]]:
    """The rows of such a file, as text."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def reach(row: EdgeRow) -> float:
    """How many times its start an edge lies away, upwards or downwards; 0 where the start is not stable."""
    return max(row.good / row.start, row.start / row.good) if row.good else 0.0


def recorded_bounds(cases: Iterable[CaseRow], edges: Iterable[EdgeRow]) -> list[Bound]:
    """Bounds with some room below what was measured, for the default scheme."""
    bounds = []
    for row in cases:
        if row.scheme == "default":
            least = 1.0 if row.criterion in BINARY else min(max(1.0, ROOM * row.margin), MOST_RECORDED)
            bounds.append(Bound(row.case, row.criterion, float(f"{least:.2g}")))
    bounds += [Bound(f"edge {row.edge}", "reach", float(f"{ROOM * reach(row):.2g}")) for row in edges]
    return bounds


def by_case(rows: Iterable[CaseRow]) -> dict[str, dict[str, list[CaseRow]]]:
    """Rows by case and scheme, in their order."""
    table: dict[str, dict[str, list[CaseRow]]] = {}
    for row in rows:
        table.setdefault(row.case, {}).setdefault(row.scheme, []).append(row)
    return table


def verdict(rows: list[CaseRow]) -> str:
    """A case under a scheme in words: its tightest margin, or what it fails."""
    if not rows:
        return "-"
    failed = [row for row in rows if not row.passed]
    unfinished = next((row for row in failed if row.criterion == "finished"), None)
    if unfinished:
        return f"**breaks** at {unfinished.value * unfinished.hours:.2g} h"
    if failed:
        return "**fails**: " + ", ".join(f"{row.criterion} {row.value:.2g} (bound {row.bound:g})" for row in failed)
    scaled = [row for row in rows if row.criterion not in BINARY]
    tightest = min(scaled, key=lambda row: row.margin)
    return f"stable, {tightest.criterion} {tightest.margin:.2g} times within its bound"


# ---- the map --------------------------------------------------------------------------------------


def margin_panel(axes: Axes, cases: list[CaseRow]) -> None:
    """Cases against criteria: the darker, the larger the margin; failed ones stand out. Beside, the paper's verdict."""
    table = by_case(cases)
    names = [criterion.name for criterion in GENERAL] + ["restart"]
    columns = [*names, "case's own", "paper's scheme"]
    shades = LinearSegmentedColormap.from_list("margin", ["#DCEBF5", PASSES])
    for y, schemes in enumerate(table.values()):
        cells: dict[str, CaseRow] = {}
        for row in schemes.get("default", []):
            name = row.criterion if row.criterion in names else "case's own"
            if name not in cells or row.margin < cells[name].margin:
                cells[name] = row
        paper = schemes.get("paper", [])
        if paper:
            broken = [row for row in paper if row.criterion == "finished" and not row.passed]
            scaled = [row for row in paper if not row.passed or row.criterion not in BINARY]
            cells["paper's scheme"] = broken[0] if broken else min(scaled, key=lambda row: row.margin)
        for x, column in enumerate(columns):
            if column not in cells:
                continue
            row = cells[column]
            binary = column in BINARY
            strength = 1.0 if binary else np.clip(np.log10(max(row.margin, 1.0)) / 2.0, 0.0, 1.0)
            colour = shades(strength) if row.passed else FAILS
            axes.add_patch(plt.Rectangle((x - 0.46, y - 0.44), 0.92, 0.88, color=colour, linewidth=0))
            label = "" if binary and row.passed else "fails" if not row.passed else short(row.margin)
            if row.criterion == "finished" and not row.passed:
                label = "breaks"
            dark = strength > 0.6 or not row.passed
            axes.text(x, y, label, ha="center", va="center", size=5, color="white" if dark else "black")
    axes.set(xlim=(-0.6, len(columns) - 0.4), ylim=(len(table) - 0.4, -0.6))
    axes.set_yticks(range(len(table)), [name.replace("_", " ") for name in table])
    axes.set_xticks(range(len(columns)), [name.replace("_", " ") for name in columns], rotation=45, ha="left")
    axes.xaxis.tick_top()
    axes.tick_params(length=0, labelsize=6)
    for spine in axes.spines.values():
        spine.set_visible(False)


def short(margin: float) -> str:
    """A margin in a few characters."""
    return f"{margin:.1f}" if margin < 10.0 else f"{margin:.0f}" if margin < 1000.0 else ">1000"


def edge_panel(axes: Axes, edges: list[EdgeRow]) -> None:
    """How many times its start each quantity can be moved: bars; an arrow where the furthest tried is stable."""
    names = list(dict.fromkeys(row.edge for row in edges))
    meaning = {row.edge: row for row in edges}
    colours = {"default": draw.SIMULATION, "paper": draw.DATA}
    for row in edges:
        y = names.index(row.edge) + (0.19 if row.scheme == "paper" else -0.19 if len(edges) > len(names) else 0.0)
        if row.good is None:
            axes.text(1.1, y, f"not stable at {row.start:g}", size=5, va="center", color=colours[row.scheme])
            continue
        times = reach(row)
        axes.barh(y, times - 1.0, left=1.0, height=0.34, color=colours[row.scheme], linewidth=0)
        unit = "" if row.unit == "-" else f" {row.unit}"
        begins = {REFUSED: ", refused beyond", TOO_LONG: ", takes too long beyond"}
        ends = [text for begin, text in begins.items() if row.failed.startswith(begin)]
        end = ", furthest tried" if row.bad is None else "".join(ends)
        axes.text(max(times, 1.0) * 1.15, y, f"{row.good:.3g}{unit}{end}", size=5, va="center")
    axes.set_xscale("log")
    axes.set(xlim=(1.0, 3e5), ylim=(len(names) - 0.4, -0.6), xlabel="stable up to this many times the start")
    labels = ["{}\nfrom {:g}".format(meaning[name].meaning.replace(", ", ",\n"), meaning[name].start) for name in names]
    axes.set_yticks(range(len(names)), labels)
    axes.tick_params(axis="y", length=0, labelsize=6)
    handles = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour in colours.values()]
    axes.legend(handles, ["default scheme", "paper's scheme, E_R = E_A"], frameon=False, loc="lower left",
                bbox_to_anchor=(0.0, 1.0), fontsize=6)  # fmt: skip


def draw_map(cases: list[CaseRow], edges: list[EdgeRow], out: Path) -> None:
    """Both panels on one page."""
    draw.use_style()
    height = 4.3 * len(by_case(cases))
    figure = draw.new_figure(262.0, height + 30.0)
    margin_panel(draw.place(figure, 30.0, 5.0, 108.0, height), cases)
    edge_panel(draw.place(figure, 190.0, 12.0, 68.0, height - 10.0), edges)
    draw.letter(figure, 4.0, height + 22.0, "A")
    draw.letter(figure, 146.0, height + 22.0, "B")
    figure.savefig(out, dpi=draw.DOTS_PER_INCH)
    plt.close(figure)


# ---- the page -------------------------------------------------------------------------------------

PAGE = """<!-- SPDX-License-Identifier: MIT -->
# What stays stable

`tools/stability.py` wrote this page ({minutes}; `--quick`: half a minute). The cases are in
`tests/stability/hard_cases.py`, the criteria in `tools/rootsoil_tools/criteria.py`; `tests/stability` runs the short
versions and fails when a margin falls below the one recorded in `tests/stability/recorded_margins.csv`.

![A: hard cases and criteria, margins as multiples of the bound. B: edges of the stable region](images/stability.png)

{count}

The paper's scheme is Eq. 1-4 to the letter (`law = "pressure_deviator"`), isotropic kernel, linear gradient,
predictor-corrector, inertia from the stability bound. It needs `allow_unstable` where it is not hyperbolic, which is
nearly everywhere at E_R/E_A = 15, and breaks there within a third of an hour in 2D.

## What to do with it

{advice}
- **Width.** One, two and three cells across are stable; what they bend like is another matter (docs/accuracy_cost.md).
- **Contact.** Steps in which no balance is found, as where a root first touches a wall or buckles, are cut, down to a
  sixtieth here. Growing tissue yields: pressed for hours it folds, and where it folds stress is concentrated.
- **Curling.** A root of unequal cells (`irregular`) curls, and the step decides a little how fast: after 3.3 h it spans
  0.178 mm across with the default's steps of 0.1 h, 0.154 mm with 0.02 h and with all shorter ones. Inertia holds such
  a root straight: with the explicit stepper it spans 0.113, 0.134 and 0.153 mm with steps of 1e-3, 2.5e-4 and 6e-5 h.
- **Not in the model.** A root that meets itself does not notice.

## Criteria

A run is stable when every number keeps its bound in every frame. The margin is how many times better than that it is.
Steps that end in balance have no kinetic energy; that number is there for schemes with inertia.

{criteria}

## Hard cases

The default scheme runs the hours given, {restart}; the paper's runs a shorter version.

{cases}

## Edges of the stable region

Found by bisection in the logarithm, to {resolution:.0f} %, on the base case of 200 cells. The paper's scheme is tried
with E_R = E_A and growth that is the same everywhere. A run that is not finished within {limit} s of processor time,
where most take a second, counts as not stable. It is E_R/E_A far below 1 that does it: such a root swells fiftyfold
and more in an hour, is many times as wide as it is long, and its cells multiply to thousands.

{edges}
"""


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def advice(edges: list[EdgeRow]) -> str:
    """What a user can do, from the edges that were found."""
    found = {(row.edge, row.scheme): row for row in edges}
    lines = []
    step = found.get(("step", "default"))
    if step and step.good:
        lines.append(
            f"- **Step.** The base case is stable up to a step of {step.good:.2g} h"
            f"{', the longest that may be asked for' if step.bad is None else ''}, {step.good / USUAL_STEP_H:.0f} "
            "times what the program chooses. Every step ends in balance, and one that finds none is cut "
            "(docs/decisions/0021); accuracy ends before (docs/accuracy_cost.md)."
        )
    ratio, paper = found.get(("ratio_up", "default")), found.get(("ratio_up", "paper"))
    if ratio and paper:
        lines.append(
            f"- **E_R/E_A.** {ratio.verdict().capitalize()}; a scene beyond E_A/nu_A^2 (278 here) is refused. With the "
            f"paper's law: {paper.verdict()}. It is refused from about 2.7, where it is not hyperbolic; use "
            '`law = "elastic_growth"`.'
        )
    stretch = found.get(("stretch", "default"))
    if stretch:
        lines.append(f"- **Stretch.** Cells that do not divide: {stretch.verdict()}.")
    fixed, free = found.get(("lambda_up_fixed_step", "default")), found.get(("lambda_up", "default"))
    if free and fixed:
        lines.append(
            f"- **lambda0**, times the base's. With the step left to the program: {free.verdict()}. With the step "
            f"kept at {USUAL_STEP_H:g} h: {fixed.verdict()}. It is the strain of a step that counts, "
            f"{(fixed.good or 0.0) * BASE_RATE_PER_H * USUAL_STEP_H:.1g} here: beyond, the volume of a cell doubles "
            "within a step, which is refused. Leave `step_h` out when you raise lambda0."
        )
    return "\n".join(lines)


def write_page(cases: list[CaseRow], edges: list[EdgeRow], remarks: Mapping[str, str], limit_s: int, out: Path) -> None:
    """docs/stability.md. `remarks`: by case, why it fails, printed where it does. `limit_s`: of a run of an edge."""
    table = by_case(cases)
    stable = [name for name, schemes in table.items() if all(row.passed for row in schemes["default"])]
    paper = [
        name for name, schemes in table.items() if schemes.get("paper") and all(row.passed for row in schemes["paper"])
    ]
    failing = [name for name in table if name not in stable]
    count = f"The default scheme is stable in {len(stable)} of {len(table)} hard cases, the paper's in {len(paper)}."
    if failing:
        count += f" The default scheme fails in {', '.join(f'`{name}`' for name in failing)}: see the table."
    rows = []
    for name, schemes in table.items():
        first = schemes["default"][0]
        why = f" ({remarks[name]})" if name in failing and remarks.get(name) else ""
        paper_says = verdict(schemes.get("paper", []))
        rows.append([f"`{name}`", first.meaning, f"{first.hours:g}", verdict(schemes["default"]) + why, paper_says])
    restarts = [row for row in cases if row.criterion == "restart"]
    page = PAGE.format(
        minutes="eight minutes beside another program",
        count=count,
        advice=advice(edges),
        criteria=markdown(
            ["criterion", "number", "bound"],
            [[c.name, c.meaning, f"{'at most' if c.most else 'at least'} {c.bound:g}"] for c in GENERAL],
        ),
        restart="and once more, short, with a restart in the middle: the same bits in "
        f"{sum(r.passed for r in restarts)} of {len(restarts)}",
        cases=markdown(["case", "what is hard", "h", "default", "paper's scheme"], rows),
        resolution=15,
        limit=limit_s,
        edges=markdown(
            ["quantity", "from", "towards", "scheme", "found"],
            [[row.meaning, f"{row.start:g}", f"{row.furthest:g}", row.scheme, row.verdict()] for row in edges],
        ),
    )
    out.write_text(page, encoding="utf-8")
