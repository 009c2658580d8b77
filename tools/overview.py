#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws overview.png of a run, finished or still going on.

A: the root at several times, each cell as its ellipse, coloured by its number of divisions (as the paper's Fig. 4A);
in 3D the cells that the middle plane cuts. Below it the tip at the last time, where A is too small to see cells.
B-D, over the distance from the tip, means of the last hours with the closed form drawn in: axial strain rate (1/h),
cell length (um), radius (mm). In a scene without growth: axial and radial strain against Eq. 8, and radius. Where a
growing root meets obstacles: contact force (N, in 2D N/mm) and deflection over time, and axial strain rate.
In a soil of grains, A is the root among them at the last time, with a line at every contact, as thick as its force;
B-D are the soil's force on the root, the tip's speed with the one that these forces allow, and the axial strain rate.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from rootsoil_tools import draw, kinematics, measure, published, soil
from rootsoil_tools.runs import Frame, Run, RunError, read_summary
from rootsoil_tools.theory import ClosedForm

PAGE_WIDTH = 180.0  # mm of paper, as everything in capitals here
MARGIN = 4.0
HEADER = 10.0
STACK_MAX_HEIGHT = 95.0
ROW_GAP = 2.5
LABEL_WIDTH = 10.0
TICKS_WIDTH = 13.0  # of a panel's tick labels and axis label
ZOOM_MAX_HEIGHT = 34.0
SOIL_MAX_HEIGHT = 110.0
SPEED_OVER_H = 0.5  # the soil yields in jerks
PROFILE_HEIGHT = 40.0
PANEL_GAP = 16.0
LONG_TICKS = 3.0  # more for those of a small deflection
RIGHT_AXIS_WIDTH = 11.0  # of tick labels and label of an axis on the right
TIMES = 6
DEFLECTION_SEEN = 0.1  # of a cell's length: less looks like none
DISTANCE = "distance from the tip (mm)"


def percent(number: float) -> str:
    """Three digits, and never a power of ten."""
    if abs(number) < 1e-3:
        return "below 0.001 %"
    return f"{number:.3g} %" if number < 1000.0 else f"{number:.0f} %"


class Stack:
    """The root at several times on one panel: where each goes, and at which scale."""

    def __init__(self, run: Run):
        times = TIMES if "growth" in run.scene else 2  # elastic strains are too small to see
        wanted = np.linspace(run.times_h[0], run.times_h[-1], times)
        indices = sorted({int(np.argmin(np.abs(run.times_h - time))) for time in wanted})
        self.run = run
        self.frames = [run.frame(index) for index in indices]
        shown = [f["position"][self._of_interest(f), :2] for f in self.frames]
        low = np.min([x.min(axis=0) for x in shown], axis=0)
        high = np.max([x.max(axis=0) for x in shown], axis=0)
        edge = max(float(f["cell_axes"][:, 0].max()) for f in self.frames) / 2.0
        pad = 0.08 * float(np.max(high - low)) if run.scene.get("obstacle") else 0.0  # to show what the root meets
        self.low, self.high = low - edge - [0.0, pad], high + edge + pad
        self._arrange()

    def _of_interest(self, frame: Frame) -> np.ndarray:
        """Which cells must be in view: all; where the root meets obstacles, those within the growth zone."""
        distance = frame["distance_to_tip"]
        if not self.run.scene.get("obstacle"):
            return np.ones_like(distance, dtype=bool)
        model = frame.closed_form
        return distance < (model.growth_zone(float(distance.max())) if model.grows else np.inf)

    def _arrange(self) -> None:
        """As many columns as leave the roots nearly as large on the paper as they can be."""
        width, height = self.high - self.low
        n = len(self.frames)

        def scale(columns: int) -> float:
            rows = -(-n // columns)
            across = (PAGE_WIDTH - 2.0 * MARGIN) / columns - LABEL_WIDTH
            down = STACK_MAX_HEIGHT / rows - ROW_GAP
            return min(across / width, down / height)

        best = max(scale(columns) for columns in (1, 2, 3))
        self.columns = max(columns for columns in (1, 2, 3) if columns <= n and scale(columns) > 0.75 * best)
        self.scale = scale(self.columns)  # mm of paper per mm of root
        self.rows = -(-n // self.columns)
        self.row_height = max(height * self.scale, 2.5) + ROW_GAP
        self.height = self.rows * self.row_height

    def draw(self, axes: Axes, colours: Colormap) -> None:
        """Into axes whose unit is 1 mm of root and whose origin is the panel's upper left corner."""
        paper = 1.0 / self.scale
        width = (PAGE_WIDTH - 2.0 * MARGIN) * paper
        axes.set(xlim=(0.0, width), ylim=(-self.height * paper, 0.0))
        axes.axis("off")
        last_offset = (0.0, 0.0)
        for number, frame in enumerate(self.frames):
            row, column = divmod(number, self.columns)
            middle = -(row + 0.5) * self.row_height * paper
            left = column * width / self.columns + LABEL_WIDTH * paper
            offset = (left - self.low[0], middle - (self.low[1] + self.high[1]) / 2.0)
            cell_mm = float(np.median(frame["cell_axes"][:, 1])) * self.scale
            draw.draw_obstacles(axes, self.run.scene.get("obstacle", []), (*self.low, *self.high), offset)
            inside = np.all((frame["position"][:, :2] > self.low) & (frame["position"][:, :2] < self.high), axis=1)
            edge_mm = 0.04 * cell_mm * (cell_mm > 0.7)
            draw.draw_cells(axes, frame, self.run.dimension, colours, offset, chosen=inside, edge_mm=edge_mm)
            axes.text(left - 1.5 * paper, middle, f"{frame.time_h:.3g} h", ha="right", va="center")
            last_offset = offset
        self.last_offset = last_offset


class SoilView:
    """The root among grains at the last time, in place of a Stack."""

    def __init__(self, run: Run, frame: Frame):
        self.run, self.frames = run, [frame]
        low, high = soil.extent(frame)
        position = frame["position"][:, :2]
        half = float(frame["cell_axes"][:, 0].max()) / 2.0
        self.low, self.high = np.minimum(low, position.min(axis=0) - half), np.maximum(
            high, position.max(axis=0) + half
        )
        width, height = self.high - self.low
        self.scale = min((PAGE_WIDTH - 2.0 * MARGIN) / width, SOIL_MAX_HEIGHT / height)
        self.height = height * self.scale
        self.strong = soil.strong_force(frame)

    def draw(self, axes: Axes, colours: Colormap) -> None:
        """Into axes whose unit is 1 mm of root and whose origin is the panel's upper left corner."""
        frame, paper = self.frames[0], 1.0 / self.scale
        axes.set(xlim=(0.0, (PAGE_WIDTH - 2.0 * MARGIN) * paper), ylim=(-self.height * paper, 0.0))
        axes.axis("off")
        middle = 0.5 * (PAGE_WIDTH - 2.0 * MARGIN) * paper
        offset = (middle - 0.5 * (self.low[0] + self.high[0]), -self.high[1])
        bodies = [o for o in self.run.scene["soil"].get("obstacle", []) if o["shape"] in ("box", "plate", "stone")]
        soil.draw_grains(axes, frame, self.run.dimension, offset)
        draw.draw_obstacles(axes, [soil.rigid_shape(o) for o in bodies], (*self.low, *self.high), offset)
        soil.draw_force_chains(axes, frame, self.run.dimension, self.strong, offset)
        draw.draw_cells(axes, frame, self.run.dimension, colours, offset, edge_mm=0.06)


class Zoom:
    """The tip at the last time, drawn large."""

    def __init__(self, run: Run, frame: Frame):
        self.run, self.frame = run, frame
        length = float(frame["distance_to_tip"].max())
        radius = float(np.max(measure.radii(frame, run.dimension, np.linspace(0.0, length, 21))))
        width_paper = PAGE_WIDTH - 2.0 * MARGIN - LABEL_WIDTH
        reach = 2.0 * radius * width_paper / (0.8 * ZOOM_MAX_HEIGHT)
        from_tip = frame["distance_to_tip"] - frame["distance_to_tip"].min()
        self.near = from_tip < 1.2 * reach
        tip = frame["position"][from_tip < reach, :2]
        half_cell = np.median(frame["cell_axes"][self.near, 0])
        self.low, self.high = tip.min(axis=0), tip.max(axis=0) + half_cell
        self.low[1] -= half_cell
        size = self.high - self.low
        self.scale = min(width_paper / size[0], ZOOM_MAX_HEIGHT / size[1])
        self.height = size[1] * self.scale

    def draw(self, axes: Axes, colours: Colormap) -> None:
        """Into axes that are exactly as large as the zoomed box."""
        axes.set(xlim=(self.low[0], self.high[0]), ylim=(self.low[1], self.high[1]))
        axes.set(xticks=[], yticks=[])
        plt.setp(list(axes.spines.values()), visible=True, linewidth=0.5, color="#606060")
        draw.draw_obstacles(axes, self.run.scene.get("obstacle", []), (*self.low, *self.high), (0.0, 0.0))
        draw.draw_cells(axes, self.frame, self.run.dimension, colours, chosen=self.near, edge_mm=0.06)


def draw_growth(run: Run, model: ClosedForm, panels: list) -> list[str]:
    """Axial strain rate, cell length and radius with theory and data; returns lines to print."""
    last = run.frame(-1)
    lengths = [float(run.frame(index)["distance_to_tip"].max()) for index in run.window(measure.WINDOW_H)]
    length = lengths[-1]
    zone = model.growth_zone(length)
    end = min(1.6 * zone, *lengths)  # further back not every frame has tissue
    edges = measure.edges_of(end, measure.bin_width(last, run.dimension, min(zone, end)))
    profiles = measure.growth_profiles(run, edges)
    s = np.linspace(0.0, end, 600)
    said, steady_in = [], []

    draw.draw_profile(panels[0], profiles["axial_strain_rate"])
    (closed_form,) = panels[0].plot(s, model.axial_rate(s), **draw.THEORY_LINE)
    panels[0].set_ylabel("axial strain rate (1/h)")
    rate = profiles["axial_strain_rate"]
    peak = model.axial_rate(s).max()
    said.append(f"peak axial strain rate {np.nanmax(rate.mean):.4g} /h (closed form {peak:.4g} /h)")
    tip_speed = np.mean([model.tip_speed(at) for at in lengths])
    measured_speed = measure.tip_speed(run)
    if np.isfinite(measured_speed):
        said.append(f"tip speed {measured_speed:.4g} mm/h (closed form {tip_speed:.4g} mm/h)")

    draw.draw_profile(panels[1], profiles["cell_length"])
    panels[1].set_ylabel("cell length (µm)")
    if "cell_length" in model.columns:
        # of tissue that has come from where cells divide, and has divided once, since the start
        hours = float(run.times_h[-1])
        renewed = (s <= model.carried_to(0.25 * zone, hours, length)) & (model.stretch(s, hours, length) > 2.0)
        if np.count_nonzero(renewed) > 1:
            panels[1].plot(s[renewed], 1e3 * model.at("cell_length", s[renewed]), **draw.THEORY_LINE)
            steady_in.append("C")
    if "arabidopsis" in run.name.lower():
        dots = {"color": draw.DATA, "markersize": 2.6, "markeredgewidth": 0, "label": published.SOURCE}
        start_h, end_h = kinematics.span_h(run)
        for panel, quantity in zip(panels, ("axial_strain_rate", "cell_length")):
            panel.plot(*kinematics.published_curve(quantity), "o", **dots)
            r2 = kinematics.fit_to_published(run, quantity).r2
            if np.isfinite(r2):
                panel.set_title(f"$R^2$ = {r2:.3f}, {start_h:.3g}–{end_h:.3g} h", loc="right")
                over = f"mean of {start_h:.3g} to {end_h:.3g} h"
                said.append(f"{quantity.replace('_', ' ')}, {published.SOURCE}: R^2 = {r2:.4f} ({over})")
    draw.draw_profile(panels[2], profiles["radius"])
    start = min(int(np.searchsorted(edges, 0.25 * zone)), len(edges) - 2)
    s_start, r_start = profiles["radius"].s_mm[start], profiles["radius"].mean[start]
    steady = s[(s >= s_start) & (s <= model.carried_to(s_start, float(run.times_h[-1]), length))]
    if steady.size > 1 and zone < length:  # tissue that never stops growing has no steady state
        panels[2].plot(steady, model.radius(steady, s_start, r_start), **draw.THEORY_LINE)
        steady_in.append("D")
    closed_form.set_label("closed form" + (f" ({', '.join(steady_in)}: steady growth)" if steady_in else ""))
    panels[2].set_ylabel("radius (mm)")
    mature = measure.mature_radius(model, run)
    if np.isfinite(mature):
        drift = 1e3 * measure.radius_drift(model, run)
        changing = f", changing by {drift:.2f} % in 10 h" if np.isfinite(drift) else ""
        said.append(f"mature radius {mature:.4g} mm{changing}")
    for panel in panels:
        panel.set_xlim(0.0, end)
    return said


def draw_contact(run: Run, model: ClosedForm, panels: list) -> list[str]:
    """Contact force and deflection over time, axial strain rate with theory; returns lines to print."""
    history = run.history()
    time, force = history["time_h"], history["contact_force_N"]
    unit = "N" if run.dimension == 3 else "N/mm"
    # over decades: what it takes to deflect the root is far below what would arrest it
    arresting = measure.arresting_force(model, run)
    panels[0].semilogy(time, np.maximum(force, 1e-6 * arresting), color=draw.SIMULATION, linewidth=1.0)
    panels[0].set_ylim(1e-4 * arresting, 2.0 * max(arresting, force.max()))
    panels[0].axhline(arresting, **draw.THEORY_LINE)
    panels[0].text(0.98 * time[-1], 0.9 * arresting, "arrests the root", ha="right", va="top", size=7)
    panels[0].set_ylabel(f"contact force ({unit})")

    lateral = np.hypot(*(history[f"tip_{axis}_mm"] - history[f"tip_{axis}_mm"][0] for axis in "yz"))
    angle = np.degrees([measure.tip_angle(run.frame(index), run.dimension) for index in range(len(run.times_h))])
    panels[1].plot(time, lateral, color=draw.SIMULATION, linewidth=1.3)
    cell = float(np.median(run.frame(0)["cell_axes"][:, 0]))
    panels[1].set_ylim(0.0, 1.05 * max(float(lateral.max()), DEFLECTION_SEEN * cell))
    panels[1].locator_params(axis="y", nbins=6)
    panels[1].set_ylabel("deflection of the tip (mm)", color=draw.SIMULATION)
    twin = panels[1].twinx()
    twin.plot(run.times_h, angle, color=draw.DATA, linewidth=1.3)
    twin.set_ylabel("angle of the tip (°)", color=draw.DATA)
    twin.set_ylim(0.0, max(1.1 * float(np.max(angle)), 1.0))
    twin.spines["right"].set_visible(True)

    length = float(run.frame(-1)["distance_to_tip"].max())
    zone = model.growth_zone(length)
    edges = measure.edges_of(min(1.2 * zone, length), measure.bin_width(run.frame(-1), run.dimension, zone))
    s = np.linspace(0.0, edges[-1], 600)
    draw.draw_profile(panels[2], measure.growth_profiles(run, edges)["axial_strain_rate"])
    panels[2].plot(s, model.axial_rate(s), **draw.THEORY_LINE, label="closed form")
    panels[2].set_ylabel("axial strain rate (1/h)")
    for panel, end, label in zip(panels, (time[-1], time[-1], s[-1]), ("time (h)", "time (h)", DISTANCE)):
        panel.set_xlim(0.0, end)
        panel.set_xlabel(label)
    touching = np.flatnonzero(force > 0.0)
    first = f"contact from {time[touching[0]]:.3g} h" if touching.size else "no contact"
    return [
        f"{first}, largest force {force.max():.3g} {unit}, at the end {force[-1]:.3g} {unit} "
        f"(arresting force {arresting:.3g} {unit})",
        f"deflection at the end {lateral[-1]:.3g} mm, angle of the tip {angle[-1]:.3g} degrees",
    ]


def draw_soil(run: Run, model: ClosedForm, panels: list) -> list[str]:
    """The soil's force on the root, the tip's speed with what these forces allow, axial strain rate; returns lines."""
    history = run.history()
    time, unit = history["time_h"], "N" if run.dimension == 3 else "N/mm"
    arresting = measure.arresting_force(model, run)
    whole, tip = (
        panels[0].plot(time, history[f"soil_{name}_force_N"], color=colour, linewidth=1.0)[0]
        for name, colour in (("axial", draw.DATA), ("tip", draw.SIMULATION))
    )
    panels[0].axhline(arresting, **draw.THEORY_LINE)
    panels[0].text(time[-1], 1.02 * arresting, "arrests the root", ha="right", va="bottom", size=7)
    panels[0].set_ylim(0.0, 1.5 * max(arresting, history["soil_axial_force_N"].max()))
    panels[0].set_ylabel(f"axial force of the soil ({unit})")
    names = {"handles": [whole, tip], "labels": ["whole root", "tip"]}
    panels[0].legend(**names, frameon=False, loc="upper left", handlelength=1.4, borderpad=0.0)  # above that force

    over = (
        max(SPEED_OVER_H, 2.0 * float(np.median(np.diff(time)))) if len(time) > 1 else SPEED_OVER_H
    )  # at least three rows
    speed = measure.running_slope(time, history["length_mm"], over)
    allowed = measure.running_mean(time, history["soil_expected_tip_speed_mm_h"], over)
    free = float(np.mean([model.tip_speed(length) for length in history["length_mm"]]))
    panels[1].plot(time, speed, color=draw.SIMULATION, linewidth=1.0)
    panels[1].plot(time, allowed, **draw.THEORY_LINE, label="closed form with these forces")
    panels[1].set_ylabel("speed of the tip (mm/h)")
    panels[1].set_ylim(0.0, 1.2 * max(free, speed.max()))
    panels[1].axhline(free, color=draw.THEORY, linewidth=0.6, linestyle=":")
    panels[1].text(time[-1], 1.02 * free, "without soil", ha="right", va="bottom", size=7)

    length = float(run.frame(-1)["distance_to_tip"].max())
    zone = model.growth_zone(length)
    edges = measure.edges_of(min(1.2 * zone, length), measure.bin_width(run.frame(-1), run.dimension, zone))
    s = np.linspace(0.0, edges[-1], 600)
    draw.draw_profile(panels[2], measure.growth_profiles(run, edges)["axial_strain_rate"])
    panels[2].plot(s, model.axial_rate(s), color=draw.THEORY, linewidth=0.6, linestyle=":", label="without soil")
    panels[2].set_ylabel("axial strain rate (1/h)")
    for panel, end, label in zip(panels, (time[-1], time[-1], s[-1]), ("time (h)", "time (h)", DISTANCE)):
        panel.set_xlim(0.0, end)
        panel.set_xlabel(label)
    late = time >= 0.5 * time[-1]
    return [
        f"second half of the run: tip force {history['soil_tip_force_N'][late].mean():.3g} {unit}, axial force "
        f"{history['soil_axial_force_N'][late].mean():.3g} {unit} (arresting force {arresting:.3g} {unit})",
        f"tip speed {speed[late].mean():.4g} mm/h, as the forces allow {allowed[late].mean():.4g} mm/h, "
        f"without soil {free:.4g} mm/h",
    ]


def draw_strain(run: Run, model: ClosedForm, panels: list) -> list[str]:
    """Axial and radial strain (logarithmic) against Eq. 8, and radius; returns lines to print."""
    first, last = run.frame(0), run.frame(-1)
    length = float(first["distance_to_tip"].max())
    edges = measure.edges_of(length, 0.1 if length > 0.5 else length / 5.0)
    middle = (edges[1:] + edges[:-1]) / 2.0
    s = np.linspace(0.0, length, 400)
    strains = [np.log1p(e) for e in measure.strain_profiles(first, last, run.dimension, edges)]
    duration_h = float(run.scene["scene"]["duration_h"])
    settled = last.time_h >= duration_h * (1.0 - 1e-6)  # the default duration is long enough for that
    reached = f"{last.time_h:.3g} of {duration_h:.3g} h"
    said = []
    for panel, kind, strain in zip(panels, ("axial", "radial"), strains):
        exact = model.at(f"{kind}_strain", s)
        panel.plot(middle, 1e3 * strain, "o-", color=draw.SIMULATION, linewidth=1.0, markersize=2.6, label="simulation")
        panel.plot(s, 1e3 * exact, **draw.THEORY_LINE, label="Eq. 8")
        panel.set_ylabel(f"{kind} strain (10$^{{-3}}$)")
        top = 1.25e3 * max(np.nanmax(np.abs(strain)), np.abs(exact).max())
        panel.set_ylim(min(0.0, 1.25e3 * min(np.nanmin(strain), exact.min())), top)
        inside = (middle > 0.1) & (middle < 1.5) & np.isfinite(strain)
        if inside.any():
            error = 100.0 * np.abs(strain[inside] / model.at(f"{kind}_strain", middle[inside]) - 1.0)
            mean, most = percent(error.mean()), percent(error.max())
            off = f"off Eq. 8 by {most}" if settled else f"not settled at {reached}: off {mean}"
            panel.set_title(off, loc="right")
            waits = "" if settled else f"; it has not settled: {reached}"
            said.append(f"{kind} strain, 0.1 mm < s < 1.5 mm: {mean} off Eq. 8 (most {most}){waits}")
    fine = measure.edges_of(length, edges[1])
    panels[2].plot(middle, measure.radii(last, run.dimension, fine), "-", color=draw.SIMULATION, linewidth=1.3)
    panels[2].set_ylabel("radius (mm)")
    panels[2].set_ylim(0.0, 1.15 * panels[2].get_ylim()[1])
    for panel in panels:
        panel.set_xlim(0.0, length)
    return said


def simulated_when(run: Run, kind: str) -> str:
    """What the blue line is, in words for the legend."""
    times = run.times_h[run.window(measure.WINDOW_H)]
    period = f"mean of {times[0]:.3g}–{times[-1]:.3g} h" if len(times) > 1 else f"{times[-1]:.3g} h"
    when = {
        "strain": f", {run.times_h[-1]:.3g} h",
        "growth": f", {period}",
        "contact": f" (D: {period})",
        "soil": f" (D: {period})",
    }
    return f"simulation{when[kind]}"


def legend(
    figure: Figure, bottom: float, panels: list[Axes], simulation: str, chains: tuple[float, str] | None
) -> None:
    """One line above the panels, of what is labelled in them; in a soil with the force (and its unit) of the thickest
    lines in A."""
    named: dict[str, Artist] = {}
    for panel in panels:
        for handle, name in zip(*panel.get_legend_handles_labels()):
            named.setdefault(name, handle)
    entries = [(handle, simulation if name == "simulation" else name) for name, handle in named.items()]
    if chains:
        width = soil.THICKEST_MM * soil.POINTS_PER_MM
        line = Line2D([], [], color=soil.CHAIN, linewidth=width, solid_capstyle="butt")
        entries.insert(0, (line, f"{chains[0]:g} {chains[1]}"))
    paper = figure.get_size_inches() * 25.4
    figure.legend(
        *zip(*entries),
        loc="lower center",
        bbox_to_anchor=(0.5, bottom / paper[1]),
        ncol=len(entries),
        frameon=False,
        columnspacing=1.3,
        handlelength=1.9,
        borderpad=0.0,
    )


def division_bar(figure: Figure, colours: Colormap, top: float) -> None:
    """The colours of the numbers of divisions, right of the header."""
    count = colours.N
    box = min(6.0, 60.0 / count)
    axes = draw.place(figure, PAGE_WIDTH - MARGIN - box * count, top - 3.0, box * count, 2.6)
    axes.imshow(np.arange(count)[None, :], cmap=colours, aspect="auto", vmin=-0.5, vmax=count - 0.5)
    step = max(1, -(-count // 12))
    axes.set(yticks=[], xticks=range(0, count, step))
    axes.tick_params(length=0, pad=1.5)
    plt.setp(list(axes.spines.values()), visible=True, linewidth=0.4)
    axes.text(-0.02 * count - 0.5, 0.0, "divisions ", ha="right", va="center")


def beyond_limits(run: Run) -> str:
    """Which measures of the run's accuracy passed their limits, by how much and when, in the digits of run.log; empty:
    none."""
    measures = read_summary(run.folder).get("stated_accuracy", {})
    return "; ".join(
        f"{name.replace('_', ' ')} {m['worst']:.3g} at {m['at_h']:.4g} h (limit {m['limit']:.3g})"
        for name, m in measures.items()
        if m["rows_beyond"] > 0
    )


def draw_overview(run: Run, out: Path) -> list[str]:
    """Draws the figure; returns lines worth printing."""
    draw.use_style()
    last = run.frame(-1)
    model = last.closed_form
    growing = model.grows
    in_soil = growing and soil.has_grains(last)
    soil_view = SoilView(run, last) if in_soil else None
    stack: Stack | SoilView = soil_view or Stack(run)
    cell_paper = float(np.median(last["cell_axes"][:, 1])) * stack.scale
    contact = growing and not in_soil and bool(np.any(run.history().get("contact_force_N", np.zeros(1)) > 0.0))
    zoom = Zoom(run, last) if cell_paper < 0.8 and not contact and not in_soil else None
    colours = draw.division_colours(int(max(frame["generation"].max() for frame in stack.frames)))

    outside = beyond_limits(run)
    below = 11.0 + (3.5 if outside else 0.0)  # tick labels and axis label, a line of warning
    above = 13.0  # titles and legend
    zoom_height = zoom.height + 8.0 if zoom else 0.0  # with a gap above, and a line for its scale bar below
    height = below + PROFILE_HEIGHT + above + zoom_height + stack.height + HEADER
    figure = draw.new_figure(PAGE_WIDTH, height)

    top = height - HEADER
    letter_bottom = height - 6.0
    draw.letter(figure, MARGIN, letter_bottom, "A")
    title = run.name if run.dimension == 2 else f"{run.name} (middle plane)"
    figure.text((MARGIN + 6.0) / PAGE_WIDTH, letter_bottom / height, title, size=8.5, va="bottom")
    draw.scale_bar(figure, 0.55 * PAGE_WIDTH, height - 4.5, stack.scale)
    if outside:
        figure.text(
            0.5, 0.4 / height, f"outside its stated accuracy: {outside}", color=draw.WARNING, ha="center", va="bottom"
        )
    if colours.N > 1:
        division_bar(figure, colours, height - 2.5)
    stack_axes = draw.place(figure, MARGIN, top - stack.height, PAGE_WIDTH - 2.0 * MARGIN, stack.height)
    stack.draw(stack_axes, colours)
    if zoom and isinstance(stack, Stack):  # among grains there is no zoom
        width = (zoom.high - zoom.low)[0] * zoom.scale
        bottom = top - stack.height - zoom.height - 2.0
        zoom.draw(draw.place(figure, MARGIN + LABEL_WIDTH, bottom, width, zoom.height), colours)
        place_text = ((MARGIN + LABEL_WIDTH - 1.5) / PAGE_WIDTH, (bottom + zoom.height / 2.0) / height)
        figure.text(*place_text, "tip at\n" + f"{last.time_h:.3g} h", ha="right", va="center")
        draw.scale_bar(figure, MARGIN + LABEL_WIDTH + width, bottom - 3.0, zoom.scale)
        corner = zoom.low + stack.last_offset
        stack_axes.add_patch(
            Rectangle(corner, *(zoom.high - zoom.low), fill=False, edgecolor="#606060", linewidth=0.5, clip_on=False)
        )

    gaps = np.array([0.0, PANEL_GAP, PANEL_GAP]) + ([0.0, LONG_TICKS, RIGHT_AXIS_WIDTH] if contact else 0.0)
    width = (PAGE_WIDTH - 2.0 * MARGIN - TICKS_WIDTH - gaps.sum()) / 3.0
    lefts = MARGIN + TICKS_WIDTH + np.arange(3) * width + np.cumsum(gaps)
    panels = [draw.place(figure, left, below, width, PROFILE_HEIGHT) for left in lefts]
    for panel in panels:
        panel.set_xlabel(DISTANCE)
    kind = "soil" if in_soil else "contact" if contact else "growth" if growing else "strain"
    draw_panels = {"soil": draw_soil, "contact": draw_contact, "growth": draw_growth, "strain": draw_strain}[kind]
    said = draw_panels(run, model, panels)
    for left, panel, name in zip(lefts, panels, "BCD"):
        low, high = panel.get_ylim()
        if panel.get_yscale() == "linear":
            panel.set_ylim(bottom=low if low < -0.1 * high else 0.0)
        draw.letter(figure, left - TICKS_WIDTH, below + PROFILE_HEIGHT + 1.0, name)
    if outside:
        said.append(f"outside its stated accuracy: {outside}")
    chains = (soil_view.strong, "N" if run.dimension == 3 else "N/mm") if soil_view else None
    legend(figure, below + PROFILE_HEIGHT + 7.0, panels, simulated_when(run, kind), chains)

    temporary = out.with_name(f".{out.name}.part{out.suffix}")
    figure.savefig(temporary, dpi=draw.DOTS_PER_INCH)
    temporary.replace(out)
    plt.close(figure)
    return said


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, help="folder of the run")
    parser.add_argument("--out", type=Path, help="file to write: png, pdf or svg (default: RUN/overview.png)")
    options = parser.parse_args()
    out = options.out or options.run / "overview.png"
    try:
        said = draw_overview(Run(options.run), out)
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"overview: no picture of {options.run}: {error}", file=sys.stderr)
        return 1
    print("\n".join([*said, f"wrote {out}"]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
