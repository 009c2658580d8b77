# SPDX-License-Identifier: MIT
"""Small problems with known answers, for tools/accuracy_cost.py.

A problem turns choices (cells across, changes to its scene) into commands, and what they wrote into measures.
mm, h, MPa.
"""

from __future__ import annotations

import csv
import json
import math
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rootsoil_tools import answers
from rootsoil_tools.answers import Columns, Values
from rootsoil_tools.runs import Run, read_summary
from rootsoil_tools.scenes import Changes, Scene, scene_text, with_changes

SAMPLES = 3  # of each soil
# what is measured; to write all fields would take longer than the steps between two frames
FIELDS = ["position", "distance_to_tip", "axis", "shape", "axial_strain_rate", "clamped", "cell_id", "volume"]
STEPPER, IN_BALANCE = "numerics.stepper", "quasi_static"  # key; the program's default
TOLERANCE = "numerics.force_tolerance"
# The force across the column is 8e-5 of the pressure's on a cell, less than what balanced leaves out of balance.
EULER_TOLERANCE = 1e-7


@dataclass(frozen=True)
class Choice:
    """One way to compute. Choices of one name are a curve; `level` tells its points apart. `step_factor` multiplies the
    step of preset balanced."""

    name: str
    changes: Changes = field(default_factory=dict)
    level: float = math.nan
    step_factor: float | None = None

    @property
    def has_inertia(self) -> bool:
        """Whether it moves masses instead of looking for balance."""
        return bool(self.changes.get(STEPPER, IN_BALANCE) != IN_BALANCE)


@dataclass(frozen=True)
class Cost:
    """What the runs did, mean over samples: cells, steps, simulated hours, what they say themselves is out of balance
    (share of p, mean over the second half). NaN where there is none. Processor time of starting: of all samples."""

    cells: float
    steps: float
    hours: float = math.nan
    unbalanced: float = math.nan
    start_s: float = 0.0


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
    """`prepare` writes what the runs need into a folder and gives their commands; `read` the measures' values, then."""

    name: str
    title: str
    measures: tuple[Measure, ...]
    prepare: Callable[[Path, Path, int, Choice], list[list[str]]]
    read: Callable[[Path], tuple[Values, Cost]]
    soil: bool = False

    def measure(self, name: str) -> Measure:
        """The measure of this name."""
        return next(m for m in self.measures if m.name == name)


def usual_step_h(program: Path, scene_file: Path) -> float:
    """The step (h) that the program takes for a scene."""
    said = subprocess.run(
        [str(program), "check", str(scene_file), "--json"], check=True, capture_output=True, text=True
    )
    return float(json.loads(said.stdout)["step_h"])


# ---- kinds of problems ----------------------------------------------------------------------------


def run_cost(run: Run, summary: Mapping[str, Any]) -> Cost:
    """Of one run."""
    history = run.history()
    own = history["inertia_error" if "inertia_error" in history else "force_imbalance"]
    cells = (summary["cells_start"] + summary["cells_end"]) / 2.0
    unbalanced = float(own[len(own) // 2 :].mean())
    return Cost(cells, summary["steps"], summary["time_h"], unbalanced, summary["cpu_start_s"])


def mean_cost(costs: Sequence[Cost]) -> Cost:
    """Of the samples of a problem."""

    def mean(key: str) -> float:
        return float(np.mean([getattr(c, key) for c in costs]))

    start_s = sum(c.start_s for c in costs)
    return Cost(mean("cells"), mean("steps"), mean("hours"), mean("unbalanced"), start_s)


def scene_problem(
    name: str,
    title: str,
    measures: tuple[Measure, ...],
    scene: Callable[[int], Scene],
    read: Callable[[Run], Values],
    soil: bool = False,
    with_inertia: Callable[[int], Changes] = lambda across: {},
) -> Problem:
    """A problem that `rootsoil run` solves, with soil once for each sample. `scene` of the cells across, and what a
    stepper with inertia needs besides."""
    names = [f"sample{seed}" for seed in range(1, SAMPLES + 1)] if soil else ["run"]

    def prepare(programs: Path, folder: Path, across: int, choice: Choice) -> list[list[str]]:
        commands = []
        for seed, out in enumerate(names, 1):
            own, file = with_changes(scene(across), {"soil.seed": seed} if soil else {}), folder / f"{out}.toml"
            own = with_changes(with_changes(own, with_inertia(across) if choice.has_inertia else {}), choice.changes)
            file.write_text(scene_text(own), encoding="utf-8")
            if choice.step_factor is not None:
                step_h = choice.step_factor * usual_step_h(programs / "rootsoil", file)
                file.write_text(scene_text(with_changes(own, {"numerics.step_h": step_h})), encoding="utf-8")
            commands.append(
                [str(programs / "rootsoil"), "run", f"{out}.toml", "--out", out, "--threads", "1", "--quiet"]
            )
        return commands

    def read_folder(folder: Path) -> tuple[Values, Cost]:
        runs = [Run(folder / out) for out in names]
        values = [read(run) for run in runs]
        costs = [run_cost(run, read_summary(run.folder)) for run in runs]
        return {key: [x for v in values for x in v[key]] for key in values[0]}, mean_cost(costs)

    return Problem(name, title, measures, prepare, read_folder, soil)


def beam_problem(name: str, title: str, meaning: str, in_balance: Changes) -> Problem:
    """A beam of the bending tests: build/release/bending_problem, which has inertia unless it is told otherwise.
    `in_balance`: what steps that end in balance need besides."""

    def prepare(programs: Path, folder: Path, across: int, choice: Choice) -> list[list[str]]:
        own: Changes = {} if choice.has_inertia else {STEPPER: IN_BALANCE, **in_balance}
        changes: dict[str, Any] = {**own, **choice.changes}
        if "non_affine_control" in changes:  # an argument cannot take a section away
            del changes["non_affine_control"]
            changes |= {"non_affine_control.damping": 0.0, "non_affine_control.stiffness": 0.0}
        sets = [f"{key}={json.dumps(value)}" for key, value in changes.items()]
        return [[str(programs / "bending_problem"), name, str(across), *sets]]

    def read(folder: Path) -> tuple[Values, Cost]:
        found = json.loads((folder / "out").read_text(encoding="utf-8").splitlines()[-1])
        if not found["last_change"] < 1e-3:
            raise ValueError("it did not come to rest")
        return {"stiffness": [found["ratio"] - 1.0]}, Cost(found["cells"], found["steps"])

    return Problem(name, title, (Measure("stiffness", meaning),), prepare, read)


def penetrometer_problem(
    name: str,
    title: str,
    scene: Scene,
    measure: Measure,
    read: Callable[[Scene, Columns], list[float]],
    files: Mapping[str, str] | None = None,
) -> Problem:
    """A problem that `rootsoil penetrometer` solves; `read` gets the scene and the columns of penetrometer.csv."""

    def prepare(programs: Path, folder: Path, across: int, choice: Choice) -> list[list[str]]:
        for file, text in {**(files or {}), "scene.toml": scene_text(with_changes(scene, choice.changes))}.items():
            (folder / file).write_text(text, encoding="utf-8")
        return [[str(programs / "rootsoil"), "penetrometer", "scene.toml", "--out", "run", "--quiet"]]

    def read_folder(folder: Path) -> tuple[Values, Cost]:
        with (folder / "run" / "penetrometer.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        columns = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
        return {measure.name: read(scene, columns)}, Cost(math.nan, float(len(rows)))

    return Problem(name, title, (measure,), prepare, read_folder, soil=True)


# ---- scenes ---------------------------------------------------------------------------------------


def root_scene(
    name: str, hours: float, every_h: float, length_mm: float, diameter_mm: float, across: int, *more: Changes
) -> Scene:
    """A root under 1 MPa, and changes."""
    base = {
        "scene": {"name": name, "duration_h": hours},
        "root": {"length_mm": length_mm, "radius_mm": diameter_mm / 2.0, "cell_size_mm": diameter_mm / across},
        "tissue": {"E_axial_MPa": 1020.0},
        "pressure": {"differential_MPa": 1.0},
        "non_affine_control": {},
        "output": {"every_h": every_h, "checkpoint_every_h": hours, "fields": FIELDS},
    }
    return with_changes(base, {key: value for changes in more for key, value in changes.items()})


def stiffening(x_e_mm: float, s_e_per_mm: float, c_e: float) -> Changes:
    """E_R along the root, up to 15000 MPa."""
    profile = {"E_radial_max_MPa": 15000.0, "x_e_mm": x_e_mm, "s_e_per_mm": s_e_per_mm, "c_e": c_e}
    return {"tissue.anisotropy": profile}


STIFF = stiffening(0.0, 0.0, 1.0)


def softening(
    lambda0: float, x_g_mm: float, s_g_mm: float, c_g: float, mature: tuple[float, float] | None = None
) -> Changes:
    """lambda(s) of Eq. 6, in ug/mm^3/h; `mature`: where it ends and over which width (mm)."""
    ends = {"mature_at_mm": mature[0], "mature_width_mm": mature[1]} if mature else {}
    return {"growth": {"lambda0_ug_mm3_h": lambda0, "x_g_mm": x_g_mm, "s_g_mm": s_g_mm, "c_g": c_g, **ends}}


def strain_scene(across: int, anisotropy: Changes) -> Scene:
    """Case 1: 1 mm at rest, put under pressure."""
    return root_scene("strain", 8.0, 8.0, 1.0, 0.1, across, {"numerics.start": "rest"}, anisotropy)


GROWTH_DIAMETER_MM = 0.08


def growth_scene(hours: float, across: int, length_mm: float = 1.6) -> Scene:
    """A root that grows: the rate falls to a twentieth of its peak at 1.1 mm and to a ten-thousandth at 1.7 mm."""
    profiles = (stiffening(0.51, 6.0, 0.2), softening(4.3e5, -0.05, 0.37, -1.0))
    return root_scene("growth", hours, 0.2, length_mm, GROWTH_DIAMETER_MM, across, *profiles)


def division_scene(across: int) -> Scene:
    """Lengths in units of the cells' first size, so that refined roots divide at the same places."""
    l0_mm = 1.5 * GROWTH_DIAMETER_MM / across
    keys = {"l0_mm": l0_mm, "c_d": 1.0, "s_d_per_mm2": 5.0, "x_d_mm": 0.12, "constant_beyond_mm": 0.5}
    return with_changes(growth_scene(3.0, across), {"division": keys})


def plane(x_mm: float, normal: tuple[float, float], friction: float) -> dict[str, Any]:
    """An obstacle."""
    return {"name": "plane", "shape": "plane", "position_mm": [x_mm, 0.0], "normal": [*normal], "friction": friction}


def thrust_scene(across: int) -> Scene:
    """A root whose flat tip touches a plate, and eight times as long as it takes to come to rest."""
    own = {"root.cap": False, "obstacle": [plane(0.8, (-1.0, 0.0), 0.0)], "numerics": {"start": "rest"}}
    return root_scene("thrust", 0.02, 0.02, 0.8, 0.1, across, STIFF, softening(4.34e5, 0.1, 0.2, -1.0), own)


def thrust_with_inertia(across: int) -> Changes:
    """Steps that leave time to come to rest. The damping is about twice the slowest axial frequency, which goes as the
    inertia's 1/step."""
    step_h = 1.6e-4 / across
    return {"numerics.step_h": step_h, "numerics.mass_damping_per_h": 0.24 / across / step_h}


def path_scene(across: int) -> Scene:
    """A root that grows along a plane at 45 degrees."""
    profiles = (stiffening(0.05, 40.0, 0.2), softening(4.34e5, 0.1, 0.2, -0.95, (0.7, 0.2)))
    own = {"obstacle": [plane(1.03, (-0.7071, 0.7071), 0.2)]}
    return root_scene("path", 0.75, 0.25, 1.0, 0.12, across, *profiles, own)


def path_with_inertia(across: int) -> Changes:
    """Small steps: contact is to be quasi-static, not an impact."""
    return {"numerics.step_h": 1.5e-4 / across}


def soil_box(
    x_mm: tuple[float, float], half_width_mm: float, walls: str, pressure_MPa: float, E_MPa: float
) -> dict[str, Any]:
    """[soil] in 2D, without its grains."""
    return {
        "box_from_mm": [x_mm[0], -half_width_mm],
        "box_to_mm": [x_mm[1], half_width_mm],
        "walls": walls,
        "confining_pressure_MPa": pressure_MPa,
        "E_MPa": E_MPa,
        "friction_deg": 30.0,
        "root_friction_deg": 20.0,
    }


def soil_scene(across: int) -> Scene:
    """A root among some hundred grains. A step that ends in balance is a coupling interval."""
    profiles = (stiffening(0.1, 20.0, 0.2), softening(4e5, 0.2, 0.4, -0.95, (1.1, 0.3)))
    soil = {
        **soil_box((0.8, 2.8), 1.0, "mixed", 0.04, 100.0),
        "d_range_mm": [0.15, 0.25],
        "contact": {"interval_h": 4e-3},
    }
    return root_scene("soil", 0.6, 0.02, 1.6, 0.4, across, *profiles, {"scene.dimension": 2, "soil": soil})


def soil_with_inertia(across: int) -> Changes:
    """Whole windows of 20 steps fit into the interval."""
    return {"numerics.step_h": 6e-4 / across}


PENETROMETER: Scene = {
    "scene": {"name": "penetrometer", "dimension": 2},
    "soil": {**soil_box((0.0, 2.4), 1.2, "mixed", 0.1, 250.0), "d_range_mm": [0.2, 0.3]},
    "penetrometer": {"diameter_mm": 0.6, "rate_mm_h": 0.5, "depth_mm": 0.9, "average_from_mm": 0.3, "seeds": SAMPLES},
}


# A probe with a round tip presses a grain against a stone. A second grain is held between a stone and a wall, so that
# there is a contact from the start.
GRAIN_MM, STONE_MM, PROBE_MM = 0.15, 0.5, 0.4  # radii
GRAIN_AT_MM, HOLDER_AT_MM = 0.95, (3.2, 1.2)
HERTZ_STRETCHES_MM = np.array([0.804, 0.808, 0.812, 0.816])
HERTZ_GRAINS = f"x_mm,y_mm,z_mm,radius_mm\n{GRAIN_AT_MM},0,0,{GRAIN_MM}\n{HOLDER_AT_MM[0]},1.85,0,0.151\n"
HERTZ: Scene = {
    "scene": {"name": "hertz", "dimension": 2},
    "soil": {
        **soil_box((0.0, 4.0), 2.0, "rigid", 0.1, 250.0),
        "grains_file": "grains.csv",
        "d_mean_mm": 2.0 * GRAIN_MM,
        "contact_law": "hertz_mindlin",
        "poisson": 0.3,
        "obstacle": [
            {
                "name": "stone",
                "shape": "stone",
                "position_mm": [GRAIN_AT_MM + GRAIN_MM + STONE_MM, 0.0],
                "radius_mm": STONE_MM,
            },
            {"name": "holder", "shape": "stone", "position_mm": [*HOLDER_AT_MM], "radius_mm": STONE_MM},
        ],
    },
    "penetrometer": {
        "diameter_mm": 2.0 * PROBE_MM,
        "cone_angle_deg": 180.0,
        "rate_mm_h": 0.5,
        "depth_mm": float(HERTZ_STRETCHES_MM[-1]),
        "average_from_mm": 0.8,
        "interval_h": 0.004,
        "seeds": 1,
    },
}


def hertz_errors(scene: Scene, columns: Columns) -> list[float]:
    """Force on the probe against that of its two contacts in a row."""
    material = (scene["soil"]["E_MPa"], scene["soil"]["poisson"])
    stiffness = (
        answers.hertz_stiffness(*material, GRAIN_MM, PROBE_MM),
        answers.hertz_stiffness(*material, GRAIN_MM, STONE_MM),
    )
    return answers.hertz_errors(scene, columns, stiffness, GRAIN_AT_MM - GRAIN_MM, HERTZ_STRETCHES_MM)


# ---- all ------------------------------------------------------------------------------------------

TIP = Measure("tip speed", "tip's way against the closed form")
RATE = Measure("axial rate", "axial strain rate, rms over cells, against the closed form")
LENGTH = Measure(
    "cell length", "cell length, rms of bins of 0.2 mm, mean over time, against the closed form with divisions"
)


def strain_problem(name: str, title: str, anisotropy: Changes, exact_radial: bool = True) -> Problem:
    """Case 1: bins of 0.1 mm for 0.1 mm < s < 0.7 mm."""
    radial = "radial strain, rms of bins, " + ("against Eq. 8" if exact_radial else "against the finest run")
    return scene_problem(
        name,
        title,
        (
            Measure("axial", "axial strain, rms of bins, against Eq. 8"),
            Measure("radial", radial, not exact_radial, 1.0),
        ),
        lambda across: strain_scene(across, anisotropy),
        lambda run: answers.strain_errors(run, 0.1, 0.7, exact_radial),
    )


def all_problems() -> list[Problem]:
    """Every problem, the quick ones first."""
    return [
        strain_problem("case1_isotropic", "Case 1, isotropic", {}),
        strain_problem("case1_anisotropic", "Case 1, anisotropic", STIFF),
        strain_problem("case1_balanced", "Case 1, balanced", stiffening(0.6, 5.0, 0.0), exact_radial=False),
        strain_problem(
            "case1_irregular", "Case 1, isotropic, irregular cells", {"root.jitter": 0.2, "root.size_variation": 0.3}
        ),
        scene_problem(
            "growth",
            "Growth",
            (TIP, RATE),
            lambda across: growth_scene(1.0, across),
            lambda run: answers.growth_errors(run, 0.4),
        ),
        scene_problem(
            "division",
            "Growth and division",
            (TIP, RATE, LENGTH),
            division_scene,
            lambda run: answers.division_errors(run, 1.0),
        ),
        scene_problem(
            "sleep",
            "Growth, most of the root mature",
            (TIP, Measure("growth", "growth, rms over outputs, against the run without sleep", True)),
            lambda across: growth_scene(3.0, across, 4.0),
            lambda run: answers.sleep_values(run, 1.0),
        ),
        beam_problem(
            "cantilever", "Cantilever", "deflection beyond one depth from the clamp, against Timoshenko's", {}
        ),
        beam_problem(
            "euler",
            "Euler load",
            "load of the part beyond one depth from the clamp, against Euler's and Engesser's",
            {TOLERANCE: EULER_TOLERANCE},
        ),
        scene_problem(
            "thrust",
            "Thrust on a plate",
            (Measure("arrest stress", "stress that stops growth, against p (1 - nu_A)"),),
            thrust_scene,
            answers.thrust_errors,
            with_inertia=thrust_with_inertia,
        ),
        scene_problem(
            "path",
            "Path along an obstacle",
            (
                Measure(
                    "path", "tip's place at 0.25, 0.5 and 0.75 h, rms, in diameters, against the finest run", True, 1.0
                ),
            ),
            path_scene,
            answers.path_points,
            with_inertia=path_with_inertia,
        ),
        penetrometer_problem(
            "hertz",
            "Grain between probe and stone",
            HERTZ,
            Measure("force", "force on the probe, rms over its way, against Hertz"),
            hertz_errors,
            {"grains.csv": HERTZ_GRAINS},
        ),
        penetrometer_problem(
            "penetrometer",
            "Penetrometer",
            PENETROMETER,
            Measure("Q", "mean resistance over the confining pressure, rms over samples, against the finest run", True),
            answers.mean_Q,
        ),
        scene_problem(
            "soil",
            "Root among grains",
            (
                Measure("elongation", "growth, rms over samples, against the closed form with the soil's forces"),
                Measure("tip force", "mean force on the tip (N), rms over samples, against the finest run", True),
            ),
            soil_scene,
            lambda run: answers.soil_values(run, 0.1),
            soil=True,
            with_inertia=soil_with_inertia,
        ),
    ]
