# SPDX-License-Identifier: MIT
"""What the runs of tools/accuracy_cost.py came to, against closed forms, or for comparison with another run.

Strains are logarithmic: the tissue's law is one of rates, so Eq. 8 gives the logarithm of a stretch; the engineering
strain of 9e-4 would show an error of 0.05 % that is none. mm, h, MPa, N.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rootsoil_tools import measure, theory
from rootsoil_tools.runs import Run

Values = dict[str, list[float]]  # measure: relative errors, or values that are compared with those of another run
Columns = Mapping[str, np.ndarray]  # of penetrometer.csv, (readings,)


# ---- strain and growth ----------------------------------------------------------------------------


def strain_errors(run: Run, from_mm: float, to_mm: float, exact_radial: bool) -> Values:
    """Axial and radial strain at the end against Eq. 8, in bins of 0.1 mm; without exact_radial the radial strain over
    its largest."""
    model = run.frame(-1).closed_form
    edges = np.arange(round(from_mm * 10), round(to_mm * 10) + 1) / 10.0
    axial, radial = (np.log1p(s) for s in measure.strain_profiles(run.frame(0), run.frame(-1), 2, edges))
    middle = (edges[1:] + edges[:-1]) / 2.0
    exact = model.at("radial_strain", middle)
    return {
        "axial": list(axial / model.at("axial_strain", middle) - 1.0),
        "radial": list(radial / exact - 1.0 if exact_radial else radial / np.abs(exact).max()),
    }


def tip_speed_error(run: Run, from_h: float) -> list[float]:
    """The tip's way from a time on, against the closed form's at the lengths that the root had."""
    model = run.frame(-1).closed_form
    history = run.history()
    settled = history["time_h"] > from_h - 1e-9
    time, length = history["time_h"][settled], history["length_mm"][settled]
    way = theory.cumulative_integral(time, np.array([model.tip_speed(x) for x in length]))[-1]
    return [float((length[-1] - length[0]) / way - 1.0)]


def growth_errors(run: Run, from_h: float) -> Values:
    """Tip's way from a time on, and the axial rate of cells where it is over a tenth of the peak."""
    model = run.frame(-1).closed_form
    peak = float(model.axial_rate(model.grid(2.0 * float(run.history()["length_mm"][-1]))).max())
    errors = []
    for index in np.flatnonzero(run.times_h > from_h - 1e-9):
        frame = run.frame(int(index))
        exact = model.axial_rate(frame["distance_to_tip"])
        chosen = (exact > 0.1 * peak) & (frame["clamped"] == 0)
        errors.append(frame["axial_strain_rate"][chosen] / exact[chosen] - 1.0)
    return {
        "tip speed": tip_speed_error(run, from_h),
        "axial rate": [float(np.sqrt(np.mean(np.concatenate(errors) ** 2)))],
    }


def divided_lengths(
    model: theory.ClosedForm, s: np.ndarray, length: np.ndarray, hours: float
) -> tuple[np.ndarray, np.ndarray]:
    """Where cells are after `hours` that started at s (mm) with a length (mm), and how long: the closed form's flow
    carries and stretches them, and a cell longer than the threshold becomes two, half as long and half a length apart.
    """
    steps = max(1, round(hours / 0.0075))
    dt = hours / steps
    fine = np.linspace(0.0, 2.0 * float(s.max()), 8001)
    flow = model.velocity(fine)
    rate = model.axial_rate(fine)
    for _ in range(steps):
        half = s + 0.5 * dt * np.interp(s, fine, flow)
        length = length * np.exp(dt * np.interp(half, fine, rate))
        s = s + dt * np.interp(half, fine, flow)
        long = length > model.at("division_threshold", s)
        offset = np.where(long, length / 4.0, 0.0)
        s = np.concatenate([s - offset, s[long] + offset[long]])
        length = np.concatenate([np.where(long, length / 2.0, length), length[long] / 2.0])
    return s, length


def division_errors(run: Run, from_h: float) -> Values:
    """growth_errors from a time on, and the profile of cell length: means over bins of 0.2 mm and the outputs from that
    time on, against every cell of the first frame, carried, stretched and divided by the closed form. Over many
    outputs, since a layer of cells that divides a moment earlier halves the length in its bin for that moment."""
    model = run.frame(-1).closed_form
    edges = measure.edges_of(1.0, 0.2)
    first = run.frame(0)
    time_h, s, length = first.time_h, first["distance_to_tip"], first.axial_lengths(2)
    exact, found = [], []
    for index in range(1, len(run.times_h)):
        frame = run.frame(index)
        s, length = divided_lengths(model, s, length, frame.time_h - time_h)
        time_h = frame.time_h
        if time_h > from_h - 1e-9:
            exact.append(measure.binned(s, length, edges).mean)
            found.append(measure.binned(frame["distance_to_tip"], frame.axial_lengths(2), edges).mean)
    return {**growth_errors(run, from_h), "cell length": list(np.mean(found, axis=0) / np.mean(exact, axis=0) - 1.0)}


def sleep_values(run: Run, from_h: float) -> Values:
    """Tip's way from a time on against the closed form, and by how much the root had grown at each output (mm)."""
    length = run.history()["length_mm"]
    return {"tip speed": tip_speed_error(run, from_h), "growth": list(length[1:] - length[0])}


# ---- contact --------------------------------------------------------------------------------------


def thrust_errors(run: Run) -> Values:
    """The plate's force over the width where the root grows, against the arresting stress."""
    model = run.frame(-1).closed_form
    width = 2.0 * float(measure.radii(run.frame(-1), 2, np.array([0.1, 0.6]))[0])
    stress = abs(float(run.history()["contact_force_x_N"][-1])) / width
    return {"arrest stress": [stress / model.arrest_stress - 1.0]}


def path_points(run: Run) -> Values:
    """Where the tip is at the last three outputs, in diameters."""
    history = run.history()
    diameter_mm = 2.0 * run.scene["root"]["radius_mm"]
    return {"path": list(np.concatenate([history[f"tip_{a}_mm"][-3:] for a in "xy"]) / diameter_mm)}


# ---- soil -----------------------------------------------------------------------------------------


def hertz_stiffness(E_MPa: float, poisson: float, radius_mm: float, other_radius_mm: float) -> float:
    """k (N/mm^1.5) of F = k d^1.5 between two balls of one material: 4/3 E* sqrt(R), 1/E* = 2 (1 - nu^2)/E,
    1/R = 1/r1 + 1/r2 (Johnson, Contact Mechanics, eq. 4.23)."""
    reduced_mm = 1.0 / (1.0 / radius_mm + 1.0 / other_radius_mm)
    return float(4.0 / 3.0 * E_MPa / (2.0 * (1.0 - poisson**2)) * np.sqrt(reduced_mm))


def two_contacts_N(approach: np.ndarray, stiffness: tuple[float, float]) -> np.ndarray:
    """Force (N) of two Hertzian contacts in a row, F = k d^1.5 each (k in N/mm^1.5), that approach (mm) together."""
    return (np.maximum(approach, 0.0) / sum(k ** (-2.0 / 3.0) for k in stiffness)) ** 1.5


def hertz_errors(
    scene: Mapping[str, Any], columns: Columns, stiffness: tuple[float, float], touch_mm: float, edges_mm: np.ndarray
) -> list[float]:
    """Force on the probe, which presses a grain against a stone from touch_mm on, against Hertz: means over stretches
    of its way. A stretch holds the same way however often the force is read: the grain's ringing averages out alike."""
    probe = scene["penetrometer"]
    section = probe["diameter_mm"] * scene["soil"]["d_mean_mm"]
    depth = columns["depth_mm"]
    errors = []
    for start, end in zip(edges_mm, edges_mm[1:]):
        way = np.linspace(start, end, 101)
        exact = np.trapz(two_contacts_N(way - touch_mm, stiffness), way) / (end - start)
        inside = (depth > start) & (depth < end)
        errors.append(float(columns["Q_MPa"][inside].mean() * section / exact - 1.0))
    return errors


def mean_Q(scene: Mapping[str, Any], columns: Columns) -> list[float]:
    """Mean resistance behind average_from_mm over the confining pressure, a number for each sample."""
    deep = columns["depth_mm"] >= scene["penetrometer"]["average_from_mm"]
    seeds = np.unique(columns["seed"])
    pressure = scene["soil"]["confining_pressure_MPa"]
    return [float(columns["Q_MPa"][deep & (columns["seed"] == seed)].mean() / pressure) for seed in seeds]


def soil_values(run: Run, from_h: float) -> Values:
    """From a time on: growth against the closed form with the soil's forces, and the mean force on the tip (N)."""
    history = run.history()
    later = history["time_h"] > from_h - 1e-9
    time, length = history["time_h"][later], history["length_mm"][later]
    way = theory.cumulative_integral(time, history["soil_expected_tip_speed_mm_h"][later])[-1]
    return {
        "elongation": [float((length[-1] - length[0]) / way - 1.0)],
        "tip force": [float(history["soil_tip_force_N"][later].mean())],
    }
