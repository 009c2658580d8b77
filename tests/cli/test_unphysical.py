# SPDX-License-Identifier: MIT
"""A run that breaks stops, says which cell, where and when, and keeps what was good."""

from __future__ import annotations

import re

import numpy as np
import pytest
from cli_support import FULL, SECTIONS, SMALL, Program, checkpoint, frames, history, replaced, same_results, summary

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
    """Not hyperbolic: exit status 2, with the place along the root, what is allowed, what to do; no folder is made."""
    law = replaced(FULL, "1020.0", '1020.0\nlaw = "pressure_deviator"')
    done = program("run", program.scene(law), "--out", "out")
    assert done.status == 2
    assert re.search(r"tissue.law: the law is not hyperbolic \S+ mm from the tip", done.err)
    assert "E_R/E_A below 2.7" in done.err and "scene.allow_unstable = true" in done.err
    assert not (program.folder / "out").exists()


def test_a_step_that_is_none_is_refused(program: Program):
    """Zero, negative or beyond an hour: exit status 2. Any other step is stable, since inertia follows it."""
    for step in ("0.0", "-0.001", "3.6"):
        done = program("run", program.scene(replaced(FULL, "step_h = 0.001", f"step_h = {step}")), "--out", "out")
        assert done.status == 2 and "numerics.step_h" in done.err, done.err
        assert not (program.folder / "out").exists()


@pytest.mark.slow
def test_cells_that_divide_without_end(program: Program):
    """A threshold that is tiny only where cells arrive later: cells divide window after window, and the run stops."""
    scene = program.scene(
        replaced(SMALL, "every_h = 0.1", "every_h = 0.01")
        + SECTIONS["pressure"]
        + replaced(SECTIONS["growth"], "1.3e6", "5e6")
        + "[division]\nl0_mm = 1e-5\ns_d_per_mm2 = 1e7\nx_d_mm = 0.08\n"
    )
    out = program.folder / "out"
    done = program(
        "run", scene, "--out", out, "--set", "output.checkpoint_every_h=0.001", "--set", "scene.duration_h=0.4"
    )
    assert done.status == UNPHYSICAL, done.err
    message = done.err[done.err.index("rootsoil: ") :]
    assert re.search(r"divides without end at t = \S+ h: its \d+ cells are on average 1\d\.\d times shorter", message)
    assert re.search(r"Cell \d+, \S+ mm long and 0.0\d* mm from the tip, is \S+ times as long as the thresh", message)
    assert "(division.l0_mm = 1e-05)" in message and "the last good checkpoint of" in message
    found = summary(out)
    assert found["status"] == "unphysical" and found["cells_end"] < 13000  # 6452 measured; 50 at the start
    assert np.all(np.isfinite(checkpoint(out)["cells/position"]))


# A root runs into a plane, with far too much inertia.
CRASH = (
    replaced(FULL, "angle_deg = 60.0", "angle_deg = 90.0")
    .replace("step_h = 0.001", "step_h = 0.005")
    .replace("inertia_error_max = 1e3", "inertia_error_max = 0.05")
)


def test_a_run_outside_its_stated_accuracy_says_so(program: Program):
    """On the screen, in summary.json, at the end, in the picture's words; and within the limit nothing of it."""
    scene = program.scene(replaced(CRASH, "[output]", "[output]\npicture = true"))
    done = program("run", scene, "--out", "out")
    assert done.status == 0, done.err
    found = summary(program.folder / "out")
    measure = found["stated_accuracy"]["inertia_error"]
    assert found["status"] == "done, outside its stated accuracy"
    assert measure["worst"] == found["inertia_error_max"] > measure["limit"] == 0.05
    beyond = [row["time_h"] for row in history(program.folder / "out") if row["inertia_error"] > 0.05]
    assert measure["rows_beyond"] == len(beyond) > 0
    said = done.out + done.err
    assert re.search(r"outside the stated accuracy: inertia_error was \S+ at \S+ h and beyond its limit of 0.05", said)
    assert "done, outside its stated accuracy: " in said
    assert (program.folder / "out" / "overview.png").is_file()

    wide = program("run", scene, "--out", "wide", "--set", "numerics.inertia_error_max=1e3")
    assert wide.status == 0 and "outside" not in wide.out + wide.err
    assert summary(program.folder / "wide")["status"] == "done"


def test_it_stops_there_when_the_scene_says_so(program: Program):
    """Exit status 3 at the first row beyond the limit; with a wider limit it goes on, to the same bits."""
    scene, out = program.scene(CRASH), program.folder / "out"
    done = program("run", scene, "--out", out, "--set", 'numerics.beyond_accuracy="stop"')
    assert done.status == UNPHYSICAL and "outside the stated accuracy: inertia_error was" in done.err, done.err
    assert "take a smaller numerics.step_h" in done.err
    assert summary(out)["status"] == "stopped, outside its stated accuracy"
    rows = history(out)
    assert rows[-1]["inertia_error"] > 0.05 and all(row["inertia_error"] <= 0.05 for row in rows[:-1])
    on = program("run", scene, "--out", out, "--resume", "--set", "numerics.inertia_error_max=1e3")
    assert on.status == 0, on.err
    assert program("run", scene, "--out", "whole", "--set", "numerics.inertia_error_max=1e3").status == 0
    same_results(out, program.folder / "whole")
