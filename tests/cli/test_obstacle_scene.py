# SPDX-License-Identifier: MIT
"""obstacle_tilted, coarser and shorter: symmetric until contact, no penetration, Coulomb's cone kept, turns."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from cli_support import PROJECT, Program, frames, history

SCENE = PROJECT / "scenarios" / "obstacle_tilted.toml"
CELL_MM = 0.03
COARSER = [
    f"root.cell_size_mm={CELL_MM}",
    f"division.l0_mm={1.5 * CELL_MM}",
    "output.picture=false",
]


@dataclass(frozen=True)
class Contact:
    """The box's nearest face and the cells of one frame: all (n,), n the number of cells."""

    penetration: np.ndarray  # depth over the cell's extent across the face; negative: apart
    normal_N: np.ndarray
    tangential_N: np.ndarray


def contact(frame: dict[str, np.ndarray], box: dict) -> Contact:
    """Where the cells' ellipses are against the box, computed from the frame alone (2D)."""
    angle = np.deg2rad(box["angle_deg"])
    to_box = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    local = (frame["position"][:, :2] - box["position_mm"]) @ to_box.T
    beyond = np.abs(local) - box["half_size_mm"]
    outside = np.maximum(beyond, 0.0)
    inside = np.all(beyond < 0.0, axis=1)
    distance = np.where(inside, beyond.max(axis=1), np.linalg.norm(outside, axis=1))
    direction = np.where(inside[:, None], beyond == beyond.max(axis=1, keepdims=True), outside) * np.sign(local)
    normal = direction @ to_box / np.linalg.norm(direction, axis=1, keepdims=True)
    xx, yy, xy = frame["shape"][:, 0], frame["shape"][:, 1], frame["shape"][:, 3]
    # half extent of r^T Q r = 1 along n: sqrt(n^T Q^-1 n)
    nx, ny = normal.T
    half = np.sqrt((yy * nx**2 - 2.0 * xy * nx * ny + xx * ny**2) / (xx * yy - xy**2))
    force = frame["contact_force"][:, :2]
    pressed = np.sum(force * normal, axis=1)
    return Contact((half - distance) / (2.0 * half), pressed, np.linalg.norm(force - pressed[:, None] * normal, axis=1))


@pytest.fixture(scope="module")
def run(program_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """1.6 h; the tip touches the box at about 0.8 h."""
    program = Program(program_path, tmp_path_factory.mktemp("obstacle"))
    overrides = [word for value in COARSER for word in ("--set", value)]
    done = program("run", SCENE, "--out", "run", "--threads", 1, "--until", 1.6, *overrides)
    assert done.status == 0, done.err
    return program.folder / "run"


@pytest.fixture(scope="module")
def box(run: Path) -> dict:
    return tomllib.loads((run / "scene.toml").read_text())["obstacle"][0]


def first_contact(run: Path) -> int:
    """Index of the first frame with a contact force."""
    touching = [row["contact_force_N"] > 0.0 for row in history(run)]
    assert 5 < touching.index(True) < len(touching) - 5
    return touching.index(True)


def test_symmetric_until_contact(run: Path):
    """The scene is symmetric about y = 0 until the tip touches the box: so is every cell's place."""
    for frame in frames(run)[: first_contact(run)]:
        y = frame["position"][:, 1]
        assert abs(np.average(y, weights=frame["volume"])) < 4e-5 * CELL_MM  # 2.0e-5
        # as many cells at -y as at y, to what the balance leaves
        assert np.abs(np.sort(y) - np.sort(-y)).max() < 1.5e-4 * CELL_MM


def test_does_not_pass_into_the_box(run: Path, box: dict):
    deepest = max(contact(frame, box).penetration.max() for frame in frames(run))
    assert 0.0 < deepest < 0.05


def test_keeps_to_the_friction_cone(run: Path, box: dict):
    """Friction's bound follows the normal forces until they agree to 0.1 %."""
    touching, sliding, furthest = 0, 0, 0.0
    for frame in frames(run):
        c = contact(frame, box)
        pressed = c.normal_N > 0.0
        assert np.all(c.tangential_N[~pressed] == 0.0)
        cone = c.tangential_N[pressed] / (box["friction"] * c.normal_N[pressed])
        furthest = max(furthest, *cone, 0.0)
        touching += int(pressed.sum())
        sliding += int(np.sum(cone > 0.9))
    assert touching > 5
    assert sliding > 0
    assert furthest < 1.0008, furthest  # 1.0004 measured with steps of 1e-4 h


def test_turns_and_grows_along_the_face(run: Path, box: dict):
    """The tip gains height, keeps close to the face, and its axis turns towards it."""
    last = frames(run)[-1]
    rows = history(run)
    face = np.deg2rad(box["angle_deg"])
    later = rows[-8]
    travelled = np.array([rows[-1][f"tip_{axis}_mm"] - later[f"tip_{axis}_mm"] for axis in "xy"])
    assert abs(np.arctan2(travelled[1], travelled[0]) - face) < np.deg2rad(12.0)
    tip = last["distance_to_tip"] < 0.1
    axis = last["axis"][tip].mean(axis=0)
    assert np.deg2rad(10.0) < np.arctan2(axis[1], axis[0]) < face
    assert contact(last, box).penetration.max() > -0.5  # within half a cell of the box
