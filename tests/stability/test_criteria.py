# SPDX-License-Identifier: MIT
"""The criteria see what they are there for: a lost cell, a crack, rough motion, a bad number."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from hard_cases import DEFAULT, PAPER, cases, scene_text
from rootsoil_tools import criteria, stability_report
from rootsoil_tools.runs import Frame

SIZE_MM = 0.02


def block(across: int = 6, along: int = 20) -> Frame:
    """A lattice of round cells that were all born with it."""
    x, y = np.meshgrid(np.arange(along) * SIZE_MM, np.arange(across) * SIZE_MM, indexing="ij")
    position = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    n = len(position)
    shape = np.zeros((n, 6))
    shape[:, :2] = 4.0 / SIZE_MM**2
    fields = {
        "position": position,
        "velocity": np.stack([3.0 * position[:, 0] + 1.0, -2.0 * position[:, 1], 0.0 * position[:, 0]], axis=1),
        "shape": shape,
        "volume": np.full(n, SIZE_MM**2),
        "stress": np.tile([1.0, 1.0, 0.0, 0.0, 0.0, 0.0], (n, 1)),
        "pressure": np.full(n, -1.0),
        "cell_id": np.arange(n),
        "parent_id": np.full(n, -1),
        "generation": np.zeros(n, dtype=int),
        "clamped": np.zeros(n, dtype=int),
        "neighbours": np.full(n, 20),
    }
    return Frame(0.0, fields)


def without(frame: Frame, lost: np.ndarray) -> Frame:
    """The frame without some cells."""
    return Frame(frame.time_h, {name: values[~lost] for name, values in frame.fields.items()})


def test_a_smooth_block_is_at_rest():
    """No rough motion in a linear flow, p of stress, no noise, cells that touch."""
    rough, level, noise, gap = criteria.frame_measures(block(), 2, 1.0, 1.0)
    assert rough == pytest.approx(0.0, abs=1e-12) and noise == 0.0
    assert level == pytest.approx(1.0) and gap == pytest.approx(1.0)


def test_near_pairs_are_those_of_a_full_search():
    """The sorted search finds the same pairs as comparing all with all, in cells of any shape."""
    random = np.random.default_rng(5)
    frame = block()
    position = frame["position"][:, :2] + random.uniform(-0.005, 0.005, (frame.cells, 2))
    half = random.uniform(-1.0, 1.0, (frame.cells, 2, 2)) / SIZE_MM
    shape = half @ half.transpose(0, 2, 1) + np.eye(2) / SIZE_MM**2
    i, j, distance = criteria.near_pairs(position, shape, 2.0)
    found = {(min(a, b), max(a, b)): d for a, b, d in zip(i, j, distance)}
    expected = {}
    for a in range(frame.cells):
        for b in range(a + 1, frame.cells):
            r = position[b] - position[a]
            d = np.sqrt(0.125 * r @ (shape[a] + shape[b]) @ r)
            if d < 2.0:
                expected[a, b] = d
    assert found.keys() == expected.keys() and len(found) > 100
    assert all(found[pair] == pytest.approx(expected[pair]) for pair in found)


def test_a_crack_is_seen():
    """A gap of two and a half cells through the whole block fails, one of a cell in its middle does not."""
    frame = block()
    x = frame["position"][:, 0]
    frame.fields["position"][x > 0.19, 0] += 1.5 * SIZE_MM
    assert not criteria.Finding(criteria.CRACK, criteria.frame_measures(frame, 2, 1.0, 1.0)[3]).passed
    hole = block()
    hole = without(hole, np.arange(hole.cells) == 65)
    assert criteria.frame_measures(hole, 2, 1.0, 1.0)[3] == pytest.approx(1.0)


def test_noise_and_rough_motion_are_seen():
    """Alternating pressure of 0.3 p has a noise of 0.6 p between rows; random motion is rough."""
    frame = block()
    sign = np.where(np.arange(frame.cells) % 2 == 0, 1.0, -1.0)  # rows of constant y alternate
    frame.fields["pressure"] = -1.0 + 0.3 * sign
    frame.fields["velocity"] = np.random.default_rng(1).normal(size=(frame.cells, 3))
    rough, _, noise, _ = criteria.frame_measures(frame, 2, 1.0, 1.0)
    assert 0.3 < noise < 0.6
    assert rough > 0.5


def test_a_lost_cell_is_seen():
    """Of a cell, of a daughter, or one that is there twice; divisions are no loss."""
    frame = block()
    n = frame.cells
    assert criteria.cells_kept(frame, n) == 1.0
    assert criteria.cells_kept(without(frame, np.arange(n) == 7), n) < 1.0
    divided = block()
    divided.fields["generation"][:2] = 1  # two daughters in the place of one mother
    assert criteria.cells_kept(divided, n - 1) == 1.0
    assert criteria.cells_kept(without(divided, np.arange(n) == 0), n - 1) < 1.0
    twice = block()
    twice.fields["cell_id"][3] = 4
    assert criteria.cells_kept(twice, n) == 0.0


def test_neighbours_that_were_never_there_are_not_missed():
    """A cell must keep 6, but not one that began with fewer; daughters inherit that."""
    first, later = block(), block()
    first.fields["neighbours"][0] = 4
    later.fields["neighbours"][0] = 3
    assert criteria.neighbours_kept([first, later], 2) == pytest.approx(1.5)
    later.fields["cell_id"][0], later.fields["parent_id"][0] = 999, 0
    assert criteria.neighbours_kept([first, later], 2) == pytest.approx(1.5)
    later.fields["neighbours"][5] = 5
    assert criteria.neighbours_kept([first, later], 2) == pytest.approx(5 / 6)
    assert criteria.neighbours_kept([first, later], 2, enough=5.0) == pytest.approx(1.0)


def test_margins():
    """Times better than the bound, from either side; what is not a number has none."""
    most = criteria.Criterion("a", "", 0.1)
    least = criteria.Criterion("b", "", 6.0, most=False)
    assert most.margin(0.05) == pytest.approx(2.0) and most.margin(0.2) == pytest.approx(0.5)
    assert least.margin(9.0) == pytest.approx(1.5) and least.margin(3.0) == pytest.approx(0.5)
    assert most.margin(float("nan")) == least.margin(float("inf")) == 0.0
    assert most.margin(0.0) == criteria.MOST_MARGIN


def test_a_folder_without_a_run_has_not_finished(tmp_path: Path):
    """Nothing to read is a failure, not a pass."""
    findings = criteria.judge(tmp_path, 1.0, {})
    assert [f.criterion for f in findings] == [criteria.FINISHED] and not findings[0].passed


def test_scenes_are_toml():
    """Every case under both schemes reads back; what a scheme removes is gone."""
    for case in cases():
        scene = tomllib.loads(scene_text(case, DEFAULT, case.short_h))
        assert scene["scene"]["name"] == case.name and "non_affine_control" in scene
        paper = tomllib.loads(scene_text(case, PAPER, case.short_h))
        assert paper["tissue"]["law"] == "pressure_deviator" and "non_affine_control" not in paper
    assert len({case.name for case in cases()}) == len(cases())


def test_only_what_moves_masses_is_given_a_step():
    """Soil cases end every interval in balance; the paper's scheme keeps the small steps that it needs."""
    for case in (case for case in cases() if case.with_inertia):
        assert "numerics" not in tomllib.loads(scene_text(case, DEFAULT, case.short_h))
        assert tomllib.loads(scene_text(case, PAPER, case.short_h))["numerics"]["step_h"] <= 2e-4
    assert {case.name for case in cases() if case.with_inertia} == {c.name for c in cases() if "soil" in c.name}


def test_an_edge_says_how_it_ended():
    """Stable to the end, refused, failed, or given up."""
    row = stability_report.EdgeRow("ratio_down", "-", "E_R/E_A, downwards", "default", 1.0, 0.01)
    assert row.ended(0.01, None, "").verdict() == "stable to 0.01, the furthest tried"
    assert row.ended(0.1, 0.09, "neighbours").verdict() == "stable to 0.1; at 0.09 fails: neighbours"
    assert row.ended(0.1, 0.09, "refused").verdict() == "stable to 0.1; at 0.09 refused"
    too_long = row.ended(0.1, 0.09, f"{stability_report.TOO_LONG} within 60 s")
    assert too_long.verdict() == "stable to 0.1; at 0.09 not finished within 60 s"
