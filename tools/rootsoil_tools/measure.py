# SPDX-License-Identifier: MIT
"""Measuring along the root: bins over the distance from the tip. Lengths in mm, times in h."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rootsoil_tools.runs import Frame, Run
from rootsoil_tools.theory import ClosedForm

WINDOW_H = 10.0  # profiles are means over the last hours of a run
DRIFT_WINDOW_H = 40.0  # irregular cells scatter the radius by 0.4 %: a line through 10 h would be uncertain by that


@dataclass(frozen=True)
class Profile:
    """A quantity over the distance from the tip; NaN where a bin is empty."""

    s_mm: np.ndarray
    mean: np.ndarray
    low: np.ndarray  # 16th percentile
    high: np.ndarray  # 84th percentile


def round_width(width: float) -> float:
    """The largest of 1, 2, 2.5, 5 times a power of ten that is at most `width`."""
    power = 10.0 ** np.floor(np.log10(width))
    return float(max(m for m in (1.0, 2.0, 2.5, 5.0) if m * power <= width * (1.0 + 1e-9)) * power)


def bin_width(frame: Frame, dimension: int, zone: float) -> float:
    """Width of bins (mm) that resolve the growth zone and hold enough cells."""
    cell = float(np.median(frame.axial_lengths(dimension)[frame["distance_to_tip"] < zone]))
    return round_width(max(zone / 40.0, cell / 2.0))


def edges_of(end: float, width: float) -> np.ndarray:
    """Edges of bins of a width from the tip up to `end`."""
    return width * np.arange(max(int(np.floor(end / width + 1e-9)), 1) + 1)


def binned(s: np.ndarray, values: np.ndarray, edges: np.ndarray) -> Profile:
    """Mean and 16th to 84th percentile of the values in each bin."""
    owner = np.searchsorted(edges, s, side="right") - 1
    table = np.full((3, len(edges) - 1), np.nan)
    for index in range(len(edges) - 1):
        inside = values[owner == index]
        if inside.size:
            table[:, index] = inside.mean(), *np.percentile(inside, [16, 84])
    return Profile((edges[1:] + edges[:-1]) / 2.0, *table)


def radii(frame: Frame, dimension: int, edges: np.ndarray) -> np.ndarray:
    """Radius of the root in each bin (mm), from the tissue's cross-section: half of it in 2D, sqrt(A/pi) in 3D.

    Each cell's volume is spread evenly over its length, so that cells may be longer than a bin.
    """
    s, length, volume = frame["distance_to_tip"], frame.axial_lengths(dimension), frame["volume"]
    start = s - length / 2.0
    up_to_edge = np.array([np.sum(volume * np.clip((edge - start) / length, 0.0, 1.0)) for edge in edges])
    section = np.diff(up_to_edge) / np.diff(edges)
    return section / 2.0 if dimension == 2 else np.sqrt(section / np.pi)


def growth_profiles(run: Run, edges: np.ndarray) -> dict[str, Profile]:
    """axial_strain_rate (1/h), cell_length (um) and radius (mm): the frames of the last WINDOW_H taken together."""
    s, rate, length, radius = [], [], [], []
    for index in run.window(WINDOW_H):
        frame = run.frame(index)
        s.append(frame["distance_to_tip"])
        rate.append(frame["axial_strain_rate"])
        length.append(1e3 * frame.axial_lengths(run.dimension))
        radius.append(radii(frame, run.dimension, edges))
    middle = (edges[1:] + edges[:-1]) / 2.0
    return {
        "axial_strain_rate": binned(np.concatenate(s), np.concatenate(rate), edges),
        "cell_length": binned(np.concatenate(s), np.concatenate(length), edges),
        "radius": Profile(middle, np.mean(radius, axis=0), *np.percentile(radius, [16, 84], axis=0)),
    }


def strain_profiles(first: Frame, last: Frame, dimension: int, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Axial and radial strain of a straight root along x between two frames, in bins of the first's distance.

    In each bin the least-squares slope of the last position against the first, less one: x for the axial strain;
    y, and in 3D z with it, for the radial strain. NaN in bins with fewer than three cells.
    """
    order_first, order_last = np.argsort(first["cell_id"]), np.argsort(last["cell_id"])
    if not np.array_equal(first["cell_id"][order_first], last["cell_id"][order_last]):
        raise ValueError("strain between two frames needs the same cells in both")
    before, after = first["position"][order_first], last["position"][order_last]
    owner = np.searchsorted(edges, first["distance_to_tip"][order_first], side="right") - 1
    strains = np.full((2, len(edges) - 1), np.nan)
    for index in range(len(edges) - 1):
        x0, x1 = before[owner == index], after[owner == index]
        if len(x0) < 3:
            continue
        x0, x1 = x0 - x0.mean(axis=0), x1 - x1.mean(axis=0)
        for row, axes in enumerate((slice(0, 1), slice(1, dimension))):
            spread = np.sum(x0[:, axes] ** 2)
            if spread > 1e-12:  # mm^2; less is rounding, of one column of cells
                strains[row, index] = np.sum(x0[:, axes] * x1[:, axes]) / spread - 1.0
    return strains[0], strains[1]


def mature_radii(model: ClosedForm, run: Run, hours: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (h) of the last `hours` and the radius (mm) just behind the growth zone, over a quarter of its length.

    Only of tissue that has flowed through the growth zone since the start: tissue that was beyond the zone's first
    quarter at the start is left out, as far as the closed form can tell. Empty where the root ends before.
    """
    frames = run.window(hours)
    last = run.frame(-1)
    length = float(last["distance_to_tip"].max())
    zone = model.growth_zone(length)
    end = min(1.25 * zone, length, model.carried_to(0.25 * zone, float(run.times_h[frames[0]]), length))
    if end <= zone:
        return np.empty(0), np.empty(0)
    window = np.array([zone, end])
    return run.times_h[frames], np.array([radii(run.frame(i), run.dimension, window)[0] for i in frames])


def mature_radius(model: ClosedForm, run: Run) -> float:
    """Mean of mature_radii (mm) over WINDOW_H; NaN where there is none."""
    radius = mature_radii(model, run, WINDOW_H)[1]
    return float(np.mean(radius)) if radius.size else float("nan")


def radius_drift(model: ClosedForm, run: Run) -> float:
    """Relative change of mature_radii per hour (1/h), from the least-squares line over DRIFT_WINDOW_H; NaN below three
    frames."""
    time, radius = mature_radii(model, run, DRIFT_WINDOW_H)
    return float(np.polyfit(time, np.log(radius), 1)[0]) if radius.size > 2 else float("nan")


def tip_speed(run: Run) -> float:
    """Growth of the root's length (mm/h) over the last WINDOW_H, from history.csv.

    With fewer than two rows in that time, what the last row says: the growth since the row before it, and in a run with
    one row its speed at the start. NaN only without history.csv.
    """
    history = run.history()
    if not history:
        return float("nan")
    time, length = history["time_h"], history["length_mm"]
    inside = time >= time[-1] - min(WINDOW_H, (time[-1] - time[0]) / 3.0) - 1e-9
    if np.count_nonzero(inside) < 2:
        return float(history["tip_speed_mm_h"][-1])
    return float(np.polyfit(time[inside], length[inside], 1)[0])


def arresting_force(model: ClosedForm, run: Run) -> float:
    """Axial force that stops growth (closed form; N, in 2D N/mm): the arresting stress times the section."""
    frame = run.frame(0)
    radius = float(np.max(radii(frame, run.dimension, np.linspace(0.0, float(frame["distance_to_tip"].max()), 21))))
    section = 2.0 * radius if run.dimension == 2 else np.pi * radius**2
    return model.arrest_stress * section


def running_mean(time: np.ndarray, values: np.ndarray, over: float) -> np.ndarray:
    """Mean of the values within `over`/2 of each time; the first row, before anything has moved, does not count."""
    near = (np.abs(time[:, None] - time[None, :]) <= over / 2.0 + 1e-9) & (np.arange(len(time)) > 0)
    return (near @ values) / np.maximum(near.sum(axis=1), 1)


def running_slope(time: np.ndarray, values: np.ndarray, over: float) -> np.ndarray:
    """Slope of the straight line through the values within `over`/2 of each time."""
    near = (np.abs(time[:, None] - time[None, :]) <= over / 2.0 + 1e-9).astype(float)
    count = near.sum(axis=1)
    t, v = near @ time / count, near @ values / count
    return (near @ (time * values) / count - t * v) / np.maximum(near @ time**2 / count - t**2, 1e-12)


def tip_angle(frame: Frame, dimension: int) -> float:
    """Angle (rad) between the x axis and the material axis of the last 0.4 radii of the root."""
    distance = frame["distance_to_tip"] - frame["distance_to_tip"].min()
    reach = 0.4 * float(np.max(radii(frame, dimension, np.linspace(0.0, float(distance.max()), 21))))
    axis = frame["axis"][distance <= reach].mean(axis=0)
    return float(np.arctan2(np.hypot(axis[1], axis[2]), axis[0]))


def near_points(run: Run, frames: list[int], quantity: str, at_mm: np.ndarray, half_mm: float) -> np.ndarray:
    """Mean of axial_strain_rate (1/h) or cell_length (um) of cells within `half_mm` of each point, a row a frame."""
    table = np.full((len(frames), len(at_mm)), np.nan)
    for row, index in enumerate(frames):
        frame = run.frame(index)
        lengths = 1e3 * frame.axial_lengths(run.dimension)
        values = lengths if quantity == "cell_length" else frame[quantity]
        near = np.abs(frame["distance_to_tip"][None, :] - at_mm[:, None]) <= half_mm
        count = near.sum(axis=1)
        table[row, count > 0] = (near @ values)[count > 0] / count[count > 0]
    return table


def division_rates(run: Run, frames: list[int], at_mm: np.ndarray, half_mm: float) -> np.ndarray:
    """Divisions for each cell and hour (1/h) within `half_mm` of each point, a row for each two frames in succession.

    A division is a mother of the earlier frame of whom the later one has daughters; it lies half-way between her place
    and theirs. Cells that divided twice between the frames count once.
    """
    table = np.full((len(frames) - 1, len(at_mm)), np.nan)
    for row, (first, second) in enumerate(zip(frames, frames[1:])):
        before, after = run.frame(first), run.frame(second)
        place = dict(zip(before["cell_id"], before["distance_to_tip"]))
        daughters: dict[int, list[float]] = {}
        for mother, s in zip(after["parent_id"], after["distance_to_tip"]):
            if mother in place:
                daughters.setdefault(mother, []).append(s)
        survived = np.isin(after["cell_id"], before["cell_id"])
        newborn = set(after["parent_id"][~survived])
        at = np.array([(place[m] + np.mean(s)) / 2.0 for m, s in daughters.items() if m in newborn])
        hours = run.times_h[second] - run.times_h[first]
        divisions = (np.abs(at[None, :] - at_mm[:, None]) <= half_mm).sum(axis=1) if at.size else np.zeros(len(at_mm))
        cells = np.mean(
            [(np.abs(f["distance_to_tip"][None, :] - at_mm[:, None]) <= half_mm).sum(axis=1) for f in (before, after)],
            axis=0,
        )
        table[row, cells > 0] = divisions[cells > 0] / (cells[cells > 0] * hours)
    return table
