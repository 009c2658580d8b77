#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How fast the program is: jobs, scaling with cells, and the pair loops against what the machine can do.

Writes OUT/performance.csv, a row a number, OUT/images/performance_scaling.png and performance_roofline.png, and without
--quick OUT/performance.md; what stands below that page's last mark is written by hand and kept. --only PART... measures
these anew and takes the others from the file; --only alone measures nothing and draws. The million cells need 11 GB.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from rootsoil_tools import performance_page, roofline
from rootsoil_tools.cost import examine, hourly_cost, session, stepping_s
from rootsoil_tools.pages import kept_part
from rootsoil_tools.performance_page import Row
from rootsoil_tools.runs import Run, RunError, read_summary
from rootsoil_tools.scenes import scene_text, with_changes
from rootsoil_tools.series import PROGRAM, PROJECT
from rootsoil_tools.theory import cumulative_integral

SCENARIOS = PROJECT / "scenarios"
INERTIA = ("numerics.stepper=symplectic",)
FULL_NAME = "paper's S3"


@dataclass(frozen=True)
class Job:
    """A scene as a whole, for these numbers of threads, and its first hours with inertia."""

    name: str
    scene: str
    hours: float
    with_inertia_h: float
    threads: tuple[int, ...] = (1,)


@dataclass(frozen=True)
class Plan:
    """How much is measured."""

    jobs: tuple[Job, ...]
    hours: tuple[float, float, float, float]  # from, to of an early stretch, from, to of a late one
    across: tuple[int, ...]
    steps: int  # of roots of many cells
    roofline_across: int
    inertia_steps: int
    triad_mb: int


FULL = Plan(
    jobs=(
        Job("main job", "case2_arabidopsis", 50.0, 10.0, threads=(1, 2)),
        Job("3D growth", "growth_3d", 10.0, 2.0),
        Job("tilted obstacle", "obstacle_tilted", 8.0, 2.0),
    ),
    hours=(5.0, 15.0, 40.0, 50.0),
    across=(5, 8, 12, 17, 25, 36, 54),
    steps=3,
    roofline_across=25,
    inertia_steps=40,
    triad_mb=256,
)
QUICK = Plan(
    jobs=(
        Job("main job", "case2_arabidopsis", 0.2, 0.01, threads=(1, 2)),
        Job("3D growth", "growth_3d", 0.25, 0.01),
        Job("tilted obstacle", "obstacle_tilted", 0.1, 0.002),
    ),
    hours=(0.1, 0.2, 0.3, 0.4),
    across=(4, 6),
    steps=2,
    roofline_across=6,
    inertia_steps=20,
    triad_mb=32,
)


class Bench:
    """Runs below a folder, and what they come to as rows."""

    def __init__(self, program: Path, work: Path, plan: Plan, repeat: int):
        self.program, self.work, self.plan, self.repeat = program, work, plan, repeat
        work.mkdir(parents=True, exist_ok=True)

    def jobs(self) -> list[Row]:
        """Every job as a whole; of one thread also where its steps spend their time."""
        rows = []
        for job in self.plan.jobs:
            for threads in job.threads:
                name = f"{job.name} ({threads} thread{'s' if threads > 1 else ''})"
                folder = self.work / job.scene
                told = []
                for _ in range(self.repeat):
                    self.run(job, folder, job.hours, threads=threads)
                    told.append(whole_run(folder))
                print(f"{name}: {told[-1]['cpu_s']:.3g} s", flush=True)
                rows += [Row("jobs", name, q, float(np.median([t[q] for t in told]))) for q in told[0]]
                if threads == 1:
                    summary = read_summary(folder)
                    spent = summary["wall_s_by_effect"].items()
                    rows += [Row("phases", job.name, phase, s / summary["wall_s"]) for phase, s in spent]
        return rows

    def ratios(self) -> list[Row]:
        """The first hours of every job with inertia and without, in turn."""
        rows = []
        for job in self.plan.jobs:
            pairs = []
            for _ in range(self.repeat):  # the machine's mood is the same for both
                pair = [stepping_s(self.run(job, self.work / "first", job.with_inertia_h, s)) for s in (INERTIA, ())]
                pairs.append([*pair, pair[0] / pair[1]])
            medians = np.median(pairs, axis=0)
            print(f"{job.name}: {medians[2]:.3g} times faster than with inertia", flush=True)
            quantities = zip(("inertia_cpu_s", "balance_cpu_s", "ratio"), medians)
            rows += [Row("ratios", job.name, q, float(v)) for q, v in (("hours", job.with_inertia_h), *quantities)]
        return rows

    def hours(self) -> list[Row]:
        """What an hour of the main job costs, early and late."""
        scene = SCENARIOS / f"{self.plan.jobs[0].scene}.toml"
        costs = []
        for _ in range(self.repeat):
            _, early, _, late = hourly_cost(self.program, scene, self.plan.hours, self.work / "hours")
            costs.append([early[2], late[2], late[2] / early[2]])
        early_s, late_s, ratio = (float(v) for v in np.median(costs, axis=0))
        a, b, c, d = self.plan.hours
        return [
            Row("hours", f"{a:g}-{b:g}", "cpu_s_per_h", early_s),
            Row("hours", f"{c:g}-{d:g}", "cpu_s_per_h", late_s),
            Row("hours", f"{c:g}-{d:g}", "over_early", ratio),
        ]

    def scaling(self, most_cells: float) -> list[Row]:
        """The same root with more and more cells across."""
        points: list[dict[str, float]] = []
        scene = self.root(self.plan.across[0])
        step_h = examine(self.program, scene)["step_h"]  # follows from the growth rate, whatever the cells
        for across in self.plan.across:
            cells = points[-1]["cells"] * (across / points[-1]["across"]) ** 3 if points else 0.0
            if cells > most_cells:
                print(f"{across} across: some {cells:.2g} cells are left out (--most-cells)", flush=True)
                continue
            told = [self.steps_of(across, step_h) for _ in range(self.repeat if cells < 1e5 else 1)]
            point = {q: float(np.median([t[q] for t in told])) for q in told[0] if not q.startswith("s in ")}
            points.append(point | {"across": float(across)})
            print(f"{across} across: {point['cells']:.0f} cells, {point['step_cpu_s']:.3g} s a step", flush=True)
        return [Row("scaling", f"{point['across']:.0f} across", q, v) for point in points for q, v in point.items()]

    def roofline(self) -> list[Row]:
        """The machine, and the pair loops of one root under both steppers."""
        machine = roofline.measure_machine(self.plan.triad_mb)
        rows = [Row("machine", "one core", q, v) for q, v in asdict(machine).items()]
        for stepper, step_h, steps in (("quasi_static", 0.1, None), ("symplectic", 1e-4, self.plan.inertia_steps)):
            told = self.steps_of(self.plan.roofline_across, step_h, steps, [f"numerics.stepper={stepper}"])
            loops = {
                "forces": roofline.force_loop(3, damped=stepper == "symplectic"),
                "velocity gradients": roofline.gradient_loop(3),
            }
            for name, loop in loops.items():
                values = {
                    "cells": told["cells"],
                    "operations": float(loop.operations),
                    "bytes": loop.bytes_per_pair(told["pairs"] / told["cells"]),
                    "ns_per_pair": 1e9 * told[f"s in {name}"] / (told["evaluations"] * told["pairs"]),
                }
                rows += [Row("roofline", f"{stepper}: {name}", q, v) for q, v in values.items()]
        return rows

    def run(self, job: Job, folder: Path, until_h: float, settings: Sequence[str] = (), threads: int = 1) -> dict:
        """Summary of a job until then."""
        return session(self.program, SCENARIOS / f"{job.scene}.toml", folder, until_h, settings, threads)

    def root(self, across: int) -> Path:
        """The scene of growth_3d with so many cells across. It writes little."""
        base = tomllib.loads((SCENARIOS / "growth_3d.toml").read_text(encoding="utf-8"))
        changes = {
            "root.cell_size_mm": 2.0 * base["root"]["radius_mm"] / across,
            "division": None,
            "output": {"every_h": base["scene"]["duration_h"], "fields": ["position"]},
        }
        scene = self.work / f"growth_3d_{across}_across.toml"
        scene.write_text(scene_text(with_changes(base, changes)), encoding="utf-8")
        return scene

    def steps_of(
        self, across: int, step_h: float, steps: int | None = None, settings: Sequence[str] = ()
    ) -> dict[str, float]:
        """Steps after the first: a run of all of them less a run of the first."""
        scene, folder = self.root(across), self.work / "steps"
        settings = [*settings, f"numerics.step_h={step_h!r}"]
        one = session(self.program, scene, folder, step_h, settings)
        steps = steps or int(min(max(self.plan.steps, 5e4 / one["cells_start"]), 12))  # small roots are soon done
        more = session(self.program, scene, folder, (1 + steps) * step_h, settings)

        def spent(key: str) -> float:
            """NaN in a summary of an older program."""
            return float(more.get(key, math.nan) - one.get(key, math.nan))

        clock, before = more["wall_s_by_effect"], one["wall_s_by_effect"]
        return {
            "cells": float(more["cells_end"]),
            "layers": float(more["lattice"]["layers"]),
            "pairs": float(more["pairs"]),
            "steps": float(steps),
            "step_h": step_h,
            "step_cpu_s": spent("cpu_s") / steps,
            "step_iterations": spent("balance_iterations") / steps,
            "evaluations": spent("force_evaluations"),
            "memory_mb": float(more["peak_memory_mb"]),
            **{f"s in {name}": clock[name] - before[name] for name in ("forces", "velocity gradients")},
        }


def whole_run(folder: Path) -> dict[str, float]:
    """What a run came to that was made in one session. RunError: it was not."""
    summary, run = read_summary(folder), Run(folder)
    if not summary:
        raise RunError(f"{folder / 'summary.json'} is not there: the run has not ended")
    if "resumed at" in (folder / "run.log").read_text(encoding="utf-8"):
        raise RunError(f"{folder} was resumed: its summary.json has the time of the last session only; run it in one")
    history = run.history()
    return {
        "dimension": run.dimension,
        "hours": summary["time_h"],
        "cells_start": summary["cells_start"],
        "cells_end": summary["cells_end"],
        "cell_hours": float(cumulative_integral(history["time_h"], history["cells"])[-1]),
        "cpu_s": summary["cpu_s"],
        "wall_s": summary["wall_s"],
        "steps": summary["steps"],
        "iterations": summary.get("balance_iterations", math.nan),  # an older program's
        "memory_mb": summary["peak_memory_mb"],
        "threads": summary["threads"],
        "length_mm": summary["length_mm"],
    }


def full_rows(folder: Path) -> list[Row]:
    """The paper's S3, from the folder of its run."""
    told = whole_run(folder)
    threads = told["threads"]
    name = f"{FULL_NAME} ({threads} thread{'s' if threads > 1 else ''})"
    return [Row("full", name, quantity, float(value)) for quantity, value in told.items()]


PARTS = ("jobs", "ratios", "hours", "scaling", "roofline")
ROWS_OF = {"jobs": {"jobs", "phases", "settings"}, "roofline": {"machine", "roofline"}}


def main() -> int:
    """0, or 1 with a message where a run failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="half a minute: small roots, few steps; no page")
    parser.add_argument("--repeat", type=int, default=3, metavar="N", help="medians of N (default: 3; --quick: 1)")
    parser.add_argument("--out", type=Path, help="folder (default: docs; with --quick: runs/bench)")
    parser.add_argument(
        "--work", type=Path, default=Path("runs/bench_work"), help="where runs go (default: %(default)s)"
    )
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/release/rootsoil")
    parser.add_argument("--full", type=Path, metavar="DIR", help="folder of a finished run of growth_3d_full")
    parser.add_argument("--most-cells", type=float, default=1.1e6, help="of the scaling (default: %(default)g)")
    parser.add_argument("--only", nargs="*", choices=PARTS, help="measure these only; otherwise all")
    options = parser.parse_args()
    if options.repeat < 1:
        parser.error(f"--repeat {options.repeat}: give 1 or more")
    quick, parts = options.quick, PARTS if options.only is None else options.only
    out = options.out or (Path("runs/bench") if quick else PROJECT / "docs")
    repeat = 1 if quick else options.repeat
    file, pictures = out / "performance.csv", out / "images"
    try:
        pictures.mkdir(parents=True, exist_ok=True)
        bench = Bench(options.program, options.work, QUICK if quick else FULL, repeat)
        rows = performance_page.read_rows(file)
        for part in parts:
            new = bench.scaling(options.most_cells) if part == "scaling" else getattr(bench, part)()
            if part == "jobs":
                new.append(Row("settings", "", "repeat", repeat))
            replaced = ROWS_OF.get(part, {part})
            rows = [row for row in rows if row.part not in replaced] + new
            performance_page.write_rows(rows, file)
        if options.full:
            rows = [row for row in rows if row.part != "full"] + full_rows(options.full)
        performance_page.write_rows(rows, file)
    except subprocess.CalledProcessError as error:
        print(
            f"bench: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}: {error.stderr}",
            file=sys.stderr,
        )
        return 1
    except (RunError, OSError, ValueError, KeyError, json.JSONDecodeError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    measured = {row.part for row in rows}
    if "scaling" in measured:
        performance_page.draw_scaling(rows, pictures / "performance_scaling.png")
    if "roofline" in measured:
        performance_page.draw_roofline(rows, pictures / "performance_roofline.png")
    if not quick:
        page = out / "performance.md"
        page.write_text(performance_page.page(rows) + kept_part(page, "bench"), encoding="utf-8")
    print(f"wrote {file} and the pictures beside it")
    return 0


if __name__ == "__main__":
    sys.exit(main())
