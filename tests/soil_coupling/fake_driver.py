# SPDX-License-Identifier: MIT
"""A soil's process without YADE, that behaves as its file name's environment variable FAKE_SOIL says: every way in
which the real one can fail, on purpose and at once. The first interval always succeeds."""

import json
import os
import signal
import sys
import time
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "soil_coupling" / "yade_side"))

from message import KINDS, NAMES, Channel  # noqa: E402

NUMBERS = [f"soil_wall_{axis}_{end}_N" for axis in "xy" for end in ("from", "to")]
NUMBERS += [f"soil_obstacle_{axis}_N" for axis in "xyz"]
NUMBERS += [f"soil_{name}" for name in ("inertial_number", "substeps", "work_Nmm", "grains", "slots", "overlap_max")]
NUMBERS += [f"soil_{name}" for name in ("unbalanced", "force_balance", "coordination", "solid_fraction", "dem_s")]
NUMBERS += ["soil_settled_unbalanced", "soil_exchange_s"]

how = os.environ.get("FAKE_SOIL", "")
channel = Channel(3, 4)
while (request := channel.receive()) is not None:
    kind = NAMES[request.kind]
    if kind == "stop":
        break
    if kind == "hello":
        if how == "missing":
            channel.answer("failed", "YadeMissing: YADE can't be imported")
            os._exit(1)
        if how == "version":
            wrong = replace(request, version=99, kind=KINDS["done"], text_bytes=0)
            channel._socket.send(wrong.bytes())
            continue
        if how == "mute":
            time.sleep(60)
        channel.answer("done", json.dumps({"engine": "fake"}))
    elif kind == "advance":
        later = request.interval > 0
        print(f"interval {request.interval}", flush=True)
        if later and how == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if later and how == "crash":
            os.kill(os.getpid(), signal.SIGSEGV)
        if later and how == "stop":
            os.kill(os.getpid(), signal.SIGSTOP)
        if later and how == "exit":
            os._exit(7)
        if later and how == "traceback":
            raise ValueError("no such grain")
        if later and how == "throw":
            channel.answer("failed", "ZeroDivisionError: division by zero")
            os._exit(1)
        if later and how == "refuse":
            channel.answer("refused", json.dumps({"what": "no room", "key": "soil.box_to_mm", "remedy": "a wider box"}))
            os._exit(1)
        if later and how == "late":
            time.sleep(1.5)
        rows = request.rows
        motion = channel.columns("motion", rows)
        moved = motion["end_mm"] - motion["start_mm"]
        ids, radius = motion["id"].copy(), motion["radius_mm"].copy()
        forces = channel.columns("forces", rows)
        forces["mean_N"][:] = -moved
        forces["mean_torque_Nmm"][:] = 0.0
        forces["contact_stiffness_N_mm"][:] = ids + radius
        if later and how == "nan":
            forces["mean_N"][-1, 1] = float("nan")
        numbers = dict.fromkeys(NUMBERS, 0.0) | {"soil_rows": float(rows)}
        if later and how == "nan_number":
            numbers["soil_rows"] = float("nan")
        if later and how == "sequence":
            channel._request = replace(request, sequence=request.sequence - 1)
        if later and how == "rows":
            rows -= 1
        channel.answer("done", json.dumps(numbers), rows)
    else:
        if how == "progress":
            for k in range(3):
                channel.answer("progress", f"part {k}")
        channel.answer("done")
