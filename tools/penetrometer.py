#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws what `rootsoil penetrometer` measured: resistance over depth, one line a seed, with the mean and its scatter.

Writes penetrometer.png into the folder of the results.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

WINDOW_MM = 0.1  # over which the lines are smoothed


def read_csv(path: Path) -> dict[int, dict[str, np.ndarray]]:
    """Columns by seed: depth_mm, Q_MPa, shaft_force_N, overlap_max, each (readings,)."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    seeds = sorted({int(row["seed"]) for row in rows})
    return {
        seed: {
            name: np.array([float(row[name]) for row in rows if int(row["seed"]) == seed])
            for name in ("depth_mm", "Q_MPa", "shaft_force_N", "overlap_max")
        }
        for seed in seeds
    }


def smoothed(depth_mm: np.ndarray, values: np.ndarray, window_mm: float) -> np.ndarray:
    """Mean over a window of depth around each reading; shorter at the ends. (n,), (n,) -> (n,)."""
    return np.array([values[np.abs(depth_mm - at) <= window_mm / 2].mean() for at in depth_mm])


def draw(folder: Path) -> Path:
    """The figure of one folder; OSError, KeyError, ValueError where its files are not those of a penetrometer."""
    seeds = read_csv(folder / "penetrometer.csv")
    found = json.loads((folder / "penetrometer.json").read_text())
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    for seed, columns in seeds.items():
        axes.plot(columns["depth_mm"], columns["Q_MPa"], color="0.8", linewidth=0.6)
    for seed, columns in seeds.items():
        line = smoothed(columns["depth_mm"], columns["Q_MPa"], WINDOW_MM)
        axes.plot(columns["depth_mm"], line, linewidth=1.4, label=f"seed {seed}")
    start, end = found["averaged_mm"]
    mean, scatter = found["Q_MPa"], found["Q_deviation_MPa"]
    axes.fill_between([start, end], mean - scatter, mean + scatter, color="black", alpha=0.12, linewidth=0)
    text = f"mean {mean:.2f} MPa"
    if len(seeds) > 1:
        text += rf" $\pm$ {scatter:.2f} between seeds"
    axes.plot([start, end], [mean, mean], color="black", linewidth=1.4, linestyle="--", label=text)
    axes.set_xlabel("depth of the tip (mm)")
    axes.set_ylabel("resistance Q (MPa)")
    axes.set_xlim(0, end)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, loc="lower right")
    axes.set_title(
        f"Q/P = {found['Q_over_P']:.1f} at P = {found['confining_pressure_MPa']:g} MPa, "
        f"inertial number {found['inertial_number']:.2g}",
        fontsize="medium",
    )
    axes.spines[["top", "right"]].set_visible(False)
    path = folder / "penetrometer.png"
    figure.savefig(path, dpi=150)
    plt.close(figure)
    return path


def main() -> int:
    """0, or 1 where the folder does not hold what it should."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder that `rootsoil penetrometer` wrote")
    folder = parser.parse_args().folder
    try:
        print(draw(folder))
    except (OSError, KeyError, ValueError) as error:
        print(f"penetrometer: {folder} holds no results of a penetrometer: {error!r}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
