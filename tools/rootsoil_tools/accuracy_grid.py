# SPDX-License-Identifier: MIT
"""The choices of tools/accuracy_cost.py and the grid of its runs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rootsoil_tools.problems import Choice, Problem
from rootsoil_tools.scenes import PAPER, Changes

DEFAULT_NAME, FINEST_NAME, PAPER_NAME = "default", "finest", "paper's scheme"
DEFAULT = Choice(DEFAULT_NAME)
THE_PAPERS = Choice(PAPER_NAME, PAPER)

# either or: a curve over the cells across
SWITCHES = [
    *(
        Choice(f"isotropic kernel, H_bar {h:g}", {"numerics.kernel": "isotropic", "numerics.H_bar": h})
        for h in (2.0, 4.5, 8.0)
    ),
    Choice("plain gradient", {"numerics.gradient": "plain"}),
    Choice("linear gradient", {"numerics.gradient": "linear"}),
    Choice("quadratic gradient", {"numerics.gradient": "quadratic"}),
    Choice("scalar inertia", {"numerics.inertia": "scalar"}),
    Choice("no compensation of inertia", {"numerics.inertia_compensation": False}),
    Choice("no non-affine control", {"non_affine_control": None}),
    Choice("predictor-corrector", {"numerics.stepper": "predictor_corrector"}),
    Choice("law pressure_deviator", {"tissue.law": "pressure_deviator"}),
    THE_PAPERS,
]
PRESETS = [Choice(f"preset {name}", {"numerics.accuracy": name}) for name in ("fast", "balanced", "reference")]


@dataclass(frozen=True)
class Dial:
    """A choice that is a number: a curve over it. The default's run is the point at `usual`."""

    name: str
    key: str  # empty: the step, over preset balanced's
    levels: Sequence[float]
    usual: float = math.nan  # NaN: the default is without it, and no point of the curve
    with_it: Changes = field(default_factory=dict)

    def choices(self) -> list[Choice]:
        """Its points but the usual one."""
        if not self.key:
            return [Choice(self.name, {}, level, level) for level in self.levels]
        return [Choice(self.name, {**self.with_it, self.key: level}, level) for level in self.levels]


STEP = Dial("step", "", (8.0, 4.0, 2.0, 0.5), 1.0)
WINDOW = Dial("window", "numerics.window_steps", (5, 10, 40, 80), 20)
ETA = Dial("eta", "numerics.eta", (1.2, 1.35, 1.75, 2.0), 1.5)
SLEEP = [
    Dial("sleep, strain rate", "sleep.strain_rate_per_h", (0.1, 0.01, 1e-3, 1e-4)),
    Dial("sleep, stress change", "sleep.stress_change", (0.05, 0.005, 5e-4), with_it={"sleep.strain_rate_per_h": 1e-3}),
]


def in_soil(interval: Dial, lowest_inertial_number: float, *more: Dial) -> list[Dial]:
    """What every soil has."""
    return [
        interval,
        Dial("inertial number", "soil.inertial_number_max", (0.1, 0.03, 0.003, lowest_inertial_number), 0.01),
        Dial("substeps", "soil.step_safety", (1.0, 0.25), 0.5),
        *more,
    ]


DIALS: dict[str, list[Dial]] = {
    **{name: [WINDOW, ETA] for name in ("case1_isotropic", "case1_anisotropic", "case1_balanced", "case1_irregular")},
    **{name: [WINDOW, ETA] for name in ("cantilever", "euler", "thrust")},
    **{name: [STEP, WINDOW, ETA] for name in ("growth", "division", "path")},
    "sleep": SLEEP,
    "hertz": in_soil(Dial("interval", "penetrometer.interval_h", (0.008, 0.002, 0.001), 0.004), 0.001),
    "penetrometer": in_soil(
        Dial("interval", "penetrometer.interval_h", (0.048, 0.024, 0.006, 0.003), 0.012),
        0.002,
        Dial("grain stiffness", "soil.E_MPa", (62.5, 125.0, 500.0), 250.0),
    ),
    "soil": in_soil(
        Dial("interval", "soil.contact.interval_h", (0.016, 0.008, 0.002), 0.004),
        0.001,
        Dial("grain stiffness", "soil.E_MPa", (25.0, 50.0, 200.0), 100.0),
        Dial("marker spacing", "soil.contact.marker_spacing", (1.0, 0.8, 0.4, 0.3), 0.6),
    ),
}
FINEST_IN_SOIL: Mapping[str, dict[str, Any]] = {
    "penetrometer": {"penetrometer.interval_h": 0.006, "soil.inertial_number_max": 0.002},
    "soil": {
        "soil.contact.interval_h": 0.002,
        "soil.inertial_number_max": 0.001,
        "soil.step_safety": 0.25,
        "soil.contact.marker_spacing": 0.3,
    },
}
USUAL_ACROSS = 8  # of choices that are numbers, and of presets
SOIL_ACROSS = 6


@dataclass(frozen=True)
class Task:
    """One run (of each sample)."""

    problem: Problem
    choice: Choice
    across: int


def place_of_task(task: Task) -> tuple[str, str, int, str]:
    """Which run of the grid it is."""
    return task.problem.name, task.choice.name, task.across, f"{task.choice.level:g}"


def concerns(choice: Choice, problem: Problem) -> bool:
    """Whether the choice can make a difference: inertia is compensated where tissue grows."""
    return choice.name != "no compensation of inertia" or problem.name in ("growth", "division", "path")


def cells_of_default(problem: Problem) -> Sequence[int]:
    """Cells across. The path is compared with its finest run."""
    return (6, 8, 10, 12) if problem.name == "path" else (4, 6, 8, 10, 12, 16)


def cells_of_switch(problem: Problem, choice: Choice) -> Sequence[int]:
    """Cells across. Wide kernels stop at 8, where a run takes 4 to 6 times the default's; at 12 it would be 8 to 14."""
    all_cells = (6, 8, 10) if problem.name == "path" else (4, 6, 8, 12)
    return [n for n in all_cells if n <= 8 or choice.changes.get("numerics.H_bar", 0.0) <= 2.0]


def grid_of(problem: Problem) -> list[Task]:
    """All runs of a problem."""
    own = [choice for dial in DIALS[problem.name] for choice in dial.choices()]
    if problem.soil or problem.name == "sleep":
        across = SOIL_ACROSS if problem.soil else USUAL_ACROSS
        finest = [Choice(FINEST_NAME, FINEST_IN_SOIL[problem.name])] if problem.name in FINEST_IN_SOIL else []
        return [Task(problem, choice, across) for choice in (DEFAULT, *finest, *own)]
    return [
        *(Task(problem, DEFAULT, across) for across in cells_of_default(problem)),
        *(Task(problem, choice, USUAL_ACROSS) for choice in (*PRESETS, *own)),
        *(Task(problem, c, n) for c in SWITCHES if concerns(c, problem) for n in cells_of_switch(problem, c)),
    ]


def full_grid(problems: Sequence[Problem]) -> list[Task]:
    """Every run."""
    return [task for problem in problems for task in grid_of(problem)]


def quick_grid(problems: Sequence[Problem]) -> list[Task]:
    """What continuous integration runs: no obstacle's path, no soil."""
    cheap = [p for p in problems if p.name not in ("path", "sleep") and not p.soil]
    tasks = [Task(p, DEFAULT, across) for across in (6, 10) for p in cheap if across == 6 or p.name != "division"]
    tasks += [Task(p, choice, 6) for choice in PRESETS if choice.name != "preset balanced" for p in cheap]
    tasks += [Task(p, THE_PAPERS, 6) for p in cheap]
    by_name = {p.name: p for p in problems}
    asleep = [DEFAULT, *(c for c in SLEEP[0].choices() if c.level in (0.01, 1e-4))]
    tasks += [Task(by_name["sleep"], choice, 4) for choice in asleep if "sleep" in by_name]
    return tasks


def usual_level(problem: str, name: str) -> float:
    """Where the default lies on the curve of a choice; NaN: nowhere."""
    return next((dial.usual for dial in DIALS[problem] if dial.name == name), math.nan)
