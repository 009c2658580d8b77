# SPDX-License-Identifier: MIT
"""The recorded errors are those of tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
RECORDED = TESTS / "physics" / "recorded_errors.csv"


def test_every_record_is_of_a_test():
    """A test that is renamed or taken away takes its records along."""
    sources = [
        path.read_text(encoding="utf-8") for folder in ("physics", "soil") for path in (TESTS / folder).glob("*.cpp")
    ]
    tests = {".".join(of) for text in sources for of in re.findall(r"^TEST(?:_[FP])?\((\w+), (\w+)\)", text, re.M)}
    header, *rows = RECORDED.read_text(encoding="utf-8").splitlines()
    assert header == "test,quantity,error" and rows
    assert all(row.count(",") == 2 for row in rows)
    # A test over parameters is called "Instantiation/Suite.Name/parameter".
    recorded = {re.fullmatch(r"(?:\w+/)?(\w+\.\w+)(?:/\w+)?", row.split(",")[0]).group(1) for row in rows}
    assert recorded <= tests, f"records of tests that are no more: {sorted(recorded - tests)}"
