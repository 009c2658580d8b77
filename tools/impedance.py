#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the impedance series and draws the paper's Fig. 5B: one scene under several pressure differentials.

Each run goes to OUT/p_<MPa>. Runs that are finished, of the same scene and by the same program, are taken as they
are; interrupted ones go on. Writes OUT/impedance.png (softening, axial strain rate, radial modulus and radius over the
distance from the tip; speed and radius over the soil's strength), OUT/impedance.csv (the profiles) and
OUT/impedance_series.csv (a row for each pressure), and prints the latter beside published numbers.
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.lines import Line2D

from rootsoil_tools import draw, published
from rootsoil_tools.impedance_series import HARD_MPA, PRESSURES_MPA, SOFT_MPA, Member, halved_at, measure_member
from rootsoil_tools.runs import Run, RunError
from rootsoil_tools.series import PROGRAM, PROJECT, Series

QUICK_FRACTION = 0.4  # of the scene's duration
# Rows of tools/data/reference_values.csv.
PEAK = "peak axial strain rate p=1 (authors' own calibration target)"
WIDER = "diameter increase soft to hard soil"
HALVES = "penetrometer resistance that halves elongation"
FORCE = "maximum axial growth pressure"


@dataclass(frozen=True)
class Comparison:
    """A number of the series beside the published one, and where this is drawn."""

    what: str
    found: float
    reference: published.Reference
    panel: int  # -1: in none
    beside: float  # coordinate on the other axis
    vertical: bool  # whether the number is one of the panel's y axis

    def __str__(self) -> str:
        low, high = f"{self.reference.low:g}", f"{self.reference.high:g}"
        asked = low if low == high else f"{low} to {high}"
        unit = "" if self.reference.unit == "1" else f" {self.reference.unit}"
        found = f"{self.found:.3g}{unit}" if np.isfinite(self.found) else "none"
        return f"{self.what}: {found}, published {asked}{unit} ({self.reference.source})"


def comparisons(order: list[Member]) -> list[Comparison]:
    """What is published of pea in soft and in hard soil, as far as the series, from soft to hard, has these."""
    found: list[Comparison] = []

    def compare(what: str, value: float, name: str, panel: int, beside: float, vertical: bool) -> None:
        species = "various" if name == HALVES else "pea"
        found.append(Comparison(what, value, published.reference(name, species), panel, beside, vertical))

    soft, hard = (next((member for member in order if member.p == p), None) for p in (SOFT_MPA, HARD_MPA))
    if soft:
        peak, peak_at = soft.peak_rate, float(soft.s[np.nanargmax(soft.profiles["axial_strain_rate"].mean)])
        compare("peak strain rate in soft soil", peak, PEAK, 1, peak_at, True)
        compare("growth zone in soft soil", soft.growth_zone, "growth zone in soft soil", 1, 0.05 * peak, False)
        compare("penetrometer resistance that halves the speed", halved_at(order), HALVES, 4, 0.5, False)
        compare("stress that arrests growth in soft soil", soft.model.arrest_stress, FORCE, -1, 0.0, False)
    if hard:
        at = 0.05 * hard.peak_rate
        compare("growth zone in hard soil", hard.growth_zone, "growth zone in hard soil", 1, at, False)
    if soft and hard:
        wider = hard.mature_radius / soft.mature_radius - 1.0
        compare("mature radius, hard over soft soil, less 1", wider, WIDER, 5, hard.penetrometer, True)
    return found


def draw_series(members: list[Member], out: Path) -> None:
    """The four panels of Fig. 5B, and two over the soil's strength; light blue is the lowest pressure differential,
    dark blue the highest, orange what is published."""
    draw.use_style()
    figure = draw.new_figure(180.0, 206.0)
    width, height = 71.0, 44.0
    places = [(x, y) for y in (145.0, 86.0, 27.0) for x in (16.0, 105.0)]
    panels = [draw.place(figure, x, y, width, height) for x, y in places]
    order = sorted(members, key=lambda member: -member.p)
    blues = plt.get_cmap("Blues")(np.linspace(1.0, 0.35, len(order)))
    end = max(float(member.s[-1]) for member in members)
    dashed = {"color": draw.THEORY, "linewidth": 0.6, "linestyle": (0, (4, 3)), "zorder": 3}
    published_bar = {"color": draw.DATA, "linewidth": 2.0, "marker": "o", "markersize": 3.5, "zorder": 4}
    for member, blue in zip(order, blues):
        s = np.linspace(0.0, end, 600)
        line = {"color": blue, "linewidth": 1.3}
        panels[0].plot(s, member.model.at("softening", s) / 1e3, label=f"{member.p:g}", **line)
        panels[2].plot(s, member.model.at("radial_modulus", s) / 1e3, **line)
        panels[1].plot(s, member.model.axial_rate(s), **dashed)
        for panel, name in ((panels[1], "axial_strain_rate"), (panels[3], "radius")):
            profile = member.profiles[name]
            filled = np.isfinite(profile.mean)
            panel.plot(profile.s_mm[filled], profile.mean[filled], **line)
        for panel, value in (
            (panels[4], member.tip_speed / order[0].tip_speed),
            (panels[5], member.mature_radius / order[0].mature_radius - 1.0),
        ):
            panel.plot(member.penetrometer, value, "D", color=blue, markersize=4.5)
    drawn = [known for known in comparisons(order) if known.panel >= 0]
    for known in drawn:
        span, beside = [known.reference.low, known.reference.high], [known.beside, known.beside]
        panels[known.panel].plot(*((beside, span) if known.vertical else (span, beside)), **published_bar)
    softest = f"at p = {order[0].p:g} MPa"
    labels = (
        "softening $\\lambda$ (10$^3$ µg mm$^{-3}$ h$^{-1}$)",
        "axial strain rate (1/h)",
        "radial modulus $E_R$ (GPa)",
        "radius (mm)",
        f"tip speed over that\n{softest}",
        f"mature radius over that\n{softest}, less 1",
    )
    for index, (panel, label, name, (x, y)) in enumerate(zip(panels, labels, "ABCDEF", places)):
        panel.set_ylabel(label)
        if index < 4:
            panel.set(xlabel="distance from the tip (mm)", xlim=(0.0, end))
        else:
            panel.set(xlabel="penetrometer resistance, 4 (1 MPa − $p$) (MPa)", xlim=(-0.1, None))
        panel.set_ylim(bottom=0.0)
        draw.letter(figure, x - 12.0, y + height + 1.0, name)
    panels[1].legend(
        handles=[
            Line2D([], [], color=blues[0], linewidth=1.3, label="simulation"),
            Line2D([], [], **dashed, label="closed form"),
            Line2D([], [], **published_bar, label="published"),
        ],
        frameon=False,
        loc="upper right",
    )
    handles, names = panels[0].get_legend_handles_labels()
    legend = figure.legend(
        handles,
        names,
        title="pressure differential (MPa)",
        loc="upper center",
        bbox_to_anchor=(0.5, 1.0),
        ncol=len(names),
        frameon=False,
    )
    legend.get_title().set_fontsize(7.5)
    sources = [f"{'ABCDEF'[known.panel]}, {known.what}: {known.reference.source}" for known in drawn]
    figure.text(4.0 / 180.0, 2.0 / 206.0, "Published:\n" + "\n".join(sources), size=5.5, va="bottom", linespacing=1.3)
    figure.savefig(out, dpi=draw.DOTS_PER_INCH)
    plt.close(figure)


def write_csv(members: list[Member], out: Path) -> None:
    """One row for each pressure and bin."""
    with out.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(
            ["p_MPa", "distance_mm", "softening_ug_mm3_h", "radial_modulus_MPa", "axial_strain_rate_per_h"]
            + ["axial_strain_rate_closed_form_per_h", "radius_mm"]
        )
        for m in members:
            columns = [m.s, m.model.at("softening", m.s), m.model.at("radial_modulus", m.s)]
            columns += [m.profiles["axial_strain_rate"].mean, m.model.axial_rate(m.s), m.profiles["radius"].mean]
            for row in np.stack(columns, axis=1):
                writer.writerow([f"{m.p:g}", *(f"{value:.6g}" for value in row)])


def numbers(member: Member, softest: Member) -> dict[str, float]:
    """A row of the series."""
    return {
        "p_MPa": member.p,
        "tip_speed_mm_h": member.tip_speed,
        "peak_rate_per_h": member.peak_rate,
        "growth_zone_mm": member.growth_zone,
        "rate_R2": member.fit.r2,
        "rate_RMSE_per_h": member.fit.rmse,
        "mature_radius_mm": member.mature_radius,
        "relative_radius": member.mature_radius / softest.mature_radius,
        "drift_percent_10h": 1e3 * member.radius_drift,
    }


def table(rows: list[dict[str, float]]) -> str:
    """The series in numbers: strain rates against the closed form, radii relative to that at the highest p."""
    lines = ["  ".join(rows[0])]
    lines += ["  ".join(f"{value:{len(name)}.5g}" for name, value in row.items()) for row in rows]
    if any(np.isnan(value) for row in rows for value in row.values()):
        lines.append("nan: no new tissue has left the growth zone (the run is too short, or all of the root grows)")
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "scene", type=Path, nargs="?", default=PROJECT / "scenarios" / "case3_pea_soft.toml", help="scene file"
    )
    parser.add_argument("--out", type=Path, default=Path("runs/impedance"), help="folder (default: %(default)s)")
    parser.add_argument(
        "--pressures", type=float, nargs="+", default=PRESSURES_MPA, metavar="MPa", help="default: those of the paper"
    )
    parser.add_argument("--quick", action="store_true", help=f"only {QUICK_FRACTION:g} of the scene's duration")
    parser.add_argument("--accuracy", choices=("fast", "balanced", "reference"), help="passed on to the runs")
    parser.add_argument("--threads", type=int, help="passed on to the runs")
    parser.add_argument(
        "--program",
        type=Path,
        default=PROGRAM,
        help="default: build/release/rootsoil",
    )
    options = parser.parse_args()
    arguments = ["--accuracy", options.accuracy] if options.accuracy else []
    try:
        duration = float(tomllib.loads(options.scene.read_text(encoding="utf-8"))["scene"]["duration_h"])
        until = duration * (QUICK_FRACTION if options.quick else 1.0)
        series = Series(options.scene, options.out, options.program, arguments, options.threads)
        members = []
        for p in options.pressures:
            folder = series.run(f"p_{p:g}", [f"pressure.differential_MPa={p:g}"], until)
            members.append(measure_member(p, Run(folder)))
        draw_series(members, options.out / "impedance.png")
        write_csv(members, options.out / "impedance.csv")
        rows = [numbers(member, max(members, key=lambda m: m.p)) for member in members]
        with (options.out / "impedance_series.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows({name: f"{value:.6g}" for name, value in row.items()} for row in rows)
    except subprocess.CalledProcessError as error:
        print(f"impedance: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}", file=sys.stderr)
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"impedance: {error}", file=sys.stderr)
        return 1
    print(table(rows))
    for known in comparisons(sorted(members, key=lambda member: -member.p)):
        print(known)
    print(f"wrote impedance.png, impedance.csv and impedance_series.csv to {options.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
