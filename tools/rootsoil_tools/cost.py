# SPDX-License-Identifier: MIT
"""What runs cost: sessions of a run whose summary.json tells time, memory and counts."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from rootsoil_tools.runs import read_summary


def set_options(settings: Sequence[str]) -> list[str]:
    """--set for each key=value."""
    return [part for setting in settings for part in ("--set", setting)]


def examine(program: Path, scene: Path, settings: Sequence[str] = ()) -> dict:
    """What `rootsoil check --json` says."""
    command = [str(program), "check", str(scene), "--json", *set_options(settings)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def session(
    program: Path,
    scene: Path,
    folder: Path,
    until_h: float,
    settings: Sequence[str] = (),
    threads: int = 1,
    resume: bool = False,
) -> dict:
    """summary.json of a run that starts anew in its folder, or goes on there, until a time. Times in it are those of
    this session, without a picture. CalledProcessError: it failed."""
    if not resume:
        shutil.rmtree(folder, ignore_errors=True)
    command = [str(program), "run", str(scene), "--out", str(folder), "--threads", str(threads)]
    command += ["--quiet", "--until", repr(until_h)]
    command += ["--resume"] if resume else []
    subprocess.run(
        [*command, *set_options([*settings, "output.picture=false"])],
        check=True,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        env={**os.environ, "OMP_WAIT_POLICY": "passive"},  # a thread that waits takes no processor time
    )
    return read_summary(folder)


def stepping_s(summary: dict) -> float:
    """Processor time of a session (s) but for starting, which older programs do not tell apart."""
    return summary["cpu_s"] - summary.get("cpu_start_s", 0.0)


def hourly_cost(program: Path, scene: Path, hours: Sequence[float], folder: Path) -> list[tuple[float, float, float]]:
    """(from h, to h, processor time per simulated hour in s) of stretches of one run that is paused in between."""
    rows, before = [], 0.0
    for until in hours:
        spent = stepping_s(session(program, scene, folder, until, resume=before > 0.0))
        rows.append((before, until, spent / (until - before)))
        before = until
    return rows
