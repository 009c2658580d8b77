# SPDX-License-Identifier: MIT
"""A small root in grains that the real YADE moves: what a run leaves, resume, a YADE that is killed, no open port."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from cli_support import PROJECT, Program, checkpoint, digest, frames, history, same_bits, summary

pytestmark = pytest.mark.slow

SCENE = PROJECT / "scenarios" / "soil_tutorial.toml"
# some 70 grains and 110 cells; the root is in contact from the start
SMALLER = [
    "scene.duration_h=0.12",
    "root.length_mm=1.2",
    "root.cell_size_mm=0.1",
    "root.radius_mm=0.3",
    "soil.box_from_mm=[0.4,-1.5]",
    "soil.box_to_mm=[2.9,1.5]",
    "soil.d_range_mm=[0.3,0.4]",
    "soil.contact.ramp_h=0.02",
    "output.every_h=0.02",
    "output.checkpoint_every_h=0.02",
    "output.picture=false",
]
CHECKPOINT_H = 0.1  # one of them
# longer, and mature from 0.6 mm on; grains touch its flanks up to 0.4 mm from the base
ASLEEP = ["root.length_mm=2.0", "growth.mature_at_mm=0.6", "growth.mature_width_mm=0.1", "sleep.mean_over_h=0.01"]
CLOCKS = {"soil_dem_s", "soil_exchange_s"}  # the machine's, not the model's


@pytest.fixture(scope="module")
def root_in_soil(program_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Program:
    """The program in a folder with a finished run, `whole`; samples go there, too."""
    program = Program(program_path, tmp_path_factory.mktemp("soil"))
    program.environment["ROOTSOIL_CACHE"] = str(program.folder / "cache")
    done = program(*command("whole"))
    assert done.status == 0, done.err
    assert "soil: tip speed" in done.err, "the run checks its speed against the soil's forces"
    return program


def command(out: str, *more: object, settings: Sequence[str] = (), threads: int = 1) -> list[object]:
    """The small scene into a folder."""
    overrides = [word for value in (*SMALLER, *settings) for word in ("--set", value)]
    return ["run", SCENE, "--out", out, "--threads", threads, *overrides, *more]


def yade_of(pid: int) -> int | None:
    """The soil's process, a child of the run's."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    drivers = [int(c) for c in children if b"driver.py" in Path(f"/proc/{c}/cmdline").read_bytes()]
    return drivers[0] if drivers else None


def wait_for_rows(run: Path, process: subprocess.Popen[bytes], rows: int) -> None:
    """Until history.csv has so many rows."""
    until = time.monotonic() + 60.0
    while not (run / "history.csv").exists() or len((run / "history.csv").read_text().splitlines()) <= rows:
        assert process.poll() is None and time.monotonic() < until, "the run did not get far enough"
        time.sleep(0.02)


def same_numbers(a: Path, b: Path) -> None:
    """Two runs agree bit for bit in all but what they read from the clock."""
    rows_a, rows_b = history(a), history(b)
    for row in rows_a + rows_b:
        for name in CLOCKS:
            row.pop(name)
    np.testing.assert_equal(rows_a, rows_b)
    for frame_a, frame_b in zip(frames(a), frames(b), strict=True):
        same_bits(frame_a, frame_b)
    held_a, held_b = checkpoint(a), checkpoint(b)
    names = sorted(CLOCKS)
    for held in (held_a, held_b):
        numbers = [name for name in held if name.endswith("soil/numbers")]
        assert len(numbers) == 1
        # alphabetical, as the columns of history.csv are
        columns = [name for name in (a / "history.csv").read_text().splitlines()[0].split(",")][
            -held[numbers[0]].size :
        ]
        assert columns == sorted(columns) and set(names) < set(columns)
        held[numbers[0]] = np.delete(held[numbers[0]], [columns.index(name) for name in names])
    same_bits(held_a, held_b)


def test_what_a_run_holds(root_in_soil: Program):
    """Grains and contacts in the frames, forces that balance, a root that has pushed."""
    run = root_in_soil.folder / "whole"
    last, row = frames(run)[-1], history(run)[-1]
    grains = len(last["grains/radius"])
    assert grains == row["soil_grains"] > 40
    assert last["grains/position"].shape == (grains, 3) and last["grains/stress"].shape == (grains, 6)
    assert row["soil_tip_force_N"] > 0.0 and row["soil_axial_force_N"] > 0.0 and row["soil_root_work_Nmm"] > 0.0
    assert 0.0 < row["soil_overlap_max"] < 0.1 and 0.0 < row["soil_inertial_number"] < 0.03
    section = 2.0 * row["mean_radius_mm"]
    assert row["soil_tip_resistance_MPa"] == pytest.approx(row["soil_tip_force_N"] / section, rel=1e-6)
    # every grain's contacts are among the listed ones, and the root is one of the bodies that they touch
    ids = np.concatenate([last["soil_contacts/first_id"], last["soil_contacts/second_id"]])
    for grain, count in zip(last["grains/grain_id"], last["grains/contacts"]):
        assert np.count_nonzero(ids == grain) == count
    assert np.any(ids == -1) and np.any(ids == -2)
    # the soil's force on the root, as the markers have it and as the contacts have it
    first, force = last["soil_contacts/first_id"], last["soil_contacts/force"]
    on_root = force[first == -1].sum(axis=0) - force[last["soil_contacts/second_id"] == -1].sum(axis=0)
    markers = last["markers/force"].sum(axis=0)
    assert np.linalg.norm(on_root - markers)[()] < 0.2 * np.linalg.norm(last["markers/force"], axis=1).sum()
    assert "grains" in (run / "run.xmf").read_text()


def test_two_threads_as_one(root_in_soil: Program):
    """Two threads for the root, one for the grains: the same numbers."""
    assert root_in_soil(*command("two", threads=2)).status == 0
    assert summary(root_in_soil.folder / "two")["threads"] == 2
    same_numbers(root_in_soil.folder / "two", root_in_soil.folder / "whole")


def test_resume_changes_nothing(root_in_soil: Program):
    """Killed twice, wherever that happens to be, and paused at the time of a checkpoint: the same numbers."""
    folder = root_in_soil.folder
    resume: list[str] = []
    for rows in (2, 4):
        process = root_in_soil.start(*command("parts", *resume))
        wait_for_rows(folder / "parts", process, rows)
        process.kill()
        assert process.wait() == -signal.SIGKILL
        resume = ["--resume"]
    done = root_in_soil(*command("parts", "--resume", "--until", CHECKPOINT_H))
    assert done.status == 0 and "paused" in done.err, done.err
    done = root_in_soil(*command("parts", "--resume"))
    assert done.status == 0, done.err
    same_numbers(folder / "parts", folder / "whole")


def test_asleep_among_grains(root_in_soil: Program):
    """Tissue that grains press on rests, markers stand still, forces balance; killed and resumed, the same numbers."""
    folder = root_in_soil.folder
    done = root_in_soil(*command("asleep", settings=ASLEEP))
    assert done.status == 0, done.err
    rows, frame = history(folder / "asleep"), frames(folder / "asleep")
    assert min(row["cells_at_rest"] for row in rows[1:]) > 15
    assert summary(folder / "asleep")["momentum_residual"] < 1e-12
    asleep = frame[-1]["asleep"] == 1
    assert np.count_nonzero(frame[-1]["contact_force"][asleep]) > 0, "grains press on cells that sleep"
    resting_mm = (
        frame[-1]["position"][asleep, 0].max() - 0.4
    )  # markers farther from the tip follow cells that sleep only
    place = [dict(zip(f["markers/marker_id"], map(tuple, f["markers/position"]))) for f in frame[1:]]
    still = {marker: x for marker, x in place[0].items() if x[0] < resting_mm}
    assert len(still) > 10
    assert all(still[marker] == after[marker] for after in place[1:] for marker in still)
    process = root_in_soil.start(*command("asleep_parts", settings=ASLEEP))
    wait_for_rows(folder / "asleep_parts", process, 3)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    done = root_in_soil(*command("asleep_parts", "--resume", settings=ASLEEP))
    assert done.status == 0, done.err
    same_numbers(folder / "asleep_parts", folder / "asleep")


def test_yade_is_killed(root_in_soil: Program):
    """Exit status 4, a message that says what is kept, no process left behind, and a checkpoint that goes on."""
    folder = root_in_soil.folder
    with (folder / "said").open("w") as said:
        process = subprocess.Popen(
            root_in_soil.command(*command("killed")), cwd=folder, env=root_in_soil.environment, stderr=said
        )
        wait_for_rows(folder / "killed", process, 4)
        yade = yade_of(process.pid)
        assert yade is not None
        os.kill(yade, signal.SIGKILL)
        assert process.wait(timeout=30) == 4
    text = (folder / "said").read_text()
    assert "was killed by signal 9" in text and "last good checkpoint" in text
    assert summary(folder / "killed")["status"] == "soil failed"
    assert not Path(f"/proc/{yade}").exists()
    done = root_in_soil(*command("killed", "--resume"))
    assert done.status == 0, done.err
    same_numbers(folder / "killed", folder / "whole")


def listening() -> set[str]:
    """Inodes of all sockets that wait for connections from the network, on this machine."""
    found = set()
    for table in ("tcp", "tcp6"):
        lines = Path(f"/proc/net/{table}").read_text().splitlines()[1:]
        found |= {line.split()[9] for line in lines if line.split()[3] == "0A"}
    return found


def test_nobody_listens(root_in_soil: Program):
    """Neither process of a run has a listening socket; killing the run ends YADE."""
    process = root_in_soil.start(*command("ports"))
    wait_for_rows(root_in_soil.folder / "ports", process, 1)
    yade = yade_of(process.pid)
    assert yade is not None
    open_files = [
        os.readlink(f) for pid in (process.pid, yade) for f in Path(f"/proc/{pid}/fd").iterdir() if f.is_symlink()
    ]
    assert any(name.startswith("socket:") for name in open_files), "the two talk over a socket pair"
    assert not {f"socket:[{inode}]" for inode in listening()} & set(open_files)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    until = time.monotonic() + 10.0
    while Path(f"/proc/{yade}").exists() and time.monotonic() < until:
        time.sleep(0.05)
    assert not Path(f"/proc/{yade}").exists()


def test_check_lists_it(root_in_soil: Program):
    """`check` names the effect and both processes, and starts none."""
    before = digest(root_in_soil.folder / "cache")
    found = root_in_soil("check", SCENE, "--json").json()
    assert found["processes"] == ["rootsoil", "yade"]
    assert any(effect["name"] == "soil contact" and effect["active"] for effect in found["effects"])
    assert digest(root_in_soil.folder / "cache") == before
