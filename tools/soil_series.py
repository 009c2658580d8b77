#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Series of runs through explicit soil: what uniform pressure each soil amounts to, and what a root's flexibility does.

pressure     One root through soils of several confining pressures, several samples (seeds) each, beside a penetrometer
             in the same samples and the same root without soil under the pressure that gives it the same force-limited
             speed. Writes pressure.csv, pressure.png and a table: tip speed against force and resistance, with the
             paper's bridge p = turgor - Q/4.
flexibility  Roots of several axial moduli across a gap into the same soil, softening in proportion so that all grow
             alike, beside a penetrometer over the depths that the stiffest one reaches: the rigid root. Writes
             flexibility.csv, flexibility.png and a table.

Runs go to OUT; finished ones are taken as they are, interrupted ones go on.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rootsoil_tools import draw, measure
from rootsoil_tools.runs import Run, RunError
from rootsoil_tools.series import PROGRAM, PROJECT, Series, resistance_MPa, without_sections

PRESSURES_MPA = (0.01, 0.02, 0.035, 0.05)
MODULI_MPA = (1600.0, 400.0, 200.0, 100.0, 50.0)
SEEDS = 3
SETTLED_FROM = 0.25  # of the run: before, forces rise
SHALLOW = 0.3  # of the depth that the stiffest root reaches: the penetrometer counts from there
DEPTHS_MM = (1.2, 2.6)  # over which the penetrometer's resistance is averaged
SOIL_SECTIONS = ("soil", "soil.contact", "soil.obstacle", "penetrometer")
SCENES = {"pressure": "soil_tutorial", "flexibility": "soil_buckling"}
QUICK: dict[str, Any] = {"pressures": (0.01, 0.05), "moduli": (1600.0, 100.0), "seeds": 1, "fraction": 0.25}


@dataclass(frozen=True)
class Passage:
    """A root's way through one sample; means from SETTLED_FROM on. Forces in N (2D: N/mm), speeds in mm/h."""

    confining_MPa: float
    E_axial_MPa: float
    seed: int
    tip_speed: float
    expected_speed: float  # from the soil's forces, closed form
    free_speed: float  # without soil, closed form
    tip_force: float
    arresting_force: float
    resistance_MPa: float  # tip force over the section
    radius_mm: float
    pressure_MPa: float  # the differential, which is the turgor

    @property
    def relative_speed(self) -> float:
        """Tip speed over that without soil."""
        return self.tip_speed / self.free_speed

    @property
    def relative_force(self) -> float:
        """Tip force over that which arrests the root."""
        return self.tip_force / self.arresting_force

    @property
    def deviation(self) -> float:
        """Of the speed from the one that the forces allow, over the free speed."""
        return (self.tip_speed - self.expected_speed) / self.free_speed


def mean_from(time_h: np.ndarray, values: np.ndarray, start_h: float) -> float:
    """Mean of evenly spaced values (n,) from start_h on; what is not finite does not count."""
    return float(np.nanmean(values[time_h >= start_h - 1e-9]))


def measure_passage(run: Run) -> Passage:
    """Means of one run. RunError: it has no soil."""
    history, scene = run.history(), run.scene
    if "soil_tip_force_N" not in history:
        raise RunError(f"{run.folder} is no run through soil")
    time = history["time_h"]
    start = SETTLED_FROM * float(time[-1])
    late = time >= start - 1e-9
    model = run.frame(-1).closed_form
    return Passage(
        confining_MPa=float(scene["soil"]["confining_pressure_MPa"]),
        E_axial_MPa=float(scene["tissue"]["E_axial_MPa"]),
        seed=int(scene["soil"]["seed"]),
        tip_speed=float(np.polyfit(time[late], history["length_mm"][late], 1)[0]),
        expected_speed=mean_from(time, history["soil_expected_tip_speed_mm_h"], start),
        free_speed=model.tip_speed(mean_from(time, history["length_mm"], start)),
        tip_force=mean_from(time, history["soil_tip_force_N"], start),
        arresting_force=measure.arresting_force(model, run),
        resistance_MPa=mean_from(time, history["soil_tip_resistance_MPa"], start),
        radius_mm=zone_radius(run),
        pressure_MPa=model.p,
    )


def zone_radius(run: Run) -> float:
    """Mean radius (mm) of the tissue in the proximal half of the growth zone, at the end."""
    frame = run.frame(-1)
    zone = frame.closed_form.growth_zone(float(frame["distance_to_tip"].max()))
    return float(np.nanmean(measure.radii(frame, run.dimension, np.linspace(0.5 * zone, zone, 4))))


def probe_settings(scene: dict, rate_mm_h: float, seeds: int, depths_mm: tuple[float, float]) -> list[str]:
    """Keys of a penetrometer as wide as the root, averaged between two depths."""
    keys = {"diameter_mm": 2.0 * float(scene["root"]["radius_mm"]), "rate_mm_h": rate_mm_h, "seeds": seeds}
    keys |= {"average_from_mm": depths_mm[0], "depth_mm": depths_mm[1]}
    return [f"penetrometer.{key}={value:g}" for key, value in keys.items()]


def write_csv(passages: Sequence[Passage], extra: Sequence[dict[str, float]], path: Path) -> None:
    """A row a run: the fields of Passage, its ratios, and `extra` columns."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = [
            {
                **dataclasses.asdict(p),
                "relative_speed": p.relative_speed,
                "relative_force": p.relative_force,
                "deviation": p.deviation,
                **more,
            }
            for p, more in zip(passages, extra)
        ]
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({name: f"{value:.6g}" for name, value in row.items()})


def spread(values: Sequence[float]) -> str:
    """Mean +- standard deviation over samples."""
    scatter = float(np.std(values, ddof=1)) if len(values) > 1 else float("nan")
    return f"{np.mean(values):.3f} +- {scatter:.3f}"


# ---- pressure ---------------------------------------------------------------------------------------


def bridge_factor(relative_speed: float, Q_over_turgor: float) -> float:
    """k of speed/free speed = 1 - k Q/turgor: 1/4 in the paper's bridge."""
    return (1.0 - relative_speed) / Q_over_turgor


def draw_pressure(passages: Sequence[Passage], Q_MPa: dict[float, float], path: Path) -> None:
    """Speed against confining pressure, against force and against the penetrometer's resistance."""
    draw.use_style()
    figure = draw.new_figure(180.0, 66.0)
    places = [14.0, 74.0, 134.0]
    panels = [draw.place(figure, x, 12.0, 42.0, 44.0) for x in places]
    turgor = passages[0].pressure_MPa
    axes = (
        ([p.confining_MPa for p in passages], "confining pressure (MPa)"),
        ([p.relative_force for p in passages], "tip force / arresting force"),
        ([Q_MPa[p.confining_MPa] / turgor for p in passages], "penetrometer's $Q$ / turgor"),
    )
    for panel, (x, label), place, name in zip(panels, axes, places, "ABC"):
        panel.plot(x, [p.relative_speed for p in passages], "o", color=draw.SIMULATION, markersize=3.5, alpha=0.75)
        panel.set(xlabel=label, ylim=(0.0, 1.05))
        panel.set_xlim(0.0, 1.15 * max(x))
        draw.letter(figure, place - 10.0, 58.0, name)
    panels[0].set_ylabel("tip speed / without soil")
    confining = sorted({p.confining_MPa for p in passages})
    means = [np.mean([p.relative_speed for p in passages if p.confining_MPa == c]) for c in confining]
    panels[0].plot(confining, means, "-", color=draw.SIMULATION, linewidth=1.0)
    theory = {"color": draw.THEORY, "linewidth": 0.9}
    line(panels[1], 1.0, "closed form", linestyle="--", **theory)
    line(panels[2], 1.0, "$p$ = turgor - $Q$", linestyle="--", **theory)
    line(panels[2], 0.25, "$p$ = turgor - $Q$/4 (paper)", linestyle=":", **theory)
    for panel in panels[1:]:
        panel.legend(frameon=False, loc="lower left")
    figure.savefig(path, dpi=draw.DOTS_PER_INCH)


def line(axes: Axes, factor: float, label: str, **style: object) -> None:
    """1 - factor x over the panel's width."""
    x = np.array(axes.get_xlim())
    axes.plot(x, 1.0 - factor * x, label=label, **style)


def pressure_series(options: argparse.Namespace, until_h: float) -> str:
    """Runs, measures, draws; returns the table."""
    series = Series(options.scene, options.out, options.program, threads=options.threads)
    scene = tomllib.loads(options.scene.read_text(encoding="utf-8"))
    uniform = options.out / "uniform.toml"
    options.out.mkdir(parents=True, exist_ok=True)
    uniform.write_text(without_sections(options.scene.read_text(encoding="utf-8"), SOIL_SECTIONS), encoding="utf-8")
    alone = Series(uniform, options.out, options.program, threads=options.threads)
    passages: list[Passage] = []
    extra: list[dict[str, float]] = []
    Q_MPa: dict[float, float] = {}
    lines = [
        f"{'P':>6} {'speed/free':>16} {'force/arresting':>16} {'deviation':>10} {'Q probe':>8} {'Q root':>7} {'k':>6} "
        f"{'matched p':>10} {'speed':>7} {'radius':>8} {'in soil':>8}",
        f"{'MPa':>6} {'':>16} {'':>16} {'% (most)':>10} {'MPa':>8} {'MPa':>7} {'':>6} "
        f"{'MPa':>10} {'/free':>7} {'mm':>8} {'mm':>8}",
    ]
    for confining in options.pressures:
        soil = [f"soil.confining_pressure_MPa={confining:g}"]
        here = [
            measure_passage(Run(series.run(f"P_{confining:g}_seed_{seed}", [*soil, f"soil.seed={seed}"], until_h)))
            for seed in range(1, options.seeds + 1)
        ]
        probe = series.penetrometer(
            f"P_{confining:g}_probe", soil + probe_settings(scene, here[0].free_speed, options.seeds, DEPTHS_MM)
        )
        Q_MPa[confining] = resistance_MPa(probe)
        turgor = here[0].pressure_MPa
        matched = turgor * (1.0 - float(np.mean([p.relative_force for p in here])))
        run = Run(alone.run(f"P_{confining:g}_matched", [f"pressure.differential_MPa={matched:.6g}"], until_h))
        matched_speed = measure.tip_speed(run) / here[0].free_speed
        matched_radius = zone_radius(run)
        passages += here
        extra += [
            {"probe_Q_MPa": Q_MPa[confining], "matched_p_MPa": matched, "matched_speed": matched_speed}
            | {"matched_radius_mm": matched_radius}
        ] * len(here)
        relative = [p.relative_speed for p in here]
        worst = max((p.deviation for p in here), key=abs)
        lines.append(
            f"{confining:6g} {spread(relative):>16} {spread([p.relative_force for p in here]):>16} "
            f"{100 * worst:+10.1f} {Q_MPa[confining]:8.3f} {np.mean([p.resistance_MPa for p in here]):7.3f} "
            f"{bridge_factor(float(np.mean(relative)), Q_MPa[confining] / turgor):6.2f} {matched:10.3f} "
            f"{matched_speed:7.3f} {matched_radius:8.4f} {np.mean([p.radius_mm for p in here]):8.4f}"
        )
    write_csv(passages, extra, options.out / "pressure.csv")
    draw_pressure(passages, Q_MPa, options.out / "pressure.png")
    turgor = passages[0].pressure_MPa
    off = {
        name: np.mean([p.relative_speed - (1.0 - k * Q_MPa[p.confining_MPa] / turgor) for p in passages])
        for name, k in (("turgor - Q/4", 0.25), ("turgor - Q", 1.0))
    }
    lines.append(
        "deviation: of the tip speed from the one the forces allow, over the free speed; k: speed/free = 1 - k Q/turgor"
    )
    lines.append("; ".join(f"p = {name}: speed/free is off by {100 * d:+.0f} % on average" for name, d in off.items()))
    return "\n".join(lines)


# ---- flexibility ------------------------------------------------------------------------------------


def scaled_root(scene: dict, E_axial_MPa: float) -> list[str]:
    """Keys of the scene's root with another axial modulus; the others and the softening follow: strain rates stay."""
    scale = E_axial_MPa / float(scene["tissue"]["E_axial_MPa"])
    keys = {
        "tissue.E_axial_MPa": E_axial_MPa,
        "tissue.anisotropy.E_radial_max_MPa": scale * float(scene["tissue"]["anisotropy"]["E_radial_max_MPa"]),
        "growth.lambda0_ug_mm3_h": scale * float(scene["growth"]["lambda0_ug_mm3_h"]),
    }
    return [f"{key}={float(value)!r}" for key, value in keys.items()]


def flexibility_series(options: argparse.Namespace, until_h: float) -> str:
    """Runs, measures, draws; returns the table."""
    series = Series(options.scene, options.out, options.program, threads=options.threads)
    scene = tomllib.loads(options.scene.read_text(encoding="utf-8"))
    runs = [
        Run(series.run(f"E_{E:g}_seed_{seed}", [*scaled_root(scene, E), f"soil.seed={seed}"], until_h))
        for E in options.moduli
        for seed in range(1, options.seeds + 1)
    ]
    passages = [measure_passage(run) for run in runs]
    stiffest = runs[int(np.argmax([p.E_axial_MPa for p in passages]))].history()
    reached_mm = float(stiffest["tip_x_mm"][-1]) - float(scene["soil"]["box_from_mm"][0])
    depths = (SHALLOW * reached_mm, reached_mm)
    width = 2.0 * float(scene["root"]["radius_mm"])
    probe = series.penetrometer("probe", probe_settings(scene, passages[0].free_speed, options.seeds, depths))
    rigid = resistance_MPa(probe) * (
        width if int(scene["scene"].get("dimension", 2)) == 2 else np.pi * width**2 / 4.0
    )
    write_csv(passages, [{"rigid_force": rigid}] * len(passages), options.out / "flexibility.csv")
    draw_flexibility(passages, rigid, options.out / "flexibility.png")
    lines = [
        f"{'E_A (MPa)':>9} {'tip force (N/mm)':>17} {'over rigid':>10} {'speed/free':>16} {'deviation, % (most)':>20}"
    ]
    for E in options.moduli:
        here = [p for p in passages if p.E_axial_MPa == E]
        force = [p.tip_force for p in here]
        lines.append(
            f"{E:9g} {spread(force):>17} {np.mean(force) / rigid:10.3f} {spread([p.relative_speed for p in here]):>16} "
            f"{100 * max((p.deviation for p in here), key=abs):+20.1f}"
        )
    lines.append(f"rigid root (penetrometer): {rigid:.3f} N/mm")
    return "\n".join(lines)


def draw_flexibility(passages: Sequence[Passage], rigid: float, path: Path) -> None:
    """Mean tip force against flexibility 1/E_A, with the rigid root's as the cap."""
    draw.use_style()
    figure = draw.new_figure(88.0, 66.0)
    axes = draw.place(figure, 16.0, 12.0, 66.0, 48.0)
    axes.semilogx(
        [1.0 / p.E_axial_MPa for p in passages],
        [p.tip_force for p in passages],
        "o",
        color=draw.SIMULATION,
        markersize=3.5,
    )
    moduli = sorted({p.E_axial_MPa for p in passages})
    means = [np.mean([p.tip_force for p in passages if p.E_axial_MPa == E]) for E in moduli]
    axes.semilogx(
        [1.0 / E for E in moduli], means, "-", color=draw.SIMULATION, linewidth=1.0, label="mean over samples"
    )
    axes.axhline(rigid, color=draw.THEORY, linestyle="--", linewidth=0.9, label="rigid root (penetrometer)")
    axes.set(xlabel="flexibility 1/$E_A$ (1/MPa)", ylabel="mean tip force (N/mm)")
    axes.set_ylim(0.0, 1.15 * max(rigid, max(p.tip_force for p in passages)))
    axes.legend(frameon=False, loc="lower left")
    figure.savefig(path, dpi=draw.DOTS_PER_INCH)


def main() -> int:
    """0, or 1 with a message where a run failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=("pressure", "flexibility"))
    parser.add_argument("--scene", type=Path, help=f"default: one of scenarios/, {SCENES}")
    parser.add_argument("--out", type=Path, help="folder (default: runs/soil_STUDY)")
    parser.add_argument("--pressures", type=float, nargs="+", metavar="MPa", help=f"default: {PRESSURES_MPA}")
    parser.add_argument("--moduli", type=float, nargs="+", metavar="MPa", help=f"default: {MODULI_MPA}")
    parser.add_argument("--seeds", type=int, help=f"samples of each soil (default: {SEEDS})")
    parser.add_argument("--quick", action="store_true", help="two members, one sample, a quarter of the time")
    parser.add_argument("--threads", type=int, help="passed on to the runs")
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/release/rootsoil")
    options = parser.parse_args()
    quick = options.quick
    options.scene = options.scene or PROJECT / "scenarios" / f"{SCENES[options.study]}.toml"
    options.out = options.out or Path("runs") / f"soil_{options.study}"
    options.pressures = options.pressures or (QUICK["pressures"] if quick else PRESSURES_MPA)
    options.moduli = options.moduli or (QUICK["moduli"] if quick else MODULI_MPA)
    options.seeds = options.seeds or (QUICK["seeds"] if quick else SEEDS)
    try:
        duration = float(tomllib.loads(options.scene.read_text(encoding="utf-8"))["scene"]["duration_h"])
        study = pressure_series if options.study == "pressure" else flexibility_series
        print(study(options, duration * (QUICK["fraction"] if quick else 1.0)))
    except subprocess.CalledProcessError as error:
        print(f"soil_series: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}", file=sys.stderr)
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"soil_series: {error}", file=sys.stderr)
        return 1
    print(f"wrote {options.out / options.study}.png and .csv")
    return 0


if __name__ == "__main__":
    sys.exit(main())
