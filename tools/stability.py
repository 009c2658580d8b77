#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the hard cases under two schemes and looks for the edges of the stable region.

Each case of tests/stability/hard_cases.py runs with the default scheme and with the paper's (Eq. 1-4 to the letter,
isotropic kernel, predictor-corrector) and is judged by the criteria of rootsoil_tools/criteria.py. The edges, of the
step, of E_R/E_A, of the stretch and of lambda0, are found by bisection. Writes OUT/cases.csv, OUT/edges.csv and
OUT/stability.png; without --quick also docs/stability.md and docs/images/stability.png. Runs that are finished are
taken as they are, interrupted ones go on.
"""

from __future__ import annotations

import argparse
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import log, sqrt
from pathlib import Path

from rootsoil_tools import stability_report as report
from rootsoil_tools.criteria import Criterion, Finding, judge
from rootsoil_tools.runs import RunError, read_summary
from rootsoil_tools.series import PROGRAM, PROJECT, Series

sys.path[:0] = [str(PROJECT / "tests" / "stability"), str(PROJECT / "tests" / "cli")]

from cli_support import same_results  # noqa: E402
from hard_cases import DEFAULT, PAPER, SCHEMES, UNIFORM, Case, Changes, Scheme, cases, moduli, scene_text  # noqa: E402

RESTART = Criterion(
    "restart", "part of the results that are the same, bit for bit, after a restart in the middle", 1.0, most=False
)
REFUSED, UNPHYSICAL, SOIL_FAILED, TOO_LONG = 2, 3, 4, -signal.SIGXCPU  # exit statuses
BROKEN = {"unphysical": "the tissue broke", "soil failed": "the soil"}  # summary's status: how the message begins
SAMPLE = ("ratio_1", "ratio_15", "three_wide")  # of the paper's cases in quick mode
RECORDED = PROJECT / "tests" / "stability" / "recorded_margins.csv"
RESOLUTION, QUICK_RESOLUTION = 1.15, 1.5  # at which a bisection ends: failing over passing value
EDGE_LIMIT_S = 60  # processor time of a run of an edge; a root that swells without end takes hours
ENDS = {REFUSED: report.REFUSED, TOO_LONG: f"{report.TOO_LONG} within {EDGE_LIMIT_S} s"}  # no message tells these


@dataclass(frozen=True)
class Edge:
    """A search from a value that should be stable towards one that may not be; which way depends on which is larger."""

    name: str
    unit: str
    meaning: str
    start: float
    furthest: float
    changes: Callable[[float], Changes]
    hours: Callable[[float], float]
    quick: bool = False
    of_ratio: bool = False


def edges() -> list[Edge]:
    """The edges of the stable region of the base case."""
    rate_per_h, kept_h = report.BASE_RATE_PER_H, report.USUAL_STEP_H
    free = {**UNIFORM, "division": None}

    def alike(ratio: float) -> Changes:
        return {**UNIFORM, **moduli(ratio)}

    return [
        Edge("step", "h", "step", 1e-4, 1.0,
             lambda v: {"numerics.step_h": v}, lambda v: 12 * v, quick=True),
        Edge("ratio_up", "-", "E_R/E_A, upwards", 1.0, 270.0, alike, lambda v: 1.0, quick=True, of_ratio=True),
        Edge("ratio_down", "-", "E_R/E_A, downwards", 1.0, 0.01, alike, lambda v: 1.0, of_ratio=True),
        Edge("stretch", "-", "stretch of all tissue, no division", 1.5, 100.0,
             lambda v: free, lambda v: log(v) / rate_per_h),
        Edge("stretch_division", "-", "stretch of all tissue, with division", 1.5, 30.0,
             lambda v: UNIFORM, lambda v: log(v) / rate_per_h),
        Edge("lambda_up", "-", "lambda0, step from the program", 1.0, 1e4,
             lambda v: {"growth.lambda0_ug_mm3_h": 4.34e5 * v}, lambda v: 2.0 / v),
        Edge("lambda_up_fixed_step", "-", f"lambda0, step kept at {kept_h:g} h", 1.0, 1e2,
             lambda v: {"growth.lambda0_ug_mm3_h": 4.34e5 * v, "numerics.step_h": kept_h},
             lambda v: max(2.0 / v, 12 * kept_h)),
        Edge("lambda_down", "-", "lambda0, downwards", 1.0, 1e-4,
             lambda v: {"growth.lambda0_ug_mm3_h": 4.34e5 * v}, lambda v: 2.0),
    ]  # fmt: skip


class Runner:
    """Runs scenes below a folder and judges them."""

    def __init__(self, out: Path, program: Path, twin: Path):
        self.out, self.program, self.twin = out, program, twin
        self.scenes = out / "scenes"
        self.scenes.mkdir(parents=True, exist_ok=True)

    def series(self, name: str, text: str, twin: Sequence[str] | None = None, cpu_limit_s: int | None = None) -> Series:
        """Runs of the scene, which is written beside them; `twin`: against a plate, with these arguments."""
        scene = self.scenes / f"{name}.toml"
        if not scene.is_file() or scene.read_text(encoding="utf-8") != text:
            scene.write_text(text, encoding="utf-8")
        program = self.program if twin is None else self.twin
        arguments = ["--quiet", *(twin or ())]
        return Series(scene, self.out / "runs", program, arguments, threads=1, cpu_limit_s=cpu_limit_s)

    def run(self, name: str, hours: float, series: Series) -> tuple[Path, str]:
        """The folder of a run, and what it said where it was refused or broke off."""
        folder = series.out / name
        if read_summary(folder).get("status") not in BROKEN:
            try:
                series.run(name, [], hours)
            except subprocess.CalledProcessError as error:
                if error.returncode not in (REFUSED, UNPHYSICAL, SOIL_FAILED, TOO_LONG):
                    raise
                if error.returncode == TOO_LONG:  # else it would go on from there the next time
                    shutil.rmtree(folder, ignore_errors=True)
                if error.returncode in ENDS:
                    return folder, ENDS[error.returncode]
        return folder, last_error(folder)

    def case(self, case: Case, scheme: Scheme, long: bool) -> tuple[list[Finding], str]:
        """What a case comes to under a scheme, and the message where it broke off."""
        hours = case.long_h if long else case.short_h
        name = f"{case.name}-{scheme.name}-{'long' if long else 'short'}"
        text = scene_text(case, scheme, hours)
        folder, message = self.run(name, hours, self.series(name, text, case.twin))
        reaches = {what: both[long] for what, both in case.reaches.items()}
        return judge(folder, hours, reaches, case.stress_MPa, case.neighbours), message

    def restart(self, case: Case) -> Finding:
        """The short run, interrupted in the middle and resumed, against the one that was not."""
        text = scene_text(case, DEFAULT, case.short_h)
        series = self.series(f"{case.name}-{DEFAULT.name}-short", text, case.twin)
        whole, _ = self.run(f"{case.name}-{DEFAULT.name}-short", case.short_h, series)
        parts = series.run(f"{case.name}-restart", [], case.short_h / 2)
        series.run(f"{case.name}-restart", [], case.short_h)
        try:
            same_results(whole, parts)
        except AssertionError as difference:
            print(f"{case.name}: after a restart {difference}", file=sys.stderr)
            return Finding(RESTART, 0.0)
        return Finding(RESTART, 1.0)

    def stable(self, edge: Edge, scheme: Scheme, value: float) -> tuple[bool, str]:
        """Whether the base case is stable at this value of an edge's quantity, and the criterion that fails."""
        value = float(f"{value:.3g}")
        changes = edge.changes(value)
        if (
            scheme is PAPER and not edge.of_ratio
        ):  # its law is hyperbolic only where E_R is near E_A, and then a zone bulges
            changes = {**UNIFORM, **changes, **moduli(1.0)}
        hours = edge.hours(value)
        case = Case(edge.name, edge.meaning, changes, hours, hours)
        name = f"{edge.name}-{scheme.name}-{value:g}"
        series = self.series(name, scene_text(case, scheme, hours), cpu_limit_s=EDGE_LIMIT_S)
        folder, message = self.run(name, hours, series)
        if message in ENDS.values():
            return False, message
        failed = [finding.criterion.name for finding in judge(folder, hours, {}) if not finding.passed]
        return not failed, ", ".join(failed)

    def edge(self, edge: Edge, scheme: Scheme, resolution: float) -> report.EdgeRow:
        """Bisects, in the logarithm, between the last stable and the first value that is not."""
        row = report.EdgeRow(edge.name, edge.unit, edge.meaning, scheme.name, edge.start, edge.furthest)
        fine, failed = self.stable(edge, scheme, edge.start)
        if not fine:
            return row.ended(None, edge.start, failed)
        fine, failed = self.stable(edge, scheme, edge.furthest)
        if fine:
            return row.ended(edge.furthest, None, "")
        good, bad = edge.start, edge.furthest
        while max(good / bad, bad / good) > resolution:
            middle = sqrt(good * bad)
            fine, why = self.stable(edge, scheme, middle)
            if fine:
                good = middle
            else:
                bad, failed = middle, why
        return row.ended(good, bad, failed)


def last_error(folder: Path) -> str:
    """What the program said when it broke off, without what it kept; nothing where it did not."""
    begins = BROKEN.get(read_summary(folder).get("status", ""))
    log_file = folder / "run.log"
    if begins is None or not log_file.is_file():
        return ""
    text = log_file.read_text(encoding="utf-8")
    start = text.rfind(begins)
    return text[start:].splitlines()[0] if start >= 0 else "broke off"


def examine_cases(runner: Runner, quick: bool) -> list[report.CaseRow]:
    """The table hard case x scheme x criterion: long by default, short in quick mode. The paper's scheme runs short."""
    rows = []
    for case in cases():
        for scheme in SCHEMES:
            if quick and scheme is PAPER and case.name not in SAMPLE:
                continue
            long = scheme is DEFAULT and not quick
            findings, message = runner.case(case, scheme, long)
            if (
                scheme is DEFAULT and (case.restart or not quick) and not case.needs_yade
            ):  # those have tests of their own
                findings.append(runner.restart(case))
            hours = case.long_h if long else case.short_h
            rows += [report.CaseRow.of(case.name, case.meaning, scheme.name, hours, f, message) for f in findings]
            worst = min(findings, key=lambda finding: finding.margin)
            print(
                f"{case.name} ({scheme.name}): {'stable' if worst.passed else 'fails: ' + worst.criterion.name}",
                flush=True,
            )
    return rows


def examine_edges(runner: Runner, quick: bool) -> list[report.EdgeRow]:
    """All edges under both schemes; in quick mode two, coarsely, under the default."""
    rows = []
    for edge in edges():
        for scheme in SCHEMES:
            if quick and (scheme is PAPER or not edge.quick):
                continue
            rows.append(runner.edge(edge, scheme, QUICK_RESOLUTION if quick else RESOLUTION))
            print(rows[-1].text(), flush=True)
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("runs/stability"), help="folder (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="short runs and two coarse edges: a minute of one core")
    parser.add_argument(
        "--record", action="store_true", help=f"with --quick: write {RECORDED.name}, which tests compare with"
    )
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/release/rootsoil")
    parser.add_argument(
        "--twin", type=Path, default=PROGRAM.parent / "twin_soil", help="default: build/release/twin_soil"
    )
    options = parser.parse_args()
    try:
        runner = Runner(options.out, options.program, options.twin)
        case_rows, edge_rows = examine_cases(runner, options.quick), examine_edges(runner, options.quick)
        report.write_rows(options.out / "cases.csv", case_rows)
        report.write_rows(options.out / "edges.csv", edge_rows)
        report.draw_map(case_rows, edge_rows, options.out / "stability.png")
        if not options.quick:
            report.draw_map(case_rows, edge_rows, PROJECT / "docs" / "images" / "stability.png")
            remarks = {case.name: case.remark for case in cases()}
            report.write_page(case_rows, edge_rows, remarks, EDGE_LIMIT_S, PROJECT / "docs" / "stability.md")
        elif options.record:
            report.write_rows(RECORDED, report.recorded_bounds(case_rows, edge_rows))
    except subprocess.CalledProcessError as error:
        print(f"stability: '{' '.join(map(str, error.cmd))}' ended with status {error.returncode}", file=sys.stderr)
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"stability: {error}", file=sys.stderr)
        return 1
    unstable = sorted({row.case for row in case_rows if row.scheme == DEFAULT.name and not row.passed})
    print(f"wrote {options.out / 'cases.csv'}, {options.out / 'edges.csv'} and {options.out / 'stability.png'}")
    if unstable:
        print(f"stability: the default scheme fails in {', '.join(unstable)}", file=sys.stderr)
    return 1 if unstable else 0


if __name__ == "__main__":
    sys.exit(main())
