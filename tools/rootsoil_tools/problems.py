# SPDX-License-Identifier: MIT
"""Small problems with known answers, for tools/accuracy_cost.py.

A problem turns choices (cells across, keys of the scene) into a command, and what the command wrote into measures.
Strains are logarithmic: the tissue's law is one of rates, so Eq. 8 gives the logarithm of a stretch; the engineering
strain of 9e-4 would show an error of 0.05 % that is none.
"""

from __future__ import annotations

import csv
import json
import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rootsoil_tools import measure, theory
from rootsoil_tools.runs import Run, read_summary

NON_AFFINE = "\n[non_affine_control]\n"


@dataclass(frozen=True)
class Choice:
    """One way to compute. `keys` are those of the scene. Choices of one name are a curve; `level` tells its points
    apart. `step_factor` multiplies the step of preset balanced."""

    name: str
    keys: dict[str, object] = field(default_factory=dict)
    level: float = math.nan
    step_factor: float | None = None
    non_affine: bool = True


@dataclass(frozen=True)
class Cost:
    """What a run did: cells (mean), steps, simulated hours, its own inertia error (share of p, mean over the second half;
    NaN where none)."""

    cells: float
    steps: float
    hours: float
    inertia_error: float


@dataclass(frozen=True)
class Measure:
    """One number to be compared. Its values are relative errors against a closed form already, or are to be compared
    with those of the finest run, divided by `scale` or, where that is None, by the finest run's own."""

    name: str
    meaning: str
    finest: bool = False
    scale: float | None = None


@dataclass(frozen=True)
class Problem:
    """`prepare` writes what a run needs into a folder and gives its command; `read` the measures' values, then."""

    name: str
    title: str
    measures: tuple[Measure, ...]
    prepare: Callable[[Path, Path, int, Choice], list[str]]
    read: Callable[[Path], tuple[dict[str, list[float]], Cost]]
    soil: bool = False

    def measure(self, name: str) -> Measure:
        """The measure of this name."""
        return next(m for m in self.measures if m.name == name)


# ---- scenes ---------------------------------------------------------------------------------------


def text_of(value: object) -> str:
    """A value as TOML."""
    return json.dumps(value)


def scene_problem(
    name: str,
    title: str,
    measures: tuple[Measure, ...],
    scene: Callable[[int], str],
    step_h: Callable[[int], float],
    read: Callable[[Run], dict[str, list[float]]],
    soil: bool = False,
) -> Problem:
    """A problem that `rootsoil run` solves. `scene` of the cells across; `step_h` of preset balanced, by default."""

    def prepare(programs: Path, folder: Path, across: int, choice: Choice) -> list[str]:
        text = scene(across) + (NON_AFFINE if choice.non_affine else "")
        (folder / "scene.toml").write_text(text, encoding="utf-8")
        keys = dict(choice.keys)
        if choice.step_factor is not None:
            keys["numerics.step_h"] = choice.step_factor * step_h(across)
        sets = [part for key, value in keys.items() for part in ("--set", f"{key}={text_of(value)}")]
        command = [str(programs / "rootsoil"), "run", "scene.toml", "--out", "run", "--threads", "1", "--quiet"]
        return command + sets

    def read_folder(folder: Path) -> tuple[dict[str, list[float]], Cost]:
        run, summary = Run(folder / "run"), read_summary(folder / "run")
        cells = (summary["cells_start"] + summary["cells_end"]) / 2.0
        inertia = run.history()["inertia_error"]
        cost = Cost(cells, summary["steps"], summary["time_h"], float(inertia[len(inertia) // 2 :].mean()))
        return read(run), cost

    return Problem(name, title, measures, prepare, read_folder, soil)


STRAIN = """\
[scene]
name = "strain"
duration_h = 8
[root]
length_mm = 1
radius_mm = 0.05
cell_size_mm = {size}
[tissue]
E_axial_MPa = 1020
{more}
[pressure]
differential_MPa = 1
[numerics]
start = "rest"
[output]
every_h = 8
"""
ANISOTROPIC = "[tissue.anisotropy]\nE_radial_max_MPa = 15000\nx_e_mm = 0\ns_e_per_mm = 0\nc_e = 1\n"
BALANCED = "[tissue.anisotropy]\nE_radial_max_MPa = 15000\nx_e_mm = 0.6\ns_e_per_mm = 5\nc_e = 0\n"


def strain_problem(name: str, title: str, anisotropy: str = "", root: str = "", exact_radial: bool = True) -> Problem:
    """Case 1: a root of 1 mm under 1 MPa at rest; bins of 0.1 mm for 0.1 mm < s < 0.7 mm."""
    length, diameter, from_mm, to_mm = 1.0, 0.1, 0.1, 0.7

    def read(run: Run) -> dict[str, list[float]]:
        model = theory.model_of(run.scene)
        edges = np.arange(round(from_mm * 10), round(to_mm * 10) + 1) / 10.0
        axial, radial = (np.log1p(s) for s in measure.strain_profiles(run.frame(0), run.frame(-1), 2, edges))
        middle = (edges[1:] + edges[:-1]) / 2.0
        exact = model.radial_strain(middle)
        return {
            "axial": list(axial / model.axial_strain() - 1.0),
            "radial": list(radial / exact - 1.0 if exact_radial else radial / np.abs(exact).max()),
        }

    def scene(across: int) -> str:
        text = STRAIN.format(size=diameter / across, more=anisotropy)
        return text.replace("[tissue]", root + "[tissue]", 1)

    radial = "radial strain, rms of bins, " + ("against Eq. 8" if exact_radial else "against the finest run")
    return scene_problem(
        name,
        title,
        (
            Measure("axial", "axial strain, rms of bins, against Eq. 8"),
            Measure("radial", radial, not exact_radial, 1.0),
        ),
        scene,
        lambda across: 8.0 / max(2000.0, 25.0 * length * across / diameter),
        read,
    )


GROWTH = """\
[scene]
name = "growth"
duration_h = {hours}
[root]
length_mm = 1.6
radius_mm = 0.04
cell_size_mm = {size}
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.51
s_e_per_mm = 6
c_e = 0.2
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.37
c_g = -1
[output]
every_h = 0.2
"""
# in units of the cells' first size, so that refined roots divide at the same places
DIVISION = """\
[division]
l0_mm = {l0}
c_d = 1
s_d_per_mm2 = 5
x_d_mm = 0.12
constant_beyond_mm = 0.5
"""
GROWTH_DIAMETER_MM = 0.08


def last_window_h(run: Run) -> float:
    """Duration of the window that ended with a frame; frames end windows."""
    numerics = run.scene["numerics"]
    steps = round(run.scene["output"]["every_h"] / numerics["step_h"])
    return numerics["step_h"] * (steps % numerics["window_steps"] or numerics["window_steps"])


def growth_errors(run: Run, from_h: float) -> dict[str, list[float]]:
    """Tip's way from a time on, and the axial rate of cells where it is over a tenth of the peak.

    A frame holds the distance from the tip at its last window's start, and the rate of that window."""
    model = theory.model_of(run.scene)
    history = run.history()
    time, length = history["time_h"], history["length_mm"]
    settled = time > from_h - 1e-9
    t, measured = time[settled], length[settled]
    way = theory.cumulative_integral(t, np.array([model.tip_speed(x) for x in measured]))[-1]
    fine = model.grid(2.0 * float(length[-1]))
    flow = model.velocity(fine)
    peak = float(model.axial_rate(fine).max())
    errors = []
    for index in np.flatnonzero(settled):
        frame = run.frame(int(index))
        start = frame["distance_to_tip"]
        exact = model.axial_rate(start + 0.5 * last_window_h(run) * np.interp(start, fine, flow))
        chosen = (exact > 0.1 * peak) & (frame["clamped"] == 0)
        errors.append(frame["axial_strain_rate"][chosen] / exact[chosen] - 1.0)
    return {
        "tip speed": [float((measured[-1] - measured[0]) / way - 1.0)],
        "axial rate": [float(np.sqrt(np.mean(np.concatenate(errors) ** 2)))],
    }


def divided_lengths(
    model: theory.Model, threshold: Callable[[np.ndarray], np.ndarray], s: np.ndarray, length: np.ndarray, hours: float
) -> tuple[np.ndarray, np.ndarray]:
    """Where cells are after `hours` that started at s (mm) with a length (mm), and how long: the closed form's flow
    carries and stretches them, and a cell longer than the threshold becomes two, half as long and half a length apart.
    """
    steps = 400
    dt = hours / steps
    fine = np.linspace(0.0, 2.0 * float(s.max()), 8001)
    flow = model.velocity(fine)
    rate = model.axial_rate(fine)
    for _ in range(steps):
        half = s + 0.5 * dt * np.interp(s, fine, flow)
        length = length * np.exp(dt * np.interp(half, fine, rate))
        s = s + dt * np.interp(half, fine, flow)
        long = length > threshold(s)
        offset = np.where(long, length / 4.0, 0.0)
        s = np.concatenate([s - offset, s[long] + offset[long]])
        length = np.concatenate([np.where(long, length / 2.0, length), length[long] / 2.0])
    return s, length


def division_errors(run: Run, from_h: float) -> dict[str, list[float]]:
    """growth_errors from a time on, and the profile of cell length: means over bins of 0.2 mm against every cell of the first frame,
    carried, stretched and divided by the closed form."""
    model = theory.model_of(run.scene)
    keys = run.scene["division"]

    def threshold(s: np.ndarray) -> np.ndarray:
        capped = np.minimum(s, keys["constant_beyond_mm"])
        return keys["l0_mm"] * (keys["c_d"] + keys["s_d_per_mm2"] * (capped - keys["x_d_mm"]) ** 2)

    first, last = run.frame(0), run.frame(-1)
    s, length = divided_lengths(
        model, threshold, first["distance_to_tip"], first.axial_lengths(2), last.time_h - first.time_h
    )
    edges = measure.edges_of(1.0, 0.2)
    exact = measure.binned(s, length, edges).mean
    found = measure.binned(last["distance_to_tip"], last.axial_lengths(2), edges).mean
    return {**growth_errors(run, from_h), "cell length": list(found / exact - 1.0)}


def growth_scene(hours: float, across: int) -> str:
    """A root that grows for some hours."""
    return GROWTH.format(hours=hours, size=GROWTH_DIAMETER_MM / across)


def growth_step_h(across: int) -> float:
    """The tip moves by a hundredth of a cell in a step, as preset balanced has it."""
    scene = tomllib.loads(growth_scene(1.0, across))
    speed_mm_h = theory.model_of(scene).tip_speed(2.0)
    return min(1e-3, 0.01 * scene["root"]["cell_size_mm"] / speed_mm_h)


TIP = Measure("tip speed", "tip's way against the closed form")
RATE = Measure("axial rate", "axial strain rate, rms over cells, against the closed form")
LENGTH = Measure("cell length", "cell length, rms of bins of 0.2 mm, against the closed form with divisions")


# ---- a plate --------------------------------------------------------------------------------------

THRUST = """\
[scene]
name = "thrust"
duration_h = 0.02
[root]
length_mm = 0.8
radius_mm = 0.05
cell_size_mm = {size}
cap = false
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0
s_e_per_mm = 0
c_e = 1
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.34e5
x_g_mm = 0.1
s_g_mm = 0.2
c_g = -1
[[obstacle]]
name = "plate"
shape = "plane"
position_mm = [0.8, 0.0]
normal = [-1.0, 0.0]
friction = 0.0
[numerics]
start = "rest"
step_h = {step}
mass_damping_per_h = {damping}
[output]
every_h = 0.02
"""
THRUST_DIAMETER_MM = 0.1


def thrust_step_h(across: int) -> float:
    """It comes to rest: the step only has to leave time for it."""
    return 1.6e-4 / across


def thrust_scene(across: int) -> str:
    step = thrust_step_h(across)
    # about twice the slowest axial frequency, which goes as the inertia's 1/step
    return THRUST.format(size=THRUST_DIAMETER_MM / across, step=step, damping=0.24 / across / step)


def thrust_errors(run: Run) -> dict[str, list[float]]:
    """The plate's force over the width where the root grows, against p (1 - nu_A)."""
    model = theory.model_of(run.scene)
    width = 2.0 * float(measure.radii(run.frame(-1), 2, np.array([0.1, 0.6]))[0])
    stress = abs(float(run.history()["contact_force_x_N"][-1])) / width
    return {"arrest stress": [stress / (model.p * (1.0 - model.nu_A)) - 1.0]}


PATH = """\
[scene]
name = "path"
duration_h = 0.75
[root]
length_mm = 1.0
radius_mm = 0.06
cell_size_mm = {size}
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.05
s_e_per_mm = 40
c_e = 0.2
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.34e5
x_g_mm = 0.1
s_g_mm = 0.2
c_g = -0.95
mature_at_mm = 0.7
mature_width_mm = 0.2
[[obstacle]]
name = "plane"
shape = "plane"
position_mm = [1.03, 0.0]
normal = [-0.7071, 0.7071]
friction = 0.2
[numerics]
step_h = {step}
[output]
every_h = 0.25
"""
PATH_DIAMETER_MM = 0.12


def path_step_h(across: int) -> float:
    """Small: the contact is to be quasi-static, not an impact."""
    return 1.5e-4 / across


def path_points(run: Run) -> dict[str, list[float]]:
    """Where the tip is at 0.25, 0.5 and 0.75 h, in diameters."""
    history = run.history()
    return {"path": list(np.concatenate([history[f"tip_{a}_mm"][-3:] for a in "xy"]) / PATH_DIAMETER_MM)}


# ---- beams ----------------------------------------------------------------------------------------


def beam_problem(name: str, title: str, meaning: str) -> Problem:
    """A beam of the bending tests: build/release/bending_problem."""

    def prepare(programs: Path, folder: Path, across: int, choice: Choice) -> list[str]:
        keys = dict(choice.keys)
        if choice.step_factor is not None:
            keys["numerics.step_h"] = 1e-3 * choice.step_factor
        if not choice.non_affine:
            keys |= {"non_affine_control.damping": 0.0, "non_affine_control.stiffness": 0.0}
        sets = [f"{key}={text_of(value)}" for key, value in keys.items()]
        return [str(programs / "bending_problem"), name, str(across), *sets]

    def read(folder: Path) -> tuple[dict[str, list[float]], Cost]:
        found = json.loads((folder / "out").read_text(encoding="utf-8").splitlines()[-1])
        if not found["last_change"] < 1e-3:
            raise ValueError("it did not come to rest")
        cost = Cost(found["cells"], found["steps"], math.nan, math.nan)
        return {"stiffness": [found["ratio"] - 1.0]}, cost

    return Problem(name, title, (Measure("stiffness", meaning),), prepare, read)


# ---- soil -----------------------------------------------------------------------------------------

HERTZ = """\
[scene]
name = "hertz"
dimension = 2
[soil]
box_from_mm = [0.0, -2.0]
box_to_mm = [4.0, 2.0]
walls = "rigid"
confining_pressure_MPa = 0.1
grains_file = "grains.csv"
d_mean_mm = 0.3
contact_law = "hertz_mindlin"
E_MPa = 250.0
poisson = 0.3
friction_deg = 30.0
root_friction_deg = 20.0
[[soil.obstacle]]
name = "stone"
shape = "stone"
position_mm = [1.6, 0.0]
radius_mm = 0.5
[[soil.obstacle]]
name = "holder"
shape = "stone"
position_mm = [3.2, 1.2]
radius_mm = 0.5
[penetrometer]
diameter_mm = 0.8
cone_angle_deg = 180.0
rate_mm_h = 0.5
depth_mm = 0.816
average_from_mm = 0.8
interval_h = 0.004
seeds = 1
"""
# the second grain is held between a stone and a wall, so that there is a contact from the start
HERTZ_GRAINS = "x_mm,y_mm,z_mm,radius_mm\n0.95,0,0,0.15\n3.2,1.85,0,0.151\n"
HERTZ_READ_FROM_MM = 0.804

PENETROMETER = """\
[scene]
name = "penetrometer"
dimension = 2
[soil]
box_from_mm = [0.0, -1.2]
box_to_mm = [2.4, 1.2]
walls = "mixed"
confining_pressure_MPa = 0.1
d_range_mm = [0.2, 0.3]
E_MPa = 250.0
friction_deg = 30.0
root_friction_deg = 20.0
[penetrometer]
diameter_mm = 0.6
rate_mm_h = 0.5
depth_mm = 0.9
average_from_mm = 0.3
seeds = 1
"""

ROOT_IN_SOIL = """\
[scene]
name = "soil"
dimension = 2
duration_h = 0.6
[root]
length_mm = 1.6
radius_mm = 0.2
cell_size_mm = {size}
[tissue]
E_axial_MPa = 1020.0
[tissue.anisotropy]
E_radial_max_MPa = 15000.0
x_e_mm = 0.1
s_e_per_mm = 20.0
c_e = 0.2
[pressure]
differential_MPa = 1.0
[growth]
lambda0_ug_mm3_h = 4.0e5
x_g_mm = 0.2
s_g_mm = 0.4
c_g = -0.95
mature_at_mm = 1.1
mature_width_mm = 0.3
[soil]
box_from_mm = [0.8, -1.0]
box_to_mm = [2.8, 1.0]
walls = "mixed"
confining_pressure_MPa = 0.04
d_range_mm = [0.15, 0.25]
E_MPa = 100.0
friction_deg = 30.0
root_friction_deg = 20.0
[soil.contact]
interval_h = 4e-3
[numerics]
step_h = {step}
[output]
every_h = 0.02
"""
ROOT_IN_SOIL_DIAMETER_MM = 0.4


def soil_step_h(across: int) -> float:
    """Whole windows of 20 steps fit into the interval."""
    return 6e-4 / across


def penetrometer_problem(
    name: str, title: str, scene: str, grains: str, measured: Measure, read: Callable[[dict, dict], list[float]]
) -> Problem:
    """A problem that `rootsoil penetrometer` solves; `read` gets the scene and the columns of penetrometer.csv."""

    def prepare(programs: Path, folder: Path, across: int, choice: Choice) -> list[str]:
        (folder / "scene.toml").write_text(scene, encoding="utf-8")
        if grains:
            (folder / "grains.csv").write_text(grains, encoding="utf-8")
        sets = [part for key, value in choice.keys.items() for part in ("--set", f"{key}={text_of(value)}")]
        return [str(programs / "rootsoil"), "penetrometer", "scene.toml", "--out", "run", "--quiet", *sets]

    def read_folder(folder: Path) -> tuple[dict[str, list[float]], Cost]:
        with (folder / "run" / "penetrometer.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        columns = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
        cost = Cost(math.nan, float(len(rows)), math.nan, math.nan)
        return {measured.name: read(tomllib.loads(scene), columns)}, cost

    return Problem(name, title, (measured,), prepare, read_folder, soil=True)


def two_contacts_N(approach: float, stiffness: tuple[float, float]) -> float:
    """Force (N) of two Hertzian contacts in a row, F = k d^1.5 each (k in N/mm^1.5), that approach (mm) together."""
    return (approach / sum(k ** (-2.0 / 3.0) for k in stiffness)) ** 1.5 if approach > 0.0 else 0.0


def hertz_errors(scene: dict, columns: dict) -> list[float]:
    """Force on the probe, grain and stone, against Hertz: F = 4/3 E* sqrt(R) d^1.5 with 1/E* = 2 (1 - nu^2)/E and
    1/R = 1/r1 + 1/r2 (Johnson, Contact Mechanics, eq. 4.23); mean over each reading's way."""
    soil, probe = scene["soil"], scene["penetrometer"]
    modulus = soil["E_MPa"] / (2.0 * (1.0 - soil["poisson"] ** 2))
    probe_radius, grain, stone = probe["diameter_mm"] / 2.0, 0.15, 0.5
    reduced = [1.0 / (1.0 / a + 1.0 / b) for a, b in ((probe_radius, grain), (grain, stone))]
    stiffness = tuple(4.0 / 3.0 * modulus * math.sqrt(r) for r in reduced)
    touch_mm = 0.8
    section = probe["diameter_mm"] * soil["d_mean_mm"]
    depth = columns["depth_mm"]
    half = (depth[1] - depth[0]) / 2.0
    errors = []
    for at, Q in zip(depth, columns["Q_MPa"]):
        if at - half < HERTZ_READ_FROM_MM:
            continue
        way = np.linspace(at - half, at + half, 101)
        force = np.mean([two_contacts_N(x - touch_mm, stiffness) for x in way])
        errors.append(float(Q * section / force - 1.0))
    return errors


def mean_Q(scene: dict, columns: dict) -> list[float]:
    """Mean resistance behind average_from_mm over the confining pressure."""
    inside = columns["depth_mm"] >= scene["penetrometer"]["average_from_mm"]
    return [float(columns["Q_MPa"][inside].mean() / scene["soil"]["confining_pressure_MPa"])]


def soil_values(run: Run) -> dict[str, list[float]]:
    """From 0.1 h on: growth against what the closed form says with the soil's forces, and the mean force on the tip."""
    history = run.history()
    later = history["time_h"] > 0.1 - 1e-9
    time, length = history["time_h"][later], history["length_mm"][later]
    way = theory.cumulative_integral(time, history["soil_expected_tip_speed_mm_h"][later])[-1]
    return {
        "elongation": [float((length[-1] - length[0]) / way - 1.0)],
        "tip force": [float(history["soil_tip_force_N"][later].mean())],
    }


# ---- all ------------------------------------------------------------------------------------------


def all_problems() -> list[Problem]:
    """Every problem, the quick ones first."""
    return [
        strain_problem("case1_isotropic", "Case 1, isotropic"),
        strain_problem("case1_anisotropic", "Case 1, anisotropic", ANISOTROPIC),
        strain_problem("case1_balanced", "Case 1, balanced", BALANCED, exact_radial=False),
        strain_problem(
            "case1_irregular", "Case 1, isotropic, irregular cells", root="jitter = 0.2\nsize_variation = 0.3\n"
        ),
        scene_problem(
            "growth",
            "Growth",
            (TIP, RATE),
            lambda across: growth_scene(1.0, across),
            growth_step_h,
            lambda run: growth_errors(run, 0.4),
        ),
        scene_problem(
            "division",
            "Growth and division",
            (TIP, RATE, LENGTH),
            lambda across: growth_scene(3.0, across)
            + DIVISION.format(l0=1.5 * GROWTH_DIAMETER_MM / across),
            growth_step_h,
            lambda run: division_errors(run, 1.0),
        ),
        beam_problem("cantilever", "Cantilever", "deflection beyond one depth from the clamp, against Timoshenko's"),
        beam_problem("euler", "Euler load", "load of the part beyond one depth from the clamp, against Euler's and Engesser's"),
        scene_problem(
            "thrust",
            "Thrust on a plate",
            (Measure("arrest stress", "stress that stops growth, against p (1 - nu_A)"),),
            thrust_scene,
            thrust_step_h,
            thrust_errors,
        ),
        scene_problem(
            "path",
            "Path along an obstacle",
            (Measure("path", "tip's place at 0.25, 0.5 and 0.75 h, rms, in diameters, against the finest run", True, 1.0),),
            lambda across: PATH.format(size=PATH_DIAMETER_MM / across, step=path_step_h(across)),
            path_step_h,
            path_points,
        ),
        penetrometer_problem(
            "hertz",
            "Grain between probe and stone",
            HERTZ,
            HERTZ_GRAINS,
            Measure("force", "force on the probe, rms over its way, against Hertz"),
            hertz_errors,
        ),
        penetrometer_problem(
            "penetrometer",
            "Penetrometer",
            PENETROMETER,
            "",
            Measure("Q", "mean resistance, against the finest run", True),
            mean_Q,
        ),
        scene_problem(
            "soil",
            "Root among grains",
            (
                Measure("elongation", "growth, against the closed form with the soil's forces"),
                Measure("tip force", "mean force on the tip, against the finest run", True),
            ),
            lambda across: ROOT_IN_SOIL.format(size=ROOT_IN_SOIL_DIAMETER_MM / across, step=soil_step_h(across)),
            soil_step_h,
            soil_values,
            soil=True,
        ),
    ]
