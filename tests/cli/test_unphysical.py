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


def test_a_step_too_large_for_the_growth(program: Program):
    """Stops as well, names the cell, and no cell is gone: daughters' shares still add up to the cells at the start."""
    fast = replaced(FULL, "lambda0_ug_mm3_h = 1.3e6", "lambda0_ug_mm3_h = 1.3e7")
    scene, out = program.scene(replaced(fast, "step_h = 0.001", "step_h = 0.05")), program.folder / "out"
    done = program("run", scene, "--out", out)
    assert done.status == UNPHYSICAL, done.err
    assert re.search(r"broke at t = \S+ h: cell \d+ changed its volume .*position .*distance from the tip", done.err)
    assert "a step too large for the growth rate" in done.err
    for frame in frames(out):
        assert np.sum(0.5 ** frame["generation"]) == frames(out)[0]["cells"]
    assert np.all(np.isfinite(checkpoint(out)["cells/position"]))


def test_an_unstable_law_is_refused_before_anything_starts(program: Program):
    """Not hyperbolic: exit status 2, with the place along the root, what is allowed and what to do; no folder is made."""
    law = replaced(FULL, "1020.0", '1020.0\nlaw = "pressure_deviator"')
    done = program("run", program.scene(law), "--out", "out")
    assert done.status == 2
    assert re.search(r"tissue.law: the law is not hyperbolic \S+ mm from the tip", done.err)
    assert "E_R/E_A below about 4" in done.err and "scene.allow_unstable = true" in done.err
    assert not (program.folder / "out").exists()


def test_a_step_that_is_none_is_refused(program: Program):
    """Zero, negative or beyond an hour: exit status 2. Any other step is stable, since inertia follows it."""
    for step in ("0.0", "-0.001", "3.6"):
        done = program("run", program.scene(replaced(FULL, "step_h = 0.001", f"step_h = {step}")), "--out", "out")
        assert done.status == 2 and "numerics.step_h" in done.err, done.err
        assert not (program.folder / "out").exists()
