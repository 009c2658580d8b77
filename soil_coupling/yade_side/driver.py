# SPDX-License-Identifier: GPL-2.0-or-later
"""What runs in the soil's process: answers one request after the other (message.hpp). Started by soil_coupling only,
with the socket as descriptor 3 and the shared block as descriptor 4."""

from __future__ import annotations

import gc
import json
import os
import sys
import time
import traceback
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))  # python -I leaves it out

from message import NAMES, TABLES, Channel, Packet, column_offset  # noqa: E402
from soil_file import Refused  # noqa: E402

SOCKET_FD, BLOCK_FD = 3, 4
PROGRESS_EVERY_S = 5.0


def path_of(code: str) -> Path:
    """The path whose bytes these hexadecimal digits are; names of files need not be UTF-8, which JSON is."""
    return Path(os.fsdecode(bytes.fromhex(code)))


class Driver:
    """One method a request."""

    def __init__(self, channel: Channel):
        self.channel = channel
        self.soil: Any = None
        self.said = -PROGRESS_EVERY_S

    def progress(self, text: str) -> None:
        """How far a long task is; not more often than is worth reading."""
        now = time.monotonic()
        if now - self.said >= PROGRESS_EVERY_S:
            self.said = now
            self.channel.answer("progress", text)

    def hello(self, _: Packet) -> None:
        """Loads YADE, which takes some seconds."""
        import engine

        gc.freeze()  # YADE's modules are many, and stay
        self.channel.answer("done", json.dumps({"engine": engine.VERSION, "python": sys.version.split()[0]}))

    def pack(self, _: Packet) -> None:
        """Makes a sample file."""
        from soil import make_sample

        task = json.loads(self.channel.text())
        meta = make_sample(task["recipe"], path_of(task["sample"]), self.progress)
        self.channel.answer("done", json.dumps(meta))

    def build(self, request: Packet) -> None:
        """The soil at the start."""
        from soil import Soil

        task = json.loads(self.channel.text())
        body = self.channel.columns("body", request.rows)
        self.soil = Soil(task["recipe"], task["start"], self.progress)
        sample = path_of(task["sample"]) if task["sample"] else None
        begin = column_offset("body", len(TABLES["body"]), request.rows)
        listed = self.channel.columns("body", task["grains"], begin)
        self.soil.build(
            sample,
            (listed["position_mm"].copy(), listed["radius_mm"].copy()),
            (body["position_mm"].copy(), body["radius_mm"].copy()),
        )
        self.channel.answer("done")

    def load(self, _: Packet) -> None:
        """The soil of a checkpoint."""
        from soil import Soil

        task = json.loads(self.channel.text())
        if self.soil is None:
            self.soil = Soil(task["recipe"], task["start"], self.progress)
        self.soil.load(path_of(task["file"]))
        self.channel.answer("done")

    def advance(self, request: Packet) -> None:
        """One interval."""
        rows = request.rows
        numbers = self.soil.advance(
            request.interval,
            request.duration_h,
            self.channel.columns("motion", rows),
            lambda: self.channel.columns("forces", rows),  # in the same place: only when the motion has been read
        )
        self.channel.answer("done", json.dumps(numbers), rows)

    def snapshot(self, _: Packet) -> None:
        """Grains and contacts now."""
        grain_columns, contact_columns = self.soil.snapshot()
        rows, contacts = len(grain_columns["id"]), len(contact_columns["ids"])
        begin = column_offset("grains", len(TABLES["grains"]), rows)
        self.channel.columns("contacts", contacts, begin)  # makes room
        for views, columns in (
            (self.channel.columns("grains", rows), grain_columns),
            (self.channel.columns("contacts", contacts, begin), contact_columns),
        ):
            for name, values in columns.items():
                views[name][:] = values
        self.channel.answer("done", json.dumps({"contacts": contacts}), rows)

    def save(self, _: Packet) -> None:
        """Writes a checkpoint."""
        self.soil.save(path_of(json.loads(self.channel.text())["file"]))
        self.channel.answer("done")


def main() -> int:
    """Answers until it is told to stop, or the other side is gone. After an error nothing more is answered."""
    channel = Channel(SOCKET_FD, BLOCK_FD)
    driver = Driver(channel)
    try:
        while (request := channel.receive()) is not None and NAMES[request.kind] != "stop":
            getattr(driver, NAMES[request.kind])(request)
        return 0
    except Refused as refused:
        channel.answer("refused", json.dumps(refused.parts))
    except (BrokenPipeError, ConnectionResetError):
        return 0
    except BaseException as error:  # whatever it is: the other side must know
        name = type(error).__name__
        if name == "YadeMissing":  # engine.py can't be imported here, before it is asked for
            channel.answer("failed", str(error))
        else:
            traceback.print_exc()
            channel.answer("failed", f"{name}: {error}")
    return 1


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # YADE's own way out of an interpreter is not always a quiet one
