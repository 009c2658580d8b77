# SPDX-License-Identifier: MIT
"""Pages in docs/ that a tool writes: tables, and what stands below the last mark, which is written by hand and kept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path


def table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    return "\n".join(["| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *lines]]) + "\n"


def mark_of(tool: str) -> str:
    """The line below which a page is kept."""
    return f"<!-- From here on written by hand: tools/{tool}.py keeps it. -->\n"


def kept_part(page: Path, tool: str) -> str:
    """What stands below the mark of a page that is there, with the mark; of any other, nothing."""
    if not page.is_file():
        return ""
    _, mark, text = page.read_text(encoding="utf-8").partition(mark_of(tool))
    return mark + text
