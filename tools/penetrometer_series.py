#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the penetrometer over inertial numbers, pressures, friction angles and seeds, and draws Q/P against I.

Each run goes to OUT/<its numbers>. Runs that are finished, of the same soil and by the same program, are taken as they
are. Writes OUT/penetrometer_series.csv (a row a run), OUT/penetrometer_series.png (mean and scatter between seeds) and
prints a table. --quick takes a few grains, two seeds and two inertial numbers: a minute, to see that it works.
"""

from __future__ import annotations

import argparse
import csv
import itertools
import json
import subprocess
import sys
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

from penetrometer import read_csv
from rootsoil_tools import draw
from rootsoil_tools.runs import RunError
from rootsoil_tools.series import PROGRAM, PROJECT, Series

INERTIAL_NUMBERS = (0.1, 0.03, 0.01, 0.003)
QUASI_STATIC = 0.01  # below it Q should no longer depend on the inertial number
BESIDE = 1.08  # a sample's dot stands beside its mean
QUICK_NUMBERS, QUICK_SEEDS = (0.1, 0.03), (1, 2)
QUICK = (
    "soil.box_from_mm=[0.0, -1.2]",
    "soil.box_to_mm=[2.4, 1.2]",
    "penetrometer.diameter_mm=0.6",
    "penetrometer.depth_mm=1.2",
    "penetrometer.average_from_mm=0.6",
)  # of a soil in 2D


@dataclass(frozen=True)
class Choice:
    """What one run differs in; None: as the file says."""

    inertial_number: float
    pressure_MPa: float | None
    friction_deg: float | None
    seed: int

    @property
    def name(self) -> str:
        """Of the run's folder."""
        parts = [f"I{self.inertial_number:g}"]
        parts += [f"P{self.pressure_MPa:g}"] if self.pressure_MPa is not None else []
        parts += [f"friction{self.friction_deg:g}"] if self.friction_deg is not None else []
        return "_".join([*parts, f"seed{self.seed}"])

    @property
    def settings(self) -> list[str]:
        """key=value for --set."""
        settings = [
            f"soil.inertial_number_max={self.inertial_number:g}",
            f"soil.seed={self.seed}",
            "penetrometer.seeds=1",
        ]
        if self.pressure_MPa is not None:
            settings.append(f"soil.confining_pressure_MPa={self.pressure_MPa:g}")
        if self.friction_deg is not None:
            settings.append(f"soil.friction_deg={self.friction_deg:g}")
        return settings


@dataclass(frozen=True)
class Measured:
    """One run: a row of the table."""

    inertial_number: float
    pressure_MPa: float
    friction_deg: float  # nan: as the file says
    seed: int
    Q_MPa: float
    Q_over_P: float
    Q_fluctuation_MPa: float  # standard deviation along the way
    overlap_max: float  # of two bodies, over the smaller radius
    from_mm: float  # Q is the mean over these depths
    to_mm: float


@dataclass(frozen=True)
class Point:
    """The seeds of one choice together."""

    inertial_number: float
    seeds: int
    mean: float  # of Q/P
    deviation: float  # of Q/P, between seeds; nan with one


def measure(folder: Path, choice: Choice) -> Measured:
    """The numbers of one finished run."""
    found = json.loads((folder / "penetrometer.json").read_text(encoding="utf-8"))
    (readings,) = read_csv(folder / "penetrometer.csv").values()
    start, end = found["averaged_mm"]
    return Measured(
        inertial_number=choice.inertial_number,
        pressure_MPa=found["confining_pressure_MPa"],
        friction_deg=np.nan if choice.friction_deg is None else choice.friction_deg,
        seed=choice.seed,
        Q_MPa=found["Q_MPa"],
        Q_over_P=found["Q_over_P"],
        Q_fluctuation_MPa=found["Q_fluctuation_MPa"],
        overlap_max=float(readings["overlap_max"].max()),
        from_mm=start,
        to_mm=end,
    )


def curves(runs: list[Measured]) -> dict[tuple[float, float], list[Point]]:
    """Points over the inertial number, largest first, for every pressure (MPa) and friction angle (degrees)."""
    found: dict[tuple[float, float], dict[float, list[float]]] = {}
    for run in runs:
        curve = found.setdefault((run.pressure_MPa, run.friction_deg), {})
        curve.setdefault(run.inertial_number, []).append(run.Q_over_P)
    return {
        key: [
            Point(number, len(q), float(np.mean(q)), float(np.std(q, ddof=1)) if len(q) > 1 else np.nan)
            for number, q in sorted(curve.items(), reverse=True)
        ]
        for key, curve in found.items()
    }


def label_of(pressure_MPa: float, friction_deg: float) -> str:
    """Of a curve."""
    return f"P = {pressure_MPa:g} MPa" + ("" if np.isnan(friction_deg) else f", friction {friction_deg:g}°")


def draw_series(runs: list[Measured], out: Path) -> None:
    """Q/P against the inertial number: dots for the samples, mean and scatter between them."""
    draw.use_style()
    figure = draw.new_figure(90.0, 66.0)
    axes = draw.place(figure, 12.0, 11.0, 74.0, 48.0)
    colours = [draw.SIMULATION, draw.DATA, *draw.DIVISIONS]
    for ((pressure, friction), points), colour in zip(curves(runs).items(), itertools.cycle(colours)):
        own = [r for r in runs if label_of(r.pressure_MPa, r.friction_deg) == label_of(pressure, friction)]
        axes.plot(
            [BESIDE * r.inertial_number for r in own],
            [r.Q_over_P for r in own],
            "o",
            color=colour,
            markersize=2.5,
            mfc="white",
            mew=0.6,
        )
        axes.errorbar(
            [p.inertial_number for p in points],
            [p.mean for p in points],
            yerr=[0.0 if np.isnan(p.deviation) else p.deviation for p in points],
            color=colour,
            marker="s",
            markersize=3.0,
            linewidth=0.9,
            capsize=3.0,
            zorder=1.5,
            label=label_of(pressure, friction),
        )
    axes.axvline(QUASI_STATIC, color=draw.OBSTACLE, linewidth=0.8, zorder=0)
    numbers = sorted({r.inertial_number for r in runs} | {QUASI_STATIC})
    axes.set(xscale="log", xlabel="inertial number I", ylabel="resistance over confining pressure Q/P")
    axes.set_xticks(numbers, [f"{number:g}" for number in numbers])
    axes.minorticks_off()
    axes.set_xlim(numbers[0] / 1.3, numbers[-1] * 1.3)
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(-0.02, 1.0), borderaxespad=0.0, ncols=2)
    figure.savefig(out, dpi=draw.DOTS_PER_INCH)
    plt.close(figure)


def write_csv(runs: list[Measured], out: Path) -> None:
    """One row a run."""
    with out.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Measured)], lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: f"{value:.6g}" for name, value in asdict(run).items()} for run in runs)


def table(runs: list[Measured]) -> str:
    """Q/P of every curve; how far each point is from the slowest one, and the standard error of that difference."""
    lines = [f"{'I':>8} {'seeds':>6} {'Q/P':>7} {'+-':>6} {'against the slowest':>22}"]
    for key, points in curves(runs).items():
        lines.append(label_of(*key))
        slowest = points[-1]
        for p in points:
            error = np.sqrt(p.deviation**2 / p.seeds + slowest.deviation**2 / slowest.seeds)
            difference = "" if p is slowest else f"{p.mean - slowest.mean:+.2f} +- {error:.2f}"
            lines.append(f"{p.inertial_number:8g} {p.seeds:6d} {p.mean:7.2f} {p.deviation:6.2f} {difference:>22}")
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "soil",
        type=Path,
        nargs="?",
        default=PROJECT / "scenarios" / "soils" / "sandy_2d.toml",
        help="default: sandy_2d",
    )
    parser.add_argument(
        "--out", type=Path, default=Path("runs/penetrometer_series"), help="folder (default: %(default)s)"
    )
    parser.add_argument("--inertial-numbers", type=float, nargs="+", default=INERTIAL_NUMBERS, metavar="I")
    parser.add_argument("--pressures", type=float, nargs="+", default=[None], metavar="MPa", help="default: the file's")
    parser.add_argument("--friction", type=float, nargs="+", default=[None], metavar="DEG", help="default: the file's")
    parser.add_argument("--seeds", type=int, nargs="+", default=(1, 2, 3), metavar="N")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="passed on to every run")
    parser.add_argument("--quick", action="store_true", help="a minute: few grains, two inertial numbers, two seeds")
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/release/rootsoil")
    options = parser.parse_args()
    numbers = QUICK_NUMBERS if options.quick else options.inertial_numbers
    seeds = QUICK_SEEDS if options.quick else options.seeds
    more = [*(QUICK if options.quick else ()), *options.set]
    picture, rows = options.out / "penetrometer_series.png", options.out / "penetrometer_series.csv"
    try:
        series = Series(options.soil, options.out, options.program)
        runs = []
        for values in itertools.product(numbers, options.pressures, options.friction, seeds):
            choice = Choice(*values)
            runs.append(measure(series.penetrometer(choice.name, [*more, *choice.settings]), choice))
            write_csv(runs, rows)
        draw_series(runs, picture)
    except KeyboardInterrupt:
        print("penetrometer_series: interrupted; the same command goes on with what is missing", file=sys.stderr)
        return 130
    except subprocess.CalledProcessError as error:
        print(
            f"penetrometer_series: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}",
            file=sys.stderr,
        )
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"penetrometer_series: {error}", file=sys.stderr)
        return 1
    print(table(runs))
    print(f"wrote {picture} and {rows}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
