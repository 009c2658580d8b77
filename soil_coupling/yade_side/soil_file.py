# SPDX-License-Identifier: GPL-2.0-or-later
"""Files that hold a soil: a packed sample, or a checkpoint.

A first line that names the format, a second line of JSON (what it is, of which YADE, how long, its SHA-256), then
YADE's own archive, compressed. A file is there as a whole or not at all.
"""

from __future__ import annotations

import hashlib
import json
import os
import zlib
from pathlib import Path
from typing import Any

FORMAT = "rootsoil soil file"
FORMAT_VERSION = 1
REMEDY = {
    "sample": "delete the file; the next run packs the sample anew",
    "checkpoint": "go on from another checkpoint, or begin the run anew in another folder",
}


class Refused(Exception):
    """Something that the user gave is wrong; becomes the program's message about wrong input."""

    def __init__(
        self, what: str, *, key: str = "", file: str = "", given: str = "", allowed: str = "", remedy: str = ""
    ):
        super().__init__(what)
        self.parts = {"what": what, "key": key, "file": file, "given": given, "allowed": allowed, "remedy": remedy}


def write_soil_file(path: Path, kind: str, engine: str, meta: dict[str, Any], archive: bytes) -> None:
    """Writes it beside the old one, then puts it in its place."""
    packed = zlib.compress(archive, 1)
    head = {
        "kind": kind,
        "version": FORMAT_VERSION,
        "engine": engine,
        "bytes": len(packed),
        "sha256": hashlib.sha256(packed).hexdigest(),
        "meta": meta,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        with temporary.open("wb") as file:
            file.write(f"{FORMAT}\n{json.dumps(head)}\n".encode())
            file.write(packed)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def read_soil_file(path: Path, kind: str, engine: str) -> tuple[dict[str, Any], bytes]:
    """Its meta data and YADE's archive. Refused: it is missing, damaged, of another kind or version."""

    def refuse(what: str, given: str = "", allowed: str = "") -> Refused:
        return Refused(what, file=str(path), given=given, allowed=allowed, remedy=REMEDY[kind])

    try:
        data = path.read_bytes()
    except OSError as error:
        raise refuse(f"the soil {kind} can't be read: {error.strerror}") from None
    lines = data.split(b"\n", 2)
    if len(lines) != 3 or lines[0] != FORMAT.encode():
        raise refuse(f"this is not a soil {kind}, or it is damaged")
    try:
        head = json.loads(lines[1])
        packed = lines[2]
        same = (head["kind"], head["version"], head["engine"]) == (kind, FORMAT_VERSION, engine)
        whole = len(packed) == head["bytes"] and hashlib.sha256(packed).hexdigest() == head["sha256"]
    except (ValueError, KeyError, TypeError):
        raise refuse(f"the soil {kind} is damaged: its head can't be read") from None
    if not same:
        raise refuse(
            f"this is not a soil {kind} of this version",
            f"{head['kind']}, format {head['version']}, YADE {head['engine']}",
            f"{kind}, format {FORMAT_VERSION}, YADE {engine}",
        )
    if not whole:
        raise refuse(f"the soil {kind} is damaged: {len(packed)} bytes of {head['bytes']}, or changed ones")
    return head["meta"], zlib.decompress(packed)
