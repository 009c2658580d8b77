#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the impedance series and draws the paper's Fig. 5B: one scene under several pressure differentials.

Each run goes to OUT/p_<MPa>. Runs that are finished, of the same scene and by the same program, are taken as they
are; interrupted ones go on. Writes OUT/impedance.png (softening, axial strain rate, radial modulus and radius over the
distance from the tip), OUT/impedance.csv (the same numbers) and prints a table.
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

from rootsoil_tools import draw, measure
from rootsoil_tools.runs import Run, RunError
from rootsoil_tools.series import PROGRAM, PROJECT, Series
from rootsoil_tools.theory import ClosedForm

PRESSURES_MPA = (1.0, 0.825, 0.75, 0.625, 0.5, 0.4)
QUICK_FRACTION = 0.4  # of the scene's duration


@dataclass(frozen=True)
class Member:
    """One run of the series and what was measured in it."""

    p: float  # MPa
    model: ClosedForm
    s: np.ndarray  # mm
    profiles: dict[str, measure.Profile]
    tip_speed: float  # mm/h
    growth_zone: float  # mm
    mature_radius: float  # mm
    radius_drift: float  # 1/h


def measure_member(p: float, run: Run) -> Member:
    """Profiles and numbers of one run."""
    last = run.frame(-1)
    model = last.closed_form
    length = float(last["distance_to_tip"].max())
    zone = model.growth_zone(length)
    edges = measure.edges_of(min(1.3 * zone, length), measure.bin_width(last, run.dimension, zone))
    return Member(
        p=p,
        model=model,
        s=(edges[1:] + edges[:-1]) / 2.0,
        profiles=measure.growth_profiles(run, edges),
        tip_speed=measure.tip_speed(run),
        growth_zone=zone,
        mature_radius=measure.mature_radius(model, run),
        radius_drift=measure.radius_drift(model, run),
    )


def draw_series(members: list[Member], out: Path) -> None:
    """The four panels of Fig. 5B; light blue is the lowest pressure differential, dark blue the highest."""
    draw.use_style()
    figure = draw.new_figure(180.0, 132.0)
    width, height = 71.0, 44.0
    places = [(x, y) for y in (71.0, 12.0) for x in (16.0, 105.0)]
    panels = [draw.place(figure, x, y, width, height) for x, y in places]
    order = sorted(members, key=lambda member: member.p)
    blues = plt.get_cmap("Blues")(np.linspace(0.35, 1.0, len(order)))
    end = max(float(member.s[-1]) for member in members)
    for member, blue in zip(order, blues):
        s = np.linspace(0.0, end, 600)
        line = {"color": blue, "linewidth": 1.3}
        theory = {"color": draw.THEORY, "linewidth": 0.6, "linestyle": (0, (4, 3)), "zorder": 3}
        panels[0].plot(s, member.model.at("softening", s) / 1e3, label=f"{member.p:g}", **line)
        panels[2].plot(s, member.model.at("radial_modulus", s) / 1e3, **line)
        panels[1].plot(s, member.model.axial_rate(s), **theory)
        for panel, name in ((panels[1], "axial_strain_rate"), (panels[3], "radius")):
            profile = member.profiles[name]
            filled = np.isfinite(profile.mean)
            panel.plot(profile.s_mm[filled], profile.mean[filled], **line)
    labels = (
        "softening $\\lambda$ (10$^3$ µg mm$^{-3}$ h$^{-1}$)",
        "axial strain rate (1/h)",
        "radial modulus $E_R$ (GPa)",
        "radius (mm)",
    )
    for panel, label, name, (x, y) in zip(panels, labels, "ABCD", places):
        panel.set(ylabel=label, xlabel="distance from the tip (mm)", xlim=(0.0, end))
        panel.set_ylim(bottom=0.0)
        draw.letter(figure, x - 12.0, y + height + 1.0, name)
    panels[1].legend(
        handles=[
            Line2D([], [], color=blues[-1], linewidth=1.3, label="simulation"),
            Line2D([], [], color=draw.THEORY, linewidth=0.6, linestyle=(0, (4, 3)), label="closed form"),
        ],
        frameon=False,
        loc="upper right",
    )
    handles, names = panels[0].get_legend_handles_labels()
    legend = figure.legend(
        handles[::-1],
        names[::-1],
        title="pressure differential (MPa)",
        loc="upper center",
        bbox_to_anchor=(0.5, 1.0),
        ncol=len(names),
        frameon=False,
    )
    legend.get_title().set_fontsize(7.5)
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


def table(members: list[Member]) -> str:
    """The series in numbers, radii relative to that at the highest pressure differential."""
    reference = max(members, key=lambda member: member.p)
    lines = [
        f"{'p':>7} {'tip speed':>10} {'peak rate':>10} {'growth zone':>12} {'mature radius':>14} {'relative':>9} "
        f"{'drift':>8}",
        f"{'MPa':>7} {'mm/h':>10} {'1/h':>10} {'mm':>12} {'mm':>14} {f'to p = {reference.p:g}':>9} {'%/10 h':>8}",
    ]
    for m in members:
        peak = np.nanmax(m.profiles["axial_strain_rate"].mean)
        relative = 100.0 * (m.mature_radius / reference.mature_radius - 1.0)
        lines.append(
            f"{m.p:7g} {m.tip_speed:10.4f} {peak:10.4f} {m.growth_zone:12.3f} {m.mature_radius:14.4f} "
            f"{relative:+8.1f}% {1e3 * m.radius_drift:8.2f}"
        )
    if any(np.isnan(m.mature_radius) for m in members):
        lines.append("nan: no new tissue has left the growth zone yet, the run is too short")
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
    except subprocess.CalledProcessError as error:
        print(f"impedance: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}", file=sys.stderr)
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"impedance: {error}", file=sys.stderr)
        return 1
    print(table(members))
    print(f"wrote {options.out / 'impedance.png'} and {options.out / 'impedance.csv'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
