# SPDX-License-Identifier: MIT
"""Reading the folder of a run, finished or still going on: scene.toml, summary.json, history.csv, run.h5."""

from __future__ import annotations

import csv
import json
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from rootsoil_tools.theory import ClosedForm


class RunError(Exception):
    """A run's folder cannot be used; the message says why."""


@dataclass(frozen=True)
class Frame:
    """All cells at one time. Fields by their name in run.h5, a row a cell."""

    time_h: float
    fields: dict[str, np.ndarray]
    tables: dict[str, dict[str, np.ndarray]] = field(default_factory=dict)  # beside the cells: markers, grains ...
    units: dict[str, str] = field(default_factory=dict)  # of fields, as run.h5 has them; "1" is none

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.fields:
            raise RunError(f"run.h5 has no field '{name}' at {self.time_h:g} h (there are: {', '.join(self.fields)})")
        return self.fields[name]

    @property
    def closed_form(self) -> ClosedForm:
        """What the measured profiles are to be compared with."""
        if "closed_form" not in self.tables:
            raise RunError(f"run.h5 has no closed form at {self.time_h:g} h: an older program wrote it; run it again")
        return ClosedForm(self.tables["closed_form"])

    @property
    def cells(self) -> int:
        """Number of cells."""
        return len(self["position"])

    def shape_matrices(self, dimension: int) -> np.ndarray | None:
        """Q of each cell (1/mm^2), r^T Q r = 1 on its surface; None where run.h5 has no field `shape`."""
        if "shape" not in self.fields:
            return None
        xx, yy, zz, xy, yz, xz = self["shape"].T
        full = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
        return full[:, :dimension, :dimension]

    def axial_lengths(self, dimension: int) -> np.ndarray:
        """Length of each cell along the root's axis (mm); without the field `shape`, that of its longest axis."""
        shape = self.shape_matrices(dimension)
        if shape is None:
            return self["cell_axes"][:, 0]
        axis = self["axis"][:, :dimension]
        return 2.0 / np.sqrt(np.einsum("ni,nij,nj->n", axis, shape, axis))


class Run:
    """A run's folder."""

    def __init__(self, path: Path | str):
        """Of the folder, or of its run.h5."""
        self.folder = Path(path).parent if Path(path).name == "run.h5" else Path(path)
        self.scene = self._read_scene()
        self.times_h, self._groups = self._list_frames()
        self.dimension = int(self.scene["scene"].get("dimension", 2))
        self.name = str(self.scene["scene"].get("name", self.folder.name))

    def _read_scene(self) -> dict:
        try:
            return tomllib.loads((self.folder / "scene.toml").read_text(encoding="utf-8"))
        except OSError as error:
            raise RunError(f"{self.folder} is not the folder of a run: {error}") from error
        except tomllib.TOMLDecodeError as error:
            raise RunError(f"{self.folder / 'scene.toml'}: {error}") from error

    def _open(self) -> h5py.File:
        try:
            return h5py.File(self.folder / "run.h5", "r", locking=False)
        except OSError as error:
            raise RunError(f"{self.folder / 'run.h5'} cannot be read: {error}") from error

    def _list_frames(self) -> tuple[np.ndarray, list[str]]:
        with self._open() as file:
            groups = sorted(file.get("frames", {}))
            try:
                times = [float(file["frames"][group].attrs["time_h"]) for group in groups]
            except (KeyError, OSError) as error:
                raise RunError(f"{self.folder / 'run.h5'}: a frame cannot be read: {error}") from error
        if not groups:
            raise RunError(f"{self.folder / 'run.h5'} holds no frame yet")
        return np.array(times), groups

    def frame(self, index: int) -> Frame:
        """One frame; -1 is the last."""
        with self._open() as file:
            group = file["frames"][self._groups[index]]
            datasets = {name: dataset for name, dataset in group.items() if isinstance(dataset, h5py.Dataset)}
            fields = {name: dataset[()] for name, dataset in datasets.items()}
            units = {name: str(dataset.attrs.get("unit", "1")) for name, dataset in datasets.items()}
            tables = {
                name: {column: dataset[()] for column, dataset in subgroup.items()}
                for name, subgroup in group.items()
                if isinstance(subgroup, h5py.Group)
            }
        return Frame(float(self.times_h[index]), fields, tables, units)

    def nearest_frame(self, time_h: float) -> int:
        """Index of the frame nearest to a time, as `rootsoil export --time` chooses it."""
        first, last = self.times_h[0], self.times_h[-1]
        if not first <= time_h <= last:
            raise RunError(f"no frame at {time_h:g} h: {self.folder / 'run.h5'} has {first:g} to {last:g} h")
        return int(np.argmin(np.abs(self.times_h - time_h)))

    def window(self, hours: float, most: int = 40) -> list[int]:
        """Indices of at most `most` frames in the last `hours` h, but in no more than the last third of the run."""
        start = self.times_h[-1] - min(hours, (self.times_h[-1] - self.times_h[0]) / 3.0)
        inside = np.flatnonzero(self.times_h >= start - 1e-9)
        chosen = np.linspace(0, len(inside) - 1, min(len(inside), most)).round().astype(int)
        return [int(i) for i in inside[chosen]]

    def history(self) -> dict[str, np.ndarray]:
        """Columns of history.csv, NaN where a field is empty; no column where there is no file."""
        path = self.folder / "history.csv"
        if not path.is_file():
            return {}
        with path.open(newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if None not in row.values()]
        return {name: np.array([float(row[name] or "nan") for row in rows]) for name in (rows[0] if rows else {})}


def read_summary(folder: Path) -> dict:
    """summary.json of a run; empty where there is none."""
    try:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, json.JSONDecodeError) as error:
        raise RunError(f"{folder / 'summary.json'}: {error}") from error
