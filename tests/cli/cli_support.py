# SPDX-License-Identifier: MIT
"""Scenes of a few dozen or hundred cells, and what the tests read from a run's folder."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
TIMEOUT_S = 300

# The smallest root that a scene can ask for: nothing but the sections that every scene needs.
SMALL = """\
[scene]
name = "small"
duration_h = 0.2

[root]
length_mm = 0.1
radius_mm = 0.02
cell_size_mm = 0.01

[tissue]
E_axial_MPa = 1020.0

[output]
every_h = 0.1
"""

SECTIONS = {
    "anisotropy": """
[tissue.anisotropy]
E_radial_max_MPa = 12000.0
x_e_mm = 0.05
s_e_per_mm = 40.0
c_e = 0.2
""",
    "pressure": """
[pressure]
differential_MPa = 1.0
""",
    "growth": """
[growth]
lambda0_ug_mm3_h = 1.3e6
x_g_mm = 0.05
s_g_mm = 0.15
c_g = -0.95
""",
    "division": """
[division]
l0_mm = 0.011
s_d_per_mm2 = 4.0
""",
    "non_affine_control": """
[non_affine_control]
""",
    "obstacle": """
[[obstacle]]
name = "wall"
shape = "plane"
position_mm = [0.34, -0.03]
angle_deg = 60.0
""",
}

# Everything at once: some 200 irregular cells grow, divide (all through the run) and press against a tilted wall.
FULL = (
    """\
[scene]
name = "full"
duration_h = 0.4

[root]
length_mm = 0.3
radius_mm = 0.03
cell_size_mm = 0.01
jitter = 0.1
size_variation = 0.3

[tissue]
E_axial_MPa = 1020.0
"""
    + "".join(SECTIONS.values())
    + """
[numerics]
stepper = "symplectic"
step_h = 0.001
window_steps = 7
inertia_error_max = 1e3  # so large a step beside the wall

[output]
every_h = 0.1
checkpoint_every_h = 0.013
"""
)

# The same in steps that end in balance; 80 of them.
BALANCED = FULL.replace(FULL[FULL.index("stepper = ") : FULL.index("[output]")], "step_h = 0.005\n\n")

# Two thirds of it are mature and fall asleep at 0.2 h; the step of pressure wakes them.
SLEEPING = """\
[scene]
name = "sleeping"
duration_h = 0.6

[root]
length_mm = 0.9
radius_mm = 0.03
cell_size_mm = 0.01

[tissue]
E_axial_MPa = 1020.0

[pressure]
table = [[0.0, 1.0], [0.45, 1.0], [0.47, 0.8]]

[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.1
c_g = -1.0
mature_at_mm = 0.15
mature_width_mm = 0.05

[division]
l0_mm = 0.012
c_d = 1.0
s_d_per_mm2 = 45.0
x_d_mm = 0.12
constant_beyond_mm = 0.5

[non_affine_control]

[sleep]

[numerics]
stepper = "symplectic"
step_h = 2e-4

[output]
every_h = 0.05
checkpoint_every_h = 0.13
"""


@dataclass(frozen=True)
class Done:
    """How the program ended, and what it wrote."""

    status: int
    out: str
    err: str

    def json(self) -> Any:
        """What it wrote to its standard output, read as JSON."""
        return json.loads(self.out)


class Program:
    """The program under test."""

    def __init__(self, path: Path, folder: Path):
        self.path = path
        self.folder = folder
        self.environment = {**os.environ, "OMP_NUM_THREADS": "1"}

    def command(self, *arguments: Any) -> list[str]:
        """The command line."""
        return [str(self.path), *map(str, arguments)]

    def __call__(self, *arguments: Any, **options: Any) -> Done:
        """Runs it to its end."""
        done = subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            **options,
        )
        return Done(done.returncode, done.stdout, done.stderr)

    def start(self, *arguments: Any) -> subprocess.Popen[bytes]:
        """Starts it, for tests that end it."""
        return subprocess.Popen(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def scene(self, text: str, name: str = "scene.toml") -> Path:
        """Writes a scene file."""
        path = self.folder / name
        path.write_text(text)
        return path


def replaced(text: str, old: str, new: str) -> str:
    """The text with one part exchanged; an error where that part is not there."""
    assert text.count(old) == 1, f"the scene has not one '{old}'"
    return text.replace(old, new)


def digest(folder: Path) -> dict[str, str]:
    """A checksum of every file below the folder, by name."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def frames(run: Path) -> list[dict[str, np.ndarray]]:
    """Every dataset of every frame of run.h5, in order ("grains/position"), with the frame's time and step."""

    def datasets(group: h5py.Group) -> dict[str, np.ndarray]:
        found: dict[str, np.ndarray] = {}
        group.visititems(
            lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None
        )
        return found

    with h5py.File(run / "run.h5") as file:
        return [
            datasets(group) | {name: np.asarray(group.attrs[name]) for name in ("time_h", "step", "cells")}
            for _, group in sorted(file["frames"].items())
        ]


def checkpoint(run: Path) -> dict[str, np.ndarray]:
    """Every dataset and attribute of checkpoint.h5."""
    found: dict[str, np.ndarray] = {}
    with h5py.File(run / "checkpoint.h5") as file:
        found.update({f"attribute {name}": np.asarray(value) for name, value in file.attrs.items()})
        file.visititems(
            lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None
        )
    return found


def history(run: Path, name: str = "history.csv") -> list[dict[str, float]]:
    """The rows of a table of the run; NaN where a field is empty."""
    with (run / name).open() as file:
        return [{key: float(value or "nan") for key, value in row.items()} for row in csv.DictReader(file)]


def summary(run: Path) -> dict[str, Any]:
    """summary.json."""
    return json.loads((run / "summary.json").read_text())


# In summary.json: what is measured on the clock, the machine or the present session.
MEASURED = {"wall_s", "cpu_s", "cpu_start_s", "wall_s_by_effect", "pairs_per_s", "peak_memory_mb", "threads"}


def same_bits(a: dict[str, np.ndarray], b: dict[str, np.ndarray]) -> None:
    """Asserts the same names, shapes and bytes."""
    assert a.keys() == b.keys()
    for name, values in a.items():
        assert values.dtype == b[name].dtype and values.shape == b[name].shape, name
        assert values.tobytes() == b[name].tobytes(), f"{name} differs"


def same_results(a: Path, b: Path) -> None:
    """Asserts that two finished runs hold the same numbers, bit for bit, wherever they wrote them."""
    frames_a, frames_b = frames(a), frames(b)
    assert len(frames_a) == len(frames_b)
    for frame_a, frame_b in zip(frames_a, frames_b):
        same_bits(frame_a, frame_b)
    assert (a / "history.csv").read_text() == (b / "history.csv").read_text()
    same_bits(checkpoint(a), checkpoint(b))
    summary_a, summary_b = summary(a), summary(b)
    for name in MEASURED:
        del summary_a[name], summary_b[name]
    assert summary_a == summary_b
