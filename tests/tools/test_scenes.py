# SPDX-License-Identifier: MIT
"""rootsoil_tools/scenes.py: changes to a scene, and its file."""

from __future__ import annotations

import tomllib

from rootsoil_tools import scenes

BASE = {
    "root": {"length_mm": 1.0},
    "division": {"l0_mm": 0.01},
    "obstacle": [{"shape": "plane", "position_mm": [1.0, 0.0]}],
}


def test_changes_leave_the_base_as_it_is():
    own = {"x_e_mm": 0.5}
    changed = scenes.with_changes(
        BASE,
        {"root.length_mm": 2.0, "division": None, "tissue.anisotropy": own, "tissue.anisotropy.c_e": 0.2, "sleep": {}},
    )
    assert changed == {
        "root": {"length_mm": 2.0},
        "obstacle": BASE["obstacle"],
        "tissue": {"anisotropy": {"x_e_mm": 0.5, "c_e": 0.2}},
        "sleep": {},
    }
    assert BASE["root"]["length_mm"] == 1.0 and "division" in BASE and own == {"x_e_mm": 0.5}


def test_the_file_says_what_the_scene_does():
    assert tomllib.loads(scenes.scene_text(BASE)) == BASE
