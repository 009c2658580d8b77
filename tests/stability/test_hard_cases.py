# SPDX-License-Identifier: MIT
"""The quick version of tools/stability.py: every hard case, short, and two edges, against the recorded margins."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hard_cases import PROJECT, cases
from rootsoil_tools.stability_report import read_rows

RECORDED = PROJECT / "tests" / "stability" / "recorded_margins.csv"
UNPHYSICAL = 3  # exit status


# Stands for the program and notes how it ended, and for which run's folder.
NOTED = """\
#!/bin/sh
"{program}" "$@"
status=$?
echo "$status $4" >> "{notes}"
exit $status
"""


def noted(program: Path, folder: Path) -> Path:
    """A script in the folder that runs the program and adds its exit status to exit_statuses.txt."""
    script = folder / program.name
    script.write_text(NOTED.format(program=program, notes=folder / "exit_statuses.txt"))
    script.chmod(0o755)
    return script


@pytest.fixture(scope="session")
def quick(program_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a quick run: a minute of one core."""
    out = tmp_path_factory.mktemp("stability")
    programs = [noted(program_path, out), noted(program_path.parent / "twin_soil", out)]
    command = [sys.executable, PROJECT / "tools" / "stability.py", "--quick", "--out", out]
    command += ["--program", programs[0], "--twin", programs[1]]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "ROOTSOIL_CACHE": str(out / "cache")}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert (out / "edges.csv").is_file(), done.stdout + done.stderr
    return out


def exit_statuses(quick: Path, run: str) -> set[int]:
    """How the program ended whenever it ran into this folder."""
    notes = [line.split(maxsplit=1) for line in (quick / "exit_statuses.txt").read_text().splitlines()]
    return {int(status) for status, folder in notes if Path(folder).name == run}


def recorded(case: str) -> dict[str, float]:
    """The least margins of a case, by criterion."""
    return {row["criterion"]: float(row["least"]) for row in read_rows(RECORDED) if row["case"] == case}


def test_every_case_is_recorded():
    """No case and no edge can be added without its margins."""
    known = {row["case"] for row in read_rows(RECORDED)}
    assert {case.name for case in cases()} == {name for name in known if not name.startswith("edge ")}


@pytest.mark.slow
@pytest.mark.parametrize("case", [case.name for case in cases()])
def test_it_stays_stable(case: str, quick: Path):
    """The program says that it went well, and every criterion keeps its bound, by at least the margin recorded."""
    found = {
        row["criterion"]: row
        for row in read_rows(quick / "cases.csv")
        if row["case"] == case and row["scheme"] == "default"
    }
    least = recorded(case)
    assert exit_statuses(quick, f"{case}-default-short") == {0}
    assert exit_statuses(quick, f"{case}-restart") == ({0} if "restart" in least else set())
    assert found.keys() == least.keys()
    for criterion, row in found.items():
        assert row["passed"] == "True", f"{criterion}: {row['value']}, bound {row['bound']}. {row['message']}"
        assert float(row["margin"]) >= least[criterion], f"{criterion} got worse: {row['value']}, bound {row['bound']}"


@pytest.mark.slow
def test_the_papers_law_breaks_and_says_where(quick: Path):
    """At E_R/E_A = 15 the paper's scheme does not survive; the message names the cell."""
    row = next(
        r
        for r in read_rows(quick / "cases.csv")
        if (r["case"], r["scheme"], r["criterion"]) == ("ratio_15", "paper", "finished")
    )
    assert row["passed"] == "False" and "cell" in row["message"] and "position" in row["message"]
    assert exit_statuses(quick, "ratio_15-paper-short") == {UNPHYSICAL}


@pytest.mark.slow
def test_the_edges_are_where_they_were(quick: Path):
    """The stable region reaches at least as far as recorded."""
    edges = read_rows(quick / "edges.csv")
    assert edges
    for row in edges:
        good, start = float(row["good"] or 0.0), float(row["start"])
        assert good / start >= recorded(f"edge {row['edge']}")["reach"], f"{row['edge']}: {row['good']} {row['unit']}"
