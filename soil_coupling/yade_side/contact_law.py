# SPDX-License-Identifier: GPL-2.0-or-later
"""Materials and functors of each contact law, and which bodies meet which.

YADE runs a mismatched pair of functors without any error, so they are listed here once and checked afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians
from typing import Any

from engine import O, utils, wrapper

# Bodies meet where their masks share a bit; bodies that share SELF never meet (the root's markers).
GRAIN_MASK, WALL_MASK, ROOT_MASK, OBSTACLE_MASK, SELF = 3, 2, 5, 1, 4


@dataclass(frozen=True)
class Functors:
    """Names of YADE's classes."""

    sphere_sphere: str
    box_sphere: str
    physics: str
    law: str
    phys: str  # what `physics` makes of a contact


FRICTION = Functors(
    "Ig2_Sphere_Sphere_ScGeom",
    "Ig2_Box_Sphere_ScGeom",
    "Ip2_FrictMat_FrictMat_FrictPhys",
    "Law2_ScGeom_FrictPhys_CundallStrack",
    "FrictPhys",
)
MINDLIN = Functors(
    "Ig2_Sphere_Sphere_ScGeom",
    "Ig2_Box_Sphere_ScGeom",
    "Ip2_FrictMat_FrictMat_MindlinPhys",
    "Law2_ScGeom_MindlinPhys_Mindlin",
    "MindlinPhys",
)
COHESION = Functors(
    "Ig2_Sphere_Sphere_ScGeom6D",
    "Ig2_Box_Sphere_ScGeom6D",
    "Ip2_CohFrictMat_CohFrictMat_CohFrictPhys",
    "Law2_ScGeom6D_CohFrictPhys_CohesionMoment",
    "CohFrictPhys",
)


def functors_of(recipe: dict[str, Any]) -> Functors:
    """Rolling resistance needs the moments of the cohesive law, even without cohesion."""
    if recipe["contact_law"] == "hertz_mindlin":
        return MINDLIN
    if recipe["contact_law"] == "cohesive" or recipe["rolling"] > 0.0:
        return COHESION
    return FRICTION


def make_materials(recipe: dict[str, Any], density: float) -> None:
    """`grain`, `wall` (smooth) and `root`. Two materials meet with the smaller friction and the smaller cohesion."""

    def material(label: str, friction_deg: float, rolling: float, cohesion: float) -> Any:
        common = {
            "young": recipe["E_MPa"],
            "poisson": recipe["poisson"],
            "frictionAngle": radians(friction_deg),
            "density": density,
            "label": label,
        }
        if functors_of(recipe) is not COHESION:
            return wrapper.FrictMat(**common)
        return wrapper.CohFrictMat(
            **common,
            momentRotationLaw=rolling > 0.0,
            alphaKr=2.0,
            etaRoll=rolling,
            alphaKtw=0.0,
            isCohesive=cohesion > 0.0,
            normalCohesion=cohesion,
            shearCohesion=cohesion,
            fragile=True,
        )

    O.materials.append(material("grain", recipe["friction_deg"], recipe["rolling"], recipe["cohesion_MPa"]))
    O.materials.append(material("wall", 0.0, 0.0, 0.0))
    O.materials.append(material("root", recipe["root_friction_deg"], 0.0, 0.0))


def contact_engines(recipe: dict[str, Any]) -> list[Any]:
    """Collider and contact loop."""
    names = functors_of(recipe)
    collider = wrapper.InsertionSortCollider(
        [wrapper.Bo1_Sphere_Aabb(), wrapper.Bo1_Box_Aabb()],
        verletDist=0.15 * recipe["d_mean_mm"],
        avoidSelfInteractionMask=SELF,
    )
    law = getattr(wrapper, names.law)()
    if names is COHESION:
        law.always_use_moment_law = recipe["rolling"] > 0.0  # otherwise only bonds resist rolling
        law.useIncrementalForm = True
    loop = wrapper.InteractionLoop(
        [getattr(wrapper, names.sphere_sphere)(), getattr(wrapper, names.box_sphere)()],
        [getattr(wrapper, names.physics)()],
        [law],
    )
    return [collider, loop]


def bond_grains_in_touch() -> None:
    """Cohesion between grains that touch now; contacts that come later have none, and broken ones stay broken."""
    loop = next(e for e in O.engines if isinstance(e, wrapper.InteractionLoop))
    functor = loop.physDispatcher.functors[0]
    functor.setCohesionNow = True
    functor.setCohesionOnNewContacts = False


def check_functors(recipe: dict[str, Any]) -> None:
    """RuntimeError where the functors in use, or a contact's physics, are not those of the recipe's law."""
    names = functors_of(recipe)
    loop = next(e for e in O.engines if isinstance(e, wrapper.InteractionLoop))

    def used(dispatcher: Any) -> set[str]:
        return {type(functor).__name__ for functor in dispatcher.functors}

    found = (used(loop.geomDispatcher), used(loop.physDispatcher), used(loop.lawDispatcher))
    wanted = ({names.sphere_sphere, names.box_sphere}, {names.physics}, {names.law})
    if found != wanted:
        raise RuntimeError(f"contact functors {found} instead of {wanted}")
    for contact in O.interactions:
        if contact.isReal and type(contact.phys).__name__ != names.phys:
            raise RuntimeError(f"a contact has {type(contact.phys).__name__} instead of {names.phys}")


def set_friction(friction_deg: float) -> None:
    """Of the grains, in the material and in every contact there is."""
    utils.setContactFriction(radians(friction_deg))
    O.materials["grain"].frictionAngle = radians(friction_deg)
