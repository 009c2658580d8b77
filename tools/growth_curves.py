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
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

from rootsoil_tools import draw, published
from rootsoil_tools.kinematics import END_MM, MEASURED, UNITS, curve, fit_to_published, published_curve, span_h
from rootsoil_tools.runs import Run, RunError

PAGE_WIDTH, PANEL_WIDTH, PANEL_HEIGHT, LEFT, BOTTOM, GAP = 184.0, 32.0, 36.0, 13.0, 11.0, 14.0


def draw_curves(run: Run, out: Path) -> list[str]:
    """Draws the figure; returns lines worth printing."""
    draw.use_style()
    height = BOTTOM + PANEL_HEIGHT + 15.0
    figure = draw.new_figure(PAGE_WIDTH, height)
    said = []
    first, last = span_h(run)
    for column, quantity in enumerate((*MEASURED, "radius")):
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
            dots = {"color": draw.DATA, "markersize": 2.4, "markeredgewidth": 0, "label": published.SOURCE}
            axes.plot(*published_curve(quantity), "o", **dots)
            fit = fit_to_published(run, quantity)
            unit = f" {UNITS[quantity].removeprefix('1')}"
            axes.set_title(f"$R^2$ {fit.r2:.3f}, RMSE {fit.rmse:.2g}{unit}", loc="right", size=7)
            name = quantity.replace("_", " ")
            said.append(f"{name}: R^2 {fit.r2:.4f}, RMSE {fit.rmse:.3g}{unit}, relative error {fit.relative_error:.3f}")
        else:
            hours = last - first
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
    figure.text(0.01, 0.985, f"{run.name}, {first:.3g}–{last:.3g} h", size=8, va="top")
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
