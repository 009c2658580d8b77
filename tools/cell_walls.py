#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the cell walls of a run's tissue, as the paper's Fig. 2: the minima of the kernels' sum between cells.

A particle is a cell, and its ellipsoid is the metric of its kernel. A wall is the line on which the kernels of two
cells are equal and larger than all others: there their sum has its valley, and the line closes round every cell. The
paper looks for minima of the sum itself, row by row (its 4.9). Between equal cells the two are the same; how far they
differ elsewhere, and where the tissue ends, is said in rootsoil_tools/walls.py.

A: the whole root. B: its tip, magnified. Each cell is tinted by a field, by default its length along the root; the ends
of the colours leave out one per cent of the cells on either side. A 3D run is cut by a plane of constant z, by default
the middle one; cells and walls are cut as they lie.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colorbar import Colorbar
from matplotlib.colors import BoundaryNorm, Colormap, LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter

from rootsoil_tools import draw, measure, walls
from rootsoil_tools.runs import Frame, Run, RunError

PAGE_WIDTH = 180.0  # mm of paper, as everything in capitals here
MARGIN = 4.0
WIDTH = PAGE_WIDTH - 2.0 * MARGIN
WHOLE_MAX_HEIGHT = 90.0
TIP_MAX_HEIGHT = 46.0
HEADER = 10.0
BELOW = 5.0  # a panel, for its scale bar
LETTER_WIDTH = 6.0
PIXELS = (200, 8000)  # allowed
BOX = {"linewidth": 0.5, "edgecolor": "#606060"}
MAGNIFIED = 1.5  # times the whole root: less is no second panel
WALL = 0.16
OUTLINE = 0.3
WALL_OF_CELL = 0.1  # a wall is never wider than this part of a cell's width
TINTS = ["#FFF8DC", "#F7D98C", "#C9DB8F", "#79BFA0", "#4C93B4", "#5B6CAE"]  # light enough for dark walls
COMPONENTS = {3: ("x", "y", "z"), 6: ("xx", "yy", "zz", "xy", "yz", "xz")}  # as `rootsoil export` names them
LOG_TICKS = [m * 10.0**k for k in range(-12, 13) for m in (1.0, 2.0, 5.0)]
NO_VALUE = "#D0D0D0"
OUTLIERS = 1.0  # per cent of the cells on either side
MOST_WHOLE_NUMBERS = 12  # that have a colour each

Region = tuple[float, float, float, float]  # x0, x1, y0, y1 (mm)


def fields(frame: Frame) -> dict[str, tuple[str, int | None]]:
    """What cells can be tinted by: the field in run.h5 and the component of it; named as `rootsoil export` does."""
    named: dict[str, tuple[str, int | None]] = {"cell_length": ("shape", None)}
    for name, values in frame.fields.items():
        if values.ndim == 1:
            named[name] = (name, None)
        else:
            for k, component in enumerate(COMPONENTS.get(values.shape[1], range(1, values.shape[1] + 1))):
                named[f"{name}_{component}"] = (name, k)
    return named


def tint_values(frame: Frame, dimension: int, name: str) -> tuple[np.ndarray, str]:
    """Values of a field, one a cell, and its label with the unit."""
    named = fields(frame)
    if name not in named:
        raise RunError(f"--colour-by {name}: no such field at {frame.time_h:g} h; allowed: {', '.join(named)}")
    if name == "cell_length":
        return 1e3 * frame.axial_lengths(dimension), "cell length (µm)"
    field, component = named[name]
    values = frame[field] if component is None else frame[field][:, component]
    unit = frame.units.get(field, "1").replace("ug", "µg").replace("^2", "²").replace("^3", "³")
    label = name.replace("_", " ")
    return values, label if unit == "1" else f"{label} ({unit})"


def tint_scale(values: np.ndarray) -> tuple[Colormap, Normalize]:
    """A colour a value for few whole numbers; logarithmic over more than a decade of positive values.

    A few outliers, as the stress at a clamp, lie beyond its ends.
    """
    tints = LinearSegmentedColormap.from_list("tints", TINTS)
    tints.set_bad(NO_VALUE)
    if np.issubdtype(values.dtype, np.integer) and np.ptp(values) < MOST_WHOLE_NUMBERS:
        return tints, BoundaryNorm(np.arange(values.min() - 0.5, values.max() + 1.0), tints.N)
    low, high = (float(end) for end in np.nanpercentile(values, [OUTLIERS, 100.0 - OUTLIERS]))
    if low > 0.0 and high > 10.0 * low:
        return tints, LogNorm(low, high)
    return tints, Normalize(low, high if high > low else low + 1.0)


class Panel:
    """A part of the plane, and where it goes on the paper."""

    def __init__(self, region: Region, max_height: float):
        self.region = region
        self.size = np.array([region[1] - region[0], region[3] - region[2]])
        self.scale = min(WIDTH / self.size[0], max_height / self.size[1])  # mm of paper per mm of root
        self.width, self.height = self.size * self.scale

    def shows(self, cells: walls.Section) -> np.ndarray:
        """Which cells have a part in it (n)."""
        x0, x1, y0, y1 = self.region
        half = cells.half_widths(1.0)  # NaN of cells that are not cut, which are not shown
        return np.all((cells.centre + half > (x0, y0)) & (cells.centre - half < (x1, y1)), axis=1)

    def draw(self, axes: Axes, cells: walls.Section, colours: np.ndarray, pixels: int) -> None:
        """Into axes as large as the panel; so many pixels across the whole paper."""
        pixel = WIDTH / pixels / self.scale
        x, y = (
            low + (np.arange(max(2, round(size / pixel))) + 0.5) * pixel
            for low, size in zip(self.region[::2], self.size)
        )
        cell = float(np.median(2.0 * cells.half_widths(1.0)[cells.cut].min(axis=1)))
        wall, outline = (min(width / self.scale, WALL_OF_CELL * cell) for width in (WALL, OUTLINE))
        picture = walls.paint(cells, colours, x, y, wall, max(outline, 0.5 * pixel))
        axes.imshow(picture, extent=self.region, origin="lower", aspect="auto", interpolation="antialiased")
        axes.set(xticks=[], yticks=[])
        axes.axis("off")


def with_margin(low: np.ndarray, high: np.ndarray) -> Region:
    """A box out of its corners, a little larger."""
    edge = 0.05 * (high - low).min()
    return (low[0] - edge, high[0] + edge, low[1] - edge, high[1] + edge)


def tip(frame: Frame, dimension: int, cells: walls.Section) -> Region:
    """The tip, as much of the root as fills a panel of its largest height."""
    length = float(frame["distance_to_tip"].max())
    radius = float(np.max(measure.radii(frame, dimension, np.linspace(0.0, length, 21))))
    cut = cells.cut
    centre, half = cells.centre[cut], cells.half_widths(1.0)[cut]
    from_tip = frame["distance_to_tip"][cells.row[cut]]
    near = from_tip - from_tip.min() < 2.1 * radius * WIDTH / TIP_MAX_HEIGHT
    return with_margin((centre - half)[near].min(axis=0), (centre + half)[near].max(axis=0))


def draw_bar(figure: Figure, tints: Colormap, norm: Normalize, label: str, values: np.ndarray, top: float) -> None:
    """The colours of the field, right of the header."""
    axes = draw.place(figure, PAGE_WIDTH - MARGIN - 46.0, top - 5.5, 44.0, 2.4)
    below, above = int(np.nanmin(values) < norm.vmin), int(np.nanmax(values) > norm.vmax)
    extend = ("neither", "min", "max", "both")[below + 2 * above]
    bar = Colorbar(axes, cmap=tints, norm=norm, orientation="horizontal", extend=extend, extendfrac=0.03)
    if isinstance(norm, BoundaryNorm):
        bar.set_ticks(np.arange(int(values.min()), int(values.max()) + 1))
        bar.minorticks_off()
    elif isinstance(norm, LogNorm):
        bar.set_ticks([m for m in LOG_TICKS if norm.vmin <= m <= norm.vmax], minor=False)
        bar.formatter = FuncFormatter(lambda tick, _: f"{tick:g}")
    bar.outline.set_linewidth(0.4)
    bar.ax.tick_params(length=1.5, pad=1.0)
    axes.text(-0.06, 0.5, label, transform=axes.transAxes, ha="right", va="center")


def panels_of(frame: Frame, dimension: int, cells: walls.Section, region: Region | None) -> list[Panel]:
    """The region that was asked for; else the whole root, and its tip where that is worth a panel."""
    low, high = cells.extent()
    if region is None:
        root = Panel(with_margin(low, high), WHOLE_MAX_HEIGHT)
        magnified = Panel(tip(frame, dimension, cells), TIP_MAX_HEIGHT)
        return [root, magnified] if magnified.scale > MAGNIFIED * root.scale else [root]
    x0, x1, y0, y1 = region
    if not (x0 < x1 and y0 < y1):
        raise RunError(f"--region {x0:g} {x1:g} {y0:g} {y1:g}: give x0 < x1 and y0 < y1 (mm)")
    if x1 < low[0] or x0 > high[0] or y1 < low[1] or y0 > high[1]:
        raise RunError(
            f"--region {x0:g} {x1:g} {y0:g} {y1:g}: no tissue there; it lies within "
            f"{low[0]:.4g} {high[0]:.4g} {low[1]:.4g} {high[1]:.4g} (mm)"
        )
    return [Panel(region, 2.0 * WHOLE_MAX_HEIGHT)]


def cells_of(frame: Frame, dimension: int, z_mm: float | None) -> tuple[walls.Section, str]:
    """The cells to draw, and which plane cuts them in words for the title."""
    shape = frame.shape_matrices(dimension)
    if shape is None:
        raise RunError("run.h5 has no field 'shape', of which walls are made: put it into output.fields, and run again")
    if dimension == 2:
        if z_mm is not None:
            raise RunError(f"--slice-z {z_mm:g}: the run has two dimensions; leave it out")
        return walls.section(frame["position"], shape, frame["volume"]), ""
    z, reach = frame["position"][:, 2], draw.reach_in_z(frame)
    if z_mm is None:
        z_mm = draw.middle_plane(frame)
    elif not np.any(np.abs(z - z_mm) < reach):
        raise RunError(
            f"--slice-z {z_mm:g}: no cell there; allowed: {(z - reach).min():.4g} to {(z + reach).max():.4g}"
        )
    return walls.section(frame["position"], shape, frame["volume"], z_mm), f", cut at z = {1e3 * z_mm:.3g} µm"


def draw_walls(run: Run, frame: Frame, out: Path, options: argparse.Namespace) -> list[str]:
    """Draws the figure; returns lines worth printing."""
    draw.use_style()
    cells, plane = cells_of(frame, run.dimension, options.slice_z)
    panels = panels_of(frame, run.dimension, cells, options.region)
    values, label = tint_values(frame, run.dimension, options.colour_by)
    values = values[cells.row]
    shown = values[np.any([panel.shows(cells) for panel in panels], axis=0)]
    if not np.isfinite(shown).any():
        raise RunError(
            f"--colour-by {options.colour_by}: no cell in view has a value of it; choose another field or region"
        )
    tints, norm = tint_scale(shown)
    colours = tints(norm(values))[:, :3]

    height = HEADER + sum(panel.height + BELOW for panel in panels)
    figure = draw.new_figure(PAGE_WIDTH, height)
    title, left = f"{run.name}, {frame.time_h:.4g} h{plane}", MARGIN + (LETTER_WIDTH if len(panels) > 1 else 0.0)
    figure.text(left / PAGE_WIDTH, 1.0 - 6.0 / height, title, size=8.5, va="bottom")
    draw_bar(figure, tints, norm, label, shown, height)
    bottom = height - HEADER
    for letter, panel in zip("AB", panels):
        bottom -= panel.height
        left = MARGIN + (WIDTH - panel.width) / 2.0
        axes = draw.place(figure, left, bottom, panel.width, panel.height)
        panel.draw(axes, cells, colours, options.pixels)
        draw.scale_bar(figure, left + panel.width, bottom - 2.5, panel.scale, microns=True)
        if len(panels) > 1:
            draw.letter(figure, MARGIN, height - 6.0 if letter == "A" else bottom + panel.height + 0.5, letter)
        if panel is panels[0]:
            whole = axes
        else:
            axes.axis("on")
            plt.setp(list(axes.spines.values()), visible=True, **BOX)
            whole.add_patch(Rectangle(panel.region[::2], *panel.size, fill=False, clip_on=False, **BOX))
        bottom -= BELOW

    temporary = out.with_name(f".{out.name}.part{out.suffix}")
    figure.savefig(temporary, dpi=options.pixels / WIDTH * 25.4)
    temporary.replace(out)
    plt.close(figure)
    return [f"{np.count_nonzero(cells.cut)} cells at {frame.time_h:g} h"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, help="folder of the run, or its run.h5")
    when = parser.add_mutually_exclusive_group()
    when.add_argument("--frame", type=int, default=-1, metavar="N", help="frame, from 0 on (default: the last)")
    when.add_argument("--time", type=float, metavar="H", help="the frame nearest to this time (h)")
    parser.add_argument(
        "--out", type=Path, help="file to write: png, pdf or svg (default: cell_walls.png beside run.h5)"
    )
    parser.add_argument(
        "--colour-by", default="cell_length", metavar="FIELD", help="tint of the cells (default: %(default)s)"
    )
    parser.add_argument(
        "--region", type=float, nargs=4, metavar=("X0", "X1", "Y0", "Y1"), help="only this part of the plane (mm)"
    )
    parser.add_argument("--slice-z", type=float, metavar="MM", help="3D: the plane that cuts the root (mm)")
    parser.add_argument(
        "--pixels", type=int, default=2000, metavar="N", help="across the picture (default: %(default)s)"
    )
    options = parser.parse_args()
    try:
        if not PIXELS[0] <= options.pixels <= PIXELS[1]:
            raise RunError(f"--pixels {options.pixels}: allowed: {PIXELS[0]} to {PIXELS[1]}")
        run = Run(options.run)
        frames = len(run.times_h)
        if not -frames <= options.frame < frames:
            raise RunError(f"--frame {options.frame}: the run has frames 0 to {frames - 1}; -1 is the last")
        index = options.frame if options.time is None else run.nearest_frame(options.time)
        out = options.out or run.folder / "cell_walls.png"
        said = draw_walls(run, run.frame(index), out, options)
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"cell_walls: no picture of {options.run}: {error}", file=sys.stderr)
        return 1
    print("\n".join([*said, f"wrote {out}"]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
