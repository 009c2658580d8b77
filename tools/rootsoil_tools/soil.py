# SPDX-License-Identifier: MIT
"""Grains and the forces between them, as run.h5 holds them beside the cells. Lengths in mm, forces in N (2D: N/mm)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection

from rootsoil_tools.runs import Frame

GRAIN, GRAIN_EDGE, CHAIN = "#EFEAE0", "#BDB4A2", "#3B2A20"
THICKEST_MM = 1.5  # on paper, of the line that stands for `strong_force`
POINTS_PER_MM = 72.0 / 25.4


def has_grains(frame: Frame) -> bool:
    """Whether there is anything of this module to draw."""
    return "grains" in frame.tables


def extent(frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (x, y) of the box that holds all grains."""
    centre, radius = frame.tables["grains"]["position"][:, :2], frame.tables["grains"]["radius"][:, None]
    return (centre - radius).min(axis=0), (centre + radius).max(axis=0)


def force_lines(frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Contacts as lines (n, 2, 3) and their forces (n): between the centres of two grains, or from a grain's centre to
    where it touches the root, a wall or an obstacle."""
    grains, contacts = frame.tables["grains"], frame.tables["soil_contacts"]
    order = np.argsort(grains["grain_id"])
    sorted_id = grains["grain_id"][order]

    def end(ids: np.ndarray) -> np.ndarray:
        row = order[np.clip(np.searchsorted(sorted_id, ids), 0, len(order) - 1)]
        return np.where((ids >= 0)[:, None], grains["position"][row], contacts["position"])

    lines = np.stack([end(contacts["first_id"]), end(contacts["second_id"])], axis=1)
    return lines, np.linalg.norm(contacts["force"], axis=1)


def strong_force(frame: Frame) -> float:
    """A force that only a few contacts exceed, to a round number."""
    force = np.linalg.norm(frame.tables["soil_contacts"]["force"], axis=1)
    if not force.size or not force.max() > 0.0:
        return 1.0
    raw = np.percentile(force[force > 0.0], 98)
    power = 10.0 ** np.floor(np.log10(raw))
    return float(max(m for m in (1.0, 2.0, 5.0) if m <= raw / power * (1.0 + 1e-9)) * power)


def rigid_shape(obstacle: dict) -> dict:
    """A [[soil.obstacle]] as draw.draw_obstacles takes bodies."""
    if obstacle["shape"] == "plate":
        half = [obstacle["length_mm"] / 2.0, obstacle["thickness_mm"] / 2.0]
        return {**obstacle, "shape": "box", "half_size_mm": half}
    return obstacle


def draw_grains(axes: Axes, frame: Frame, dimension: int, offset: Sequence[float] = (0.0, 0.0)) -> None:
    """Grains as discs; in 3D those that the plane z = 0 cuts, as large as the cut."""
    centre, radius = frame.tables["grains"]["position"], frame.tables["grains"]["radius"]
    if dimension == 3:
        cut = np.abs(centre[:, 2]) < radius
        centre, radius = centre[cut], np.sqrt(radius[cut] ** 2 - centre[cut, 2] ** 2)
    axes.add_collection(
        EllipseCollection(
            2.0 * radius,
            2.0 * radius,
            np.zeros_like(radius),
            units="xy",
            offsets=centre[:, :2] + offset,
            transOffset=axes.transData,
            facecolors=GRAIN,
            edgecolors=GRAIN_EDGE,
            linewidths=0.35,
            zorder=0.6,
        )
    )


def draw_force_chains(
    axes: Axes, frame: Frame, dimension: int, strong: float, offset: Sequence[float] = (0.0, 0.0)
) -> None:
    """Contacts as lines whose width is proportional to the force; in 3D those near the plane z = 0."""
    lines, force = force_lines(frame)
    shown = force > 0.02 * strong
    if dimension == 3:
        shown &= np.abs(lines[:, :, 2]).max(axis=1) < 1.5 * frame.tables["grains"]["radius"].mean()
    axes.add_collection(
        LineCollection(
            lines[shown][:, :, :2] + offset,
            linewidths=THICKEST_MM * POINTS_PER_MM * np.minimum(force[shown] / strong, 1.5),
            colors=CHAIN,
            capstyle="round",
            zorder=0.8,
        )
    )
