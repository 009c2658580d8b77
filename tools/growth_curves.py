#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the three curves of the paper's Fig. 4B for a run, beside those of Beemster & Baskin (1998), and the radius.

Axial strain rate, cell length and division rate over the distance from the tip: means and standard errors over the last
40 outputs (fewer where a run has fewer), as in the paper's 4.9, with R^2, RMSE and relative error at the measured
points. Writes RUN/growth_curves.png and prints the numbers.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

from rootsoil_tools import draw, measure, published
from rootsoil_tools.runs import Run, RunError

OUTPUTS = 40
HALF_WIDTH_MM = {"axial_strain_rate": 0.014, "cell_length": 0.014, "division_rate": 0.028}  # divisions are few
END_MM = 1.2
PAGE_WIDTH, PANEL_WIDTH, PANEL_HEIGHT, LEFT, BOTTOM, GAP = 184.0, 32.0, 36.0, 13.0, 11.0, 14.0


@dataclass(frozen=True)
class Curve:
    """A quantity over the distance from the tip, a row for each output."""

    name: str
    label: str
    s_mm: np.ndarray
    values: np.ndarray

    def mean(self) -> np.ndarray:
        return np.nanmean(self.values, axis=0)

    def standard_error(self) -> np.ndarray:
        """Of the mean; outputs in succession are not independent, so it is a lower bound."""
        return np.nanstd(self.values, axis=0) / np.sqrt(np.isfinite(self.values).sum(axis=0))


def curve(run: Run, quantity: str, s_mm: np.ndarray) -> Curve:
    """Axial strain rate (1/h), cell length (um), division rate (1/h) or radius (mm) of the last outputs at places."""
    frames = list(range(max(0, len(run.times_h) - OUTPUTS), len(run.times_h)))
    if quantity == "radius":
        edges = np.linspace(0.0, END_MM, 25)
        rows = np.array([measure.radii(run.frame(index), run.dimension, edges) for index in frames])
        return Curve(quantity, "radius (mm)", (edges[1:] + edges[:-1]) / 2.0, rows)
    half = HALF_WIDTH_MM[quantity]
    if quantity == "division_rate":
        before = [max(0, frames[0] - 1), *frames]
        rows = measure.division_rates(run, sorted(set(before)), s_mm, half)
    else:
        rows = measure.near_points(run, frames, quantity, s_mm, half)
    labels = {"axial_strain_rate": "axial strain rate", "cell_length": "cell length", "division_rate": "division rate"}
    unit = "µm" if quantity == "cell_length" else "1/h"
    return Curve(quantity, f"{labels[quantity]} ({unit})", s_mm, rows)


def measured(quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Published curve in our units: distance from the tip (mm), values."""
    if quantity != "axial_strain_rate":
        return published.arabidopsis(quantity)
    at_mm, percent_per_h = published.arabidopsis("strain_rate")
    return at_mm, percent_per_h / 100.0


def draw_curves(run: Run, out: Path) -> list[str]:
    """Draws the figure; returns lines worth printing."""
    draw.use_style()
    height = BOTTOM + PANEL_HEIGHT + 15.0
    figure = draw.new_figure(PAGE_WIDTH, height)
    said = []
    first = run.times_h[max(0, len(run.times_h) - OUTPUTS)]
    for column, quantity in enumerate(("axial_strain_rate", "cell_length", "division_rate", "radius")):
        left = LEFT + column * (PANEL_WIDTH + GAP)
        axes = draw.place(figure, left, BOTTOM, PANEL_WIDTH, PANEL_HEIGHT)
        draw.letter(figure, left - LEFT + 2.0, BOTTOM + PANEL_HEIGHT + 1.0, "ABCD"[column])
        ours = curve(run, quantity, np.arange(0.01, END_MM, 0.01))
        mean, error = ours.mean(), ours.standard_error()
        axes.plot(ours.s_mm, mean, color=draw.SIMULATION, linewidth=1.2, label="simulation, mean")
        axes.fill_between(
            ours.s_mm, mean - error, mean + error, color=draw.SIMULATION, alpha=0.3, linewidth=0, label="standard error"
        )
        if quantity != "radius":
            at_mm, values = measured(quantity)
            axes.plot(at_mm, values, "o", color=draw.DATA, markersize=2.4, markeredgewidth=0, label=published.SOURCE)
            fit = published.fit(values, curve(run, quantity, at_mm).mean())
            unit = " µm" if quantity == "cell_length" else " /h"
            axes.set_title(f"$R^2$ {fit.r2:.3f}, RMSE {fit.rmse:.2g}{unit}", loc="right", size=7)
            name = quantity.replace("_", " ")
            said.append(f"{name}: R^2 {fit.r2:.4f}, RMSE {fit.rmse:.3g}{unit}, relative error {fit.relative_error:.3f}")
        else:
            hours = run.times_h[-1] - first
            rows = ours.values[:, np.isfinite(ours.values).all(axis=0)].mean(axis=1)
            slope = np.polyfit(run.times_h[-len(rows) :], rows, 1)[0] if hours > 0.0 else 0.0
            change = 1e3 * slope / rows.mean()  # % in 10 h
            axes.set_title(f"{change:+.2f} % in 10 h", loc="right", size=7)
            said.append(f"radius over the first {END_MM} mm: {rows.mean():.4g} mm, {change:+.2f} % in 10 h")
        axes.set_xlim(0.0, END_MM)
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel("distance from the tip (mm)", size=7)
        axes.set_ylabel(ours.label)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.55, 1.0), ncol=3, frameon=False)
    figure.text(0.01, 0.985, f"{run.name}, {first:.3g}–{run.times_h[-1]:.3g} h", size=8, va="top")
    figure.savefig(out, dpi=draw.DOTS_PER_INCH)
    plt.close(figure)
    return said


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, help="folder of the run")
    parser.add_argument("--out", type=Path, help="file to write (default: RUN/growth_curves.png)")
    options = parser.parse_args()
    out = options.out or options.run / "growth_curves.png"
    try:
        said = draw_curves(Run(options.run), out)
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"growth_curves: no picture of {options.run}: {error}", file=sys.stderr)
        return 1
    print("\n".join([*said, f"wrote {out}"]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
