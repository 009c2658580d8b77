# SPDX-License-Identifier: GPL-2.0-or-later
"""The message layout of soil_coupling/message.hpp, which documents it, mirrored; and the child's end of the channel."""

from __future__ import annotations

import json
import mmap
import os
import socket
import struct
import sys
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

MAGIC = 0x4C494F53
VERSION = 2
TEXT_ROOM = 65536
ALIGNMENT = 64
PROGRESS_ROOM = 512

PACKET = struct.Struct("<IHHQQQQqdd")
FIELDS = (
    "magic",
    "version",
    "kind",
    "sequence",
    "block_bytes",
    "text_bytes",
    "rows",
    "interval",
    "time_h",
    "duration_h",
)

KINDS = {
    "hello": 1,
    "pack": 2,
    "build": 3,
    "advance": 4,
    "snapshot": 5,
    "save": 6,
    "load": 7,
    "stop": 8,
    "done": 100,
    "progress": 101,
    "failed": 102,
    "refused": 103,
}
NAMES = {number: name for name, number in KINDS.items()}

# table: (name, type, components) of each column
TABLES = {
    "body": (("position_mm", "f8", 3), ("radius_mm", "f8", 1)),
    "motion": (
        ("id", "i8", 1),
        ("start_mm", "f8", 3),
        ("end_mm", "f8", 3),
        ("spin_per_h", "f8", 3),
        ("radius_mm", "f8", 1),
    ),
    "forces": (("mean_N", "f8", 3), ("mean_torque_Nmm", "f8", 3), ("contact_stiffness_N_mm", "f8", 1)),
    "grains": (
        ("id", "i8", 1),
        ("position_mm", "f8", 3),
        ("velocity_mm_h", "f8", 3),
        ("radius_mm", "f8", 1),
        ("contacts", "i8", 1),
        ("stress_MPa", "f8", 6),
    ),
    "contacts": (("ids", "i8", 2), ("position_mm", "f8", 3), ("force_N", "f8", 3)),
}


def column_offset(table: str, index: int, rows: int, begin: int = TEXT_ROOM) -> int:
    """First byte of a column; index = the number of columns gives the table's end."""
    offset = begin
    for _, _, components in TABLES[table][:index]:
        offset += (8 * components * rows + ALIGNMENT - 1) // ALIGNMENT * ALIGNMENT
    return offset


def describe_layout() -> str:
    """The whole layout as JSON: describe_layout() of message.cpp."""
    offsets, at = {}, 0
    for name, code in zip(FIELDS, PACKET.format[1:]):
        offsets[name] = at
        at += struct.calcsize("<" + code)
    rows = 13
    tables: dict[str, list[Any]] = {}
    for table, columns in TABLES.items():
        tables[table] = [[*column, column_offset(table, k, rows)] for k, column in enumerate(columns)]
        tables[table].append(column_offset(table, len(columns), rows))
    layout = {
        "magic": MAGIC,
        "version": VERSION,
        "bytes": PACKET.size,
        "text_room": TEXT_ROOM,
        "progress_room": PROGRESS_ROOM,
        "packet": offsets,
        "kinds": KINDS,
        "tables": tables,
    }
    return json.dumps(layout, separators=(",", ":"))


@dataclass
class Packet:
    """See message.hpp."""

    magic: int = MAGIC
    version: int = VERSION
    kind: int = 0
    sequence: int = 0
    block_bytes: int = 0
    text_bytes: int = 0
    rows: int = 0
    interval: int = 0
    time_h: float = 0.0
    duration_h: float = 0.0

    def bytes(self) -> bytes:
        """As it goes over the socket."""
        return PACKET.pack(*(getattr(self, name) for name in FIELDS))


class Channel:
    """The child's end: a socket for packets and the shared block."""

    def __init__(self, socket_fd: int, block_fd: int):
        self._socket = socket.socket(fileno=socket_fd)
        self._block_fd = block_fd
        self._map = mmap.mmap(block_fd, os.fstat(block_fd).st_size)
        self._request = Packet()

    def receive(self) -> Packet | None:
        """The next request; None when the other side is gone. ValueError: it is no packet of this version."""
        data = self._socket.recv(PACKET.size + 1)
        if not data:
            return None
        if len(data) != PACKET.size:
            raise ValueError(f"a packet of {len(data)} bytes")
        self._request = Packet(*PACKET.unpack(data))
        if self._request.magic != MAGIC or self._request.version != VERSION:
            raise ValueError(f"this driver speaks version {VERSION}, the program {self._request.version}")
        self._follow(self._request.block_bytes)
        return self._request

    def text(self) -> str:
        """The request's text."""
        return self._map[: self._request.text_bytes].decode()

    def columns(self, table: str, rows: int, begin: int = TEXT_ROOM) -> dict[str, np.ndarray]:
        """The table's columns, as views into the block: (rows,) or (rows, components); makes room where needed."""
        end = column_offset(table, len(TABLES[table]), rows, begin)
        if end > len(self._map):
            os.posix_fallocate(self._block_fd, 0, end)
            self._follow(end)
        views = {}
        for k, (name, kind, components) in enumerate(TABLES[table]):
            view = np.frombuffer(self._map, kind, rows * components, column_offset(table, k, rows, begin))
            views[name] = view if components == 1 else view.reshape(rows, components)
        return views

    def answer(self, kind: str, text: str = "", rows: int = 0) -> None:
        """Answers the last request. A text that is too long keeps its end, where an error says what it is."""
        passing = kind == "progress"
        encoded = text.encode()[-(PROGRESS_ROOM if passing else TEXT_ROOM) :]
        if not passing:
            self._map[: len(encoded)] = encoded
        packet = replace(
            self._request,
            kind=KINDS[kind],
            block_bytes=len(self._map),
            text_bytes=len(encoded),
            rows=rows,
        )
        self._socket.send(packet.bytes() + (encoded if passing else b""))

    def _follow(self, size: int) -> None:
        if size > len(self._map):
            self._map = mmap.mmap(self._block_fd, size)  # views into the old one keep it alive


if __name__ == "__main__":
    sys.stdout.write(describe_layout() + "\n")
