# SPDX-License-Identifier: MIT
"""docs/validation.md and its picture, from the numbers of docs/validation.csv."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

from rootsoil_tools import draw
from rootsoil_tools.pages import table
from rootsoil_tools.published import Reference
from rootsoil_tools.validation_cases import Number
from rootsoil_tools.validation_rows import (
    AGREES,
    DISAGREES,
    EXACT,
    FITTED,
    LEAST_R2,
    PREDICTED,
    VERDICTS,
    WITHIN,
    Row,
    outside,
    verdicts,
)

COLOURS = {AGREES: "#009E73", FITTED: "#0072B2", DISAGREES: "#C1272D"}
PICTURE = "validation"

PAGE = """<!-- SPDX-License-Identifier: MIT -->
<!-- Written by tools/validation.py. What is changed here is lost. -->
# Published numbers beside ours

`tools/validation.py` runs the scenes, writes [validation.csv](validation.csv) and draws this page from it. Published
numbers and their sources are in `tools/data/`. Ten minutes beside other programs.

{summary}

A number **agrees** in the published range or within {within:.0f} % of it, a relative error up to {within:.0f} %,
a curve from R² = {r2:g} on. These are the only thresholds. What ours is:

- **predicted**: nothing was set by the published number; this alone is validation;
- **fitted**: the scene was made to have it, or it follows from curves that were: its verdict is "fitted to it" at best.
  **Taken over**: an input, as the paper has it;
- **theory**: compared with an independent closed form, not with data.

The means of several runs have their range behind them. "Recorded": of a run too long for
this tool, as `tools/data/recorded_runs.csv` or another file of the project has it.

![Ours over the published number, for all numbers that can be compared](images/{picture}.png)

{groups}
The curves behind Fig. 4 are drawn in [scenes.md](scenes.md#case-2-unimpeded-growth), those behind Fig. 5 in
[scenes.md](scenes.md#case-3-soft-and-hard-soil).
"""


def digits(value: float) -> str:
    """Three digits; a large number in full."""
    if value != 0.0 and abs(value) < 1e-3:
        return f"{value:.1e}"
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"


def published_text(known: Reference | None) -> str:
    """The number or its range."""
    if known is None:
        return "-"
    low, high = digits(known.low), digits(known.high)
    return low if low == high else f"{low} to {high}"


def ours_text(row: Row, found: Number | None) -> str:
    """The number with its range."""
    if found is None or math.isnan(found.value):
        return row.ours or "-"
    all_three = (found.value, found.low, found.high)
    value, low, high = (f"{v:.4g}" if row.measure == "R^2" else digits(v) for v in all_three)
    return f"{value} ({low} to {high})" if low != high else value


def how_text(row: Row, found: Number | None) -> str:
    """Scene, hours, where it is recorded, and the row's note."""
    parts = []
    if found is not None:
        hours = "" if math.isnan(found.hours) else f", {found.hours:g} h"
        parts.append(f"`{found.scene}`{hours}" if " " not in found.scene else found.scene + hours)
        if found.recorded:
            parts.append(f"recorded: {found.recorded}")
    return "; ".join([*parts, *([row.note] if row.note else [])])


def difference_text(row: Row, found: Number | None) -> str:
    """Ours against the published range, in %; of a curve or an error there is none."""
    known = row.reference
    if found is None or math.isnan(found.value) or known is None or row.measure != "number" or row.apart:
        return "-"
    off = outside(found.value, known)
    return "within" if off == 0.0 else f"{100.0 * off:+.0f} %"


def summary(rows: Sequence[tuple[Row, Number | None, str]]) -> str:
    """How many rows have which verdict, and how many of the predictions agree."""
    verdict_of = [judged for _, _, judged in rows]
    counts = ", ".join(f"{name} {verdict_of.count(name)}" for name in VERDICTS if name in verdict_of)
    predicted = [judged for row, _, judged in rows if row.origin == PREDICTED and judged in (AGREES, DISAGREES)]
    agree = f"Of the {len(predicted)} that are predicted, {predicted.count(AGREES)} agree."
    return textwrap.fill(f"**{len(rows)} rows: {counts}. {agree}**", 120, break_on_hyphens=False)


def page(numbers: Mapping[str, Number]) -> str:
    """docs/validation.md."""
    rows = verdicts(numbers)
    groups = []
    for group in dict.fromkeys(row.group for row, _, _ in rows):
        lines = []
        for row, found, judged in rows:
            if row.group != group:
                continue
            known = row.reference
            told = f"{judged}: {row.apart}" if row.apart else judged
            kind = row.origin if found and (known or row.origin == EXACT) else "-"
            lines.append(
                [row.quantity, published_text(known), ours_text(row, found), difference_text(row, found), kind]
                + [f"**{told}**" if judged == DISAGREES else told, how_text(row, found), known.source if known else "-"]
            )
        head = ["quantity", "published", "ours", "difference", "ours is", "verdict", "how ours is measured", "source"]
        groups.append(f"## {group}\n\n{table(head, lines)}")
    return PAGE.format(
        summary=summary(rows),
        within=100.0 * WITHIN,
        r2=LEAST_R2,
        picture=PICTURE,
        groups="\n".join(groups),
    )


def draw_ratios(numbers: Mapping[str, Number], path: Path) -> None:
    """Ours over the middle of the published range, with that range as a bar: all numbers that have a verdict by it."""
    rows = [
        (row, found, judged)
        for row, found, judged in verdicts(numbers)
        if row.measure == "number" and judged in COLOURS and found is not None
    ]
    draw.use_style()
    height = 22.0 + 4.6 * len(rows)
    figure = draw.new_figure(180.0, height)
    axes = draw.place(figure, 84.0, 14.0, 90.0, height - 24.0)
    for place, (row, found, judged) in enumerate(reversed(rows)):
        known = row.reference
        assert known is not None
        low, high = max(known.low, 1e-3), known.high
        middle = math.sqrt(low * high) if known.low > 0.0 else high
        bar = {"color": draw.DATA, "linewidth": 5.0, "alpha": 0.45, "solid_capstyle": "butt"}
        width = 0.02 if high == low else 0.0  # a single number is drawn as a short bar
        axes.plot([low / middle * (1.0 - width), high / middle * (1.0 + width)], [place, place], **bar)
        axes.plot([found.low / middle, found.high / middle], [place, place], color=COLOURS[judged], linewidth=1.0)
        axes.plot(found.value / middle, place, "o", color=COLOURS[judged], markersize=3.6, markeredgewidth=0)
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([row.quantity for row, _, _ in reversed(rows)])
    axes.set_ylim(-0.8, len(rows) - 0.2)
    axes.set_xscale("log")
    ends = [edge for row, found, _ in rows for edge in _ends(row, found)]
    axes.set_xlim(0.8 * min(ends), 1.25 * max(ends))
    ticks = [t for t in (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0) if 0.8 * min(ends) < t < 1.25 * max(ends)]
    axes.set_xticks(ticks)
    axes.set_xticklabels([f"{t:g}" for t in ticks])
    axes.minorticks_off()
    axes.axvline(1.0, color=draw.THEORY, linewidth=0.5)
    axes.set_xlabel("over the middle of the published range")
    handles = [
        axes.plot([], [], "o", color=c, markersize=3.6, markeredgewidth=0, label=n)[0] for n, c in COLOURS.items()
    ]
    handles += axes.plot([], [], color=draw.DATA, linewidth=5.0, alpha=0.45, label="published")
    figure.legend(handles=handles, loc="upper center", ncol=4, frameon=False, bbox_to_anchor=(0.5, 1.0))
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=draw.DOTS_PER_INCH)


def _ends(row: Row, found: Number) -> list[float]:
    """What the picture has to hold of a row, in its units."""
    known = row.reference
    assert known is not None
    middle = math.sqrt(known.low * known.high) if known.low > 0.0 else known.high
    low = known.low / middle if known.low > 0.0 else 0.5
    return [low, known.high / middle, found.low / middle, found.high / middle]
