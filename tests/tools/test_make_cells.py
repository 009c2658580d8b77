# SPDX-License-Identifier: MIT
"""The cell file that tools/make_cells.py makes."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

CELLS = 300


def make(project: Path, out: Path, *options: str) -> bytes:
    command = [project / "tools" / "make_cells.py", "--cells", str(CELLS), "--out", out, *options]
    subprocess.run(command, check=True, capture_output=True)
    return out.read_bytes()


@pytest.fixture(scope="module")
def table(project: Path, tmp_path_factory: pytest.TempPathFactory) -> np.ndarray:
    path = tmp_path_factory.mktemp("cells") / "cells.csv"
    make(project, path)
    return np.loadtxt(path, delimiter=",", skiprows=1)


def test_header_byte_by_byte(project: Path, tmp_path: Path):
    for sign, micro in (("u", b"u"), ("utf8", b"\xc2\xb5"), ("latin1", b"\xb5"), ("broken", b"\xc2")):
        header = make(project, tmp_path / f"{sign}.csv", "--micro-sign", sign).split(b"\n")[0]
        um = b"(" + micro + b"m)"
        assert header == (
            b"Label, pos.X " + um + b", pos.Y " + um + b", pos.Z " + um + b", e1.X, e1.Y, e1.Z, e2.X, e2.Y, e2.Z, "
            b"r1 " + um + b", r2 " + um + b", r3 " + um
        )


def test_same_seed_same_file(project: Path, tmp_path: Path):
    first = make(project, tmp_path / "1.csv")
    assert make(project, tmp_path / "2.csv") == first
    assert make(project, tmp_path / "3.csv", "--seed", "2") != first


def test_every_cell_once(table: np.ndarray):
    assert sorted(table[:, 0]) == list(range(1, CELLS + 1))
    assert np.isfinite(table).all()


def test_axes_are_orthonormal_and_ordered(table: np.ndarray):
    e1, e2, semi_axes = table[:, 4:7], table[:, 7:10], table[:, 10:13]
    assert np.linalg.norm(e1, axis=1) == pytest.approx(np.ones(CELLS), abs=1e-8)
    assert np.linalg.norm(e2, axis=1) == pytest.approx(np.ones(CELLS), abs=1e-8)
    assert np.sum(e1 * e2, axis=1) == pytest.approx(np.zeros(CELLS), abs=1e-8)
    assert (semi_axes[:, 0] >= semi_axes[:, 1]).all() and (semi_axes[:, 1] >= semi_axes[:, 2]).all()
    assert (semi_axes[:, 2] > 0.0).all()


def test_cells_fill_the_capsule_and_vary_tenfold(table: np.ndarray):
    volume = 4.0 / 3.0 * np.pi * table[:, 10:13].prod(axis=1)
    capsule = np.pi * 60.0**2 * 340.0 + 2.0 / 3.0 * np.pi * 60.0**3
    assert volume.sum() == pytest.approx(capsule, rel=0.15)
    assert 7.0 < volume.max() / volume.min() < 25.0
    tip, base = table[:, 1] > 340.0, table[:, 1] < 60.0
    assert volume[base].mean() > 4.0 * volume[tip].mean()
    assert 350.0 < table[:, 1].max() < 400.0 and 0.0 < table[:, 1].min() < 30.0


def test_orientation_is_irregular(table: np.ndarray):
    assert 0.2 < np.abs(table[:, 4:7]).mean(axis=0).min() and np.abs(table[:, 4:7]).mean(axis=0).max() < 0.8


def test_spread_adds_long_cells_and_specks(project: Path, tmp_path: Path):
    out = tmp_path / "cells.csv"
    command = [project / "tools" / "make_cells.py", "--cells", "1000", "--spread", "2000", "--out", out]
    subprocess.run(command, check=True, capture_output=True)
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    semi_axes = table[:, 10:]
    volume = semi_axes.prod(axis=1)
    assert volume.max() / volume.min() == pytest.approx(2000.0, rel=1e-2)
    assert 5.0 < (semi_axes[:, 0] / semi_axes[:, 2]).max() < 15.0
    assert len(set(table[:, 0])) == len(table)


def test_bad_input_is_refused(project: Path, tmp_path: Path):
    out = tmp_path / "cells.csv"
    for options in (
        ["--cells", "3"],
        ["--radius-um", "500"],
        ["--radius-um", "-1"],
        ["--micro-sign", "x"],
        ["--spread", "1"],
    ):
        command = [project / "tools" / "make_cells.py", "--out", out, *options]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 2 and options[0] in done.stderr
    assert not out.exists()
