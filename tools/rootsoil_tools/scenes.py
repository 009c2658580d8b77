# SPDX-License-Identifier: MIT
"""Scenes as nested dictionaries: a base, and changes to it. Sections and keys are those of the scene file."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

import tomli_w

Scene = dict[str, Any]
Changes = Mapping[str, Any]  # "section.key" or "section": value; None removes it

# Section 4.4 of the paper and its Eq. 1-4 to the letter; inertia from the stability bound: without, there is no step.
PAPER: Changes = {
    "tissue.law": "pressure_deviator",
    "numerics.kernel": "isotropic",
    "numerics.H_bar": 2.0,
    "numerics.gradient": "linear",
    "numerics.stepper": "predictor_corrector",
    "numerics.inertia": "scalar",
    "numerics.inertia_compensation": False,
    "non_affine_control": None,
}


def with_changes(scene: Scene, changes: Changes) -> Scene:
    """A copy of the scene with the changes made, in their order."""
    changed = copy.deepcopy(scene)
    for path, value in changes.items():
        *sections, key = path.split(".")
        inner = changed
        for section in sections:
            inner = inner.setdefault(section, {})
        if value is None:
            inner.pop(key, None)
        else:
            inner[key] = copy.deepcopy(value)
    return changed


def scene_text(scene: Scene) -> str:
    """The scene file."""
    return tomli_w.dumps(scene)
