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
STEPS_AT_MOST = 100_000  # to one state of rest; 32,000 is the most that has been seen (docs/soil.md)
BLOCK = 200  # steps between two looks at the whole sample
GROW_EVERY = 10  # steps between two growths
DENSE_STRAIN = 1e-3  # pressure over E at which nearly frictionless grains find their dense packing soon
DENSE_UNBALANCED = 0.02  # when that is left
EASED_UNBALANCED = 0.05  # when the real friction comes
PACKED = {2: 0.83, 3: 0.60}  # solid fraction that a packing reaches about (measured)
CLOUD = {2: 0.45, 3: 0.25}  # solid fraction at which grains are thrown in without overlap
NOMINAL_DENSITY = 1e-3  # packing is quasi-static: any density gives the same sample


def mean_wall_stress(recipe: dict[str, Any], wall_ids: list[int]) -> float:
    """Compressive normal stress, MPa, mean over the walls that count (4 or 6)."""
    low, high = box_corners(recipe)
    size = high - low
    area = np.prod(size) / size  # of the walls across each axis
    counting = enumerate(wall_ids[: 2 * recipe["dimension"]])
    return float(np.mean([abs(O.forces.f(i)[k // 2]) / area[k // 2] for k, i in counting]))


class Growth:
    """All grains grow by one factor, in proportion to what the walls still lack, or shrink where they feel too much.

    The rate follows the sample: it goes up while the grains are loose and give way, and down once they carry, where a
    strain of P/E is all there is between no pressure and twice the wanted one.
    """

    FASTEST = 5e-3  # a growth: some hundred steps from the cloud to the first contacts
    LOOSE, TOO_MUCH = 0.3, -0.1  # of the wanted pressure that is missing

    def __init__(self) -> None:
        self.rate = self.FASTEST

    def grow(self, stress: float, pressure: float, strain: float) -> None:
        """One growth at `stress` (MPa) towards `pressure`, which is `strain` times the grains' modulus."""
        missing = max(-1.0, 1.0 - stress / pressure)
        if missing > self.LOOSE:
            self.rate *= 1.05
        elif missing < self.TOO_MUCH:
            self.rate *= 0.7
        self.rate = min(max(self.rate, 0.2 * strain), self.FASTEST)
        utils.growParticles(1.0 + self.rate * missing)


def make_servo(recipe: dict[str, Any], wall_ids: list[int], **how: Any) -> Any:
    """YADE's controller of the six walls."""
    names = ("left", "right", "bottom", "top", "back", "front")
    return wrapper.TriaxialStressController(
        thickness=0,
        stressMask=3 if recipe["dimension"] == 2 else 7,
        **{f"wall_{name}_id": i for name, i in zip(names, wall_ids)},
        **how,
    )


def throw_in(recipe: dict[str, Any]) -> list[Any]:
    """The cloud: as many grains as fill the box at their final size, each smaller by one factor. Returns them."""
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
        raise Refused(
            "the box holds no grain",
            key="soil.d_max_mm",
            given=f"{d_max}",
            remedy="take smaller grains or a larger box",
        )
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
    if len(radius) < 0.9 * total:
        raise Refused(
            f"only {len(radius)} of {total} grains find a place in the box",
            key="soil.box_to_mm",
            remedy="take a larger box, smaller grains or a higher porosity",
        )
    thrown = [add_grain(recipe, c, r) for c, r in zip(centre[outside], radius[outside])]
    O.bodies.append(thrown)
    return thrown


def pack_sample(recipe: dict[str, Any], progress: Callable[[str], None]) -> dict[str, Any]:
    """Leaves the packed sample in YADE, at rest under the confining pressure. Returns its description."""
    O.reset()
    pressure = recipe["confining_pressure_MPa"]
    make_materials({**recipe, "cohesion_MPa": 0.0}, NOMINAL_DENSITY)
    wall_ids = add_walls(recipe)
    obstacle_ids = add_obstacles(recipe)
    held = [(body, body.state.blockedDOFs) for body in O.bodies if body.dynamic]  # movable obstacles: they don't grow
    for body, _ in held:
        body.dynamic = False
    thrown = throw_in(recipe)
    growth = Growth()
    O.engines = [
        wrapper.ForceResetter(),
        *contact_engines(recipe),
        wrapper.GlobalStiffnessTimeStepper(
            active=True,
            timeStepUpdateInterval=100,
            timestepSafetyCoefficient=0.6,
            defaultDt=0.5 * utils.PWaveTimeStep(),
        ),
        wrapper.NewtonIntegrator(damping=recipe["damping"]),
    ]
    check_functors(recipe)
    O.dt = 0.5 * utils.PWaveTimeStep()

    steps = 0
    low, high = box_corners(recipe)
    free = float(np.prod(high - low)) - obstacle_volume(recipe)

    def porosity() -> float:
        return 1.0 - solid_volume(recipe, thrown) / free

    def compact(to_MPa: float, unbalanced_at_most: float) -> None:
        nonlocal steps
        most = steps + STEPS_AT_MOST
        while True:
            for _ in range(BLOCK // GROW_EVERY):
                for _ in range(GROW_EVERY):
                    O.step()
                mean = mean_wall_stress(recipe, wall_ids)
                growth.grow(mean, to_MPa, to_MPa / recipe["E_MPa"])
            steps += BLOCK
            unbalanced = utils.unbalancedForce()
            progress(
                f"packing {len(thrown)} grains: {100 * mean / to_MPa:.0f} % of {to_MPa:g} MPa, "
                f"unbalanced {unbalanced:.3f}, porosity {porosity():.3f}"
            )
            if abs(mean - to_MPa) < PRESSURE_ERROR * to_MPa and unbalanced < unbalanced_at_most:
                return
            if steps >= most:
                raise Refused(
                    f"the sample does not come to rest in {STEPS_AT_MOST} steps: {mean:.4g} of {to_MPa:g} MPa, "
                    f"unbalanced {unbalanced:.3g}",
                    key="soil",
                    given=f"damping {recipe['damping']:g}, friction {friction:g} degrees while packing, "
                    f"{recipe['friction_deg']:g} afterwards, pressure over E {pressure / recipe['E_MPa']:.2g}",
                    allowed=f"rest: {to_MPa:g} MPa within {100 * PRESSURE_ERROR:.0f} %, "
                    f"unbalanced below {unbalanced_at_most:g}",
                    remedy="take more damping (0.3 suits most soils), a higher confining_pressure_MPa, a wider box, or "
                    "a compaction_friction_deg of a few degrees",
                )

    target = recipe["porosity"]
    friction = recipe["compaction_friction_deg"] if target is None else recipe["friction_deg"]
    set_friction(friction)
    if target is None and pressure < DENSE_STRAIN * recipe["E_MPa"]:
        # the way to the dense packing takes some ten sqrt(E/P) steps: at a low pressure it would never end
        compact(DENSE_STRAIN * recipe["E_MPa"], DENSE_UNBALANCED)
    compact(pressure, EASED_UNBALANCED)
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
            set_friction(friction)
            compact(pressure, EASED_UNBALANCED)
    set_friction(recipe["friction_deg"])
    for body, blocked in held:
        body.state.blockedDOFs = blocked
    compact(pressure, UNBALANCED)

    for body in grains():
        body.state.vel = body.state.angVel = vector((0, 0, 0))
    diameters = 2 * np.array([b.shape.radius for b in thrown])
    contacts = O.interactions.countReal()
    void = free / solid_volume(recipe, thrown) - 1.0
    return {
        "wall_ids": wall_ids,
        "obstacle_ids": obstacle_ids,
        "grains": len(thrown),
        "steps": steps,
        "wall_stress_MPa": mean_wall_stress(recipe, wall_ids),
        "unbalanced": utils.unbalancedForce(),
        "porosity": porosity(),
        "void_ratio": void,
        "coordination": 2 * contacts / len(thrown),
        "d_mean_mm": float(diameters.mean()),
        "d_min_mm": float(diameters.min()),
        "d_max_mm": float(diameters.max()),
        "compaction_friction_deg": friction,
    }
