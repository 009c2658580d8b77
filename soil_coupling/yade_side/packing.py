# SPDX-License-Identifier: GPL-2.0-or-later
"""Packs a sample: a loose cloud of small grains in the box, which grow until the walls feel the confining pressure."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np

from bodies import (
    add_grain,
    add_obstacles,
    add_walls,
    box_corners,
    grains,
    inside_obstacle,
    obstacle_volume,
    solid_volume,
    vector,
)
from contact_law import check_functors, contact_engines, make_materials, set_friction
from engine import O, pack, utils, wrapper
from soil_file import Refused

PRESSURE_ERROR = 0.02  # of the mean wall stress, when packing ends
UNBALANCED = 0.01  # mean unbalanced force over mean contact force, when packing ends
STEPS_AT_MOST = 400_000
BLOCK = 200  # steps between two looks
PACKED = {2: 0.83, 3: 0.60}  # solid fraction that a packing reaches about (measured)
CLOUD = {2: 0.45, 3: 0.25}  # solid fraction at which grains are thrown in without overlap
NOMINAL_DENSITY = 1e-3  # packing is quasi-static: any density gives the same sample


def wall_stresses(recipe: dict[str, Any], servo: Any) -> np.ndarray:
    """Compressive normal stress on each wall that counts, MPa: (4,) or (6,)."""
    ids = [
        servo.wall_left_id,
        servo.wall_right_id,
        servo.wall_bottom_id,
        servo.wall_top_id,
        servo.wall_back_id,
        servo.wall_front_id,
    ][: 2 * recipe["dimension"]]
    return np.array([abs(servo.stress(i)[k // 2]) for k, i in enumerate(ids)])


def make_servo(recipe: dict[str, Any], wall_ids: list[int], **how: Any) -> Any:
    """YADE's controller of the six walls."""
    names = ("left", "right", "bottom", "top", "back", "front")
    return wrapper.TriaxialStressController(
        thickness=0,
        stressMask=3 if recipe["dimension"] == 2 else 7,
        **{f"wall_{name}_id": i for name, i in zip(names, wall_ids)},
        **how,
    )


def throw_in(recipe: dict[str, Any]) -> int:
    """The cloud: as many grains as fill the box at their final size, each smaller by one factor. Returns how many."""
    dimension = recipe["dimension"]
    low, high = box_corners(recipe)
    free = float(np.prod(high - low)) - obstacle_volume(recipe)
    d_min, d_max = recipe["d_min_mm"], recipe["d_max_mm"]
    mean, spread = 0.5 * (d_min + d_max), (d_max - d_min) / (d_max + d_min)
    # mean of d^n for diameters evenly spread over mean (1 - spread, 1 + spread)
    moment = mean**2 * (1 + spread**2 / 3) if dimension == 2 else mean**3 * (1 + spread**2)
    grain = pi / 4 * moment * recipe["layer_mm"] if dimension == 2 else pi / 6 * moment
    solid = 1.0 - recipe["porosity"] if recipe["porosity"] is not None else PACKED[dimension]
    wanted = int(free * solid / grain)
    if wanted < 1:
        raise Refused("the box holds no grain", key="soil.d_max_mm", given=f"{d_max}", remedy="take smaller grains or a larger box")
    shrink = (CLOUD[dimension] / solid) ** (1 / dimension)
    cloud = pack.SpherePack()
    corners = [vector(low), vector(high)]
    if dimension == 2:
        corners[0][2] = corners[1][2] = 0.0
    total = int(wanted * float(np.prod(high - low)) / free)  # those inside obstacles go again
    cloud.makeCloud(
        corners[0], corners[1], rMean=0.5 * mean * shrink, rRelFuzz=spread, num=total, seed=int(recipe["seed"])
    )
    centre = np.array([[*c] for c, _ in cloud])
    radius = np.array([r for _, r in cloud])
    outside = np.ones(len(radius), bool)
    for obstacle in recipe["obstacles"]:
        if obstacle["shape"] != "gap":
            outside &= ~inside_obstacle(recipe, obstacle, centre, radius)
    for c, r in zip(centre[outside], radius[outside]):
        O.bodies.append(add_grain(recipe, c, r))
    if len(radius) < 0.9 * total:
        raise Refused(
            f"only {len(radius)} of {total} grains find a place in the box",
            key="soil.box_to_mm",
            remedy="take a larger box, smaller grains or a higher porosity",
        )
    return int(outside.sum())


def pack_sample(recipe: dict[str, Any], progress: Callable[[str], None]) -> dict[str, Any]:
    """Leaves the packed sample in YADE, at rest under the confining pressure. Returns its description."""
    O.reset()
    dimension, pressure = recipe["dimension"], recipe["confining_pressure_MPa"]
    make_materials({**recipe, "cohesion_MPa": 0.0}, NOMINAL_DENSITY)
    wall_ids = add_walls(recipe)
    obstacle_ids = add_obstacles(recipe)
    count = throw_in(recipe)
    strain = pressure / recipe["E_MPa"]
    # the mean of three axes is what is controlled, and in 2D the third one has no stress
    goal = -pressure * (2 / 3 if dimension == 2 else 1.0)
    servo = make_servo(
        recipe,
        wall_ids,
        internalCompaction=True,
        maxMultiplier=1 + 20 * strain,  # growth a step must follow P/E, or it never converges with stiff grains
        finalMaxMultiplier=1 + 0.2 * strain,
        goal1=goal,
        goal2=goal,
        goal3=goal,
    )
    O.engines = [
        wrapper.ForceResetter(),
        *contact_engines(recipe),
        wrapper.GlobalStiffnessTimeStepper(
            active=True, timeStepUpdateInterval=100, timestepSafetyCoefficient=0.6, defaultDt=0.5 * utils.PWaveTimeStep()
        ),
        servo,
        wrapper.NewtonIntegrator(damping=recipe["damping"]),
    ]
    check_functors(recipe)
    O.dt = 0.5 * utils.PWaveTimeStep()

    steps = 0
    low, high = box_corners(recipe)
    free = float(np.prod(high - low)) - obstacle_volume(recipe)

    def porosity() -> float:
        return 1.0 - solid_volume(recipe) / free

    def compact(friction_deg: float) -> None:
        nonlocal steps
        while True:
            for _ in range(BLOCK):
                O.step()
            steps += BLOCK
            unbalanced = utils.unbalancedForce()
            mean = float(wall_stresses(recipe, servo).mean())
            progress(
                f"packing {count} grains: {100 * mean / pressure:.0f} % of {pressure:g} MPa, "
                f"unbalanced {unbalanced:.3f}, porosity {porosity():.3f}"
            )
            if abs(mean - pressure) < PRESSURE_ERROR * pressure and unbalanced < UNBALANCED:
                return
            if steps > STEPS_AT_MOST:
                raise Refused(
                    f"the sample does not come to rest: {mean:.4g} MPa, unbalanced {unbalanced:.3g} after {steps} steps",
                    key="soil",
                    remedy="take a wider box, more friction or a compaction_friction_deg of a few degrees",
                )

    target = recipe["porosity"]
    friction = recipe["compaction_friction_deg"] if target is None else recipe["friction_deg"]
    set_friction(recipe, friction)
    compact(friction)
    if target is not None:
        if porosity() < target:
            raise Refused(
                "the grains pack more densely than that, even with their full friction",
                key="soil.porosity",
                given=f"{target:g}",
                allowed=f"at most {porosity():.3f} for these grains",
                remedy="lower the porosity, or raise friction_deg or rolling",
            )
        loosest = porosity()
        while porosity() > target:
            friction *= 0.85
            if friction < 0.1:
                raise Refused(
                    "the grains do not pack as densely as that, even without friction",
                    key="soil.porosity",
                    given=f"{target:g}",
                    allowed=f"{porosity():.3f} to {loosest:.3f} for these grains",
                    remedy="raise the porosity, or spread the diameters more",
                )
            set_friction(recipe, friction)
            compact(friction)
    set_friction(recipe, recipe["friction_deg"])
    compact(recipe["friction_deg"])

    for body in grains():
        body.state.vel = body.state.angVel = vector((0, 0, 0))
    diameters = 2 * np.array([b.shape.radius for b in grains()])
    contacts = O.interactions.countReal()
    void = free / solid_volume(recipe) - 1.0
    return {
        "wall_ids": wall_ids,
        "obstacle_ids": obstacle_ids,
        "grains": count,
        "steps": steps,
        "porosity": porosity(),
        "void_ratio": void,
        "coordination": 2 * contacts / max(count, 1),
        "d_mean_mm": float(diameters.mean()),
        "d_min_mm": float(diameters.min()),
        "d_max_mm": float(diameters.max()),
        "compaction_friction_deg": friction,
    }
