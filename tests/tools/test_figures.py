# SPDX-License-Identifier: MIT
"""overview.py and impedance.py, and the measures they share, on run folders made without the solver."""

from __future__ import annotations

import csv
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from synthetic import make_growing_run, make_strained_run

from rootsoil_tools import measure
from rootsoil_tools.runs import Frame, Run, RunError
from rootsoil_tools.theory import model_of

PNG = b"\x89PNG\r\n\x1a\n"
OBSTACLES = """
[[obstacle]]
shape = "box"
position_mm = [2.4, 0.1]
half_size_mm = [0.1, 0.6]
angle_deg = 30.0
[[obstacle]]
shape = "plane"
position_mm = [0.0, -0.3]
normal = [0.0, 1.0]
[[obstacle]]
shape = "disc"
position_mm = [2.0, 0.4]
radius_mm = 0.2
"""


def overview(project: Path, run: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([project / "tools" / "overview.py", run, *options], capture_output=True, text=True)


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_growing_run(tmp_path_factory.mktemp("grown") / "run", more=OBSTACLES)


def test_overview_of_growth(project: Path, grown: Path):
    done = overview(project, grown)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    picture = (grown / "overview.png").read_bytes()
    assert picture.startswith(PNG) and len(picture) > 50_000
    assert int.from_bytes(picture[16:20], "big") >= 180 / 25.4 * 200  # pixels across
    assert "R^2 = " in done.stdout and "tip speed" in done.stdout
    assert [p.name for p in grown.glob("*overview*")] == ["overview.png"]


def test_overview_without_growth_compares_strain(project: Path, tmp_path: Path):
    for dimension in (2, 3):
        run = make_strained_run(tmp_path / f"{dimension}", dimension=dimension, cell=0.06)
        done = overview(project, run, "--out", str(tmp_path / f"{dimension}.pdf"))
        assert done.returncode == 0, done.stderr
        assert "Eq. 8" in done.stdout
        assert (tmp_path / f"{dimension}.pdf").read_bytes().startswith(b"%PDF")


def test_overview_in_3d_without_shapes_and_by_external_links(project: Path, tmp_path: Path):
    """A run that goes on: run.h5 only links to a file per frame; and cells without the field `shape`."""
    run = make_growing_run(
        tmp_path / "run", name="3d", dimension=3, duration=4.0, length=0.5, radius=0.08, cell=0.02, frames=4
    )
    (run / "run.h5").rename(run / "all.h5")
    with h5py.File(run / "all.h5", "r+") as file:
        for group in file["frames"].values():
            del group["shape"]
    with h5py.File(run / "run.h5", "w") as file:
        for number in range(4):
            file[f"frames/{number:06d}"] = h5py.ExternalLink("all.h5", f"/frames/{number:06d}")
    done = overview(project, run)
    assert done.returncode == 0, done.stderr
    assert (run / "overview.png").read_bytes().startswith(PNG)


def test_overview_of_a_single_frame(project: Path, tmp_path: Path):
    run = make_growing_run(tmp_path / "run", frames=2, duration=1.0)
    with h5py.File(run / "run.h5", "r+") as file:
        del file["frames/000001"]
    done = overview(project, run)
    assert done.returncode == 0, done.stderr


def test_overview_says_what_is_wrong(project: Path, tmp_path: Path):
    done = overview(project, tmp_path / "nothing")
    assert done.returncode == 1
    assert "is not the folder of a run" in done.stderr and "Traceback" not in done.stderr
    run = make_growing_run(tmp_path / "run", frames=2, duration=1.0)
    (run / "run.h5").write_bytes(b"not HDF5")
    done = overview(project, run)
    assert done.returncode == 1 and "run.h5 cannot be read" in done.stderr and "Traceback" not in done.stderr
    assert not (run / "overview.png").exists()


def test_run_without_frames_is_refused(tmp_path: Path):
    (tmp_path / "scene.toml").write_text("[scene]\n")
    with h5py.File(tmp_path / "run.h5", "w"):
        pass
    with pytest.raises(RunError, match="no frame yet"):
        Run(tmp_path)


def test_window_is_the_last_hours_of_no_more_than_a_third(grown: Path):
    run = Run(grown)  # 12 h, a frame an hour
    assert run.times_h[run.window(2.0)] == pytest.approx([10.0, 11.0, 12.0], abs=1e-6)
    assert run.times_h[run.window(10.0)][0] == pytest.approx(8.0)
    assert len(run.window(10.0, most=3)) == 3


def test_radius_of_a_lattice_is_half_its_width(tmp_path: Path):
    for dimension, expected in ((2, 0.3), (3, np.sqrt(112 / np.pi) * 0.05)):
        frame = Run(make_strained_run(tmp_path / f"{dimension}", dimension=dimension)).frame(0)
        edges = np.array([0.62, 0.7, 1.11, 1.5])  # not those of the cells
        assert measure.radii(frame, dimension, edges) == pytest.approx(np.full(3, expected), rel=1e-6)


def test_strain_of_cells_moved_as_equation_8_says(tmp_path: Path):
    for dimension in (2, 3):
        run = Run(make_strained_run(tmp_path / f"{dimension}", dimension=dimension))
        model = model_of(run.scene)
        edges = measure.edges_of(1.5, 0.1)
        axial, radial = measure.strain_profiles(run.frame(0), run.frame(1), dimension, edges)
        middle = (edges[1:] + edges[:-1]) / 2.0
        assert axial == pytest.approx(np.full(15, model.axial_strain()), rel=1e-6)
        assert radial[4:] == pytest.approx(model.radial_strain(middle[4:]), abs=3e-6)


def test_growth_profiles_find_the_closed_form(grown: Path):
    run = Run(grown)
    model = model_of(run.scene)
    rate = measure.growth_profiles(run, measure.edges_of(1.0, 0.05))["axial_strain_rate"]
    assert rate.mean[2:] == pytest.approx(model.axial_rate(rate.s_mm[2:]), abs=0.02)
    assert measure.tip_speed(run) == pytest.approx(model.tip_speed(3.0), rel=0.02)


def test_drift_of_the_mature_radius(grown: Path, tmp_path: Path):
    """In 2D the radius goes as the volumes: 1 % more of them an hour drifts by 0.01 /h more."""
    faster = shutil.copytree(grown, tmp_path / "run")
    with h5py.File(faster / "run.h5", "r+") as file:
        for group in file["frames"].values():
            group["volume"][...] *= np.exp(0.01 * group.attrs["time_h"])
    model = model_of(Run(grown).scene)
    radius, drift = (f(model, Run(grown)) for f in (measure.mature_radius, measure.radius_drift))
    assert np.isfinite(radius) and np.isfinite(drift)
    assert measure.radius_drift(model, Run(faster)) == pytest.approx(drift + 0.01, abs=1e-9)
    assert measure.mature_radius(model, Run(faster)) == pytest.approx(radius * np.exp(0.01 * 10.0), rel=1e-3)


def test_contact_measures(grown: Path, tmp_path: Path):
    for dimension, section in ((2, 0.6), (3, 112 * 0.05**2)):
        run = Run(make_strained_run(tmp_path / f"{dimension}", dimension=dimension))
        model = model_of(run.scene)
        expected = model.p * (1.0 - (dimension - 1) * 0.06) * section
        assert measure.arresting_force(model, run) == pytest.approx(expected, rel=0.02)
    frame = Run(grown).frame(0)
    turned = np.where(frame["distance_to_tip"][:, None] < 0.05, [0.8, -0.6, 0.0], [1.0, 0.0, 0.0])
    bent = Frame(0.0, {**frame.fields, "axis": turned})
    assert measure.tip_angle(bent, 2) == pytest.approx(np.arctan2(0.6, 0.8))


def test_overview_of_contact_draws_force_over_time(project: Path, grown: Path, tmp_path: Path):
    touching = shutil.copytree(grown, tmp_path / "run")
    (touching / "history.csv").write_text(
        "time_h,length_mm,tip_y_mm,tip_z_mm,contact_force_N\n"
        + "".join(f"{t},{1.5 + 0.2 * t},{0.01 * t},0,{0.002 * (t > 3)}\n" for t in range(13))
    )
    done = overview(project, touching)
    assert done.returncode == 0, done.stderr
    assert "contact from 4 h" in done.stdout and "largest force 0.002 N/mm" in done.stdout
    assert "deflection at the end 0.12 mm" in done.stdout
    assert (touching / "overview.png").read_bytes().startswith(PNG)


def test_bins_and_determination():
    s, values = np.array([0.05, 0.06, 0.15, 0.35]), np.array([1.0, 3.0, 5.0, 9.0])
    profile = measure.binned(s, values, measure.edges_of(0.3, 0.1))
    assert profile.s_mm == pytest.approx([0.05, 0.15, 0.25])
    assert profile.mean[:2] == pytest.approx([2.0, 5.0]) and np.isnan(profile.mean[2])
    assert [measure.round_width(w) for w in (0.03, 0.025, 0.19, 7.0)] == pytest.approx([0.025, 0.025, 0.1, 5.0])
    assert measure.determination(np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 4.0])) == pytest.approx(0.5)


def test_measured_cell_lengths_are_there():
    distance, length, source = measure.cell_length_data()
    assert (distance[0], length[0], distance[-1], length[-1]) == pytest.approx((0.0125, 7.0, 0.8875, 95.0))
    assert len(distance) == 36 and "Beemster" in source


FAKE_PROGRAM = """#!/usr/bin/python3
import sys
sys.path[:0] = {paths!r}
from pathlib import Path
from synthetic import make_growing_run
if sys.argv[1] == "version":
    print("rootsoil fake")
    sys.exit(0)
given = dict(zip(sys.argv[3::2], sys.argv[4::2]))
with open({log!r}, "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
p = float(given["--set"].removeprefix("pressure.differential_MPa="))
make_growing_run(Path(given["--out"]), pressure=p, duration=float(given["--until"]), cell=0.02)
"""


def test_impedance_series(project: Path, tmp_path: Path):
    program, log, scene, out = tmp_path / "rootsoil", tmp_path / "log", tmp_path / "scene.toml", tmp_path / "series"
    paths = [str(project / "tools"), str(project / "tests" / "tools")]
    program.write_text(FAKE_PROGRAM.format(paths=paths, log=str(log)))
    program.chmod(0o755)
    scene.write_text("[scene]\nduration_h = 12.0\n")
    command = [project / "tools" / "impedance.py", scene, "--out", out, "--program", program]
    command += ["--pressures", "1", "0.5"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (out / "impedance.png").read_bytes().startswith(PNG)
    with (out / "impedance.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {row["p_MPa"] for row in rows} == {"1", "0.5"}
    row = next(row for row in rows if row["p_MPa"] == "0.5")
    model = model_of(Run(out / "p_0.5").scene)
    assert float(row["softening_ug_mm3_h"]) == pytest.approx(model.softening(float(row["distance_mm"])), rel=1e-5)
    assert "relative" in done.stdout and "+0.0%" in done.stdout

    # finished runs are taken as they are; a changed scene is not mistaken for them
    again = subprocess.run(command, capture_output=True, text=True)
    assert again.returncode == 0 and len(log.read_text().splitlines()) == 2
    scene.write_text("[scene]\nduration_h = 12.0\nseed = 2\n")
    refused = subprocess.run(command, capture_output=True, text=True)
    assert refused.returncode == 1 and "another scene" in refused.stderr
    assert len(log.read_text().splitlines()) == 2


def test_impedance_reports_a_run_that_fails(project: Path, tmp_path: Path):
    program, scene = tmp_path / "rootsoil", tmp_path / "scene.toml"
    program.write_text('#!/bin/sh\n[ "$1" = version ] && exit 0\nexit 3\n')
    program.chmod(0o755)
    scene.write_text("[scene]\nduration_h = 12.0\n")
    command = [project / "tools" / "impedance.py", scene, "--out", tmp_path / "out", "--program", program]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1 and "status 3" in done.stderr and "Traceback" not in done.stderr
