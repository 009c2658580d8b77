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
from rootsoil_tools.accuracy_grid import DEFAULT_NAME, FINEST_NAME, PAPER_NAME, usual_level
from rootsoil_tools.accuracy_table import Row
from rootsoil_tools.problems import Problem

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
BLUE, GREEN, PURPLE, ORANGE = "#0072B2", "#009E73", "#8E5EA2", "#E69F00"
SKY, PINK, RED, GREY, OLIVE = "#56B4E9", "#CC79A7", "#C1272D", "#6A6A6A", "#7A7A00"
STYLES: dict[str, tuple[str, str, float]] = {
    DEFAULT_NAME: (BLUE, "o", 2.0),
    PAPER_NAME: (RED, "s", 2.0),
    "isotropic kernel, H_bar 2": (GREEN, "^", 1.0),
    "isotropic kernel, H_bar 4.5": (GREEN, "v", 1.0),
    "isotropic kernel, H_bar 8": (GREEN, "D", 1.0),
    "plain gradient": (ORANGE, "^", 1.0),
    "linear gradient": (ORANGE, "v", 1.0),
    "quadratic gradient": (ORANGE, "D", 1.0),
    "scalar inertia": (GREY, "^", 1.0),
    "no compensation of inertia": (GREY, "v", 1.0),
    "no non-affine control": (PINK, "D", 1.0),
    "predictor-corrector": (OLIVE, "P", 1.0),
    "law pressure_deviator": (RED, "+", 0.8),
    "step": (BLUE, "x", 0.8),
    "window": (SKY, "<", 0.8),
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
DASHED = ("step", "window", "eta")  # their curves are not over the cells across


@dataclass(frozen=True)
class Point:
    """A run in a diagram."""

    choice: str
    cost: float
    error: float
    place: float = 0.0  # along its curve: cells across, or what the curve varies


def points_of(rows: Iterable[Row], problem: str, measure: str, cost: str) -> list[Point]:
    """The runs of a problem that have an error; `cost` is a column. The default's run lies on the curve of every choice
    that is a number, too."""
    found = [
        r
        for r in rows
        if (r.problem, r.measure, r.status) == (problem, measure, "done")
        and math.isfinite(r.error)
        and getattr(r, cost) > 0.0
    ]

    def point(name: str, row: Row, place: float) -> Point:
        return Point(name, getattr(row, cost), max(row.error, 1e-9), place)

    points = [point(r.choice, r, r.across if math.isnan(r.level) else r.level) for r in found]
    for name, across in sorted({(r.choice, r.across) for r in found if not math.isnan(r.level)}):
        usual = [r for r in found if (r.choice, r.across) == (DEFAULT_NAME, across)]
        points += [point(name, r, level) for r in usual if not math.isnan(level := usual_level(problem, name))]
    return points


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
        own = sorted((p for p in points if p.choice == name), key=lambda p: p.place)
        if own:
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


def only_time(problem: Problem) -> bool:
    """Grains cost more than cells, and cells at rest nothing."""
    return problem.soil or problem.name == "sleep"


def draw_picture(
    rows: Sequence[Row], pairs: Sequence[tuple[str, str]], problems: dict[str, Problem], path: Path
) -> bool:
    """Two panels for each problem and measure that has runs, one where only time is the cost. False: none has."""
    panels = [
        (problem, measure, cost)
        for problem, measure in pairs
        if problem in problems
        for cost in (("cpu_s",) if only_time(problems[problem]) else COSTS)
        if points_of(rows, problem, measure, cost)
    ]
    if not panels:
        return False
    paper.use_style()
    names = {p.choice for problem, measure, cost in panels for p in points_of(rows, problem, measure, cost)}
    columns = 5
    height, gap, legend_mm = 42.0, 17.0, 3.0 + 3.6 * math.ceil((len(names) + 1) / columns)
    lines = (len(panels) + 1) // 2
    total = lines * (height + gap) + legend_mm + 1.0
    figure = paper.new_figure(180.0, total)
    for index, (problem, measure, cost) in enumerate(panels):
        left, bottom = 15.0 + 90.0 * (index % 2), total - (index // 2 + 1) * (height + gap) + gap - 9.0
        points = points_of(rows, problem, measure, cost)
        axes = paper.place(figure, left, bottom, 72.0, height)
        draw_panel(axes, points)
        axes.set_xlabel(COSTS[cost] + (", all samples" if problems[problem].soil else ""), labelpad=1.0)
        if left < 90.0 or only_time(problems[problem]):
            axes.set_ylabel("relative error")
        if cost == "cpu_s":
            name = f"{problems[problem].title}: {problems[problem].measure(measure).meaning}"
            wrapped = textwrap.fill(name, 50 if only_time(problems[problem]) else 120)
            figure.text(left / 180.0, (bottom + height + 1.5) / total, wrapped, size=7.5, va="bottom")
            paper.letter(
                figure, left - 11.0, bottom + height + 1.0, "ABCDEFGH"[len({p[:2] for p in panels[: index + 1]}) - 1]
            )
    handles = [
        Line2D([], [], color=c, marker=m, markersize=4.0 if w else 7.0, linewidth=w, linestyle=line(n), label=n)
        for n, (c, m, w) in STYLES.items()
        if n in names
    ]
    ring = {"marker": "o", "markersize": 7.5, "markerfacecolor": "none", "markeredgecolor": "black", "color": "#D0D0D0"}
    handles.append(Line2D([], [], linewidth=4.0, markeredgewidth=0.6, label="Pareto front", **ring))
    figure.legend(handles=handles, loc="lower center", ncol=columns, frameon=False, fontsize=6.5, columnspacing=1.2)
    figure.savefig(path, dpi=200)
    plt.close(figure)
    return True


def draw(rows: Sequence[Row], problems: Sequence[Problem], folder: Path) -> list[str]:
    """All pictures; the names of those that were made."""
    by_name = {p.name: p for p in problems}
    folder.mkdir(parents=True, exist_ok=True)
    return [name for name, panels in PICTURES.items() if draw_picture(rows, panels, by_name, folder / f"{name}.png")]
