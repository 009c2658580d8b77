# SPDX-License-Identifier: MIT
"""The choices of tools/accuracy_cost.py and the grid of its runs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from rootsoil_tools.problems import EULER_TOLERANCE, STEPPER, TOLERANCE, Choice, Problem
from rootsoil_tools.scenes import PAPER, Changes

DEFAULT_NAME, FINEST_NAME, PAPER_NAME = "default", "finest", "paper's scheme"
EXPLICIT_NAME, CORRECTOR_NAME = "explicit", "predictor-corrector"
DEFAULT = Choice(DEFAULT_NAME)
THE_PAPERS = Choice(PAPER_NAME, PAPER)
SYMPLECTIC: Changes = {STEPPER: "symplectic"}
EXPLICIT = Choice(EXPLICIT_NAME, SYMPLECTIC)
CORRECTOR = Choice(CORRECTOR_NAME, {STEPPER: "predictor_corrector"})

# either or: a curve over the cells across
SWITCHES = [
    *(
        Choice(f"isotropic kernel, H_bar {h:g}", {"numerics.kernel": "isotropic", "numerics.H_bar": h})
        for h in (2.0, 4.5, 8.0)
    ),
    Choice("plain gradient", {"numerics.gradient": "plain"}),
    Choice("linear gradient", {"numerics.gradient": "linear"}),
    Choice("quadratic gradient", {"numerics.gradient": "quadratic"}),
    Choice("no non-affine control", {"non_affine_control": None}),
    Choice("law pressure_deviator", {"tissue.law": "pressure_deviator"}),
]
# the other ways to move on in time, and the paper's whole scheme
STEPPERS = [EXPLICIT, CORRECTOR, THE_PAPERS]
PRESETS = [Choice(f"preset {name}", {"numerics.accuracy": name}) for name in ("fast", "balanced", "reference")]


def explicit(choice: Choice) -> Choice:
    """The same with the explicit stepper."""
    return replace(choice, name=f"{EXPLICIT_NAME}, {choice.name}", changes={**SYMPLECTIC, **choice.changes})


EXPLICIT_PRESETS = [explicit(choice) for choice in PRESETS if choice.name != "preset balanced"]
# what only a stepper with inertia has
OF_INERTIA = [
    explicit(Choice("scalar inertia", {"numerics.inertia": "scalar"})),
    explicit(Choice("no compensation", {"numerics.inertia_compensation": False})),
]


@dataclass(frozen=True)
class Dial:
    """A choice that is a number: a curve over it. The run of `base` is the point at `usual`."""

    name: str
    key: str  # empty: the step, over that of the base
    levels: Sequence[float]
    usual: float = math.nan  # NaN: the base is without it, and no point of the curve
    with_it: Changes = field(default_factory=dict)
    base: str = DEFAULT_NAME

    def choices(self) -> list[Choice]:
        """Its points but the usual one."""
        if not self.key:
            return [Choice(self.name, self.with_it, level, level) for level in self.levels]
        return [Choice(self.name, {**self.with_it, self.key: level}, level) for level in self.levels]


STEP = Dial("step", "", (2.0, 0.5, 0.25, 0.125), 1.0)
FORCES = Dial("force tolerance", TOLERANCE, (1e-2, 1e-3, 1e-5, 1e-6), 1e-4)
ETA = Dial("eta", "numerics.eta", (1.2, 1.35, 1.75, 2.0), 1.5)
EXPLICIT_STEP = Dial("explicit, step", "", (8.0, 4.0, 2.0, 0.5), 1.0, SYMPLECTIC, EXPLICIT_NAME)
EXPLICIT_WINDOW = Dial("explicit, window", "numerics.window_steps", (5, 80), 20, SYMPLECTIC, EXPLICIT_NAME)
SLEEP = [
    Dial("sleep, strain rate", "sleep.strain_rate_per_h", (0.1, 0.01, 1e-3, 1e-4)),
    Dial("sleep, stress change", "sleep.stress_change", (0.05, 0.005, 5e-4), with_it={"sleep.strain_rate_per_h": 1e-3}),
]


def in_soil(interval: Dial, *more: Dial) -> list[Dial]:
    """What every soil has."""
    return [
        interval,
        Dial("inertial number", "soil.inertial_number_max", (0.1, 0.03, 0.003), 0.01),
        Dial("substeps", "soil.step_safety", (1.0, 0.25), 0.5),
        *more,
    ]


DIALS: dict[str, list[Dial]] = {
    **{name: [FORCES, ETA] for name in ("case1_isotropic", "case1_anisotropic", "case1_balanced", "case1_irregular")},
    "cantilever": [FORCES, ETA],
    "euler": [replace(FORCES, levels=(1e-4, 1e-5, 1e-6, 1e-8), usual=EULER_TOLERANCE), ETA],
    # the default's step is the whole run
    "thrust": [replace(STEP, levels=(0.5, 0.25, 0.125)), FORCES, ETA],
    "growth": [STEP, FORCES, ETA, EXPLICIT_STEP],
    "division": [STEP, FORCES, ETA, EXPLICIT_STEP, EXPLICIT_WINDOW],
    "path": [STEP, FORCES, ETA, replace(EXPLICIT_STEP, levels=(16.0, 8.0, 4.0))],
    "sleep": SLEEP,
    "hertz": in_soil(Dial("interval", "penetrometer.interval_h", (0.008, 0.002), 0.004)),
    "penetrometer": in_soil(
        Dial("interval", "penetrometer.interval_h", (0.048, 0.003), 0.012),
        Dial("grain stiffness", "soil.E_MPa", (62.5, 500.0), 250.0),
    ),
    "soil": in_soil(
        Dial("interval", "soil.contact.interval_h", (0.016, 0.008, 0.002), 0.004),
        Dial("grain stiffness", "soil.E_MPa", (25.0, 200.0), 100.0),
        Dial("explicit, interval", "soil.contact.interval_h", (0.016,), 0.004, SYMPLECTIC, EXPLICIT_NAME),
        Dial("marker spacing", "soil.contact.marker_spacing", (1.0, 0.4), 0.6),
    ),
}
USUAL_ACROSS = 8  # of choices that are numbers, and of presets
SOIL_ACROSS = 6
# Where there is no closed form: the run that the others are compared with, and its cells across.
FINEST: Mapping[str, tuple[int, Changes]] = {
    "path": (16, {"numerics.step_h": 3e-3}),
    "penetrometer": (SOIL_ACROSS, {"penetrometer.interval_h": 0.006, "soil.inertial_number_max": 0.002}),
    "soil": (
        SOIL_ACROSS,
        {
            "soil.contact.interval_h": 0.002,
            "soil.inertial_number_max": 0.001,
            "soil.step_safety": 0.25,
            "soil.contact.marker_spacing": 0.3,
        },
    ),
}


@dataclass(frozen=True)
class Task:
    """One run (of each sample)."""

    problem: Problem
    choice: Choice
    across: int


def place_of_task(task: Task) -> tuple[str, str, int, str]:
    """Which run of the grid it is."""
    return task.problem.name, task.choice.name, task.across, f"{task.choice.level:g}"


def cells_of_default(problem: Problem) -> Sequence[int]:
    """Cells across."""
    return (6, 8, 10, 12, 16) if problem.name == "path" else (4, 6, 8, 10, 12, 16)


def cells_of(problem: Problem, choice: Choice) -> Sequence[int]:
    """Cells across of what is either or. Wide kernels stop at 8, where a run takes 5 to 10 times the default's; along
    an obstacle what has inertia stops where it takes minutes."""
    coarse = choice.changes.get("numerics.H_bar", 0.0) > 2.0
    if problem.name == "path":
        return (6, 8) if coarse or choice.name == CORRECTOR_NAME else (6, 8, 12)
    return (4, 6, 8) if coarse else (4, 6, 8, 12)


def presets_of(problem: Problem) -> list[Choice]:
    """The presets, where they differ: the column's tolerance and step are its own."""
    return PRESETS if problem.name != "euler" else []


def of_inertia(problem: Problem) -> list[Choice]:
    """Choices that steppers with inertia have, where they can make a difference: inertia is compensated where tissue
    grows, and its tensor matters where stiffnesses differ."""
    if problem.name in ("growth", "division"):
        return [*OF_INERTIA, *EXPLICIT_PRESETS]
    return OF_INERTIA[:1] if problem.name in ("case1_anisotropic", "thrust") else []


def steps_elsewhere(problem: Problem) -> list[Task]:
    """The step with fewer and more cells, for the fronts of the steppers."""
    levels = {"step": (0.25, 0.125), "explicit, step": (4.0,)}
    return [
        Task(problem, choice, across)
        for dial in DIALS[problem.name]
        for choice in dial.choices()
        if choice.level in levels.get(dial.name, ())
        for across in cells_of_default(problem)
        if across != USUAL_ACROSS and across <= 12
    ]


def grid_of(problem: Problem) -> list[Task]:
    """All runs of a problem."""
    own = [choice for dial in DIALS[problem.name] for choice in dial.choices()]
    finest = [Task(problem, Choice(FINEST_NAME, c), n) for name, (n, c) in FINEST.items() if name == problem.name]
    if problem.soil or problem.name == "sleep":
        across = SOIL_ACROSS if problem.soil else USUAL_ACROSS
        steppers = [] if problem.name in ("hertz", "penetrometer") else [EXPLICIT]  # no root
        return [Task(problem, DEFAULT, across), *finest, *(Task(problem, c, across) for c in (*steppers, *own))]
    return [
        *(Task(problem, DEFAULT, across) for across in cells_of_default(problem)),
        *finest,
        *(Task(problem, c, n) for c in STEPPERS for n in cells_of(problem, c)),
        *(Task(problem, c, USUAL_ACROSS) for c in (*presets_of(problem), *own, *of_inertia(problem))),
        *steps_elsewhere(problem),
        *(Task(problem, c, n) for c in SWITCHES for n in cells_of(problem, c)),
    ]


def full_grid(problems: Sequence[Problem]) -> list[Task]:
    """Every run."""
    return [task for problem in problems for task in grid_of(problem)]


def quick_grid(problems: Sequence[Problem]) -> list[Task]:
    """What continuous integration runs: no obstacle's path, no soil."""
    cheap = [p for p in problems if p.name not in ("path", "sleep") and not p.soil]
    tasks = [Task(p, DEFAULT, across) for across in (6, 10) for p in cheap]
    tasks += [Task(p, choice, 6) for p in cheap for choice in presets_of(p) if choice.name != "preset balanced"]
    tasks += [Task(p, choice, 6) for choice in (EXPLICIT, THE_PAPERS) for p in cheap]
    by_name = {p.name: p for p in problems}
    asleep = [DEFAULT, *(c for c in SLEEP[0].choices() if c.level in (0.01, 1e-4))]
    tasks += [Task(by_name["sleep"], choice, 4) for choice in asleep if "sleep" in by_name]
    return tasks


def dial_of(problem: str, name: str) -> Dial | None:
    """The choice of this name where it is a number."""
    return next((dial for dial in DIALS[problem] if dial.name == name), None)
