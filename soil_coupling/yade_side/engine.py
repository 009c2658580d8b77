# SPDX-License-Identifier: GPL-2.0-or-later
"""The one place that imports YADE: as a plain Python module.

The program `yade` is never started: it opens an interactive prompt and an XML-RPC server to the network. The import
opens no socket. The environment must say how many threads there are before the import.
"""

from __future__ import annotations

import ctypes
import glob
import os
import sys
import sysconfig

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

# YADE looks for a configuration in the user's home, which nothing here reads, ends where there is no HOME, and moves
# one of an old version to its present place. It gets a home that does not exist.
os.environ["HOME"] = os.environ["XDG_CONFIG_HOME"] = "/nonexistent"

SUPPORTED = "2023.02a"  # what the coupling was measured and tested with
FOLDER_VARIABLE = "ROOTSOIL_YADE_FOLDER"
NO_TEMPORARY_FOLDER_VARIABLE = "ROOTSOIL_NO_TEMPORARY_FOLDER"  # a library: no_temporary_folder.c


class YadeMissing(Exception):
    """There is no YADE, or another one than the coupling was tested with."""


def yade_folder() -> str:
    """The folder that holds the Python package `yade` in double precision."""
    if given := os.environ.get(FOLDER_VARIABLE):
        return given
    own = f"/usr/lib/{sysconfig.get_config_var('MULTIARCH')}/yade-double/py"
    found = [own, *sorted(glob.glob("/usr/lib/*/yade-double/py"))]
    return next((folder for folder in found if os.path.isdir(os.path.join(folder, "yade"))), own)


if library := os.environ.get(NO_TEMPORARY_FOLDER_VARIABLE):
    ctypes.CDLL(library, mode=ctypes.RTLD_GLOBAL)
sys.path.insert(0, yade_folder())
try:
    import yade  # noqa: F401
    from yade import config, pack, utils, wrapper
    from yade.minieigenHP import Matrix3, Quaternion, Vector3
except ImportError as error:
    raise YadeMissing(
        f"YADE can't be imported from {yade_folder()} ({error}); install Debian's package yade (tools/setup.sh --soil)"
    ) from None

VERSION = str(config.version)
if VERSION != SUPPORTED:
    raise YadeMissing(f"YADE {VERSION} is installed, the coupling was tested with {SUPPORTED} (Debian 12) only")

O = wrapper.Omega()  # noqa: E741 - its name everywhere in YADE

__all__ = ["Matrix3", "O", "Quaternion", "VERSION", "Vector3", "YadeMissing", "pack", "utils", "wrapper"]
