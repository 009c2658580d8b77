# SPDX-License-Identifier: MIT
"""cell_walls.py: walls where kernels are equal, where the tissue ends, cuts through 3D cells, and the picture."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from matplotlib.image import imread
from scipy.ndimage import label
from scipy.signal import find_peaks
from scipy.spatial import Voronoi
from synthetic import make_growing_run

from rootsoil_tools import walls

MICRON = 1e-3  # mm
CELL = 10.0 * MICRON


def ellipsoids(length: np.ndarray, turn: np.ndarray | None = None) -> np.ndarray:
    """Q of cells with these lengths along their axes (n, d; mm), turned."""
    shape = np.einsum("ni,ij->nij", 4.0 / length**2, np.eye(length.shape[1]))
    return shape if turn is None else turn @ shape @ turn.T


def boxes(length: np.ndarray) -> np.ndarray:
    """Volumes of cells that fill space as bricks."""
    return np.prod(length, axis=1)


def flat(centre: np.ndarray, length: np.ndarray) -> walls.Section:
    """2D cells with axes along x and y."""
    return walls.section(np.pad(centre, ((0, 0), (0, 1))), ellipsoids(length), boxes(length))


def pixels(low: float, high: float, pixel: float) -> np.ndarray:
    return np.arange(low + pixel / 2.0, high, pixel)


def square(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Centres and lengths of a square lattice of round cells; the first centre is the origin."""
    y, x = np.mgrid[:rows, :columns] * CELL
    return np.column_stack([x.ravel(), y.ravel()]), np.full((rows * columns, 2), CELL)


@pytest.mark.parametrize("second", [1.0, 2.0])
def test_two_cells_have_their_wall_where_they_touch(second: float):
    """In the middle between equal ones; else where their ellipsoids touch, for there both q are one."""
    length = np.array([[CELL, CELL], [second * CELL, CELL]])
    cells = flat(np.array([[0.0, 0.0], [0.5 * (1.0 + second) * CELL, 0.0]]), length)
    pixel = 0.1 * MICRON
    x, y = pixels(-CELL, 3.0 * CELL, pixel), pixels(-0.3 * CELL, 0.3 * CELL, pixel)
    part = walls.raster(cells, x, y)
    middle = len(y) // 2
    assert abs(x[np.argmin(part.wall_mm[middle])] - 0.5 * CELL) <= pixel
    changes = x[np.flatnonzero(np.diff(part.owner[middle]) == 1)]
    np.testing.assert_allclose(changes, 0.5 * CELL, atol=pixel)
    if second == 1.0:  # the wall is straight, and its distance is that of the pixels
        near = np.abs(x - 0.5 * CELL) < 2.0 * pixel
        exact = np.broadcast_to(np.abs(x[near] - 0.5 * CELL), (len(y), near.sum()))
        np.testing.assert_allclose(part.wall_mm[:, near], exact, atol=0.05 * pixel)


def test_walls_are_the_minima_that_the_paper_looks_for():
    """Paper 4.9: scipy's find_peaks on the kernels' sum. With kernels as wide as the solver's the sum is flat."""
    centre, length = square(7, 7)
    cells = flat(centre, length)
    pixel = 0.05 * MICRON
    x, y = pixels(1.2 * CELL, 4.8 * CELL, pixel), pixels(2.7 * CELL, 3.3 * CELL, pixel)
    minima = [find_peaks(-row)[0] for row in walls.kernel_sum(cells, 0.5, x, y)]
    wall = walls.raster(cells, x, y).wall_mm
    for row, found in enumerate(minima):
        np.testing.assert_allclose(x[found], (np.arange(1, 5) + 0.5) * CELL, atol=pixel)
        assert np.all(wall[row, found] <= pixel)
    row = walls.kernel_sum(cells, walls.MARKERS_ETA, x, y)[len(y) // 2]
    assert np.ptp(row) < 0.02


def test_between_unequal_cells_the_minimum_is_near():
    """Of a cell and one of twice its length: a tenth of the smaller one's length further, in the larger one."""
    length = np.array([[CELL, CELL], [2.0 * CELL, CELL]])
    cells = flat(np.array([[0.0, 0.0], [1.5 * CELL, 0.0]]), length)
    x = pixels(0.0, 1.5 * CELL, 0.01 * MICRON)
    total = walls.kernel_sum(cells, 0.5, x, np.array([0.0]))[0]
    (minimum,) = find_peaks(-total)[0]
    assert x[minimum] - 0.5 * CELL == pytest.approx(0.1 * CELL, abs=0.01 * CELL)


@pytest.mark.parametrize("jitter", [0.0, 0.3])
def test_walls_are_as_long_as_voronois(jitter: float):
    """Round cells of one size: the painted length within 1 % of the edges of scipy's Voronoi diagram."""
    random = np.random.default_rng(3)
    rows, columns = np.mgrid[:12, :12]
    centre = np.column_stack([((columns + 0.5 * (rows % 2)) * CELL).ravel(), (rows * CELL * 0.75**0.5).ravel()])
    centre += jitter * CELL * random.uniform(-0.5, 0.5, centre.shape)
    low, high, pixel = 2.6 * CELL, 7.4 * CELL, 0.1 * MICRON
    x = pixels(low, high, pixel)
    width = 0.5 * pixel  # wider lines lie upon each other where they meet
    part = walls.raster(flat(centre, np.full((len(centre), 2), CELL)), x, x)
    painted = walls.covered(part.wall_mm, width, pixel).sum() * pixel**2 / width
    diagram = Voronoi(centre)
    edges = diagram.vertices[[edge for edge in diagram.ridge_vertices if -1 not in edge]]
    along = np.linspace(0.0, 1.0, 2001)[:, None, None]
    points = edges[:, 0] + along * (edges[:, 1] - edges[:, 0])
    inside = np.all((points > low) & (points < high), axis=2).mean(axis=0)
    exact = np.sum(inside * np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1))
    assert painted == pytest.approx(exact, rel=0.01)


def test_a_lone_sphere_is_cut_to_its_circle():
    radius, pixel = 10.0 * MICRON, 0.1 * MICRON
    length = np.full((1, 3), 2.0 * radius)
    x = pixels(-1.2 * radius, 1.2 * radius, pixel)
    for z in (0.0, 0.6, -0.9):
        volume = np.array([np.pi / 6.0 * (2.0 * radius) ** 3])
        cells = walls.section(np.array([[0.0, 0.0, z * radius]]), ellipsoids(length), volume, 0.0)
        tissue = walls.raster(cells, x, x).surface_mm > 0.0
        cut = np.sqrt(tissue.sum() * pixel**2 / np.pi)
        assert cut == pytest.approx(radius * np.sqrt(1.0 - z**2), abs=0.2 * pixel)
    missed = walls.section(np.array([[0.0, 0.0, 1.1 * radius]]), ellipsoids(length), volume, 0.0)
    assert not np.any(walls.raster(missed, x, x).surface_mm > 0.0)


def test_a_tilted_ellipsoid_is_cut_as_it_lies():
    """q in the plane is q in space."""
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    length = np.array([[CELL, 2.0 * CELL, 4.0 * CELL]])
    shape, centre = ellipsoids(length, turn), np.array([[0.3, -0.2, 0.5]]) * CELL
    z = 0.9 * CELL
    cells = walls.section(centre, shape, boxes(length), z)
    x = pixels(-CELL, CELL, 0.1 * CELL)
    (patch,) = walls.patches(cells, 100.0, x, x)
    away = np.stack(np.broadcast_arrays(x, x[:, None], z), axis=-1) - centre[0]
    np.testing.assert_allclose(patch.q, np.sqrt(np.einsum("yxi,ij,yxj->yx", away, shape[0], away)), rtol=1e-5)


def lattice_with_daughters() -> tuple[walls.Section, np.ndarray, np.ndarray]:
    """A lattice of 5 by 6 cells of which three have just divided (paper 4.2), and pixels that show all of it."""
    centre, length = square(5, 6)
    dividing = np.array([0, 8, 20])
    centre, length = (np.concatenate([values, values[dividing]]) for values in (centre, length))
    for daughters, side in ((dividing, -1.0), (np.arange(30, 33), 1.0)):
        centre[daughters, 0] += side * CELL / 4.0
        length[daughters, 0] /= 2.0
    pixel = 0.1 * MICRON
    return flat(centre, length), pixels(-CELL, 6.0 * CELL, pixel), pixels(-CELL, 5.0 * CELL, pixel)


def test_every_cell_is_enclosed():
    """As many regions within walls and outline as cells, and one outside; daughters have a wall between them."""
    cells, x, y = lattice_with_daughters()
    part = walls.raster(cells, x, y)
    pixel = x[1] - x[0]
    _, regions = label((part.surface_mm > pixel) & (part.wall_mm > pixel))
    assert regions == len(cells.centre) == 33
    column, row = np.argmin(np.abs(x)), np.argmin(np.abs(y))
    assert part.wall_mm[row, column] < pixel  # in the middle of the mother
    assert {part.owner[row, column - 9], part.owner[row, column + 9]} == {0, 30}


def test_tissue_ends_where_it_does():
    """A flat side half a cell from the outer centres, within a twentieth of a cell; no wall outside, no holes."""
    cells, x, y = lattice_with_daughters()
    part = walls.raster(cells, x, y)
    pixel = x[1] - x[0]
    column = np.argmin(np.abs(x - 2.0 * CELL))
    depth = part.surface_mm[:, column]
    below = y[np.flatnonzero(np.diff(np.sign(depth)))]
    np.testing.assert_allclose(below, [-0.5 * CELL, 4.5 * CELL], atol=0.05 * CELL)
    _, outside = label(part.surface_mm <= 0.0)
    assert outside == 1
    picture = walls.paint(cells, np.full((len(cells.centre), 3), 0.5), x, y, 2.0 * pixel, 2.0 * pixel)
    assert np.all(picture[part.surface_mm < -2.0 * pixel] == 255)
    wall = round(255 * walls.WALL_COLOUR[0])
    assert np.all(picture[(part.surface_mm > 0.0) & (part.wall_mm < 0.4 * pixel), 0] == wall)
    assert np.all(picture[(part.surface_mm > 2.0 * pixel) & (part.wall_mm > 2.0 * pixel)] == 128)


def test_irregular_cells_leave_no_holes():
    random = np.random.default_rng(1)
    centre, _ = square(14, 14)
    centre += 0.3 * CELL * random.uniform(-0.5, 0.5, centre.shape)
    cells = flat(centre, CELL * random.uniform(0.85, 1.15, (len(centre), 1)) * np.ones(2))
    x = pixels(-2.0 * CELL, 15.0 * CELL, 0.5 * MICRON)
    _, outside = label(walls.raster(cells, x, x).surface_mm <= 0.0)
    assert outside == 1


def test_a_line_covers_as_much_as_it_is_wide():
    """Also one thinner than a pixel: grey in the pixel that it runs through."""
    at = np.arange(-5.0, 5.0) + 0.3
    for width in (0.2, 1.0, 3.7):
        assert walls.covered(at, width, 1.0).sum() == pytest.approx(width)


@pytest.mark.parametrize("rows, left_over", [(37, 8), (599, 1)])
def test_bands_make_the_same_picture(monkeypatch: pytest.MonkeyPatch, rows: int, left_over: int):
    cells, x, y = lattice_with_daughters()
    colours = np.random.default_rng(2).uniform(size=(len(cells.centre), 3))
    whole = walls.paint(cells, colours, x, y, 2e-4, 4e-4)
    assert len(y) % rows == left_over
    monkeypatch.setattr(walls, "BAND_PIXELS", rows * len(x))
    banded = walls.paint(cells, colours, x, y, 2e-4, 4e-4)
    assert np.mean(np.abs(banded.astype(int) - whole) > 2) < 1e-3


def cell_walls(project: Path, run: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([project / "tools" / "cell_walls.py", run, *options], capture_output=True, text=True)


@pytest.fixture(scope="module", params=[2, 3])
def grown(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int]:
    folder = tmp_path_factory.mktemp(f"grown{request.param}") / "run"
    return (
        make_growing_run(folder, dimension=request.param, duration=4.0, length=0.6, cell=0.02, frames=5),
        request.param,
    )


def test_the_picture_comes_out(project: Path, grown: tuple[Path, int]):
    run, dimension = grown
    done = cell_walls(project, run)
    assert (done.returncode, done.stderr) == (0, "")
    assert "at 4 h" in done.stdout
    picture = imread(run / "cell_walls.png")
    assert abs(picture.shape[1] - 2000 * 180 / 172) <= 1
    lower_half = picture[picture.shape[0] // 2 :, :, :3]  # without the colour bar: tinted cells, and walls
    assert np.mean(np.ptp(lower_half, axis=2) > 0.1) > 0.3
    assert 0.01 < np.mean(lower_half.max(axis=2) < 0.25) < 0.2
    assert [p.name for p in run.glob("*cell_walls*")] == ["cell_walls.png"]


def test_what_is_asked_for_is_drawn(project: Path, grown: tuple[Path, int], tmp_path: Path):
    """Field with its unit, the frame nearest to a time, a plane, a region; from run.h5 as well."""
    run, dimension = grown
    out = tmp_path / "out.svg"
    options = ["--out", str(out), "--pixels", "300", "--time", "2.2", "--colour-by", "axial_strain_rate"]
    options += ["--region", "0.1", "0.5", "-0.05", "0.05"]
    options += ["--slice-z", "0.013"] if dimension == 3 else []
    done = cell_walls(project, run / "run.h5", *options)
    assert (done.returncode, done.stderr) == (0, "")
    text = out.read_text(encoding="utf-8")
    assert "axial strain rate (1/h)" in text and "synthetic_arabidopsis, 2 h" in text and "µm</text>" in text
    assert ("cut at z = 13 µm" in text) == (dimension == 3)
    assert ">B<" not in text
    done = cell_walls(project, run, "--out", str(out), "--pixels", "300", "--frame", "0", "--colour-by", "generation")
    assert done.returncode == 0 and "synthetic_arabidopsis, 0 h" in out.read_text(encoding="utf-8")


@pytest.mark.parametrize("grown", [2], indirect=True)
@pytest.mark.parametrize(
    "options, said",
    [
        (["--frame", "5"], "--frame 5: the run has frames 0 to 4; -1 is the last"),
        (["--frame", "-6"], "--frame -6: the run has frames 0 to 4"),
        (["--time", "4.1"], "no frame at 4.1 h"),
        (["--colour-by", "colour"], "--colour-by colour: no such field at 4 h; allowed: cell_length, "),
        (["--pixels", "100"], "--pixels 100: allowed: 200 to 8000"),
        (["--region", "5", "6", "0", "1"], "--region 5 6 0 1: no tissue there"),
        (["--region", "1", "0", "0", "1"], "give x0 < x1 and y0 < y1"),
        (["--slice-z", "0"], "--slice-z 0: the run has two dimensions"),
        (["--out", "nowhere/out.png"], "nowhere"),
        (["--out", "out.txt"], "txt"),
    ],
)
def test_what_is_wrong_is_said(project: Path, grown: tuple[Path, int], tmp_path: Path, options: list[str], said: str):
    out = tmp_path / "out.png"
    done = cell_walls(project, grown[0], "--out", str(out), *options)
    assert done.returncode == 1 and said in done.stderr and "Traceback" not in done.stderr
    assert not out.exists()


@pytest.mark.parametrize("grown", [3], indirect=True)
def test_a_plane_beside_the_root_is_refused(project: Path, grown: tuple[Path, int]):
    done = cell_walls(project, grown[0], "--slice-z", "0.2")
    assert done.returncode == 1 and "--slice-z 0.2: no cell there; allowed: -0.0" in done.stderr


@pytest.mark.parametrize("grown", [2], indirect=True)
def test_a_run_that_cannot_be_drawn(project: Path, grown: tuple[Path, int], tmp_path: Path):
    done = cell_walls(project, tmp_path / "nothing")
    assert done.returncode == 1 and "is not the folder of a run" in done.stderr and "Traceback" not in done.stderr
    run = shutil.copytree(grown[0], tmp_path / "run")
    with h5py.File(run / "run.h5", "r+") as file:
        for group in file["frames"].values():
            del group["shape"]
    done = cell_walls(project, run)
    assert done.returncode == 1 and "no field 'shape'" in done.stderr and "output.fields" in done.stderr
