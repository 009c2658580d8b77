# SPDX-License-Identifier: MIT
"""What a run shows: one line that renews itself on a terminal, no such line elsewhere."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import resource
import struct
import subprocess
import termios

import pytest
from cli_support import FULL, TIMEOUT_S, Program

# simulated/total h, cells, length, speed, time left, inertia error
LINE = (
    r"\d+\.\d\d/0\.4 h  \d+ cells  root \d\.\d{3} mm  \d+ steps/s  (\d+:)?\d+:\d\d left  " r"inertia error [0-9.e+-]+"
)


def on_terminal(
    program: Program, *arguments: object, columns: int = 120, limit: int | None = None, kind: str = "xterm"
) -> tuple[int, str]:
    """Exit status, and what a terminal of this width and kind got on stderr."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    running = subprocess.Popen(
        program.command(*arguments),
        cwd=program.folder,
        env={**program.environment, "TERM": kind},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=theirs,
        preexec_fn=(lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))) if limit else None,
    )
    os.close(theirs)
    received = b""
    try:
        while part := os.read(ours, 4096):
            received += part
    except OSError:  # the other side has closed it
        pass
    os.close(ours)
    return running.wait(TIMEOUT_S), received.decode()


def progress_lines(received: str) -> list[str]:
    """The states of the progress line, one after the other."""
    return re.findall(r"\r([^\r\n]*)\x1b\[K", received)


def test_terminal(program: Program):
    """On a terminal: one line, renewed in place, with all its numbers; the end begins a line of its own."""
    status, received = on_terminal(program, "run", program.scene(FULL), "--out", "out")
    assert status == 0
    lines = progress_lines(received)
    assert lines and all(re.fullmatch(LINE, line) for line in lines), lines
    times = [float(line.split("/")[0]) for line in lines]
    assert times == sorted(times)
    shown = received[received.index(lines[0]) : received.index("done: ")]
    assert shown.count("\n") == 1 and shown.endswith("\n")


@pytest.mark.parametrize("columns", [80, 40])
def test_narrow_terminal(program: Program, columns: int):
    """The line never wraps: what would wrap could not be renewed in place."""
    status, received = on_terminal(program, "run", program.scene(FULL), "--out", "out", columns=columns)
    assert status == 0
    assert max(len(line) for line in progress_lines(received)) < columns


def test_dumb_terminal(program: Program):
    """A terminal that can't renew a line gets whole lines, as a pipe does."""
    status, received = on_terminal(program, "run", program.scene(FULL), "--out", "out", kind="dumb")
    assert status == 0 and "done: " in received
    assert "\x1b" not in received and "\r" not in received.replace("\r\n", "\n")


def test_error_begins_a_new_line(program: Program):
    """A message that ends a run is not glued to the progress line."""
    status, received = on_terminal(program, "run", program.scene(FULL), "--out", "out", limit=110000)
    assert status == 5 and progress_lines(received)
    assert "\nrootsoil: " in received.replace("\r", "")


def test_pipe(program: Program):
    """Not on a terminal: what the run is, how it ended, and in between at most one whole line of progress a minute."""
    done = program("run", program.scene(FULL), "--out", "out")
    assert done.out == "" and "\r" not in done.err and "\x1b" not in done.err
    first, *between, end, errors = done.err.splitlines()
    assert all(re.fullmatch(LINE, line) for line in between if "steps/s" in line)
    assert re.match(r"full: \d+ cells, 0\.4 h in 400 steps of 0\.001 h, 1 thread", first)
    assert re.match(r"done: \d+ cells after \d+ divisions, root \S+ mm, \S+ s, \d+ MB$", end)
    assert re.match(
        r"this run: inertia error \S+ % of p at the end, at most \S+ %; discretisation error about ", errors
    )


def test_quiet_warns(program: Program):
    """--quiet: warnings are shown all the same, and the picture's tool is as quiet as the run."""
    settings = ["--set", "numerics.inertia_error_max=1e-12", "--set", "output.picture=true", "--until", "0.1"]
    done = program("run", program.scene(FULL), "--out", "out", "--quiet", *settings)
    assert done.status == 0 and done.out == ""
    assert done.err.startswith("warning: outside the stated accuracy: inertia_error") and done.err.count("\n") == 1
    assert (program.folder / "out" / "overview.png").is_file()


def test_quiet(program: Program):
    """--quiet: nothing at all where all is well, on a terminal as well."""
    done = program("run", program.scene(FULL), "--out", "out", "--quiet")
    assert (done.status, done.out, done.err) == (0, "", "")
    assert on_terminal(program, "run", program.scene(FULL), "--out", "again", "--quiet") == (0, "")
