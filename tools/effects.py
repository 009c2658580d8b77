#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What each effect costs, in time and memory, and where it takes part: writes docs/effects.md and its picture.

Three measurements: what `rootsoil check` finds in every scene of scenarios/; the main job and a 3D root with each
effect taken out in turn (processor time of the same number of steps, pair by pair, median); the main job with and
without [sleep], hour by hour. --quick: shorter ones, for CI, into --out only. What stands below the page's last mark is
written by hand and kept.
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rootsoil_tools import draw
from rootsoil_tools.cost import examine, hourly_cost, session
from rootsoil_tools.pages import kept_part
from rootsoil_tools.runs import Run, RunError
from rootsoil_tools.series import PROGRAM, PROJECT, without_sections

SCENARIOS = PROJECT / "scenarios"
JOBS = {"main job (2D)": SCENARIOS / "case2_arabidopsis.toml", "3D": SCENARIOS / "growth_3d.toml"}


@dataclass(frozen=True)
class Removal:
    """How to take an effect out of a scene: sections to leave out and keys to set."""

    effect: str
    sections: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    buys: str = ""


REMOVALS = (
    Removal("anisotropy", ("tissue.anisotropy",), buys="a root that keeps its width: growth goes along it"),
    Removal("growth", ("growth", "division"), buys="elongation (taken out together with division)"),
    Removal("division", ("division",), buys="cells of the measured lengths; without it they stretch for ever"),
    Removal("pair resistance", ("non_affine_control",), buys="no odd-even modes; bending needs it"),
)
SLEEP_HOURS = (2.0, 10.0, 20.0, 30.0, 40.0, 50.0)


# ---- scenes -----------------------------------------------------------------------------------------


def scene_table(program: Path) -> list[str]:
    """Effects, memory and processes of every scene."""
    found = {scene.stem: examine(program, scene) for scene in sorted(SCENARIOS.glob("*.toml"))}
    effects = [effect["name"] for effect in next(iter(found.values()))["effects"]]
    lines = ["| scene | " + " | ".join(effects) + " | bytes a cell | bytes a pair | processes |"]
    lines.append("|---" * (len(effects) + 4) + "|")
    for name, scene in found.items():
        active = {effect["name"] for effect in scene["effects"] if effect["active"]}
        marks = " | ".join("x" if effect in active else "" for effect in effects)
        lines.append(
            f"| `{name}` | {marks} | {scene['bytes_per_cell']} | {scene['bytes_per_pair']} | "
            f"{', '.join(scene['processes'])} |"
        )
    return lines


# ---- one effect less --------------------------------------------------------------------------------


def short_run_s(program: Path, scene: Path, settings: Sequence[str], steps: int, step_h: float, folder: Path) -> float:
    """Processor time of the first steps (s), less that of starting."""
    settings = [*settings, f"numerics.step_h={step_h!r}"]
    whole, start = (session(program, scene, folder, n * step_h, settings)["cpu_s"] for n in (steps, 1))
    return whole - start


def shares(program: Path, job: Path, steps: int, pairs: int, work: Path) -> list[str]:
    """A row for each effect: time and memory that it adds, against the same scene without it."""
    whole = examine(program, job)
    text, rows = job.read_text(encoding="utf-8"), []
    active = {effect["name"] for effect in whole["effects"] if effect["active"]}
    for removal in REMOVALS:
        if removal.effect not in active:
            continue
        scene = work / f"{job.stem}_without_{removal.effect.replace(' ', '_')}.toml"
        scene.write_text(without_sections(text, removal.sections), encoding="utf-8")
        less = examine(program, scene, removal.settings)
        ratios = []
        for _ in range(pairs):  # in turn: the machine's mood is the same for both
            with_it = short_run_s(program, job, (), steps, whole["step_h"], work / "run")
            without_it = short_run_s(program, scene, removal.settings, steps, whole["step_h"], work / "run")
            ratios.append(1.0 - without_it / with_it)
        cell = whole["bytes_per_cell"] - less["bytes_per_cell"]
        pair = whole["bytes_per_pair"] - less["bytes_per_pair"]
        rows.append(f"| {removal.effect} | {100 * np.median(ratios):+.0f} % | {cell} | {pair} | {removal.buys} |")
    return rows


# ---- sleep ------------------------------------------------------------------------------------------


def sleep_study(program: Path, job: Path, hours: Sequence[float], work: Path, out: Path) -> list[str]:
    """Cost per hour with and without [sleep]: CSV, picture, and the text's lines."""
    awake = work / f"{job.stem}_awake.toml"
    awake.write_text(without_sections(job.read_text(encoding="utf-8"), ("sleep",)), encoding="utf-8")
    rows = {
        name: hourly_cost(program, scene, hours, work / name) for name, scene in (("awake", awake), ("asleep", job))
    }
    with (out / "effects_sleep.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["from_h", "to_h", "awake_s_per_h", "asleep_s_per_h"])
        for (start, end, whole), (_, _, less) in zip(rows["awake"], rows["asleep"]):
            writer.writerow([start, end, f"{whole:.4g}", f"{less:.4g}"])
    draw_sleep(rows, out / "effects_sleep.png")
    runs = {name: Run(work / name) for name in rows}
    length = {name: float(run.history()["length_mm"][-1]) for name, run in runs.items()}
    lines = ["| hours | all awake, s/h | with `[sleep]`, s/h |", "|---|---|---|"]
    lines += [f"| {a:g}-{b:g} | {w:.2f} | {s:.2f} |" for (a, b, w), (_, _, s) in zip(rows["awake"], rows["asleep"])]
    resting, cells, woken = (
        int(runs["asleep"].history()[name][-1]) for name in ("cells_at_rest", "cells", "times_woken")
    )
    change = abs(length["asleep"] / length["awake"] - 1.0)
    lines += [
        "",
        f"At the end {resting} of {cells} cells rest, the root has woken {woken} times, "
        f"and its length differs by {change:.1e} from the one that was awake all the time.",
    ]
    return lines


def draw_sleep(rows: dict[str, list[tuple[float, float, float]]], path: Path) -> None:
    """Steps of cost over time."""
    draw.use_style()
    figure = draw.new_figure(88.0, 60.0)
    axes = draw.place(figure, 14.0, 11.0, 70.0, 45.0)
    for name, colour, label in (("awake", draw.THEORY, "all awake"), ("asleep", draw.SIMULATION, "with [sleep]")):
        edges = [rows[name][0][0], *(row[1] for row in rows[name])]
        axes.stairs([row[2] for row in rows[name]], edges, baseline=None, color=colour, linewidth=1.3, label=label)
    axes.set(xlabel="simulated time (h)", ylabel="processor time per simulated hour (s)")
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False, loc="upper left")
    figure.savefig(path, dpi=draw.DOTS_PER_INCH)


PAGE = """<!-- SPDX-License-Identifier: MIT -->
<!-- Written by tools/effects.py. What is changed here is lost. -->
# Effects: what a scene pays for

A section in the scene = an effect; an absent section = absent from memory, loops, phases and processes. `rootsoil check
SCENE` shows it for one scene, `rootsoil effects` lists them all. An effect that the program has and a scene does not
call for changes no bit of its results and no time. When `[sleep]` was added: the first hour of the main job by the
program before and after, five pairs in turn, 2.86 and 2.87 s of processor time (medians), history.csv the same to the
byte. tests/cli/test_absent_effects.py looks for fields, phases and pair terms that nobody called for.

## Which scene has what

{scenes}

## What each costs and buys

Processor time of the first {steps} steps with the effect, against the same scene without it (share of the whole; median
of {pairs} pairs run in turn, one thread, noise some 5 %), and the memory that goes with it.
A step takes as many iterations as its balance asks for, so that a share is also that of another root: without
anisotropy it bloats in place of growing long, and without growth it rests.

{shares}

Not in this table: the pressure differential (nothing that can be measured), obstacles (cells near the surface only),
soil (the soil's process takes some nine tenths of a run with few cells, half of one with many: the columns `soil_dem_s`
and `soil_exchange_s` of history.csv), probes (at outputs only).

## Only where and when it matters: `[sleep]`

Mature tissue that does not move leaves all loops: everything from the base up to two kernel reaches beyond the last
cell that strains by more than `strain_rate_per_h` or moves (mean over ten windows, or over `mean_over_h`). The cells in
between are held, as at the base. When their axial stress changes by more than `stress_change` of the pressure
differential (thrust, bending, a neighbour that moves), or the differential itself does, all wake; cells in contact with
an `[[obstacle]]` do not fall asleep. Those among grains do (below).

![Cost per simulated hour, with and without sleep](images/effects_sleep.png)

{sleep}

Without `[sleep]` the cost of an hour follows the root's length, with it the length of the part that grows. What it does
to the results is measured above and in tests/physics/sleep_test.cpp (places of cells within 0.5 % of a cell after an
hour; force on a plate within 2 %; same bits after a pause).

"""


def main() -> int:
    """0, or 1 with a message where a run failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a minute: 2D only, few steps, two hours of sleep")
    parser.add_argument("--out", type=Path, help="folder (default: docs and docs/images; with --quick: runs/effects)")
    parser.add_argument(
        "--work", type=Path, default=Path("runs/effects_work"), help="where runs go (default: %(default)s)"
    )
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/release/rootsoil")
    options = parser.parse_args()
    quick = options.quick
    page_folder = options.out or (Path("runs/effects") if quick else PROJECT / "docs")
    pictures = page_folder / "images"
    steps, pairs = (20, 1) if quick else (50, 3)
    try:
        pictures.mkdir(parents=True, exist_ok=True)
        options.work.mkdir(parents=True, exist_ok=True)
        table = []
        for name, job in list(JOBS.items())[: 1 if quick else None]:
            table += [
                f"**{name}**, `{job.stem}`",
                "",
                "| effect | time | bytes a cell | bytes a pair | what it buys |",
                "|---|---|---|---|---|",
            ]
            table += [*shares(options.program, job, steps, pairs, options.work), ""]
        hours = (2.0, 3.0, 5.0) if quick else SLEEP_HOURS
        sleep = sleep_study(options.program, JOBS["main job (2D)"], hours, options.work, pictures)
        scenes = scene_table(options.program)
    except subprocess.CalledProcessError as error:
        print(
            f"effects: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}: {error.stderr}",
            file=sys.stderr,
        )
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"effects: {error}", file=sys.stderr)
        return 1
    page = page_folder / "effects.md"
    text = PAGE.format(
        scenes="\n".join(scenes), shares="\n".join(table).rstrip(), sleep="\n".join(sleep), steps=steps, pairs=pairs
    )
    page.write_text(text + kept_part(page, "effects"), encoding="utf-8")
    print(f"wrote {page}, {pictures / 'effects_sleep.png'} and {pictures / 'effects_sleep.csv'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
