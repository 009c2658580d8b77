# SPDX-License-Identifier: MIT
"""Drawing: the figures' common style, cells as ellipses, obstacles, bands. Paper sizes in mm, root sizes in mm."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Polygon, Rectangle

from rootsoil_tools.measure import Profile
from rootsoil_tools.runs import Frame

matplotlib.use("Agg")

# Okabe & Ito's colours, which colour-blind readers tell apart.
SIMULATION = "#0072B2"
THEORY = "#222222"
DATA = "#D55E00"
WARNING = "#c00000"
OBSTACLE = "#B8B8B8"
# Blue to red, all dark enough to be seen on white; differ in lightness as well.
DIVISIONS = ["#313695", "#4F93C9", "#8FCBD9", "#F5C55A", "#F08243", "#B2182B"]
DOTS_PER_INCH = 300
THEORY_LINE = {"color": THEORY, "linestyle": (0, (4, 2)), "linewidth": 1.0}


def use_style() -> None:
    """Small sans-serif type, thin lines; text stays text in PDF and SVG."""
    plt.rcParams.update(
        {
            "font.family": "sans-serif",
            "font.size": 7.5,
            "axes.labelsize": 7.5,
            "axes.titlesize": 7.5,
            "xtick.labelsize": 7,
            "ytick.labelsize": 7,
            "legend.fontsize": 7,
            "axes.linewidth": 0.6,
            "xtick.major.width": 0.6,
            "ytick.major.width": 0.6,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "pdf.fonttype": 42,
            "svg.fonttype": "none",
        }
    )


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, mm."""
    return plt.figure(figsize=(width / 25.4, height / 25.4), dpi=DOTS_PER_INCH)


def place(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes at a place of the paper, mm from its lower left corner."""
    paper = figure.get_size_inches() * 25.4
    return figure.add_axes([left / paper[0], bottom / paper[1], width / paper[0], height / paper[1]])


def letter(figure: Figure, left: float, bottom: float, text: str) -> None:
    """A panel's bold letter, mm."""
    paper = figure.get_size_inches() * 25.4
    figure.text(left / paper[0], bottom / paper[1], text, weight="bold", size=10, va="bottom", ha="left")


def division_colours(most: int) -> ListedColormap:
    """One colour for each number of divisions from 0 (blue) to `most` (red), as the paper's Fig. 4A."""
    scale = LinearSegmentedColormap.from_list("divisions", DIVISIONS)
    return ListedColormap(scale(np.linspace(0.0, 1.0, max(most + 1, 2)))[: most + 1])


def cell_ellipses(frame: Frame, dimension: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centres (n, 2), semi-axes (n, 2; mm) and unit directions of the first (n, 2) of the cells in the x-y plane.

    Without the field `shape`, the longest axis lies along the cell's root axis.
    """
    shape = frame.shape_matrices(dimension)
    if shape is None:
        direction = frame["axis"][:, :2] / np.linalg.norm(frame["axis"][:, :2], axis=1, keepdims=True)
        return frame["position"][:, :2], frame["cell_axes"][:, :2] / 2.0, direction
    eigenvalues, vectors = np.linalg.eigh(shape[:, :2, :2])
    return frame["position"][:, :2], 1.0 / np.sqrt(eigenvalues), vectors[:, :, 0]


def reach_in_z(frame: Frame) -> np.ndarray:
    """Half the height of each cell of a 3D run in z (n; mm)."""
    shape = frame.shape_matrices(3)
    if shape is None:
        return frame["cell_axes"][:, 1:].mean(axis=1) / 2.0
    return np.sqrt(np.linalg.inv(shape)[:, 2, 2])


def middle_plane(frame: Frame) -> float:
    """z (mm) of a plane near the root's middle; a little off it, where on a lattice two layers of cells can meet."""
    return float(frame["position"][:, 2].mean() + 0.3 * np.median(reach_in_z(frame)))


def in_middle_plane(frame: Frame, dimension: int) -> np.ndarray:
    """Which cells to draw: all in 2D; in 3D those that the middle plane cuts."""
    if dimension == 2:
        return np.ones(frame.cells, dtype=bool)
    return np.abs(frame["position"][:, 2] - middle_plane(frame)) < reach_in_z(frame)


def draw_cells(
    axes: Axes,
    frame: Frame,
    dimension: int,
    colours: ListedColormap,
    offset: Sequence[float] = (0.0, 0.0),
    chosen: np.ndarray | None = None,
    edge_mm: float = 0.0,
) -> None:
    """Cells as their ellipses, coloured by number of divisions, moved by `offset`; edges of a width on paper (mm)."""
    shown = in_middle_plane(frame, dimension)
    if chosen is not None:
        shown &= chosen
    centre, semi_axes, direction = (part[shown] for part in cell_ellipses(frame, dimension))
    angle = np.linspace(0.0, 2.0 * np.pi, 24 if edge_mm else 12, endpoint=False)
    along = semi_axes[:, :1] * np.cos(angle)
    across = semi_axes[:, 1:] * np.sin(angle)
    normal = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    outline = (
        (centre + offset)[:, None, :]
        + along[:, :, None] * direction[:, None, :]
        + across[:, :, None] * normal[:, None, :]
    )
    faces = colours(frame["generation"][shown].astype(int))
    cells = PolyCollection(
        outline,
        facecolors=faces,
        edgecolors="#303030" if edge_mm else faces,
        linewidths=edge_mm * 72.0 / 25.4 if edge_mm else 0.15,
        rasterized=True,
    )
    axes.add_collection(cells, autolim=False)


def draw_obstacles(axes: Axes, obstacles: list[dict], box: tuple[float, ...], offset: tuple[float, float]) -> None:
    """The scene's obstacles in grey, cut off at `box` (x0, y0, x1, y1; mm, before the offset); 3D: in the plane."""
    x0, y0, x1, y1 = box
    reach = 2.0 * np.hypot(x1 - x0, y1 - y0)
    for obstacle in obstacles:
        position = np.array(obstacle["position_mm"][:2], dtype=float)
        if obstacle["shape"] == "plane":
            normal = np.array(obstacle["normal"][:2], dtype=float)
            normal /= max(np.hypot(*normal), 1e-12)
            middle = np.array([(x0 + x1) / 2.0, (y0 + y1) / 2.0])
            foot = middle - ((middle - position) @ normal) * normal
            along = np.array([-normal[1], normal[0]])
            corners = [
                foot + reach * along,
                foot - reach * along,
                foot - reach * (along + normal),
                foot + reach * (along - normal),
            ]
        elif obstacle["shape"] == "box":
            half = np.array(obstacle["half_size_mm"][:2], dtype=float)
            angle = np.deg2rad(obstacle.get("angle_deg", 0.0))
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            corners = [position + turn @ (half * sign) for sign in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        else:
            corners = []
        if corners:
            patch: Patch = Polygon(np.array(corners) + offset)
        else:
            patch = Circle(position + offset, obstacle["radius_mm"])
        patch.set(facecolor=OBSTACLE, edgecolor="#6A6A6A", linewidth=0.4, zorder=0.5)
        axes.add_patch(patch)
        patch.set_clip_path(Rectangle((x0 + offset[0], y0 + offset[1]), x1 - x0, y1 - y0, transform=axes.transData))


def scale_bar(figure: Figure, right: float, bottom: float, scale: float, microns: bool = False) -> None:
    """A bar of a round length of at most 20 mm of paper, its length left of it; `scale` is mm of paper per mm."""
    raw = 20.0 / scale
    power = 10.0 ** np.floor(np.log10(raw))
    bar = max(m for m in (1.0, 2.0, 5.0) if m * power <= raw) * power
    axes = place(figure, right - bar * scale, bottom, bar * scale, 0.7)
    axes.axis("off")
    axes.axhspan(0.0, 1.0, color="black", linewidth=0)
    paper = figure.get_size_inches() * 25.4
    left = (right - bar * scale - 1.2) / paper[0]
    label = f"{1e3 * bar:g} µm" if microns else f"{bar:g} mm"
    figure.text(left, (bottom + 0.35) / paper[1], label, ha="right", va="center_baseline", size=7)


def draw_profile(axes: Axes, profile: Profile) -> None:
    """A mean with its band where there is one; empty bins are bridged. Both are labelled, for a legend."""
    filled = np.isfinite(profile.mean)
    s, mean, low, high = (part[filled] for part in (profile.s_mm, profile.mean, profile.low, profile.high))
    axes.plot(s, mean, color=SIMULATION, linewidth=1.3, label="simulation")
    if np.any(high - low > 0.01 * np.max(np.abs(mean), initial=0.0)):  # thinner ones hide behind the line
        axes.fill_between(s, low, high, color=SIMULATION, alpha=0.22, linewidth=0, label="16–84 %")
