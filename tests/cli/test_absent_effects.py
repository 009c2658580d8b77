# SPDX-License-Identifier: MIT
"""What a scene does not call for is not there: no field, no phase, no pair term. `check --json` tells."""

from __future__ import annotations

from typing import Any

import pytest
from cli_support import FULL, PROJECT, SECTIONS, SMALL, Program, replaced, summary

PROBES = {
    'name = "bin"\ndistance_to_tip_mm = [0.1, 0.2]': set(),
    'name = "cell"\nposition_mm = [0.2, 0.0]': {"probe cell"},  # which cells descend from the one it began with
}
EVERY = PROJECT / "tests" / "support" / "every_effect.toml"
# what a root has that nothing happens to
ALWAYS_FIELDS = {
    *("position", "velocity", "volume", "mass", "material_stress", "frame", "shape", "distance_to_tip", "generation"),
    *("cell_id", "parent_id", "clamped", "velocity_gradient", "deformation", "nominal_force", "force"),
    *("axial_strain", "window_index"),
}
ALWAYS_PHASES = {
    *("root axis", "neighbours", "gradient operators", "pair terms", "velocity gradients", "material", "forces"),
}
# and with inertia
INERTIA_FIELDS = {"inverse_inertia", "start_velocity"}
INERTIA_PHASES = {"stability bound", "motion"}
# section: its name in the list of effects, and what it alone brings
FIELDS = {
    "anisotropy": ("anisotropy", {"radial_modulus", "stiffness"}),
    "growth": ("growth", {"softening"}),
    "obstacle": ("obstacle", {"slip wall", "contact wall"}),
    "non_affine_control": ("pair resistance", {"pair_damping", "start_frame", "start_position"}),
    "pressure": ("pressure", set()),
    "division": ("division", set()),
}
PHASES = {
    "anisotropy": {"anisotropy"},
    "growth": {"growth"},
    "obstacle": {"obstacle wall"},
    "division": {"division"},
}


def names(found: list[dict[str, Any]]) -> set[str]:
    """The names in a list."""
    return {entry["name"] for entry in found}


def active(found: dict[str, Any]) -> set[str]:
    """The effects that take part."""
    return names([effect for effect in found["effects"] if effect["active"]])


@pytest.fixture
def full(program: Program) -> dict[str, Any]:
    """What `check --json` says of the scene with every effect."""
    return program("check", program.scene(FULL), "--json").json()


def test_check_has_its_keys(full: dict[str, Any]):
    """Effects, fields with bytes, pair terms, step, stability, hyperbolicity and time are there for programs."""
    assert {
        "cells",
        "effects",
        "fields",
        "pair_terms",
        "phases",
        "step_h",
        "steps",
        "hyperbolic",
        "estimated_run_s",
    } <= (full.keys())
    assert full["step_h"] == 0.001 and full["steps"] == 400 and full["hyperbolic"] is True
    assert full["bytes_per_cell"] == sum(field["bytes_per_cell"] for field in full["fields"])
    assert all(field["unit"] and field["kept"] in ("state", "scratch") for field in full["fields"])
    assert full["estimated_run_s"] > 0
    assert full["processes"] == ["rootsoil"]


def test_check_for_people(program: Program, full: dict[str, Any]):
    """The text of `check` says the same."""
    text = program("check", program.scene(FULL)).out
    for effect in full["effects"]:
        line = next(line for line in text.splitlines() if line.startswith(f"  {effect['name']} "))
        assert ("not called for" in line) != effect["active"]
    for field in full["fields"]:
        assert f"\n  {field['name']} " in text
    assert "step: 0.001 h, 400 steps" in text and "hyperbolic: yes" in text and "estimated run time" in text
    assert f"discretisation error about {100 * full['discretisation_error']:.2g} %; inertia error " in text
    assert full["inertia_error_at_start"] > 0.0


def test_check_writes_nothing(program: Program):
    """`check` runs nothing that stays."""
    scene = program.scene(FULL)
    assert program("check", scene).status == 0
    assert list(program.folder.iterdir()) == [scene]


@pytest.mark.parametrize("section", FIELDS)
def test_without_one_section(program: Program, full: dict[str, Any], section: str):
    """A section taken out takes its effect, its fields, its phase and its pair terms along, and nothing else."""
    effect, fields = FIELDS[section]
    found = program("check", program.scene(replaced(FULL, SECTIONS[section], "")), "--json").json()
    assert effect in active(full) and effect not in active(found)
    assert fields <= names(full["fields"]) - names(found["fields"])
    assert names(found["fields"]) <= names(full["fields"])
    assert found["bytes_per_cell"] <= full["bytes_per_cell"]
    assert PHASES.get(section, set()) <= set(full["phases"]) - set(found["phases"])
    assert set(found["phases"]) <= set(full["phases"])
    assert effect not in {term["effect"] for term in found["pair_terms"]}


def test_nothing_at_all(program: Program, full: dict[str, Any]):
    """The smallest scene: of everything that any effect of the table brings, nothing is there."""
    every = program("check", EVERY, "--json").json()
    assert active(every) == names(program("effects", "--json").json()), f"call for it in {EVERY.name}"
    for stepper in ("quasi_static", "symplectic"):
        scene = program.scene(SMALL + f'[numerics]\nstepper = "{stepper}"\n')
        found = program("check", scene, "--json").json()
        assert names(found["effects"]) == active(every) and active(found) == {"clamped base"}
        assert found["pair_terms"] == []
        with_inertia = stepper == "symplectic"
        assert names(found["fields"]) == ALWAYS_FIELDS | (INERTIA_FIELDS if with_inertia else set())
        assert set(found["phases"]) == ALWAYS_PHASES | (INERTIA_PHASES if with_inertia else {"balance"})
        assert ALWAYS_FIELDS | INERTIA_FIELDS < names(every["fields"])
        assert ALWAYS_PHASES | INERTIA_PHASES < set(every["phases"])
        assert found["bytes_per_pair"] < full["bytes_per_pair"]


@pytest.mark.parametrize("probe", PROBES)
def test_a_probe(program: Program, full: dict[str, Any], probe: str):
    """A probe is listed; one in a bin adds nothing to the cells, one at a cell a mark; none adds to the pairs."""
    found = program("check", program.scene(f"{FULL}\n[[probe]]\n{probe}\n"), "--json").json()
    assert active(found) == active(full) | {"probe"}
    assert names(found["fields"]) - names(full["fields"]) == PROBES[probe]
    for key in ("pair_terms", "bytes_per_pair", "cells", "step_h"):
        assert found[key] == full[key]


def test_check_agrees_with_the_run(program: Program, full: dict[str, Any]):
    """The effects and fields that `check` announces are those that the run lists in summary.json."""
    assert program("run", program.scene(FULL), "--out", "out", "--until", 0.01).status == 0
    found = summary(program.folder / "out")
    assert set(found["active_effects"]) == active(full)
    assert found["fields"] == full["fields"]
    assert found["wall_s_by_effect"].keys() == set(full["phases"])
