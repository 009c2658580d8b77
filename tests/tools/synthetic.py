# SPDX-License-Identifier: MIT
"""Run folders made without the solver: cells that move as a closed form of this file says.

Lengths in mm, times in h.
"""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np

from rootsoil_tools.theory import ClosedForm, cumulative_integral

SCENE = """
[scene]
name = "{name}"
dimension = {dimension}
duration_h = {duration}
[root]
length_mm = {length}
radius_mm = {radius}
cell_size_mm = {cell}
[tissue]
E_axial_MPa = 1020.0
nu_axial = 0.06
nu_radial = 0.3
rho0_ug_mm3 = 1000.0
[tissue.anisotropy]
E_radial_max_MPa = 15000.0
x_e_mm = 0.51
s_e_per_mm = 6.0
c_e = 0.2
[pressure]
table = [[0.0, {pressure}]]
{more}
"""
GROWTH = """
[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.37
c_g = -1.0
mature_at_mm = 1.3
mature_width_mm = 0.4
"""


def closed_form(dimension: int, length: float, pressure: float, grows: bool = True) -> ClosedForm:
    """Strains as in Eq. 8 with E_R = 10 E_A away from the tip; a bell of growth, and some of it widens the tip."""
    s = np.linspace(0.0, length, 4001)
    one = np.ones_like(s)
    radial_modulus = 1020.0 * (1.0 + 9.0 * s / (s + 0.1))
    transverse = 1.0 if dimension == 2 else 0.7
    columns = {
        "distance_to_tip": s,
        "pressure_differential": pressure * one,
        "arrest_stress": pressure * (1.0 - 0.06 * (dimension - 1)) * one,
        "radial_modulus": radial_modulus,
        "axial_strain": pressure * (1.0 - 0.06 * (dimension - 1)) / 1020.0 * one,
        "radial_strain": pressure * (transverse / radial_modulus - 0.06 / 1020.0),
    }
    if grows:
        rate = 0.4 * pressure * np.exp(-(((s - 0.32) / 0.3) ** 2))
        radial = 0.1 * rate * np.exp(-s / 0.3)
        speed = cumulative_integral(s, rate)
        slope = np.where(s > 0.2, radial / np.maximum(speed, 1e-9), 0.0)
        columns |= {
            "softening": 1e6 * rate,
            "axial_strain_rate": rate,
            "radial_strain_rate": radial,
            "speed_from_tip": speed,
            "relative_radius": np.exp(cumulative_integral(s, slope)),
        }
    return ClosedForm(columns)


def write_frame(
    file: h5py.File, number: int, time_h: float, columns: dict[str, tuple[np.ndarray, str]], exact: ClosedForm
) -> None:
    """One frame in the layout of run.h5."""
    group = file.create_group(f"frames/{number:06d}")
    group.attrs.update(time_h=time_h, step=number, cells=len(columns["position"][0]))
    for name, (values, unit) in columns.items():
        group.create_dataset(name, data=values).attrs["unit"] = unit
    for name, values in exact.columns.items():
        group.create_dataset(f"closed_form/{name}", data=values)


def columns_of(s, position, along, across, rate, volume, generation, label) -> dict[str, tuple[np.ndarray, str]]:
    """A frame's fields out of distance, position, the two lengths, rate, volume, generation and id of each cell."""
    n = len(s)
    axes = np.sort(np.stack([along, across, across], axis=1), axis=1)[:, ::-1]
    zero = np.zeros(n)
    shape = np.stack([4.0 / along**2, 4.0 / across**2, 4.0 / across**2, zero, zero, zero], axis=1)
    return {
        "position": (position, "mm"),
        "volume": (volume, "mm^3"),
        "axial_strain_rate": (rate, "1/h"),
        "distance_to_tip": (s, "mm"),
        "axis": (np.tile([1.0, 0.0, 0.0], (n, 1)), "1"),
        "cell_axes": (axes, "mm"),
        "shape": (shape, "1/mm^2"),
        "generation": (generation, "1"),
        "cell_id": (label, "1"),
        "parent_id": (np.full(n, -1), "1"),
    }


def lattice(dimension: int, length: float, radius: float, cell: float) -> np.ndarray:
    """Centres of a capsule lattice, base at x = 0, tip at x = length (mm)."""
    across = np.arange(-radius + cell / 2.0, radius, cell)
    grids = np.meshgrid(np.arange(cell / 2.0, length, cell), *[across] * (dimension - 1), indexing="ij")
    points = np.stack([g.ravel() for g in grids], axis=1)
    beyond = np.maximum(points[:, 0] - (length - radius), 0.0)
    points = points[beyond**2 + np.sum(points[:, 1:] ** 2, axis=1) < radius**2]
    return np.pad(points, ((0, 0), (0, 3 - dimension)))


def make_growing_run(
    folder: Path,
    name: str = "synthetic_arabidopsis",
    dimension: int = 2,
    duration: float = 12.0,
    length: float = 1.5,
    radius: float = 0.07,
    cell: float = 0.014,
    frames: int = 13,
    pressure: float = 1.0,
    more: str = "",
) -> Path:
    """Makes the folder of a run in which cells follow the closed form and divide at 1.5 cell sizes."""
    folder.mkdir(parents=True)
    text = SCENE.format(
        name=name,
        dimension=dimension,
        duration=duration,
        length=length,
        radius=radius,
        cell=cell,
        pressure=pressure,
        more=GROWTH + more,
    )
    (folder / "scene.toml").write_text(text)
    model = closed_form(dimension, length + 0.5 * duration, pressure)
    random = np.random.default_rng(1)
    centre = lattice(dimension, length, radius, cell)
    s, y = length - centre[:, 0], centre[:, 1:].copy()
    along, across = np.full(len(s), cell), np.full(len(s), cell)
    generation, label = np.zeros(len(s), dtype=int), np.arange(len(s))
    limit = cell * random.uniform(1.4, 1.6, len(s))
    step = 0.05
    grid = np.linspace(0.0, length + duration * 0.5, 4000)
    speed = model.velocity(grid)
    time, next_frame, rows = 0.0, 0, []
    with h5py.File(folder / "run.h5", "w") as file:
        file.attrs["dimension"] = str(dimension)
        while next_frame < frames:
            if time >= next_frame * duration / (frames - 1) - 1e-9:
                volume = along * across ** (dimension - 1)
                position = np.column_stack([s.max() + cell / 2.0 - s, y])
                rate = model.axial_rate(s) * random.normal(1.0, 0.03, len(s))
                columns = columns_of(s, position, along, across, rate, volume, generation, label)
                write_frame(file, next_frame, time, columns, model)
                rows.append((time, len(s), s.max() + cell / 2.0, model.tip_speed(s.max())))
                next_frame += 1
            a, r = model.axial_rate(s), model.at("radial_strain_rate", s)
            s = s + step * np.interp(s, grid, speed)
            s -= (s - along / 2.0).min()
            y *= np.exp(step * r)[:, None]
            along, across = along * np.exp(step * a), across * np.exp(step * r)
            ready = (along > limit * (1.0 + 60.0 * (s - 0.12) ** 2 * (s > 0.12))) & (s < 0.7)
            shift = along[ready] / 4.0
            along[ready] /= 2.0
            generation[ready] += 1
            daughters = s[ready] + shift
            s[ready] -= shift
            s = np.concatenate([s, daughters])
            y, along, across, generation, limit = (
                np.concatenate([v, v[ready]]) for v in (y, along, across, generation, limit)
            )
            label = np.arange(len(s))
            time += step
    lines = ["time_h,cells,length_mm,tip_speed_mm_h"] + [",".join(map(str, row)) for row in rows]
    (folder / "history.csv").write_text("\n".join(lines) + "\n")
    (folder / "summary.json").write_text(json.dumps({"status": "done", "time_h": duration}))
    return folder


def make_strained_run(
    folder: Path, dimension: int = 2, length: float = 2.0, radius: float = 0.3, cell: float = 0.05
) -> Path:
    """Makes the folder of a run without growth whose cells have moved as Eq. 8 says."""
    folder.mkdir(parents=True)
    text = SCENE.format(
        name="strained",
        dimension=dimension,
        duration=8.0,
        length=length,
        radius=radius,
        cell=cell,
        pressure=1.0,
        more="",
    )
    (folder / "scene.toml").write_text(text)
    model = closed_form(dimension, length, 1.0, grows=False)
    before = lattice(dimension, length, radius, cell)
    s = length - before[:, 0]
    after = before.copy()
    after[:, 0] *= np.exp(model.at("axial_strain", 0.0))
    after[:, 1:] *= np.exp(model.at("radial_strain", s))[:, None]
    size = np.full(len(s), cell)
    with h5py.File(folder / "run.h5", "w") as file:
        for number, position in enumerate((before, after)):
            zero = np.zeros(len(s), dtype=int)
            columns = columns_of(s, position, size, size, 0.0 * s, size**dimension, zero, np.arange(len(s)))
            write_frame(file, number, 8.0 * number, columns, model)
    return folder
