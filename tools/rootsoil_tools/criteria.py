# SPDX-License-Identifier: MIT
"""What stable means: numeric criteria that a run's folder is judged by, each with its bound, written here only."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rootsoil_tools.runs import Frame, Run, RunError, read_summary

ADJACENT = 1.3  # in cell sizes: those nearer are neighbours; on a lattice, diagonals lie at 1.41
SMOOTH = 2.3  # in cell sizes: over this distance motion is smooth
SEARCHED = 4.0  # in cell sizes: how far a gap is looked across
LEAST_PRESSURE_MPA = 1.0  # measures are relative to the largest |p| of the scene, or to this where p = 0
MOST_MARGIN = 1e6  # of a value that is zero, where zero is best
ROWS = 256  # of a block of the pair search


@dataclass(frozen=True)
class Criterion:
    """A number of a run and its bound. `most`: the bound is an upper one."""

    name: str
    meaning: str
    bound: float
    most: bool = True

    def margin(self, value: float) -> float:
        """How many times better than the bound; below 1 it fails. A NaN has none."""
        if not np.isfinite(value):
            return 0.0
        better, worse = (self.bound, value) if self.most else (value, self.bound)
        return float(min(better / worse, MOST_MARGIN)) if worse > 0.0 else MOST_MARGIN


FINISHED = Criterion("finished", "part of the run's hours that it reached", 1.0, most=False)
FINITE = Criterion("finite", "part of all written numbers that are numbers", 1.0, most=False)
KINETIC = Criterion("kinetic", "kinetic energy of motion that is not smooth, over the elastic energy under p", 0.1)
ELASTIC = Criterion("elastic", "mean square of the stress over p^2: elastic energy over that under p", 4.0)
MOMENTUM = Criterion("momentum", "sum of all forces over the sum of their sizes", 1e-10)
CELLS_LOST = Criterion("cells_kept", "cells at the start of which every descendant is there", 1.0, most=False)
NEIGHBOURS = Criterion(
    "neighbours", "fewest neighbours over 6 (3D: 12), or half of what a cell began with", 1.0, most=False
)
# Corners and the rim of a contact concentrate stress: cells there differ by a third of p or more, on average too.
STRESS_NOISE = Criterion("stress_noise", "rms difference of the pressure of adjacent cells, over p", 0.5)
CRACK = Criterion("crack", "widest gap that splits the tissue, in cell sizes (1: cells touch)", 2.0)
GENERAL = (FINISHED, FINITE, KINETIC, ELASTIC, MOMENTUM, CELLS_LOST, NEIGHBOURS, STRESS_NOISE, CRACK)


@dataclass(frozen=True)
class Finding:
    """What a run came to under one criterion."""

    criterion: Criterion
    value: float

    @property
    def margin(self) -> float:
        """See Criterion.margin."""
        return self.criterion.margin(self.value)

    @property
    def passed(self) -> bool:
        """Whether the bound is kept."""
        return self.margin >= 1.0


def near_pairs(position: np.ndarray, shape: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs of cells within `reach` cell sizes of each other: first, second, distance (1: ellipsoids touch).

    Positions (n, d), shape matrices (n, d, d; r^T Q r = 1 on a cell's surface). Measured in the mean shape of both.
    """
    order = np.argsort(position[:, 0], kind="stable")
    position, shape = position[order], shape[order]
    x = position[:, 0]
    furthest = reach * float(2.0 / np.sqrt(np.linalg.eigvalsh(shape)[:, 0].min()))  # of the longest cell
    first, second, distances = [], [], []
    for start in range(0, len(x), ROWS):
        end = min(start + ROWS, len(x))
        last = int(np.searchsorted(x, x[end - 1] + furthest, side="right"))
        r = position[None, start:last] - position[start:end, None]
        both = shape[None, start:last] + shape[start:end, None]
        distance = np.sqrt(0.125 * np.einsum("ijab,ija,ijb->ij", both, r, r, optimize=True))
        i, j = np.nonzero(np.triu(distance < reach, 1))
        first.append(order[i + start])
        second.append(order[j + start])
        distances.append(distance[i, j])
    return np.concatenate(first), np.concatenate(second), np.concatenate(distances)


def widest_gap(cells: int, first: np.ndarray, second: np.ndarray, distance: np.ndarray) -> float:
    """The longest edge of the shortest tree that joins all cells (Kruskal); infinity where the pairs join them not."""
    root = list(range(cells))

    def leader(i: int) -> int:
        while root[i] != i:
            root[i] = root[root[i]]
            i = root[i]
        return i

    parts, widest = cells, 0.0
    for k in np.argsort(distance, kind="stable"):
        a, b = leader(int(first[k])), leader(int(second[k]))
        if a != b:
            root[a] = b
            parts -= 1
            widest = float(distance[k])
            if parts == 1:
                break
    return widest if parts == 1 else float("inf")


def rough_motion(position: np.ndarray, velocity: np.ndarray, first: np.ndarray, second: np.ndarray) -> float:
    """Part of sum v^2 that is not smooth: what a plane through velocities (n, d) of a cell and those near it leaves."""
    total = float(np.sum(velocity**2))
    if total == 0.0:
        return 0.0
    n, d = position.shape
    own = np.arange(n)
    i, j = np.concatenate([first, second, own]), np.concatenate([second, first, own])
    basis = np.concatenate([np.ones((len(i), 1)), position[j] - position[i]], axis=1)
    size = np.abs(basis[:, 1:]).max()
    basis[:, 1:] /= size if size > 0.0 else 1.0
    normal, right = np.zeros((n, d + 1, d + 1)), np.zeros((n, d + 1, d))
    np.add.at(normal, i, basis[:, :, None] * basis[:, None, :])
    np.add.at(right, i, basis[:, :, None] * velocity[j][:, None, :])
    smooth = (np.linalg.pinv(normal, rcond=1e-9, hermitian=True) @ right)[:, 0]
    return float(np.sum((velocity - smooth) ** 2)) / total


def free_cells(frame: Frame) -> Frame:
    """The frame without the held base: that is rigid, and its stress means nothing."""
    free = frame["clamped"] == 0
    return Frame(frame.time_h, {name: values[free] for name, values in frame.fields.items()})


def mean_square_stress(frame: Frame, dimension: int) -> float:
    """Mean over the volume of sigma : sigma / dimension, MPa^2; p^2 in a root at rest under p."""
    stress = frame["stress"]
    square = np.sum(stress[:, :3] ** 2, axis=1) + 2.0 * np.sum(stress[:, 3:] ** 2, axis=1)
    return float(np.average(square, weights=frame["volume"]) / dimension)


def cells_kept(frame: Frame, cells_start: int) -> float:
    """1 where nothing is lost. Daughters count half their mother, so the sum of 2^-generation never changes."""
    if len(np.unique(frame["cell_id"])) != frame.cells:
        return 0.0
    found = float(np.sum(0.5 ** frame["generation"]))
    return 1.0 if found == cells_start else min(found, cells_start) / max(found, cells_start) * (1.0 - 1e-9)


def neighbours_kept(frames: list[Frame], dimension: int, enough: float | None = None) -> float:
    """Fewest neighbours over what a cell must keep, in all but the first of the frames.

    A cell must keep `enough`, 6 (3D: 12) by default; one that began with fewer, itself or its nearest known ancestor,
    half of those. No cell counts as having begun with more than most cells of the root.
    """
    enough = enough or (6.0 if dimension == 2 else 12.0)
    usual = float(np.median(frames[0]["neighbours"]))
    began: dict[int, float] = {}
    worst = np.inf
    for k, frame in enumerate(frames):
        for cell, parent, count in zip(frame["cell_id"], frame["parent_id"], frame["neighbours"]):
            start = began.setdefault(int(cell), began.get(int(parent), min(float(count), usual) if k == 0 else usual))
            if k > 0:
                worst = min(worst, float(count) / (enough if start >= enough else max(0.5 * start, 1.0)))
    return float(worst)


def pressure_scale(scene: Mapping) -> float:
    """The largest |p| of a scene, MPa."""
    pressure = scene.get("pressure", {})
    values = [row[1] for row in pressure.get("table", [])] or [pressure.get("differential_MPa", 0.0)]
    return max(abs(float(value)) for value in values) or LEAST_PRESSURE_MPA


def finite_part(frames: list[Frame]) -> float:
    """Part of all numbers of the frames that are finite."""
    finite = [np.isfinite(values) for frame in frames for values in frame.fields.values()]
    return float(np.mean(np.concatenate([part.ravel() for part in finite])))


def measures(
    folder: Path, hours: float, stress_MPa: float | None, neighbours: float | None
) -> Iterator[tuple[Criterion, float]]:
    """Every general criterion's number, the worst over all frames of the run. Stresses relative to p or to stress_MPa.

    `neighbours`: as many are enough, where 6 (3D: 12) are not to be had.
    """
    run, summary = Run(folder), read_summary(folder)
    history, d = run.history(), run.dimension
    frames = [run.frame(k) for k in range(len(run.times_h))]
    reached = float(summary.get("time_h", 0.0))
    yield FINISHED, 1.0 if reached >= hours * (1.0 - 1e-9) else reached / hours
    finite = finite_part(frames)
    yield FINITE, finite
    if finite < 1.0:
        return
    p = stress_MPa or pressure_scale(run.scene)
    yield MOMENTUM, float(summary["momentum_residual"])
    yield CELLS_LOST, min(cells_kept(frame, int(summary["cells_start"])) for frame in frames)
    if len(frames) > 2:
        yield NEIGHBOURS, neighbours_kept(frames[1:], d, neighbours)  # at the start nobody has looked for neighbours
    worst = np.zeros(4)
    for frame, ratio in zip(frames, history["kinetic_over_elastic"]):
        worst = np.maximum(worst, frame_measures(frame, d, p, float(ratio)))
    yield from zip((KINETIC, ELASTIC, STRESS_NOISE, CRACK), map(float, worst))


def frame_measures(frame: Frame, dimension: int, p_MPa: float, kinetic_over_elastic: float) -> tuple[float, ...]:
    """KINETIC, ELASTIC, STRESS_NOISE and CRACK of one frame. The held base is tissue for CRACK only."""
    shape = frame.shape_matrices(dimension)
    if shape is None:
        raise RunError("the frames have no field 'shape'; run the scene again with it in output.fields")
    i, j, distance = near_pairs(frame["position"][:, :dimension], shape, SEARCHED)
    gap = widest_gap(frame.cells, i, j, distance)
    free = free_cells(frame)
    number = np.cumsum(frame["clamped"] == 0) - 1  # of a cell among the free ones
    both = (frame["clamped"][i] == 0) & (frame["clamped"][j] == 0)
    i, j, distance = number[i[both]], number[j[both]], distance[both]
    level = mean_square_stress(free, dimension) / p_MPa**2
    near, adjacent = distance < SMOOTH, distance < ADJACENT
    rough = rough_motion(free["position"][:, :dimension], free["velocity"][:, :dimension], i[near], j[near])
    difference = free["pressure"][i[adjacent]] - free["pressure"][j[adjacent]]
    noise = float(np.sqrt(np.mean(difference**2))) / p_MPa if len(difference) else 0.0
    return rough * kinetic_over_elastic * level, level, noise, gap


def reached_numbers(folder: Path) -> dict[str, float]:
    """What hard cases are to come to: stretch, divisions, generation, contact_N, bend_mm."""
    run = Run(folder)
    history, first, last = run.history(), run.frame(0), run.frame(-1)
    start = float(np.ptp(first["position"][:, 0]))
    return {
        "stretch": float(np.ptp(last["position"][:, 0])) / start if start > 0.0 else 0.0,
        "divisions": float(history["divisions"][-1]),
        "generation": float(last["generation"].max()),
        "contact_N": float(history["contact_force_N"].max()),
        "bend_mm": float(np.ptp(last["position"][:, 1]) - np.ptp(first["position"][:, 1])),
    }


def judge(
    folder: Path,
    hours: float,
    reaches: Mapping[str, float],
    stress_MPa: float | None = None,
    neighbours: float | None = None,
) -> list[Finding]:
    """All findings of a run that should last `hours` and come to `reaches`."""
    try:
        findings = [Finding(criterion, value) for criterion, value in measures(folder, hours, stress_MPa, neighbours)]
        numbers = reached_numbers(folder)
    except RunError:  # it wrote nothing
        return [Finding(FINISHED, 0.0)]
    for name, least in reaches.items():
        findings.append(Finding(Criterion(name, f"{name}, as the case wants", least, most=False), numbers[name]))
    return findings


def tightest(findings: list[Finding]) -> Finding:
    """The finding nearest to its bound, those that have no middle (1 or nothing) left out unless they fail."""
    failed = [finding for finding in findings if not finding.passed]
    scaled = [f for f in findings if f.criterion not in (FINISHED, FINITE, CELLS_LOST)]
    return min(failed or scaled or findings, key=lambda finding: finding.margin)
