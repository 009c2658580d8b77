# SPDX-License-Identifier: MIT
"""Series of runs: what a folder holds is taken only where the same program made it."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import pytest

from rootsoil_tools.runs import RunError
from rootsoil_tools.series import Series

FAKE = """#!/usr/bin/python3
import json, pathlib, sys
if sys.argv[1] == "version":
    print("rootsoil 1.2.3")
    sys.exit()
out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
out.mkdir(parents=True, exist_ok=True)
(out / "summary.json").write_text(json.dumps({"time_h": 1.0}))
"""


def test_another_build_of_the_same_version_is_another_program(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    program, scene = tmp_path / "rootsoil", tmp_path / "scene.toml"
    program.write_text(FAKE)
    program.chmod(0o755)
    scene.write_text("[scene]\n")

    def run() -> Path:
        return Series(scene, tmp_path / "out", program).run("a", ["root.length_mm=1"], until_h=1.0)

    run()
    assert "running into" in capsys.readouterr().out
    run()
    assert "is finished" in capsys.readouterr().out
    program.write_text(FAKE + "# another build\n")
    with pytest.raises(RunError, match="another build of the program"):
        run()


def test_a_run_that_takes_too_long_is_ended(tmp_path: Path):
    program, scene = tmp_path / "rootsoil", tmp_path / "scene.toml"
    program.write_text("#!/usr/bin/python3\nwhile True:\n    pass\n")
    program.chmod(0o755)
    scene.write_text("[scene]\n")
    with pytest.raises(subprocess.CalledProcessError) as ended:
        Series(scene, tmp_path / "out", program, cpu_limit_s=1).run("a", [], until_h=1.0)
    assert ended.value.returncode == -signal.SIGXCPU
