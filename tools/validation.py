#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Puts every published number that we have beside ours: writes docs/validation.csv, docs/validation.md and its picture.

Runs the scenes of the paper's figures, an impedance series, roots that are stopped and pushed, and a column that
buckles, or takes them as they are where they are finished. Published numbers are in tools/data/. Nothing is left out:
what disagrees, and what has no public number, has its row.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from rootsoil_tools import validation_page
from rootsoil_tools.runs import RunError
from rootsoil_tools.series import PROGRAM, PROJECT
from rootsoil_tools.validation_cases import CASES, Bench, read_numbers, write_numbers


def main() -> int:
    """0, or 1 with a message where a run failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--out", type=Path, default=Path("runs/validation"), help="where runs go (default: %(default)s)"
    )
    parser.add_argument("--programs", type=Path, default=PROGRAM.parent, help="folder (default: build/release)")
    parser.add_argument(
        "--quick", action="store_true", help="half a minute: short runs, and the page goes to --out too"
    )
    parser.add_argument("--draw-only", action="store_true", help="draws the page from the numbers that are there")
    parser.add_argument("--only", nargs="+", choices=list(CASES), help="measures these, keeps the other numbers")
    options = parser.parse_args()
    folder = options.out if options.quick else PROJECT / "docs"
    file, page = folder / "validation.csv", folder / "validation.md"
    try:
        if not options.draw_only:
            bench = Bench(options.out.absolute(), options.programs.absolute(), options.quick)
            numbers = read_numbers(file) if options.only and file.is_file() else {}
            for name in options.only or CASES:
                numbers |= {number.key: number for number in CASES[name](bench)}
            folder.mkdir(parents=True, exist_ok=True)
            write_numbers(numbers.values(), file)
        numbers = read_numbers(file)  # the page is what the file says
        validation_page.draw_ratios(numbers, folder / "images" / f"{validation_page.PICTURE}.png")
        page.write_text(validation_page.page(numbers), encoding="utf-8")
    except subprocess.CalledProcessError as error:
        command = " ".join(map(str, error.cmd))
        print(f"validation: '{command}' ended with status {error.returncode}: {error.stderr or ''}", file=sys.stderr)
        return 1
    except (RunError, OSError, ValueError, KeyError) as error:
        print(f"validation: {error}", file=sys.stderr)
        return 1
    print(f"wrote {file} and {page}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
