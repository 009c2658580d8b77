# SPDX-License-Identifier: MIT
"""Work-precision diagrams, from the rows of tools/accuracy_cost.py."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from rootsoil_tools import draw as paper
from rootsoil_tools.accuracy_grid import (
    CORRECTOR_NAME,
    DEFAULT_NAME,
    EXPLICIT_NAME,
    EXPLICIT_PRESETS,
    FINEST_NAME,
    PAPER_NAME,
    PRESETS,
    dial_of,
)
from rootsoil_tools.accuracy_table import Row
from rootsoil_tools.problems import Problem

# the steppers against each other: what each is offered with, and its colour
BLUE, GREEN, PURPLE, ORANGE = "#0072B2", "#009E73", "#8E5EA2", "#E69F00"
SKY, PINK, RED, GREY, OLIVE = "#56B4E9", "#CC79A7", "#C1272D", "#6A6A6A", "#7A7A00"
FAMILIES: dict[str, tuple[tuple[str, ...], str, str]] = {
    "default (quasi_static)": ((DEFAULT_NAME, "step", *(c.name for c in PRESETS)), BLUE, "o"),
    "explicit (symplectic)": ((EXPLICIT_NAME, "explicit, step", *(c.name for c in EXPLICIT_PRESETS)), ORANGE, "^"),
    "predictor-corrector": ((CORRECTOR_NAME,), OLIVE, "P"),
    "paper's whole scheme": ((PAPER_NAME,), RED, "s"),
}
STEPPERS_PICTURE = "accuracy_steppers"
STEPPERS_PANELS = [
    ("case1_isotropic", "radial"),
    ("case1_balanced", "radial"),
    ("growth", "axial rate"),
    ("growth", "tip speed"),
    ("division", "axial rate"),
    ("division", "cell length"),
    ("cantilever", "stiffness"),
    ("euler", "stiffness"),
    ("thrust", "arrest stress"),
    ("path", "path"),
]

# which problem and measure has a panel in which picture
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
    "accuracy_sleep": [("sleep", "growth"), ("sleep", "tip speed")],
    "accuracy_bending_contact": [
        ("cantilever", "stiffness"),
        ("euler", "stiffness"),
        ("thrust", "arrest stress"),
        ("path", "path"),
    ],
    "accuracy_soil": [("hertz", "force"), ("penetrometer", "Q"), ("soil", "tip force"), ("soil", "elongation")],
}
# colour, marker, line width; choices of a kind share a colour
STYLES: dict[str, tuple[str, str, float]] = {
    DEFAULT_NAME: (BLUE, "o", 2.0),
    PAPER_NAME: (RED, "s", 2.0),
    "isotropic kernel, H_bar 2": (GREEN, "^", 1.0),
    "isotropic kernel, H_bar 4.5": (GREEN, "v", 1.0),
    "isotropic kernel, H_bar 8": (GREEN, "D", 1.0),
    "plain gradient": (ORANGE, "^", 1.0),
    "linear gradient": (ORANGE, "v", 1.0),
    "quadratic gradient": (ORANGE, "D", 1.0),
    "no non-affine control": (PINK, "D", 1.0),
    "law pressure_deviator": (RED, "+", 0.8),
    EXPLICIT_NAME: (GREY, "o", 2.0),
    CORRECTOR_NAME: (OLIVE, "P", 1.2),
    "explicit, step": (GREY, "x", 0.8),
    "explicit, window": (GREY, "<", 0.8),
    "explicit, interval": (GREY, ">", 0.8),
    "explicit, scalar inertia": (GREY, "^", 0.0),
    "explicit, no compensation": (GREY, "v", 0.0),
    "explicit, preset fast": (GREY, "1", 0.0),
    "explicit, preset reference": (GREY, "*", 0.0),
    "step": (BLUE, "x", 0.8),
    "force tolerance": (SKY, "<", 0.8),
    "eta": (PURPLE, ">", 0.8),
    "preset fast": ("black", "1", 0.0),
    "preset balanced": ("black", "2", 0.0),
    "preset reference": ("black", "*", 0.0),
    "sleep, strain rate": (GREEN, "D", 1.2),
    "sleep, stress change": (ORANGE, "^", 1.2),
    FINEST_NAME: ("black", "*", 0.0),
    "interval": (SKY, "o", 1.2),
    "inertial number": (PURPLE, "s", 1.2),
    "substeps": (PINK, "v", 1.2),
    "grain stiffness": (ORANGE, "^", 1.2),
    "marker spacing": (GREEN, "D", 1.2),
}
DASHED = ("step", "force tolerance", "eta", "explicit, step", "explicit, window")  # not over the cells across


@dataclass(frozen=True)
class Point:
    """A run in a diagram."""

    choice: str
    cost: float
    error: float
    across: int = 0
    level: float = math.nan  # of a choice that is a number


def points_of(rows: Iterable[Row], problem: str, measure: str) -> list[Point]:
    """The runs of a problem that have an error. The run of its base lies on the curve of every choice that is a
    number, too."""
    found = [
        r
        for r in rows
        if (r.problem, r.measure, r.status) == (problem, measure, "done") and math.isfinite(r.error) and r.time_s > 0.0
    ]

    def point(name: str, row: Row, level: float) -> Point:
        return Point(name, row.time_s, max(row.error, 1e-9), row.across, level)

    points = [point(r.choice, r, r.level) for r in found]
    for name, across in sorted({(r.choice, r.across) for r in found if not math.isnan(r.level)}):
        dial = dial_of(problem, name)
        if dial and not math.isnan(dial.usual):
            usual = [r for r in found if (r.choice, r.across) == (dial.base, across)]
            points += [point(name, r, dial.usual) for r in usual]
    return points


def curves_of(points: Sequence[Point]) -> list[list[Point]]:
    """One choice's points: a curve over the cells across, or for each number of cells one over the levels."""
    plain = [p for p in points if math.isnan(p.level)]
    numbers = {p.across for p in points if not math.isnan(p.level)}
    curves = [sorted(plain, key=lambda p: p.across)] if plain else []
    own = [[p for p in points if p.across == n and not math.isnan(p.level)] for n in sorted(numbers)]
    return curves + [sorted(curve, key=lambda p: p.level) for curve in own]


def pareto_front(points: Sequence[Point]) -> list[Point]:
    """Those than which none is both as cheap and as exact, by cost."""
    front: list[Point] = []
    for point in sorted(points, key=lambda p: (p.cost, p.error)):
        if not front or point.error < front[-1].error:
            front.append(point)
    return front


def line(name: str) -> str | tuple:
    """Style of a choice's curve."""
    return (0, (3, 2)) if name in DASHED else "-" if STYLES[name][2] else "none"


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
        for own in curves_of([p for p in points if p.choice == name]):
            axes.plot(
                [p.cost for p in own],
                [p.error for p in own],
                color=colour,
                marker=marker,
                markersize=4.0 if width else 7.0,
                linewidth=width,
                linestyle=line(name),
                zorder=3 if width > 1.5 else 2,
            )
    finish_panel(axes)


def finish_panel(axes: Axes) -> None:
    """Logarithmic axes that show at least a few units."""
    axes.set(xscale="log", yscale="log")
    widen(axes.get_xlim, axes.set_xlim, 5.0)
    widen(axes.get_ylim, axes.set_ylim, 15.0)
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if high < 100.0 * low:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(visible=True, which="major", color="#E8E8E8", linewidth=0.5)
    axes.set_axisbelow(True)


def draw_families(axes: Axes, points: Sequence[Point]) -> None:
    """Every stepper's runs, and the front of each: what an error costs with it."""
    for names, colour, marker in FAMILIES.values():
        own = [p for p in points if p.choice in names]
        front = pareto_front(own)
        if not own:
            continue
        axes.plot(
            [p.cost for p in own],
            [p.error for p in own],
            linestyle="none",
            marker=marker,
            markersize=3.0,
            markerfacecolor="white",
            markeredgecolor=colour,
            markeredgewidth=0.6,
        )
        axes.plot([p.cost for p in front], [p.error for p in front], color=colour, marker=marker, markersize=4.5)
    finish_panel(axes)


def families_legend() -> list[Line2D]:
    """What draw_families draws."""
    named = [
        Line2D([], [], color=colour, marker=marker, markersize=4.5, label=name)
        for name, (_, colour, marker) in FAMILIES.items()
    ]
    other = {"linestyle": "none", "marker": "o", "markersize": 3.0, "markerfacecolor": "white"}
    return [*named, Line2D([], [], markeredgecolor="black", markeredgewidth=0.6, label="not on its front", **other)]


def choices_legend(names: set[str]) -> list[Line2D]:
    """What draw_panel draws."""
    handles = [
        Line2D([], [], color=c, marker=m, markersize=4.0 if w else 7.0, linewidth=w, linestyle=line(n), label=n)
        for n, (c, m, w) in STYLES.items()
        if n in names
    ]
    ring = {"marker": "o", "markersize": 7.5, "markerfacecolor": "none", "markeredgecolor": "black", "color": "#D0D0D0"}
    return [*handles, Line2D([], [], linewidth=4.0, markeredgewidth=0.6, label="Pareto front", **ring)]


def draw_picture(
    rows: Sequence[Row], pairs: Sequence[tuple[str, str]], problems: dict[str, Problem], path: Path, families: bool
) -> bool:
    """A panel for each problem and measure that has runs; `families`: steppers instead of choices. False: none has."""
    found = {pair: points_of(rows, *pair) for pair in pairs if pair[0] in problems}
    panels = {pair: points for pair, points in found.items() if points}
    if not panels:
        return False
    paper.use_style()
    handles = families_legend() if families else choices_legend({p.choice for own in panels.values() for p in own})
    columns = 5
    height, gap, legend_mm = 42.0, 19.0, 3.0 + 3.6 * math.ceil(len(handles) / columns)
    lines = (len(panels) + 1) // 2
    total = lines * (height + gap) + legend_mm + 1.0
    figure = paper.new_figure(180.0, total)
    for index, ((problem, measure), points) in enumerate(panels.items()):
        left, bottom = 15.0 + 90.0 * (index % 2), total - (index // 2 + 1) * (height + gap) + gap - 9.0
        axes = paper.place(figure, left, bottom, 72.0, height)
        (draw_families if families else draw_panel)(axes, points)
        axes.set_xlabel("processor time (s)" + (", all samples" if problems[problem].soil else ""), labelpad=1.0)
        axes.set_ylabel("relative error")
        name = f"{problems[problem].title}: {problems[problem].measure(measure).meaning}"
        figure.text(left / 180.0, (bottom + height + 1.5) / total, textwrap.fill(name, 56), size=7.0, va="bottom")
        paper.letter(figure, left - 11.0, bottom + height + 1.0, "ABCDEFGHIJ"[index])
    figure.legend(handles=handles, loc="lower center", ncol=columns, frameon=False, fontsize=6.5, columnspacing=1.2)
    figure.savefig(path, dpi=200)
    plt.close(figure)
    return True


def draw(rows: Sequence[Row], problems: Sequence[Problem], folder: Path) -> list[str]:
    """All pictures; the names of those that were made."""
    by_name = {p.name: p for p in problems}
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {STEPPERS_PICTURE: STEPPERS_PANELS, **PICTURES}
    return [
        name
        for name, panels in pictures.items()
        if draw_picture(rows, panels, by_name, folder / f"{name}.png", name == STEPPERS_PICTURE)
    ]
