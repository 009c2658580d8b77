# SPDX-License-Identifier: MIT
"""A run that breaks stops, says which cell, where and when, and keeps what was good."""

from __future__ import annotations

import re

import numpy as np
from cli_support import FULL, Program, checkpoint, frames, history, replaced, summary

UNPHYSICAL = 3
# The law whose waves grow by themselves, where that was allowed.
BREAKS = replaced(FULL, "1020.0", '1020.0\nlaw = "pressure_deviator"').replace(
    'name = "full"', 'name = "breaks"\nallow_unstable = true'
)
BREAKS = BREAKS.replace("12000.0", "15300.0").replace("every_h = 0.1\n", "every_h = 0.01\n")


def test_it_stops(program: Program):
    """Exit status 3; the message names cell, place, time and what is kept; frames and checkpoint are good."""
    scene, out = program.scene(BREAKS), program.folder / "out"
    done = program("run", scene, "--out", out)
    assert done.status == UNPHYSICAL, done.err
    message = done.err[done.err.index("rootsoil: ") :]
    assert re.search(r"broke at t = \S+ h: cell \d+ .*position .* mm, distance from the tip \S+ mm", message)
    assert re.search(r"kept: frames until \S+ h and the last good checkpoint of \S+ h in .*out", message)
    assert message.removeprefix("rootsoil: ") in (out / "run.log").read_text()

    broke_h = float(re.search(r"t = (\S+) h", message)[1])
    found = summary(out)
    assert found["status"] == "unphysical" and 0.0 < found["time_h"] <= broke_h + 1e-9
    written = frames(out)
    assert len(written) == len(history(out)) >= 1
    for frame in written:
        assert frame["time_h"] < broke_h
        assert all(np.all(np.isfinite(values)) for values in frame.values())
    state = checkpoint(out)
    assert state["attribute time_h"] < broke_h
    assert np.all(np.isfinite(state["cells/position"]))


def test_it_breaks_again(program: Program):
    """--resume goes on from the good checkpoint and meets the same end."""
    scene, out = program.scene(BREAKS), program.folder / "out"
    first = program("run", scene, "--out", out)
    second = program("run", scene, "--out", out, "--resume")
    assert first.status == second.status == UNPHYSICAL
    message = first.err[first.err.index("rootsoil: ") :]
    assert second.err.endswith(message)


def test_quiet_does_not_hide_it(program: Program):
    """The message comes with --quiet, too."""
    done = program("run", program.scene(BREAKS), "--out", "out", "--quiet")
    assert done.status == UNPHYSICAL and done.err.startswith("rootsoil: the tissue broke")
