# SPDX-License-Identifier: MIT
"""The numbers of ours that docs/validation.md puts beside published ones: which scene is run, and what is measured.

Every function of CASES makes its runs by a Bench and yields Numbers. mm, h, MPa, N.
"""

from __future__ import annotations

import csv
import math
import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import astuple, dataclass, field, fields
from pathlib import Path

import numpy as np

from rootsoil_tools import answers, kinematics, measure, performance_page, problems, published
from rootsoil_tools.impedance_series import HARD_MPA, PRESSURES_MPA, SOFT_MPA, halved_at, measure_member
from rootsoil_tools.runs import Run
from rootsoil_tools.scenes import Changes, Scene, scene_text, with_changes
from rootsoil_tools.series import PROJECT, Series

SEEDS = (1, 2, 3)
PRINTED_BELLS_MPA = (0.987, 0.625)  # the paper's 2.4
PROFILE_END_MM = 15.0  # of the authors' profiles
S1_H = 50.0
PUSH_N = 0.1  # on a pea root (reference_values.csv)
PUSHED_FROM_H, PUSHED_TO_H = 0.3, 0.6


@dataclass(frozen=True)
class Number:
    """One number of ours; low and high where it is the mean of several. `recorded`: where it stands, if it was not
    measured by this tool. NaN: the run was too short for it."""

    key: str
    value: float
    low: float
    high: float
    scene: str
    hours: float
    recorded: str = ""


def mean_number(key: str, values: Sequence[float], scene: str, hours: float, recorded: str = "") -> Number:
    """Mean and range of several values; NaN if one of them is."""
    return Number(key, float(np.mean(values)), float(np.min(values)), float(np.max(values)), scene, hours, recorded)


def write_numbers(numbers: Iterable[Number], path: Path) -> None:
    """Replaces the file as a whole."""
    partial = path.with_suffix(".partial")
    with partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([f.name for f in fields(Number)])
        for number in numbers:
            values = astuple(number)
            writer.writerow(["" if v != v else f"{v:.6g}" if isinstance(v, float) else v for v in values])
    partial.replace(path)


def read_numbers(path: Path) -> dict[str, Number]:
    """By their key."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    types: dict[str, Callable] = {"float": lambda text: float(text or "nan"), "str": str}
    numbers = [Number(**{f.name: types[str(f.type)](row[f.name]) for f in fields(Number)}) for row in rows]
    return {number.key: number for number in numbers}


@dataclass(frozen=True)
class Bench:
    """Makes runs below a folder. `quick`: short ones, and only the first of several alike."""

    out: Path
    programs: Path
    quick: bool
    scenes: list[str] = field(default_factory=list)

    def hours(self, full: float, quick: float) -> float:
        """How long to run."""
        return quick if self.quick else full

    def first(self, values: Sequence, count: int = 1) -> Sequence:
        """All of them, when quick the first `count`."""
        return values[:count] if self.quick else values

    def run(self, scene: Path, name: str, settings: Sequence[str], until_h: float) -> Run:
        """A run of a scene file, made or found finished."""
        series = Series(scene, self.out / scene.stem, self.programs / "rootsoil", ["--quiet"], 1)
        return Run(series.run(name, [*settings, "output.picture=false"], until_h))

    def scenario(self, scene: str, name: str, settings: Sequence[str], until_h: float) -> Run:
        """A run of a scene of scenarios/."""
        return self.run(PROJECT / "scenarios" / f"{scene}.toml", name, settings, until_h)

    def own(self, name: str, scene: Scene, until_h: float) -> Run:
        """A run of a scene that is written for it."""
        file = self.out / f"{name}.toml"
        self.out.mkdir(parents=True, exist_ok=True)
        file.write_text(scene_text(scene), encoding="utf-8")
        return self.run(file, "run", [], until_h)


# ---- case 1 ---------------------------------------------------------------------------------------


def strain_under_pressure(bench: Bench) -> Iterator[Number]:
    """Fig. 3: mean relative error of the strains against Eq. 8 for 0.1 mm < s < 1.5 mm."""
    for tissue in ("isotropic", "balanced", "anisotropic"):
        scene = f"case1_{tissue}"
        errors = answers.strain_errors(bench.scenario(scene, "run", [], 8.0), 0.1, 1.5, exact_radial=True)
        for direction, values in errors.items():
            yield mean_number(f"{direction} strain error, {tissue}", [float(np.abs(values).mean())], scene, 8.0)


# ---- case 2 ---------------------------------------------------------------------------------------


def arabidopsis(bench: Bench) -> Iterator[Number]:
    """Fig. 4B and what follows from its curves, over seeds; S1 is the same run at 50 h."""
    scene, hours = "case2_arabidopsis", bench.hours(100.0, 12.0)
    runs = [bench.scenario(scene, f"seed_{seed}", [f"scene.seed={seed}"], hours) for seed in bench.first(SEEDS)]
    for quantity in kinematics.MEASURED:
        fits = [kinematics.fit_to_published(run, quantity) for run in runs]
        yield mean_number(f"{quantity} R^2", [fit.r2 for fit in fits], scene, hours)
        yield mean_number(f"{quantity} RMSE", [fit.rmse for fit in fits], scene, hours)
    at_mm = np.arange(0.02, kinematics.END_MM, 0.02)
    measured: dict[str, list[float]] = {}
    for run in runs:
        last = run.frame(-1)
        model, length = last.closed_form, float(last["distance_to_tip"].max())
        division_end = float(run.scene["division"]["ends_at_mm"])
        first_cell = float(model.at("cell_length", 0.0))
        zone = model.growth_zone(length)
        diameter = 2.0 * float(np.mean(measure.radii(last, run.dimension, np.array([0.1, division_end]))))
        drift = measure.radius_drift(model, run)
        for key, value in {
            "peak rate": float(np.nanmax(kinematics.curve(run, "axial_strain_rate", at_mm).mean())),
            "tip speed": measure.tip_speed(run),
            "hours in the meristem": model.travel_time(first_cell, division_end, length),
            "hours in the elongation zone": model.travel_time(division_end, zone, length),
            "meristem over diameter": division_end / diameter,
            "radius drift": abs(10.0 * drift),
            "S1 volume ratio": _at(run, S1_H, lambda f: float(f["volume"].sum() / run.frame(0)["volume"].sum())),
            "S1 divisions": _at(run, S1_H, lambda f: float(f["generation"].max())),
        }.items():
            measured.setdefault(key, []).append(value)
    for key, values in measured.items():
        yield mean_number(f"arabidopsis {key}", values, scene, S1_H if key.startswith("S1") else hours)


def _at(run: Run, time_h: float, what: Callable) -> float:
    """Of the frame at a time; NaN where the run ends before."""
    return what(run.frame(run.nearest_frame(time_h))) if run.times_h[-1] >= time_h * (1.0 - 1e-9) else math.nan


# ---- case 3 ---------------------------------------------------------------------------------------


def pea(bench: Bench) -> Iterator[Number]:
    """Fig. 5: the impedance series."""
    scene, hours = "case3_pea_soft", bench.hours(200.0, 6.0)
    pressures = [SOFT_MPA, HARD_MPA] if bench.quick else PRESSURES_MPA
    runs = {p: bench.scenario(scene, f"p_{p:g}", [f"pressure.differential_MPa={p:g}"], hours) for p in pressures}
    members = {p: measure_member(p, run) for p, run in runs.items()}
    soft, hard = members[SOFT_MPA], members[HARD_MPA]
    threshold = float(soft.model.at("division_threshold", 0.0))
    first_mm = np.linspace(0.0, 1.0, 101)
    rates = [np.interp(first_mm, m.s, m.profiles["axial_strain_rate"].mean) for m in members.values()]
    for key, value in {
        "peak rate": soft.peak_rate,
        "growth zone, soft": soft.growth_zone,
        "growth zone, hard": hard.growth_zone,
        "wider in hard soil": hard.mature_radius / soft.mature_radius - 1.0,
        "resistance that halves": halved_at(list(members.values())),
        "threshold over length": threshold / _dividing_length_mm(runs[SOFT_MPA]),
        "first millimetre": float(np.ptp(rates, axis=0).max()),
        "Young's modulus": float(runs[SOFT_MPA].scene["tissue"]["E_axial_MPa"]),
        "radius drift, soft": abs(10.0 * soft.radius_drift),
        "radius drift, hard": abs(10.0 * hard.radius_drift),
    }.items():
        yield mean_number(f"pea {key}", [value], scene, hours)
    yield mean_number("pea rate R^2 to Eq. 6", [m.fit.r2 for m in members.values()], scene, hours)
    yield from _printed_bells(bench, members, hours)
    hours = bench.hours(24.0, 2.0)
    printed = bench.scenario("case3_as_printed", "run", [], hours)
    drift = abs(10.0 * measure.radius_drift(printed.frame(-1).closed_form, printed))
    yield mean_number("as printed radius drift", [drift], "case3_as_printed", hours)


def _dividing_length_mm(run: Run) -> float:
    """Mean length of cells in the second quarter of the growth zone, where all have divided often, at the end."""
    last = run.frame(-1)
    zone = last.closed_form.growth_zone(float(last["distance_to_tip"].max()))
    at_mm = np.linspace(0.25 * zone, 0.5 * zone, 21)
    lengths_um = measure.near_points(run, run.window(measure.WINDOW_H), "cell_length", at_mm, 0.02 * zone)
    return float(np.nanmean(lengths_um)) / 1e3


def _printed_bells(bench: Bench, members: dict, hours: float) -> Iterator[Number]:
    """Strain rate against the bells that the authors fitted to Croser et al. and print in 2.4, the hard soil's sign
    mended (docs/decisions/0006), over 15 mm."""
    for p in PRINTED_BELLS_MPA:
        settings = [f"pressure.differential_MPa={p:g}", "response.growth.c_g=[-1.0,-0.9]"]
        bell = bench.scenario("case3_as_printed", f"bell_{p:g}", settings, 0.01).frame(0).closed_form
        if p not in members:
            yield mean_number(f"pea rate R^2 to the printed bell, {p:g}", [math.nan], "case3_pea_soft", hours)
            continue
        member = members[p]
        s = np.linspace(0.1, PROFILE_END_MM, 150)
        rate = member.profiles["axial_strain_rate"].mean
        there = np.isfinite(rate)
        ours = np.interp(s, member.s[there], rate[there], right=0.0)
        fit = published.fit(bell.axial_rate(s), ours)
        yield mean_number(f"pea rate R^2 to the printed bell, {p:g}", [fit.r2], "case3_pea_soft", hours)


# ---- thrust ---------------------------------------------------------------------------------------

PUSHED_ROOT: Scene = {
    "scene": {"name": "pushed_pea", "dimension": 3, "duration_h": 1.0},
    "root": {"length_mm": 2.6, "radius_mm": 0.5, "cell_size_mm": 0.2},
    "tissue": {
        "E_axial_MPa": 1020.0,
        "anisotropy": {"E_radial_max_MPa": 15000.0, "x_e_mm": 0.0, "s_e_per_mm": 0.0, "c_e": 1.0},
    },
    "pressure": {"differential_MPa": 0.7},
    "growth": {
        "lambda0_ug_mm3_h": 4.3e5,
        "x_g_mm": 0.1,
        "s_g_mm": 0.6,
        "c_g": -0.95,
        "mature_at_mm": 2.2,
        "mature_width_mm": 0.6,
    },
    "non_affine_control": {},
    "numerics": {"step_h": 0.1},
    "output": {"every_h": 0.1},
}
YIELDS: dict[str, Changes] = {
    "no yield": {"pressure.differential_MPa": 1.0},
    "uniform yield": {"growth.yield_MPa": 0.2},
    "rising yield": {"growth.yield_profile": [[0.4, 0.05], [0.6, 0.6]], "root.cell_size_mm": 0.125},
}
WALL = {"shape": "plane", "position_mm": [2.6005, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0], "friction": 0.0}


def thrust(bench: Bench) -> Iterator[Number]:
    """A pea root of 1 mm in 3D, stopped by a wall and pushed with 100 mN."""
    for name in YIELDS if not bench.quick else ("no yield", "uniform yield"):
        scene = with_changes(PUSHED_ROOT, YIELDS[name])
        label = name.replace(" ", "_")
        stopped = bench.own(f"wall_{label}", with_changes(scene, {"root.cap": False, "obstacle": [WALL]}), PUSHED_TO_H)
        history = stopped.history()
        section = math.pi * scene["root"]["radius_mm"] ** 2
        stress = float(history["contact_force_N"][-1]) / section
        arrest = stopped.frame(-1).closed_form.arrest_stress  # (p - Y)(1 - 2 nu_A)
        yield mean_number(f"growth pressure, {name}", [stress], f"wall_{label}", PUSHED_TO_H)
        speed = []
        for force_N in (0.0, PUSH_N):
            push = {"force": {"table": [[0.0, 0.0], [0.1, 1.0]], "axial_N": force_N}}
            run = bench.own(f"push_{label}_{1e3 * force_N:g}_mN", with_changes(scene, push), PUSHED_TO_H)
            time, tip = run.history()["time_h"], run.history()["tip_x_mm"]
            late = time > PUSHED_FROM_H - 1e-9
            speed.append(float(np.polyfit(time[late], tip[late], 1)[0]))
        left = speed[1] / speed[0]
        yield mean_number(f"left after 100 mN, {name}", [left], f"push_{label}", PUSHED_TO_H)
        if "yield_profile" not in scene["growth"]:  # else the arresting stress is not that of any one place
            for what, error in (
                ("growth pressure", stress / arrest - 1.0),
                ("left after 100 mN", left - (1.0 - PUSH_N / (section * arrest))),
            ):
                yield mean_number(f"{what} error, {name}", [abs(error)], f"wall_{label}", PUSHED_TO_H)


# ---- buckling -------------------------------------------------------------------------------------


def buckling(bench: Bench) -> Iterator[Number]:
    """Euler's load by build/release/bending_problem, and the critical length on a plate as its test records it."""
    euler = next(p for p in problems.all_problems() if p.name == "euler")
    across = 6 if bench.quick else 12
    folder = bench.out / f"euler_{across}"
    folder.mkdir(parents=True, exist_ok=True)
    (command,) = euler.prepare(bench.programs, folder, across, problems.Choice("default"))
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    (folder / "out").write_text(done.stdout, encoding="utf-8")
    values, _ = euler.read(folder)
    yield mean_number("Euler load error", [abs(values["stiffness"][0])], f"a column {across} cells across", math.nan)
    test, quantity = "Buckling.TheCriticalLengthOnAPlateIsEulers", "critical length/Euler's - 1"
    file = PROJECT / "tests" / "physics" / "recorded_errors.csv"
    with file.open(newline="", encoding="utf-8") as rows:
        (error,) = [row["error"] for row in csv.DictReader(rows) if (row["test"], row["quantity"]) == (test, quantity)]
    yield mean_number("critical length error", [float(error)], test, 2.0, recorded(file, f"{quantity},{error}"))


# ---- recorded -------------------------------------------------------------------------------------


def recorded(file: Path, text: str) -> str:
    """A file of the project, and the commit with which this text came into it."""
    name = str(file.relative_to(PROJECT))
    command = ["git", "-C", str(PROJECT), "log", "-1", "--format=%h of %cs", f"-S{text}", "--", name]
    done = subprocess.run(command, capture_output=True, text=True)
    return f"{name}, {done.stdout.strip()}" if done.stdout.strip() else name


def long_runs(_bench: Bench) -> Iterator[Number]:
    """S3, S4 and soils: what docs/performance.csv and tools/data/recorded_runs.csv have of them."""
    file = PROJECT / "docs" / "performance.csv"
    full = next(v for k, v in performance_page.cases(performance_page.read_rows(file), "full").items() if "S3" in k)
    base = PROJECT / "scenarios" / "growth_3d_full.toml"
    start = next(float(line.split("=")[1]) for line in base.read_text().splitlines() if line.startswith("length_mm"))
    where = recorded(file, f"length_mm,{full['length_mm']:.6g}")
    for key, value in (("S3 cells", full["cells_end"]), ("S3 elongation", full["length_mm"] - start)):
        yield mean_number(key, [value], "growth_3d_full", full["hours"], where)
    rows = published.table("recorded_runs")
    for key in dict.fromkeys(row["key"] for row in rows):
        same = [row for row in rows if row["key"] == key]
        scene = same[0]["scene"].split(" at ")[0]
        values = [float(row["value"]) for row in same]
        yield mean_number(key, values, scene, float(same[0]["hours"]), same[0]["recorded"].replace(";", ","))


CASES: dict[str, Callable[[Bench], Iterator[Number]]] = {
    "case 1": strain_under_pressure,
    "case 2": arabidopsis,
    "case 3": pea,
    "thrust": thrust,
    "buckling": buckling,
    "recorded": long_runs,
}
