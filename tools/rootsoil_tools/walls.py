# SPDX-License-Identifier: MIT
"""Cell walls, which a run does not hold: they are where the kernels of two cells are equal. Lengths in mm.

A cell's kernel is w(q / (2 eta)), Wendland's, with q^2 = r^T Q r: q = 1 on the ellipsoid Q (docs/physics.md 5.1). The
paper draws walls at the minima of the kernels' sum (its 4.9, Fig. 2), which are there where kernels are as narrow as
cells, eta = 1/2; with the solver's eta = 1.5 the sum is flat. Between two cells the minimum is where their kernels, by
far the largest two there, are equal: the valley line q_i = q_j. Between equal cells that is exact; where one is twice
as long as the other, the minimum lies a tenth of the smaller one's length further, in the larger one. Unlike minima
that are searched for row by row, valley lines close round every cell and do not depend on how the picture is turned.

The tissue ends where sum V_j W_j falls to one half. With eta = 1.5, as for the markers of the surface, irregular cells
leave no holes (root_sph/exchange/tissue_shape.hpp); with half of it, outer cells keep their round corners. It is where
either is more than one half, and within every ellipsoid.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

MARKERS_ETA, CELLS_ETA = 1.5, 0.75  # of the two sums that say where the tissue ends
SUPPORT = 2.0  # of w
OWNED = 3.0  # largest q of a pixel within a cell
COARSE = 0.5  # the smoother sum is evaluated at every so many semi-axes of the thinnest cell
WALL_COLOUR = (0.13, 0.13, 0.16)
BAND_PIXELS = 2**20  # worked on at once: some 100 MB
TINY = np.float32(1e-9)


def wendland(q: np.ndarray) -> np.ndarray:
    """Wendland's C2 kernel, 1 at q = 0 (root_sph/kernels/wendland.hpp, without its norm)."""
    s = np.maximum(1.0 - 0.5 * q, 0.0)
    s *= s
    return s * s * (2.0 * q + 1.0)


@dataclass(frozen=True)
class Section:
    """The n cells of a 2D root, or those near a plane of constant z: q^2 = r^T form r + beyond with r = x - centre."""

    dimension: int
    centre: np.ndarray  # (n, 2; mm)
    form: np.ndarray  # (n, 2, 2; 1/mm^2)
    beyond: np.ndarray  # (n); the plane cuts the cells where it is below one, in 2D it is 0
    weight: np.ndarray  # (n); V_j W_j at q = 0 and eta = 1
    row: np.ndarray  # (n); of the frame

    @property
    def cut(self) -> np.ndarray:
        """Which cells the plane cuts (n); in 2D all."""
        return self.beyond < 1.0

    def half_widths(self, q: float) -> np.ndarray:
        """Of the boxes in which each cell's q is below the given one (n, 2; mm); NaN: there is none."""
        with np.errstate(invalid="ignore"):
            inverse = self.form[:, [1, 0], [1, 0]] / np.linalg.det(self.form)[:, None]  # its diagonal
            return np.sqrt((q * q - self.beyond)[:, None] * inverse)

    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (x, y) of the box that holds the ellipsoids where they are cut."""
        half = self.half_widths(1.0)
        return np.nanmin(self.centre - half, axis=0), np.nanmax(self.centre + half, axis=0)


def section(position: np.ndarray, shape: np.ndarray, volume: np.ndarray, z_mm: float = 0.0) -> Section:
    """Cells at positions (n, 3; mm), with Q (n, d, d; 1/mm^2) and volumes (n; mm^d); in 3D those that are felt at z."""
    dimension = shape.shape[1]
    norm = (7.0 / 4.0 if dimension == 2 else 21.0 / 16.0) / np.pi
    weight = norm * volume * np.sqrt(np.linalg.det(shape)) / 2.0**dimension
    form, centre, beyond = shape[:, :2, :2], position[:, :2], np.zeros(len(position))
    if dimension == 3:
        depth = z_mm - position[:, 2]
        lean = np.linalg.solve(form, shape[:, :2, 2:])[:, :, 0]  # the cut's centre moves by this much per depth
        centre = centre - lean * depth[:, None]
        beyond = depth**2 * (shape[:, 2, 2] - np.einsum("ni,ni->n", shape[:, 2, :2], lean))
    felt = np.flatnonzero(beyond < (2.0 * MARKERS_ETA * SUPPORT) ** 2)
    return Section(dimension, centre[felt], form[felt], beyond[felt], weight[felt], felt)


@dataclass(frozen=True)
class Patch:
    """One cell of a section in the box of pixels round it (rows, columns)."""

    cell: int
    box: tuple[slice, slice]
    dx: np.ndarray  # from its centre (columns; mm)
    dy: np.ndarray  # (rows, 1; mm)
    form: np.ndarray
    q: np.ndarray

    def gradient(self) -> np.ndarray:
        """Of q (2, rows, columns; 1/mm)."""
        (xx, xy), (_, yy) = self.form
        return np.stack([xx * self.dx + xy * self.dy, xy * self.dx + yy * self.dy]) / np.maximum(self.q, TINY)


def patches(cells: Section, q_max: float, x: np.ndarray, y: np.ndarray) -> Iterator[Patch]:
    """The cells that come nearer than q_max to a pixel; x and y of the pixels are rising."""
    half = cells.half_widths(q_max)
    left, right = (np.searchsorted(x, cells.centre[:, 0] + sign * half[:, 0]) for sign in (-1.0, 1.0))
    low, high = (np.searchsorted(y, cells.centre[:, 1] + sign * half[:, 1]) for sign in (-1.0, 1.0))
    for j in np.flatnonzero((left < right) & (low < high)):
        dx = (x[left[j] : right[j]] - cells.centre[j, 0]).astype(np.float32)
        dy = (y[low[j] : high[j]] - cells.centre[j, 1]).astype(np.float32)[:, None]
        form = cells.form[j].astype(np.float32)
        (xx, xy), (_, yy) = form
        q = np.sqrt(xx * dx * dx + (2.0 * xy * dx) * dy + (yy * dy * dy + np.float32(cells.beyond[j])))
        yield Patch(int(j), (slice(low[j], high[j]), slice(left[j], right[j])), dx, dy, form, q)


def kernel_sum(cells: Section, eta: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """sum V_j W_j at pixels (rows, columns): the share of the plane that is tissue, blurred by the kernel."""
    total = np.zeros((len(y), len(x)), dtype=np.float32)
    for p in patches(cells, 2.0 * eta * SUPPORT, x, y):
        height = np.float32(cells.weight[p.cell] / eta**cells.dimension)
        total[p.box] += height * wendland(p.q / np.float32(2.0 * eta))
    return total


def coarse_kernel_sum(cells: Section, eta: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The same, evaluated only as often as it needs to be and interpolated in between: by far the widest patches."""
    step = COARSE / np.sqrt(np.linalg.eigvalsh(cells.form).max())
    grid = [np.linspace(along[0], along[-1], max(2, 1 + int(np.ceil(np.ptp(along) / step)))) for along in (x, y)]
    if len(grid[0]) * len(grid[1]) >= len(x) * len(y):
        return kernel_sum(cells, eta, x, y)
    total = kernel_sum(cells, eta, *grid)
    for axis, along in enumerate((y, x)):
        at = np.linspace(0.0, total.shape[axis] - 1.0, len(along))
        low = np.minimum(at.astype(int), total.shape[axis] - 2)
        part = (at - low).astype(np.float32)
        part = part[:, None] if axis == 0 else part
        total = total.take(low, axis) * (1.0 - part) + total.take(low + 1, axis) * part
    return total


@dataclass(frozen=True)
class Raster:
    """Pixels, (rows of y, columns of x)."""

    owner: np.ndarray  # the cell of the section whose kernel is the largest, -1: none
    wall_mm: np.ndarray  # distance from the nearest wall between two cells, to first order
    surface_mm: np.ndarray  # depth below the tissue's surface, negative outside, to first order


def depth_below(level: float, total: np.ndarray, pixel_mm: float) -> np.ndarray:
    """Distance from where a sum falls to the level (mm), to first order."""
    return (total - level) / np.maximum(np.hypot(*np.gradient(total, pixel_mm)), TINY)


def raster(cells: Section, x: np.ndarray, y: np.ndarray) -> Raster:
    """At the centres of pixels, x and y rising by the same step. Each cell is evaluated only where it is felt."""
    pixels = (len(y), len(x))
    owner, q = np.full(pixels, -1, dtype=np.int32), np.full(pixels, np.inf, dtype=np.float32)
    towards = np.zeros((2, *pixels), dtype=np.float32)  # gradient of q
    for p in patches(cells, OWNED, x, y):
        nearest = p.q < q[p.box]
        owner[p.box][nearest] = p.cell
        q[p.box][nearest] = p.q[nearest]
        towards[:, *p.box][:, nearest] = p.gradient()[:, nearest]
    wall = np.full(pixels, np.inf, dtype=np.float32)
    for p in patches(cells, OWNED, x, y):
        across = np.hypot(*(p.gradient() - towards[:, *p.box]))
        distance = np.where(across > TINY, (p.q - q[p.box]) / np.maximum(across, TINY), np.inf)
        wall[p.box] = np.where(owner[p.box] == p.cell, wall[p.box], np.minimum(wall[p.box], distance))
    depths = [
        depth_below(0.5, coarse_kernel_sum(cells, MARKERS_ETA, x, y), x[1] - x[0]),
        depth_below(0.5, kernel_sum(cells, CELLS_ETA, x, y), x[1] - x[0]),
        (1.0 - q) / np.maximum(np.hypot(*towards), TINY),
    ]
    return Raster(owner, wall, np.where(owner >= 0, np.max(depths, axis=0), -np.inf))


def bands(cells: Section, x: np.ndarray, y: np.ndarray) -> Iterator[tuple[slice, Raster]]:
    """The raster in bands of rows, so that memory is bounded; each is made with a row more on both sides."""
    rows = max(1, BAND_PIXELS // len(x))
    for start in range(0, len(y), rows):
        stop = min(start + rows, len(y))
        above = max(start - 1, 0)
        full = raster(cells, x, y[above : stop + 1])
        kept = slice(start - above, stop - above)
        yield slice(start, stop), Raster(full.owner[kept], full.wall_mm[kept], full.surface_mm[kept])


def covered(distance_mm: np.ndarray, width_mm: float, pixel_mm: float) -> np.ndarray:
    """How much of a pixel lies within a line of a width, whose middle is at a distance."""
    half, reach = width_mm / 2.0, pixel_mm / 2.0
    overlap = np.minimum(distance_mm + reach, half) - np.maximum(distance_mm - reach, -half)
    return np.clip(overlap / pixel_mm, 0.0, 1.0)


def paint(
    cells: Section, colours: np.ndarray, x: np.ndarray, y: np.ndarray, wall_mm: float, outline_mm: float
) -> np.ndarray:
    """Picture (rows, columns, 3; bytes) of cells in their colours (n, 3; 0 to 1), with walls and outline of a width."""
    picture = np.empty((len(y), len(x), 3), dtype=np.uint8)
    pixel = x[1] - x[0]
    for rows, part in bands(cells, x, y):
        tissue = np.clip(0.5 + part.surface_mm / pixel, 0.0, 1.0)
        ink = np.maximum(tissue * covered(part.wall_mm, wall_mm, pixel), covered(part.surface_mm, outline_mm, pixel))
        for k in range(3):
            paper = 1.0 - tissue * (1.0 - colours[part.owner, k])
            picture[rows, :, k] = np.rint(255.0 * (paper + ink * (WALL_COLOUR[k] - paper)))
    return picture
