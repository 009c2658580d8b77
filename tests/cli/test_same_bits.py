# SPDX-License-Identifier: MIT
"""Results do not depend on threads, interruptions or observers: bit for bit."""

from __future__ import annotations

import random
import signal
import time
from pathlib import Path

import numpy as np
import pytest
from cli_support import FULL, SLEEPING, SMALL, Program, checkpoint, frames, history, same_bits, same_results, summary


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


def test_pauses_while_the_root_sleeps(program: Program):
    """Before it falls asleep, asleep, and between the step of pressure and its waking."""
    scene = program.scene(SLEEPING)
    assert program("run", scene, "--out", "whole").status == 0
    resting = [row["cells_at_rest"] for row in history(program.folder / "whole")]
    assert max(resting) > 100 and history(program.folder / "whole")[-1]["times_woken"] == 1
    resume: list[str] = []
    for until in (0.19, 0.2, 0.31, 0.45, 0.46, 0.47):
        assert program("run", scene, "--out", "out", "--until", until, *resume).status == 0
        resume = ["--resume"]
    assert program("run", scene, "--out", "out", "--resume").status == 0
    same_results(program.folder / "out", program.folder / "whole")


def test_the_resolved_scene_resumes(program: Program, full_run: Path):
    """scene.toml in the run's folder goes on as the scene file does."""
    assert program("run", program.scene(FULL), "--out", "out", "--until", 0.15).status == 0
    done = program("run", "out/scene.toml", "--out", "out", "--resume")
    assert done.status == 0, done.err
    same_results(program.folder / "out", full_run)


def test_resume_of_a_finished_run_changes_nothing(program: Program, full_run: Path):
    """--resume after the end leaves the same results, and a longer duration goes on as if it had been asked for at once."""
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
        "run", program.scene(FULL, "same.toml"), "--out", "moved", "--resume", "--set", "output.checkpoint_every_h=0.031"
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
    assert float(checkpoint(out)["attribute time_h"]) == stopped["time_h"]
    assert program("run", scene, "--out", out, "--resume").status == 0
    same_results(out, full_run)


def test_killed_at_random_instants(program: Program, full_run: Path):
    """kill -9 at any instant: every frame can be read, and --resume ends as an uninterrupted run does."""
    scene, out = program.scene(FULL), program.folder / "out"
    chance = random.Random(1)
    reference = frames(full_run)
    for _ in range(8):
        resume = ["--resume"] if (out / "checkpoint.h5").exists() else []
        running = program.start("run", scene, "--out", out, *resume)
        time.sleep(chance.uniform(0.01, 0.35))
        running.kill()
        running.wait()
        if (out / "run.h5").exists():
            written = frames(out)
            assert not (out / "history.csv").exists() or abs(len(written) - len(history(out))) <= 1
            for frame, expected in zip(written, reference):
                same_bits(frame, expected)
    resume = ["--resume"] if (out / "checkpoint.h5").exists() else []
    done = program("run", scene, "--out", out, *resume)
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
    running.wait()
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
