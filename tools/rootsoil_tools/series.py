# SPDX-License-Identifier: MIT
"""Runs of one scene that differ in a few keys. What is finished is taken as it is, what was interrupted goes on."""

from __future__ import annotations

import hashlib
import json
import re
import resource
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rootsoil_tools.runs import RunError, read_summary

PROJECT = Path(__file__).resolve().parents[2]
PROGRAM = PROJECT / "build" / "release" / "rootsoil"


def without_sections(text: str, names: Sequence[str]) -> str:
    """A scene file without these sections, [name] or [[name]]."""
    parts = re.split(r"(?m)^(?=\[)", text)
    return "".join(p for p in parts if not any(re.match(rf"\[+{re.escape(name)}\]", p) for name in names))


@dataclass(frozen=True)
class Series:
    """Where runs of a scene go and how they are made. `arguments` change results, `threads` does not."""

    scene: Path
    out: Path
    program: Path = PROGRAM
    arguments: Sequence[str] = ()
    threads: int | None = None
    cpu_limit_s: int | None = None  # of a run; SIGXCPU ends it
    program_sha256: str = field(init=False)  # a build is known by its bytes: two may say the same version

    def __post_init__(self) -> None:
        if not self.program.is_file():
            raise RunError(f"{self.program} is not there; build it with tools/build.sh")
        object.__setattr__(self, "program_sha256", hashlib.sha256(self.program.read_bytes()).hexdigest())

    def _request(self, settings: Sequence[str]) -> dict:
        """What makes two runs the same."""
        digest = hashlib.sha256(self.scene.read_bytes()).hexdigest()
        return {
            "scene_sha256": digest,
            "settings": list(settings),
            "arguments": list(self.arguments),
            "program_sha256": self.program_sha256,
        }

    def _claim(self, name: str, settings: Sequence[str]) -> Path:
        """The folder OUT/name, and beside it the note of what it holds. RunError: it holds something else."""
        folder, note, request = self.out / name, self.out / f"{name}.json", self._request(settings)
        if folder.exists() and (not note.is_file() or json.loads(note.read_text(encoding="utf-8")) != request):
            raise RunError(
                f"{folder} holds a run of another scene, other arguments or another build of the program; "
                "remove it or choose another --out"
            )
        self.out.mkdir(parents=True, exist_ok=True)
        note.write_text(json.dumps(request, indent=2) + "\n", encoding="utf-8")
        return folder

    def _limit(self) -> None:
        """In the program's process, before it begins."""
        if self.cpu_limit_s is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (self.cpu_limit_s, self.cpu_limit_s + 5))

    def _command(self, verb: str, folder: Path, settings: Sequence[str]) -> list[str]:
        sets = [part for setting in settings for part in ("--set", setting)]
        return [str(self.program), verb, str(self.scene), "--out", str(folder), *sets]

    def run(self, name: str, settings: Sequence[str], until_h: float) -> Path:
        """The folder of the run with these `settings` (key=value) that reached until_h (h); runs what is missing."""
        folder = self._claim(name, settings)
        if read_summary(folder).get("time_h", 0.0) >= until_h * (1.0 - 1e-9):
            print(f"{name}: {folder} is finished", flush=True)
            return folder
        command = self._command("run", folder, settings) + ["--until", f"{until_h:g}", *self.arguments]
        if self.threads:
            command += ["--threads", str(self.threads)]
        if (folder / "checkpoint.h5").exists():
            command.append("--resume")
        print(f"{name}: running into {folder}", flush=True)
        subprocess.run(command, check=True, stdin=subprocess.DEVNULL, preexec_fn=self._limit)  # noqa: PLW1509
        return folder

    def penetrometer(self, name: str, settings: Sequence[str]) -> Path:
        """The folder of a finished `rootsoil penetrometer` with these settings; runs it where it is missing."""
        folder = self._claim(name, settings)
        if (folder / "penetrometer.json").is_file():
            print(f"{name}: {folder} is finished", flush=True)
            return folder
        (folder / "penetrometer.csv").unlink(missing_ok=True)  # of an interrupted one
        print(f"{name}: pushing into {folder}", flush=True)
        subprocess.run(self._command("penetrometer", folder, settings), check=True, stdin=subprocess.DEVNULL)
        return folder


def resistance_MPa(folder: Path) -> float:
    """Q of a finished penetrometer."""
    return float(json.loads((folder / "penetrometer.json").read_text(encoding="utf-8"))["Q_MPa"])
