# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls, obstacles and grains."""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Any

import numpy as np

from contact_law import GRAIN_MASK, OBSTACLE_MASK, WALL_MASK
from engine import O, Quaternion, Vector3, utils, wrapper

PLANE = "zXY"  # degrees of freedom that a layer of spheres does not have


def vector(values: Any) -> Any:
    """YADE's vector of three numbers."""
    return Vector3(float(values[0]), float(values[1]), float(values[2]))


def box_corners(recipe: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Of the soil's box; a 2D layer is as deep as its grains are wide, so that force over area is a stress."""
    low, high = np.array(recipe["box_from_mm"], float), np.array(recipe["box_to_mm"], float)
    if recipe["dimension"] == 2:
        low[2], high[2] = -0.5 * recipe["layer_mm"], 0.5 * recipe["layer_mm"]
    return low, high


def add_walls(recipe: dict[str, Any]) -> list[int]:
    """Six smooth walls: x from, x to, y from, y to, z from, z to. In 2D those of z meet nothing."""
    low, high = box_corners(recipe)
    ids = O.bodies.append(utils.aabbWalls([vector(low), vector(high)], thickness=0, material="wall"))
    for i in ids:
        O.bodies[i].mask = WALL_MASK
    if recipe["dimension"] == 2:
        for i in ids[4:]:
            O.bodies[i].bounded = False
            O.bodies[i].bound = None
    return list(ids)


def add_grain(recipe: dict[str, Any], position: Any, radius: float) -> Any:
    """A grain, not yet in the simulation."""
    grain = utils.sphere(vector(position), float(radius), material="grain")
    grain.mask = GRAIN_MASK
    if recipe["dimension"] == 2:
        grain.state.blockedDOFs = PLANE
    return grain


def rotated(angle_deg: float, x: float, y: float) -> tuple[float, float]:
    """A vector turned about z."""
    c, s = cos(radians(angle_deg)), sin(radians(angle_deg))
    return c * x - s * y, s * x + c * y


def half_size(recipe: dict[str, Any], obstacle: dict[str, Any]) -> np.ndarray:
    """Half the sides of a box, a plate or a gap."""
    if obstacle["shape"] == "plate":
        side = 0.5 * obstacle["length_mm"]
        half = np.array([side, 0.5 * obstacle["thickness_mm"], side])
    else:
        half = np.array(obstacle["half_size_mm"], float)
    if recipe["dimension"] == 2:
        half[2] = recipe["layer_mm"]
    return half


def obstacle_balls(obstacle: dict[str, Any]) -> list[tuple[np.ndarray, float]]:
    """Centre and radius of the balls of a stone (one) or a clump (three, in a triangle)."""
    centre, radius = np.array(obstacle["position_mm"], float), obstacle["radius_mm"]
    if obstacle["shape"] == "stone":
        return [(centre, radius)]
    lobe = 0.6 * radius
    return [
        (centre + np.array([*rotated(obstacle["angle_deg"] + turn, radius - lobe, 0.0), 0.0]), lobe)
        for turn in (0.0, 120.0, 240.0)
    ]


def inside_obstacle(
    recipe: dict[str, Any], obstacle: dict[str, Any], position: np.ndarray, radius: np.ndarray
) -> np.ndarray:
    """Which balls overlap the obstacle; position (n, 3), radius (n,). A gap holds no centre."""
    if obstacle["shape"] in ("stone", "clump"):
        hit = np.zeros(len(radius), bool)
        for centre, ball in obstacle_balls(obstacle):
            hit |= np.linalg.norm(position - centre, axis=1) < ball + radius
        return hit
    offset = position - np.array(obstacle["position_mm"])
    angle = -radians(obstacle["angle_deg"])
    c, s = cos(angle), sin(angle)
    local = np.stack([c * offset[:, 0] - s * offset[:, 1], s * offset[:, 0] + c * offset[:, 1], offset[:, 2]], axis=1)
    beyond = np.maximum(np.abs(local) - half_size(recipe, obstacle), 0.0)
    margin = np.zeros(len(radius)) if obstacle["shape"] == "gap" else radius
    return np.linalg.norm(beyond, axis=1) <= margin


def obstacle_volume(recipe: dict[str, Any]) -> float:
    """What the obstacles take of the box, by sampling (mm^3; 2D: of the layer)."""
    low, high = box_corners(recipe)
    points = np.random.default_rng(1).uniform(low, high, (200_000, 3))
    if recipe["dimension"] == 2:
        points[:, 2] = 0.0
    hit = np.zeros(len(points), bool)
    for obstacle in recipe["obstacles"]:
        if obstacle["shape"] != "gap":
            hit |= inside_obstacle(recipe, obstacle, points, np.zeros(len(points)))
    return float(hit.mean() * np.prod(high - low))


def add_obstacles(recipe: dict[str, Any]) -> list[int]:
    """Ids of all fixed bodies that obstacles consist of; movable ones are grains of their own kind."""
    fixed: list[int] = []
    for obstacle in recipe["obstacles"]:
        shape = obstacle["shape"]
        if shape == "gap":
            continue
        if shape in ("box", "plate"):
            body = utils.box(
                vector(obstacle["position_mm"]),
                vector(half_size(recipe, obstacle)),
                orientation=Quaternion((0, 0, 1), radians(obstacle["angle_deg"])),
                fixed=True,
                material="grain",
            )
            body.mask = OBSTACLE_MASK
            fixed.append(O.bodies.append(body))
            continue
        balls = [
            utils.sphere(vector(centre), ball, material="grain", dynamic=obstacle["movable"])
            for centre, ball in obstacle_balls(obstacle)
        ]
        for ball in balls:
            ball.mask = GRAIN_MASK if obstacle["movable"] else OBSTACLE_MASK
        if not obstacle["movable"]:
            fixed.extend(O.bodies.append(ball) for ball in balls)
        elif len(balls) == 1:
            if recipe["dimension"] == 2:
                balls[0].state.blockedDOFs = PLANE
            O.bodies.append(balls[0])
        else:
            clump, _ = O.bodies.appendClumped(balls)
            if recipe["dimension"] == 2:
                O.bodies[clump].state.blockedDOFs = PLANE
    return fixed


def is_sphere(body: Any) -> bool:
    """Some ids may be empty."""
    return body is not None and isinstance(body.shape, wrapper.Sphere)


def grains() -> list[Any]:
    """Everything that soil consists of and that moves by itself: bodies that are free spheres."""
    return [b for b in O.bodies if is_sphere(b) and b.mask == GRAIN_MASK]


def solid_volume(recipe: dict[str, Any], balls: list[Any] | None = None) -> float:
    """Of these balls, by default all grains: mm^3; in 2D the discs' area times the layer, mm^3 too."""
    radii = np.array([b.shape.radius for b in (grains() if balls is None else balls)])
    if recipe["dimension"] == 2:
        return float(pi * (radii**2).sum() * recipe["layer_mm"])
    return float(4.0 / 3.0 * pi * (radii**3).sum())
