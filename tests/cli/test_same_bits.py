# SPDX-License-Identifier: MIT
"""Results do not depend on threads, interruptions or observers: bit for bit."""

from __future__ import annotations

import random
import re
import signal
import time
from pathlib import Path

import numpy as np
import pytest
from cli_support import (
    BALANCED,
    FULL,
    SECTIONS,
    SLEEPING,
    SMALL,
    Program,
    checkpoint,
    frames,
    history,
    replaced,
    same_bits,
    same_results,
    summary,
)


def test_the_scene_has_it_all(full_run: Path):
    """The scene that the others compare divides in every output interval, grows, and touches the wall."""
    rows = history(full_run)
    assert all(after["divisions"] > before["divisions"] for before, after in zip(rows, rows[1:]))
    assert max(row["contact_force_N"] for row in rows) > 0.0
    assert rows[-1]["length_mm"] > rows[0]["length_mm"]
    last = frames(full_run)[-1]
    assert np.ptp(last["radial_modulus"]) > 1000.0
    assert np.any(checkpoint(full_run)["solver/slip_mm"] != 0.0)


def test_two_threads_as_one(program: Program, full_run: Path):
    """Two threads give every number of run.h5, history.csv, checkpoint.h5 and summary.json as one does."""
    assert program("run", program.scene(FULL), "--out", "two", "--threads", 2).status == 0
    assert summary(program.folder / "two")["threads"] == 2
    same_results(program.folder / "two", full_run)


def test_pauses_at_awkward_times(program: Program, full_run: Path):
    """Pauses within an output interval, and sessions with other numbers of threads, change nothing."""
    scene, out = program.scene(FULL), program.folder / "out"
    resume: list[str] = []
    for until, threads in ((0.0005, 1), (0.137, 1), (0.1, 1), (0.2, 2), (0.2511, 1)):
        done = program("run", scene, "--out", out, "--until", until, "--threads", threads, *resume)
        assert done.status == 0 and "paused" in done.err, done.err
        assert summary(out)["status"] == "paused"
        resume = ["--resume"]
    done = program("run", scene, "--out", out, "--resume", "--threads", 2)
    assert done.status == 0, done.err
    same_results(out, full_run)


def test_a_pause_leaves_a_last_frame(program: Program, full_run: Path):
    """Where a run pauses it writes a frame and a row, which are gone when it goes on; a session without a window of its
    own leaves all as it is."""
    scene, out = program.scene(FULL + "picture = true\n"), program.folder / "out"
    assert program("run", scene, "--out", out, "--until", 0.137).status == 0
    paused = summary(out)
    assert paused["status"] == "paused" and 0.137 <= paused["time_h"] < 0.15
    assert [float(frame["time_h"]) for frame in frames(out)] == [0.0, 0.1, paused["time_h"]]
    assert [row["time_h"] for row in history(out)] == [0.0, 0.1, paused["time_h"]]
    assert frames(out)[-1]["step"] == paused["steps"] and np.all(np.abs(frames(out)[-1]["axial_strain_rate"]) < 5.0)
    assert np.any(frames(out)[-1]["axial_strain_rate"] > 0.1)
    assert (out / "overview.png").stat().st_size > 10_000
    quiet = ("--resume", "--set", "output.picture=false")
    before = frames(out)
    assert program("run", scene, "--out", out, "--until", 0.12, *quiet).status == 0
    for frame, expected in zip(frames(out), before, strict=True):
        same_bits(frame, expected)
    assert program("run", scene, "--out", out, "--until", 0.3, *quiet).status == 0
    assert [float(frame["time_h"]) for frame in frames(out)] == [0.0, 0.1, 0.2, 0.3]
    assert program("run", scene, "--out", out, *quiet).status == 0
    same_results(out, full_run)


@pytest.mark.parametrize("numerics", ['stepper = "symplectic"\nstep_h = 2e-4', "step_h = 0.01"])
def test_pauses_while_the_root_sleeps(program: Program, numerics: str):
    """Before it falls asleep, asleep, and between the step of pressure and its waking; with inertia and without."""
    scene = program.scene(replaced(SLEEPING, 'stepper = "symplectic"\nstep_h = 2e-4', numerics))
    assert program("run", scene, "--out", "whole").status == 0
    rows = history(program.folder / "whole")
    woken = rows[-1]["times_woken"]
    assert max(row["cells_at_rest"] for row in rows) > 100 and (woken == 1 if "symplectic" in numerics else woken >= 1)
    resume: list[str] = []
    for until in (0.19, 0.2, 0.31, 0.45, 0.46, 0.47):
        assert program("run", scene, "--out", "out", "--until", until, *resume).status == 0
        resume = ["--resume"]
    assert program("run", scene, "--out", "out", "--resume").status == 0
    same_results(program.folder / "out", program.folder / "whole")


def test_without_inertia_too(program: Program):
    """Steps that end in balance: the same for two threads, and after pauses, a signal and kills."""
    scene = program.scene(BALANCED)
    assert program("run", scene, "--out", "whole", "--threads", 1).status == 0
    whole = program.folder / "whole"
    rows = history(whole)
    assert rows[-1]["divisions"] > 0 and max(row["contact_force_N"] for row in rows) > 0.0
    assert 0.0 < max(row["force_imbalance"] for row in rows) <= 1e-4
    assert program("run", scene, "--out", "two", "--threads", 2).status == 0
    same_results(program.folder / "two", whole)
    resume: list[str] = []
    for until, threads in ((0.0005, 1), (0.137, 2), (0.2511, 1)):
        assert program("run", scene, "--out", "out", "--until", until, "--threads", threads, *resume).status == 0
        resume = ["--resume"]
    out, killed_h = program.folder / "out", []
    for _ in range(4):
        before = written(out / "checkpoint.h5")
        running = program.start("run", scene, "--out", out, "--resume", "--set", "output.checkpoint_every_h=0.005")
        while written(out / "checkpoint.h5") == before and running.poll() is None:
            time.sleep(0.001)
        running.kill()
        if running.wait() == 0:
            break
        killed_h.append(float(checkpoint(out)["attribute time_h"]))
    assert any(0.2511 < time_h < 0.4 for time_h in killed_h), "no kill found the run at work"
    assert program("run", scene, "--out", out, "--resume").status == 0
    same_results(out, whole)


def test_the_resolved_scene_resumes(program: Program, full_run: Path):
    """scene.toml in the run's folder goes on as the scene file does."""
    assert program("run", program.scene(FULL), "--out", "out", "--until", 0.15).status == 0
    done = program("run", "out/scene.toml", "--out", "out", "--resume")
    assert done.status == 0, done.err
    same_results(program.folder / "out", full_run)


MEASURED_CELLS = (
    "Label,pos.X (um),pos.Y (um),pos.Z (um),e1.X,e1.Y,e1.Z,e2.X,e2.Y,e2.Z,r1 (um),r2 (um),r3 (um)\n"
    + "".join(
        f"{100 * i + 10 * j + k},{10 * i},{10 * j},{10 * k},1,0,0,0,1,0,5,5,5\n"
        for i in range(10)
        for j in range(3)
        for k in range(3)
    )
)
MEASURED_ROOT = replaced(SMALL, 'name = "small"', "dimension = 3").replace(
    "length_mm = 0.1\nradius_mm = 0.02\ncell_size_mm = 0.01", 'cells_file = "cells.csv"'
) + "".join(SECTIONS[name] for name in ("pressure", "growth"))


def test_scene_and_cells_moved_together(program: Program):
    """A run goes on wherever scene and cell file lie now, whatever their names are, as long as they hold the same."""
    here, there = program.folder / "here", program.folder / "there"
    here.mkdir()
    (here / "cells.csv").write_text(MEASURED_CELLS)
    (here / "scene.toml").write_text(MEASURED_ROOT)
    assert program("run", here / "scene.toml", "--out", "whole").status == 0
    assert program("run", here / "scene.toml", "--out", "parts", "--until", 0.1).status == 0
    here.rename(there)
    (there / "cells.csv").rename(there / "same.csv")
    (there / "scene.toml").write_text(replaced(MEASURED_ROOT, "cells.csv", "same.csv"))
    done = program("run", there / "scene.toml", "--out", "parts", "--resume")
    assert done.status == 0, done.err
    same_results(program.folder / "parts", program.folder / "whole")


def test_other_cells_in_the_same_place(program: Program):
    """A cell file that holds something else belongs to another run, where it lies and what it is called in spite; a key
    that differs as well is named even where the old file is gone."""
    (program.folder / "cells.csv").write_text(MEASURED_CELLS)
    scene = program.scene(MEASURED_ROOT)
    assert program("run", scene, "--out", "out", "--until", 0.1).status == 0
    (program.folder / "cells.csv").write_text(replaced(MEASURED_CELLS, "900,90,0,0", "900,91,0,0"))
    done = program("run", scene, "--out", "out", "--resume")
    assert done.status == 2 and "belongs to another scene" in done.err, done.err
    assert re.search(r'given:   root.cells_file = ".*cells.csv" \(held something else\)', done.err), done.err
    (program.folder / "cells.csv").rename(program.folder / "others.csv")
    other = replaced(replaced(MEASURED_ROOT, "cells.csv", "others.csv"), "c_g = -0.95", "c_g = -0.9")
    done = program("run", program.scene(other), "--out", "out", "--resume")
    assert done.status == 2 and "given:   growth.c_g = -0.9 (was -0.95)\n" in done.err, done.err


def test_until_beyond_the_end(program: Program):
    """However far beyond, also where no counter reaches: the run ends at its end."""
    scene = program.scene(SMALL)
    for until in ("1", "1e17", "1e308", "inf"):
        assert program("run", scene, "--out", until, "--until", until).status == 0
        found = summary(program.folder / until)
        assert (found["status"], found["time_h"]) == ("done", 0.2)


def test_resume_of_a_finished_run_changes_nothing(program: Program, full_run: Path):
    """--resume after the end leaves the same results; a longer duration goes on as if it had been asked for at once."""
    scene = program.scene(FULL)
    assert program("run", scene, "--out", "out", "--set", "scene.duration_h=0.3").status == 0
    assert program("run", scene, "--out", "out", "--resume").status == 0
    assert program("run", scene, "--out", "out", "--resume").status == 0
    same_results(program.folder / "out", full_run)


def test_what_may_change_on_resume(program: Program, full_run: Path):
    """Other checkpoint times, a folder that has moved and a scene file of another name change no bit."""
    assert program("run", program.scene(FULL), "--out", "out", "--until", 0.05).status == 0
    (program.folder / "out").rename(program.folder / "moved")
    done = program(
        "run",
        program.scene(FULL, "same.toml"),
        "--out",
        "moved",
        "--resume",
        "--set",
        "output.checkpoint_every_h=0.031",
    )
    assert done.status == 0, done.err
    same_results(program.folder / "moved", full_run)


def test_a_longer_static_run_keeps_its_step(program: Program):
    """The step of a static scene follows from its duration; a run that is lengthened keeps the one it began with."""
    scene = program.scene(SMALL)
    assert program("run", scene, "--out", "out").status == 0
    before = summary(program.folder / "out")
    done = program("run", scene, "--out", "out", "--resume", "--set", "scene.duration_h=0.4")
    assert done.status == 0, done.err
    after = summary(program.folder / "out")
    assert after["time_h"] == 0.4 and after["dt_h"] == before["dt_h"] and after["steps"] == 2 * before["steps"]


@pytest.mark.parametrize("numerics", ["step_h = 0.005", 'stepper = "symplectic"\nstep_h = 0.001\nwindow_steps = 7'])
def test_what_the_root_perceives_is_kept(program: Program, numerics: str):
    """A root that answers the wall that it feels: the same for two threads and after pauses, and not as one that does
    not feel it."""
    keys = "x_e_mm = 0.05\ns_e_per_mm = 40.0\nc_e = 0.2\n"
    text = replaced(replaced(BALANCED, keys, ""), "step_h = 0.005", numerics)
    text += """
[response]
over_h = 0.05
follows = "perceived"
[response.anisotropy]
p_MPa = [1.0, 0.0]
x_e_mm = [0.05, 0.02]
s_e_per_mm = [40.0, 60.0]
c_e = [0.2, 0.1]
"""
    scene = program.scene(text)
    assert program("run", scene, "--out", "whole", "--threads", 1).status == 0
    whole = program.folder / "whole"
    felt = [row["perceived_pressure_MPa"] for row in history(whole)]
    assert felt[0] == 1.0 and 0.0 <= min(felt) < 0.99, felt
    resume: list[str] = []
    for until, threads in ((0.137, 1), (0.25, 2)):
        assert program("run", scene, "--out", "out", "--until", until, "--threads", threads, *resume).status == 0
        resume = ["--resume"]
    assert program("run", scene, "--out", "out", "--resume", "--threads", 2).status == 0
    same_results(program.folder / "out", whole)
    scene = program.scene(replaced(replaced(text, "over_h = 0.05\n", ""), '"perceived"', '"pressure"'))
    assert program("run", scene, "--out", "unfelt", "--threads", 1).status == 0
    assert "perceived_pressure_MPa" not in history(program.folder / "unfelt")[0]
    assert "response/tip_thrust_MPa" not in checkpoint(program.folder / "unfelt")
    assert history(program.folder / "unfelt")[-1]["length_mm"] != history(whole)[-1]["length_mm"]


def wait_for(path: Path, lines: int) -> None:
    """Until a text file has so many lines."""
    end = time.monotonic() + 120
    while not (path.exists() and path.read_text().count("\n") >= lines):
        assert time.monotonic() < end, f"{path} does not grow"
        time.sleep(0.005)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal(program: Program, full_run: Path, number: int):
    """Ctrl-C and kill end a run with status 130 and a checkpoint; it then goes on to the same result."""
    scene, out = program.scene(FULL), program.folder / "out"
    running = program.start("run", scene, "--out", out)
    wait_for(out / "history.csv", 3)
    running.send_signal(number)
    assert running.wait(120) == 130
    stopped = summary(out)
    assert stopped["status"] == "interrupted" and 0.1 <= stopped["time_h"] < 0.4
    assert float(checkpoint(out)["attribute time_h"]) == stopped["time_h"] == history(out)[-1]["time_h"]
    assert program("run", scene, "--out", out, "--resume").status == 0
    same_results(out, full_run)


def written(path: Path) -> int | None:
    """When a file was replaced by what it is now; None where there is none."""
    return path.stat().st_mtime_ns if path.exists() else None


def test_killed_at_random_instants(program: Program, full_run: Path):
    """kill -9 at any instant: every frame can be read, and --resume ends as an uninterrupted run does."""
    scene, out = program.scene(FULL), program.folder / "out"
    chance = random.Random(1)
    reference = frames(full_run)
    killed_h = []  # time of the checkpoint that each kill left
    for kill in range(8):
        before = written(out / "checkpoint.h5")
        running = program.start("run", scene, "--out", out, *(["--resume"] if before else []))
        # Every other one at work, whatever the machine's speed: one of 30 checkpoints of the run has just been written.
        while kill % 2 == 0 and written(out / "checkpoint.h5") == before and running.poll() is None:
            time.sleep(0.001)
        time.sleep(chance.uniform(0.0, 0.03 if kill % 2 == 0 else 0.06))
        running.kill()
        if running.wait() == 0:
            break
        assert running.returncode == -signal.SIGKILL
        if (out / "checkpoint.h5").exists():
            killed_h.append(float(checkpoint(out)["attribute time_h"]))
        if (out / "run.h5").exists():
            found = frames(out)
            assert not (out / "history.csv").exists() or abs(len(found) - len(history(out))) <= 1
            for frame, expected in zip(found, reference):
                same_bits(frame, expected)
    assert any(0.0 < time_h < 0.4 for time_h in killed_h), "no kill found the run at work"
    done = program("run", scene, "--out", out, "--resume")
    assert done.status == 0, done.err
    same_results(out, full_run)


def test_killed_before_the_first_frame(program: Program, full_run: Path):
    """A folder with any trace of a run has a checkpoint, and one of time 0 goes on like any other."""
    scene, out = program.scene(FULL), program.folder / "out"
    running = program.start("run", scene, "--out", out)
    while not (out / "checkpoint.h5").exists() and running.poll() is None:
        time.sleep(0.0005)
        traces = [name for name in ("scene.toml", "run.h5", "history.csv") if (out / name).exists()]
        assert not traces or (out / "checkpoint.h5").exists()
    running.kill()
    assert running.wait() == -signal.SIGKILL
    done = program("run", scene, "--out", out, "--resume")
    assert done.status == 0, done.err
    same_results(out, full_run)


def test_a_probe_only_looks(program: Program, full_run: Path):
    """Probes, at a cell and in a bin, leave every result as it is, and write a row for each output time."""
    text = FULL + '\n[[probe]]\nname = "cell"\nposition_mm = [0.2, 0.0]\n'
    text += '\n[[probe]]\nname = "bin"\ndistance_to_tip_mm = [0.1, 0.2]\n'
    assert program("run", program.scene(text), "--out", "out").status == 0
    out = program.folder / "out"
    for frame, expected in zip(frames(out), frames(full_run), strict=True):
        same_bits({name: frame[name] for name in expected}, expected)
    assert (out / "history.csv").read_text() == (full_run / "history.csv").read_text()
    state, expected_state = checkpoint(out), checkpoint(full_run)
    del expected_state["attribute scene_digest"]
    same_bits({name: state[name] for name in expected_state}, expected_state)
    times = [row["time_h"] for row in history(full_run)]
    for name in ("cell", "bin"):
        assert [row["time_h"] for row in history(out, f"probe_{name}.csv")] == times


def test_probes_resume(program: Program):
    """The tables of probes, too, are the same after a pause."""
    scene = program.scene(FULL + '\n[[probe]]\nname = "cell"\nposition_mm = [0.2, 0.0]\n')
    assert program("run", scene, "--out", "whole").status == 0
    assert program("run", scene, "--out", "parts", "--until", 0.23).status == 0
    assert program("run", scene, "--out", "parts", "--resume").status == 0
    same_results(program.folder / "whole", program.folder / "parts")
    whole, parts = ((program.folder / name / "probe_cell.csv").read_text() for name in ("whole", "parts"))
    assert whole == parts
