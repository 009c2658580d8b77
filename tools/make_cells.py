#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes a cell file of an irregular 3D root tip, as MorphoGraphX users export them.

The root is a capsule: a cylinder with a flat base at x = 0 and half a sphere as its tip, at the largest x.
Cell centres are a centroidal Voronoi tessellation, relaxed by a few of Lloyd's steps over random points (for the
density, Q. Du, V. Faber, M. Gunzburger, SIAM Review 41 (1999) 637: in 3D the centres' density is the points' density
to the power 3/5). Each cell becomes the ellipsoid that has the second moments of its Voronoi cell, so ellipsoids fit
the cells, touch their neighbours and are turned every way. Volumes grow about tenfold from the tip to the base.

With --spread N the largest cell has N times the volume of the smallest, as in segmented images: rows of cells along
the axis become one long cell (r1/r3 up to about 10), and one cell in twenty comes with a speck, a small body at its
surface that the segmentation took for a cell.

Columns: Label; pos (um); e1, e2 (unit axes, e3 = e1 x e2); r1 >= r2 >= r3 (semi-axes, um).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

LLOYD_STEPS = 4
POINTS_PER_CELL = 60
TRIED_SHARE = 0.05  # of the cells swallow, where they can, those in front of and behind them, with --spread
LONGEST_ROW = 8.0
WIDEST_GAP = 1.3  # between cells of a row, in spacings: no other cell lies in between
ROW_WIDTH = 0.45  # a cell this near to the axis of a row, in spacings, belongs to it
SPECK_SHARE = 0.05
LARGEST_SPECK = 0.1  # of the volume of its cell
SIZE_RATIO = 8.0  # wanted volume at the base over that at the tip; the cells' scatter makes it about ten
MICRO_SIGNS = {
    "u": b"u",
    "utf8": "\N{MICRO SIGN}".encode(),
    "latin1": "\N{MICRO SIGN}".encode("latin-1"),
    "broken": "\N{MICRO SIGN}".encode()[:1],  # half of a UTF-8 character
}
HEADER = "Label, pos.X (um), pos.Y (um), pos.Z (um), e1.X, e1.Y, e1.Z, e2.X, e2.Y, e2.Z, r1 (um), r2 (um), r3 (um)"


def sample_capsule(rng: np.random.Generator, count: int, length: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """`count` random points in the capsule (um) and the volume that each stands for (relative).

    The points' density is that of the wanted cells to the power 5/3, highest at the tip.
    """
    points = np.empty((0, 3))
    while len(points) < count:
        trial = rng.uniform([0.0, -radius, -radius], [length, radius, radius], size=(2 * count, 3))
        beyond = np.maximum(trial[:, 0] - (length - radius), 0.0)
        inside = beyond**2 + trial[:, 1] ** 2 + trial[:, 2] ** 2 < radius**2
        kept = rng.uniform(size=len(trial)) < relative_density(trial, length)
        points = np.vstack([points, trial[inside & kept]])
    points = points[:count]
    return points, 1.0 / relative_density(points, length)


def relative_density(points: np.ndarray, length: float) -> np.ndarray:
    """Density of random points, 1 at the tip."""
    volume = SIZE_RATIO ** (1.0 - points[:, 0] / length)
    return volume ** (-5.0 / 3.0)


def nearest_centre(points: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Index of the centre nearest to each point; both in um.

    Points are taken in slabs along x; centres beyond the slab's neighbourhood are left out, which is exact as long as
    the nearest is closer than that neighbourhood is wide, and else the slab is done again with all.
    """
    order = np.argsort(points[:, 0], kind="stable")
    nearest = np.empty(len(points), dtype=np.intp)
    for chunk in np.array_split(order, max(len(points) // 2000, 1)):
        slab = points[chunk]
        margin = 0.05 * np.ptp(centres[:, 0])
        near = np.flatnonzero((centres[:, 0] > slab[0, 0] - margin) & (centres[:, 0] < slab[-1, 0] + margin))
        for candidates, reach in ((near, margin), (np.arange(len(centres)), np.inf)):
            if candidates.size == 0:
                continue
            c = centres[candidates]
            squared = np.sum(slab**2, axis=1)[:, None] - 2.0 * slab @ c.T + np.sum(c**2, axis=1)
            best = np.argmin(squared, axis=1)
            if squared[np.arange(len(slab)), best].max() < reach**2:
                nearest[chunk] = candidates[best]
                break
    return nearest


def sums(owner: np.ndarray, values: np.ndarray, cells: int) -> np.ndarray:
    """Sum over each cell's points of every column of `values`."""
    return np.stack([np.bincount(owner, column, cells) for column in values.T], axis=1)


def long_cells(rng: np.random.Generator, centres: np.ndarray, spacing: float) -> np.ndarray:
    """For each cell the one that it becomes a part of: some swallow a straight row of cells along the axis."""
    becomes = np.arange(len(centres))
    free = np.ones(len(centres), dtype=bool)
    for cell in rng.permutation(len(centres))[: int(TRIED_SHARE * len(centres))]:
        ahead = centres - centres[cell]
        beside = np.hypot(ahead[:, 1], ahead[:, 2])
        row = np.flatnonzero((beside < ROW_WIDTH * spacing) & (np.abs(ahead[:, 0]) < 0.5 * LONGEST_ROW * spacing))
        gaps = np.diff(np.sort(ahead[row, 0]))
        if free[row].all() and np.all(gaps < WIDEST_GAP * spacing):
            free[row] = False
            becomes[row] = cell
    return np.unique(becomes, return_inverse=True)[1]


Cells = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def add_specks(rng: np.random.Generator, made: Cells, spread: float) -> Cells:
    """The cells, and specks at the surface of some of them: the smallest has 1/spread of the largest cell's volume."""
    centres, e1, e2, semi_axes = made
    volumes = semi_axes.prod(axis=1)
    smallest = volumes.max() / spread
    able = np.flatnonzero(LARGEST_SPECK * volumes > smallest)
    hosts = rng.choice(able, size=min(len(able), max(1, int(SPECK_SHARE * len(centres)))), replace=False)
    share = rng.uniform(size=len(hosts))
    share[0] = 0.0
    speck_volume = smallest * (LARGEST_SPECK * volumes[hosts] / smallest) ** share
    slender = np.stack([rng.uniform(1.0, 2.0, len(hosts)), np.ones(len(hosts)), rng.uniform(0.5, 1.0, len(hosts))], 1)
    specks = slender * np.cbrt(speck_volume / slender.prod(axis=1))[:, None]
    side = rng.normal(size=(len(hosts), 3))
    side /= np.linalg.norm(side, axis=1)[:, None]
    axes = np.stack([e1[hosts], e2[hosts], np.cross(e1[hosts], e2[hosts])], axis=1)
    at = centres[hosts] + np.einsum("nk,nkx->nx", side * semi_axes[hosts], axes)
    x = np.vstack([centres, at])
    return x, np.vstack([e1, e1[hosts]]), np.vstack([e2, e2[hosts]]), np.vstack([semi_axes, specks])


def make_cells(cells: int, length: float, radius: float, seed: int, spread: float | None = None) -> Cells:
    """Centres (n, 3), e1 (n, 3), e2 (n, 3) and semi-axes (n, 3) of the cells; lengths in um."""
    rng = np.random.default_rng(seed)
    initial, volume = sample_capsule(rng, 20 * cells, length, radius)
    # density^(3/5) of the cells out of density of the points: keep each with density^(-2/5)
    chance = volume**0.4
    centres = initial[rng.choice(len(initial), size=cells, replace=False, p=chance / chance.sum())]

    for _ in range(LLOYD_STEPS):
        points, _ = sample_capsule(rng, POINTS_PER_CELL * cells, length, radius)
        owner = nearest_centre(points, centres)
        count = np.bincount(owner, minlength=cells)
        moved = sums(owner, points, cells) / np.maximum(count, 1)[:, None]
        centres = np.where(count[:, None] > 0, moved, centres)

    points, weight = sample_capsule(rng, 4 * POINTS_PER_CELL * cells, length, radius)
    owner = nearest_centre(points, centres)
    if spread is not None:
        becomes = long_cells(rng, centres, np.cbrt(np.pi * radius**2 * length / cells))
        owner, cells = becomes[owner], int(becomes.max()) + 1
    if np.bincount(owner, minlength=cells).min() < 10:
        raise ValueError("a cell came out too small to measure; use fewer cells or another seed")
    total = np.bincount(owner, weight, cells)[:, None]
    centres = sums(owner, weight[:, None] * points, cells) / total
    offset = points - centres[owner]
    products = weight[:, None] * offset[:, [0, 1, 2, 0, 1, 0]] * offset[:, [0, 1, 2, 1, 2, 2]]
    xx, yy, zz, xy, yz, xz = (sums(owner, products, cells) / total).T
    moments = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(cells, 3, 3)
    variance, axes = np.linalg.eigh(moments)  # ascending
    semi_axes = np.sqrt(5.0 * variance[:, ::-1])  # a uniform ellipsoid's variance along an axis is r^2/5
    made = centres, axes[:, :, 2], axes[:, :, 1], semi_axes
    if spread is not None:
        made = add_specks(rng, made, spread)
    order = np.lexsort(made[0].T[::-1])
    return made[0][order], made[1][order], made[2][order], made[3][order]


def cell_file(made: Cells, micro_sign: str) -> bytes:
    """The file's bytes."""
    centres, e1, e2, semi_axes = made
    header = HEADER.encode().replace(b"(um)", b"(" + MICRO_SIGNS[micro_sign] + b"m)")
    rows = (
        f"{label}, " + ", ".join([*(f"{v:.4f}" for v in c), *(f"{v:.9f}" for v in (*a, *b)), *(f"{v:.4f}" for v in r)])
        for label, (c, a, b, r) in enumerate(zip(centres, e1, e2, semi_axes), start=1)
    )
    return header + b"\n" + "\n".join(rows).encode() + b"\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=3000, help="number of cells (default: %(default)s)")
    parser.add_argument("--length-um", type=float, default=400.0, help="length with the tip, um (default: %(default)s)")
    parser.add_argument("--radius-um", type=float, default=60.0, help="radius, um (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="same seed, same file (default: %(default)s)")
    parser.add_argument(
        "--micro-sign",
        choices=MICRO_SIGNS,
        default="u",
        help="how the header's micro sign is written: the letter u, UTF-8, Latin-1, or a broken byte (default: u)",
    )
    parser.add_argument(
        "--spread",
        type=float,
        metavar="N",
        help="long cells and specks: the largest cell has N times the volume of the smallest (default: none of them)",
    )
    parser.add_argument("--out", type=Path, default=Path("cells.csv"), help="file to write (default: %(default)s)")
    options = parser.parse_args()
    if options.cells < 10:
        parser.error(f"--cells {options.cells}: at least 10")
    if not 0.0 < options.radius_um <= options.length_um:
        parser.error(f"--radius-um {options.radius_um}: more than 0 and at most the length ({options.length_um} um)")
    if options.spread is not None and not options.spread > 1.0:
        parser.error(f"--spread {options.spread}: more than 1")
    try:
        made = make_cells(options.cells, options.length_um, options.radius_um, options.seed, options.spread)
        options.out.write_bytes(cell_file(made, options.micro_sign))
    except (OSError, ValueError) as error:
        print(f"make_cells: {error}", file=sys.stderr)
        return 1
    print(f"{options.out}: {len(made[0])} cells, {options.length_um:g} um long, radius {options.radius_um:g} um")
    return 0


if __name__ == "__main__":
    sys.exit(main())
