# SPDX-License-Identifier: MIT
"""overview.py and impedance.py, and the measures they share, on run folders made without the solver."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from matplotlib import pyplot as plt
from overview import draw_contact, percent
from synthetic import make_growing_run, make_strained_run

from rootsoil_tools import measure, published
from rootsoil_tools.kinematics import HALF_WIDTH_MM, OUTPUTS, curve
from rootsoil_tools.runs import Frame, Run, RunError
from rootsoil_tools.theory import growth_ends

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
    """Of a run that has just begun: the speed is that of the start, and nothing is said that is not known."""
    run = make_growing_run(tmp_path / "run", name="arabidopsis", frames=2, duration=1.0)
    with h5py.File(run / "run.h5", "r+") as file:
        del file["frames/000001"]
    header, first, _ = (run / "history.csv").read_text().splitlines()
    (run / "history.csv").write_text(f"{header}\n{first}\n")
    done = overview(project, run)
    assert done.returncode == 0, done.stderr
    said = re.search(r"tip speed (\S+) mm/h \(closed form (\S+) mm/h\)", done.stdout)
    assert said and float(said[1]) == pytest.approx(float(said[2]), rel=0.01)
    assert "nan" not in done.stdout and done.stderr == ""
    (run / "history.csv").unlink()
    assert "nan" not in overview(project, run).stdout


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
        model = run.frame(-1).closed_form
        edges = measure.edges_of(1.5, 0.1)
        strains = measure.strain_profiles(run.frame(0), run.frame(1), dimension, edges)
        axial, radial = (np.log1p(e) for e in strains)
        middle = (edges[1:] + edges[:-1]) / 2.0
        assert axial == pytest.approx(model.at("axial_strain", middle), rel=1e-6)
        assert radial[4:] == pytest.approx(model.at("radial_strain", middle[4:]), abs=3e-6)


def test_growth_profiles_find_the_closed_form(grown: Path):
    run = Run(grown)
    model = run.frame(-1).closed_form
    rate = measure.growth_profiles(run, measure.edges_of(1.0, 0.05))["axial_strain_rate"]
    assert rate.mean[2:] == pytest.approx(model.axial_rate(rate.s_mm[2:]), abs=0.02)
    assert measure.tip_speed(run) == pytest.approx(model.tip_speed(3.0), rel=0.02)


def test_drift_of_the_mature_radius(grown: Path, tmp_path: Path):
    """In 2D the radius goes as the volumes: 1 % more of them an hour drifts by 0.01 /h more."""
    faster = shutil.copytree(grown, tmp_path / "run")
    with h5py.File(faster / "run.h5", "r+") as file:
        for group in file["frames"].values():
            group["volume"][...] *= np.exp(0.01 * group.attrs["time_h"])
    model = Run(grown).frame(-1).closed_form
    radius, drift = (f(model, Run(grown)) for f in (measure.mature_radius, measure.radius_drift))
    assert np.isfinite(radius) and np.isfinite(drift)
    assert measure.radius_drift(model, Run(faster)) == pytest.approx(drift + 0.01, abs=1e-9)
    assert measure.mature_radius(model, Run(faster)) == pytest.approx(radius * np.exp(0.01 * 10.0), rel=1e-3)


def test_tissue_of_the_start_is_not_mature(tmp_path: Path):
    """In a slow root new tissue has left the growth zone at the end, but not yet when a longer window begins."""
    run = Run(make_growing_run(tmp_path / "run", pressure=0.5, cell=0.02))
    model = run.frame(-1).closed_form
    assert measure.mature_radii(model, run, 1.0)[0] == pytest.approx([11.0, 12.0], abs=1e-6)
    assert measure.mature_radii(model, run, 10.0)[0].size == 0


def test_contact_measures(grown: Path, tmp_path: Path):
    for dimension, section in ((2, 0.6), (3, 112 * 0.05**2)):
        run = Run(make_strained_run(tmp_path / f"{dimension}", dimension=dimension))
        model = run.frame(-1).closed_form
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


def texts(project: Path, run: Path) -> str:
    """All words in the picture, and what the tool says, with spaces in between."""
    done = overview(project, run, "--out", str(run / "overview.svg"))
    assert done.returncode == 0, done.stderr
    svg = (run / "overview.svg").read_text(encoding="utf-8")
    return " ".join(re.findall(r">([^<>]+)</text>", svg)) + " " + done.stdout


def test_the_legend_names_what_is_drawn(project: Path, grown: Path, tmp_path: Path):
    """Steady growth (of cell lengths this run knows no closed form), the band and the data: only where there is any."""
    full = texts(project, shutil.copytree(grown, tmp_path / "grown"))
    for part in ("simulation, mean of 8–12 h", "16–84 %", "closed form (D: steady growth)", "Beemster"):
        assert part in full, full
    # one column of cells, seen once, has neither a steady state nor a band
    young = make_growing_run(tmp_path / "young", name="young", duration=0.02, radius=0.02, cell=0.04, frames=2)
    with h5py.File(young / "run.h5", "r+") as file:
        del file["frames/000001"]
    words = texts(project, young)
    assert "simulation, 0 h" in words and "closed form" in words
    assert "steady growth" not in words and "16–84 %" not in words and "Beemster" not in words
    strained = texts(project, make_strained_run(tmp_path / "strained", cell=0.06))
    assert "simulation, 8 h Eq. 8" in strained and "closed form" not in strained


def test_strain_that_has_not_settled_is_not_judged(project: Path, tmp_path: Path):
    """A run that was paused early says so beside its distance from Eq. 8."""
    run = make_strained_run(tmp_path / "run", cell=0.06)
    assert "settled" not in texts(project, run)
    scene = (run / "scene.toml").read_text()
    (run / "scene.toml").write_text(scene.replace("duration_h = 8.0", "duration_h = 80.0"))
    words = texts(project, run)
    assert words.count("not settled at 8 of 80 h: off ") == 2 and words.count("it has not settled: 8 of 80 h") == 2


@pytest.mark.parametrize("force, deflection", [(0.002, 0.12), (120.0, 0.12), (0.002, 5e-6)])
def test_contact_panels_show_all_of_it_and_no_more(grown: Path, tmp_path: Path, force: float, deflection: float):
    """However large the force is, it lies below the panel's top; a deflection that is none does not look like one."""
    touching = shutil.copytree(grown, tmp_path / "run")
    (touching / "history.csv").write_text(
        "time_h,length_mm,tip_y_mm,tip_z_mm,contact_force_N\n"
        + "".join(f"{t},{1.5 + 0.2 * t},{deflection * t / 12},0,{force * (t > 3)}\n" for t in range(13))
    )
    run = Run(touching)
    model = run.frame(-1).closed_form
    _, panels = plt.subplots(1, 3)
    draw_contact(run, model, panels)
    assert panels[0].get_ylim()[1] >= 1.5 * max(force, measure.arresting_force(model, run))
    top = panels[1].get_ylim()[1]
    cell = float(np.median(run.frame(0)["cell_axes"][:, 0]))
    assert top >= max(deflection, 0.1 * cell) and top < 1.2 * max(deflection, 0.1 * cell)
    plt.close()


def test_one_number_has_one_form(project: Path, grown: Path, tmp_path: Path):
    """What is outside its limit stands in the picture with the digits that run.log gives it."""
    run = shutil.copytree(grown, tmp_path / "run")
    measures = {"inertia_error": {"limit": 0.05, "worst": 231.4, "at_h": 0.1, "rows": 4, "rows_beyond": 2}}
    (run / "summary.json").write_text(json.dumps({"stated_accuracy": measures}))
    assert texts(project, run).count("inertia error 231 at 0.1 h (limit 0.05)") == 2
    assert [percent(x) for x in (0.0123456, 95.401, 1227.6, 23141.0)] == ["0.0123 %", "95.4 %", "1228 %", "23141 %"]


def test_bins_and_determination():
    s, values = np.array([0.05, 0.06, 0.15, 0.35]), np.array([1.0, 3.0, 5.0, 9.0])
    profile = measure.binned(s, values, measure.edges_of(0.3, 0.1))
    assert profile.s_mm == pytest.approx([0.05, 0.15, 0.25])
    assert profile.mean[:2] == pytest.approx([2.0, 5.0]) and np.isnan(profile.mean[2])
    assert [measure.round_width(w) for w in (0.03, 0.025, 0.19, 7.0)] == pytest.approx([0.025, 0.025, 0.1, 5.0])


def test_agreement_with_a_published_curve():
    found = published.fit(np.array([1.0, 2.0, 4.0]), np.array([1.0, 2.0, 5.0]))
    assert (found.r2, found.rmse, found.relative_error) == pytest.approx((1.0 - 3.0 / 14.0, 3.0**-0.5, 1.0 / 12.0))


def test_published_curves_are_there():
    for quantity, points, first in (
        ("cell_length", 23, (0.0121, 9.2938)),
        ("strain_rate", 26, (0.015, 3.9537)),
        ("division_rate", 20, (0.0291, 0.042965)),
    ):
        at_mm, values = published.arabidopsis(quantity)
        assert len(at_mm) == points and (at_mm[0], values[0]) == pytest.approx(first)


def test_published_numbers_have_a_source():
    found = published.reference("growth zone in soft soil", "pea")
    assert (found.low, found.high, found.unit) == (12.1, 13.3, "mm") and "Croser" in found.source
    with pytest.raises(ValueError, match="no published value of growth zone in soft soil .maize.*in hard soil .pea"):
        published.reference("growth zone in soft soil", "maize")


def test_where_growth_ends():
    s = np.array([1.0, 2.0, 3.0, 4.0])
    assert growth_ends(s, np.array([1.0, 0.04, 0.06, 0.04])) == pytest.approx(3.5)
    assert growth_ends(s, np.array([1.0, 0.08, 0.04, 0.04])) == pytest.approx(2.75)
    assert growth_ends(s, np.ones(4)) == growth_ends(s, np.zeros(4)) == 4.0


class TwoFrames:
    """Six cells 0.1 mm apart; within 2 h the second divides, and one that was not there before as well."""

    times_h, dimension = np.array([0.0, 2.0]), 2

    def frame(self, index: int) -> dict:
        ids = [[0, 1, 2, 3, 4, 5], [0, 6, 7, 2, 3, 4, 5, 8]][index]
        mothers = [[-1] * 6, [-1, 1, 1, -1, -1, -1, -1, 9]][index]
        places = [[0.05, 0.15, 0.25, 0.35, 0.45, 0.55], [0.05, 0.15, 0.19, 0.27, 0.37, 0.47, 0.57, 0.6]][index]
        return {"cell_id": np.array(ids), "parent_id": np.array(mothers), "distance_to_tip": np.array(places)}


def test_division_rate_counts_mothers_between_frames():
    rates = measure.division_rates(TwoFrames(), [0, 1], np.array([0.16, 0.46, 3.0]), 0.05)
    assert rates[0, :2] == pytest.approx([1.0 / (1.5 * 2.0), 0.0]) and np.isnan(rates[0, 2])


def growth_curves(project: Path, run: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([project / "tools" / "growth_curves.py", run, *options], capture_output=True, text=True)


def test_growth_curves_beside_measured_ones(project: Path, grown: Path, tmp_path: Path):
    done = growth_curves(project, grown, "--out", str(tmp_path / "curves.png"))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "curves.png").read_bytes().startswith(PNG)
    for line in (
        "axial strain rate: R^2 ",
        "cell length: R^2 ",
        "division rate: R^2 ",
        "radius over the first 1.2 mm: ",
    ):
        assert line in done.stdout, done.stdout
    missing = growth_curves(project, tmp_path)
    assert missing.returncode == 1 and "no picture of" in missing.stderr and "Traceback" not in missing.stderr


def test_one_run_has_one_agreement(project: Path, tmp_path: Path):
    """The overview and growth_curves compare the same outputs with Beemster & Baskin, and say which."""
    run = make_growing_run(tmp_path / "run", name="arabidopsis", frames=50)
    curves, whole = growth_curves(project, run).stdout, overview(project, run).stdout
    for quantity in ("axial strain rate", "cell length"):
        by_curves = re.search(rf"^{quantity}: R\^2 (\S+),", curves, re.M)
        by_overview = re.search(rf"^{quantity}, Beemster & Baskin 1998: R\^2 = (\S+) \(mean of (\S+) to", whole, re.M)
        assert by_curves and by_overview and by_curves[1] == by_overview[1]
        assert float(by_overview[2]) == pytest.approx(Run(run).times_h[-OUTPUTS], rel=1e-2)


def test_growth_curves_measure_what_cells_have(grown: Path):
    run = Run(grown)
    frames = [run.frame(index) for index in range(len(run.times_h))[-OUTPUTS:]]
    place = float(np.median(frames[-1]["distance_to_tip"]))
    near = [np.abs(f["distance_to_tip"] - place) <= HALF_WIDTH_MM["cell_length"] for f in frames]
    expected = [1e3 * f.axial_lengths(2)[n].mean() for f, n in zip(frames, near) if n.any()]
    lengths = curve(run, "cell_length", np.array([place]))
    assert lengths.mean()[0] == pytest.approx(np.mean(expected))
    assert lengths.standard_error()[0] == pytest.approx(np.std(expected) / np.sqrt(len(expected)))
    assert len(curve(run, "division_rate", np.array([place])).values) == len(run.times_h) - 1


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
    scene.write_text("[scene]\nduration_h = 18.0\n")
    command = [project / "tools" / "impedance.py", scene, "--out", out, "--program", program]
    command += ["--pressures", "1", "0.5"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (out / "impedance.png").read_bytes().startswith(PNG)
    with (out / "impedance.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {row["p_MPa"] for row in rows} == {"1", "0.5"}
    row = next(row for row in rows if row["p_MPa"] == "0.5")
    model = Run(out / "p_0.5").frame(-1).closed_form
    assert float(row["softening_ug_mm3_h"]) == pytest.approx(
        float(model.at("softening", float(row["distance_mm"]))), rel=1e-5
    )
    # strain rates against Eq. 6 at the same p, over its growth zone; radii against those of the softest soil
    with (out / "impedance_series.csv").open() as file:
        series = {row["p_MPa"]: {key: float(value) for key, value in row.items()} for row in csv.DictReader(file)}
    assert series.keys() == {"1", "0.5"}
    for p, found in series.items():
        run = Run(out / f"p_{p}")
        model = run.frame(-1).closed_form
        of_p = [row for row in rows if row["p_MPa"] == p and float(row["distance_mm"]) < model.growth_zone(3.0)]
        exact, measured = (
            np.array([float(row[f"axial_strain_rate{of}_per_h"]) for row in of_p]) for of in ("_closed_form", "")
        )
        filled = np.isfinite(measured)
        fit = published.fit(exact[filled], measured[filled])
        assert (found["rate_R2"], found["rate_RMSE_per_h"]) == pytest.approx((fit.r2, fit.rmse), rel=1e-4)
        assert found["rate_R2"] > 0.99 and 0.0 < found["rate_RMSE_per_h"] < 0.02 * found["peak_rate_per_h"]
        assert found["growth_zone_mm"] == pytest.approx(model.growth_zone(3.0), abs=0.05)
        assert found["mature_radius_mm"] == pytest.approx(measure.mature_radius(model, run), rel=1e-5)
        assert found["drift_percent_10h"] == pytest.approx(1e3 * measure.radius_drift(model, run), rel=1e-5)
    assert series["1"]["relative_radius"] == 1.0
    ratio = series["0.5"]["mature_radius_mm"] / series["1"]["mature_radius_mm"]
    assert series["0.5"]["relative_radius"] == pytest.approx(ratio, rel=1e-5) and ratio != 1.0
    # the published number stands beside what was found
    wider = published.reference("diameter increase soft to hard soil", "pea")
    said = re.search(r"hard over soft soil, less 1: (\S+), published (\S+) \((.*)\)", done.stdout)
    assert said and float(said[1]) == pytest.approx(ratio - 1.0, rel=0.01)
    assert (float(said[2]), said[3]) == (wider.low, wider.source)

    # finished runs are taken as they are; a changed scene is not mistaken for them
    again = subprocess.run(command, capture_output=True, text=True)
    assert again.returncode == 0 and len(log.read_text().splitlines()) == 2
    scene.write_text("[scene]\nduration_h = 18.0\nseed = 2\n")
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
