# SPDX-License-Identifier: GPL-2.0-or-later
"""The soil that a root grows through: grains, walls, obstacles, and the root's markers among them.

The markers are spheres that move as they are told: each gets the constant velocity that brings it from where it is to
where it must be at the interval's end. Contacts then see how it moves; markers that were only put in their place would
rub without friction.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from math import ceil, isfinite, sqrt
from pathlib import Path
from typing import Any

import numpy as np

import packing
from bodies import (
    add_grain,
    add_obstacles,
    add_walls,
    box_corners,
    grains,
    inside_obstacle,
    is_sphere,
    solid_volume,
    vector,
)
from contact_law import ROOT_MASK, bond_grains_in_touch, check_functors, contact_engines, make_materials
from engine import VERSION, O, utils, wrapper
from soil_file import Refused, read_soil_file, write_soil_file

SUBSTEPS_AT_LEAST = 10
FORCE_SAMPLES = 4  # equal parts of an interval, in whose middle forces are read
CHECK_EVERY = 50  # intervals between two looks at what is costly to see
CARVE = 0.95  # a grain goes where it overlaps the root by more than the rest of its radius
SETTLED = 0.02  # mean unbalanced over mean contact force, after the root has been put in
SETTLE_BLOCKS, SETTLE_STEPS = 100, 200
OVERLAP_AT_MOST = 0.5  # of two spheres, over the smaller radius: beyond it contact laws mean nothing
COLLIDE = 2.0  # a squared speed that makes the collider look again: it does not see new markers and radii by itself
Balls = tuple[np.ndarray, np.ndarray]  # centres (n, 3) and radii (n,), mm
NO_FORCE = vector((0.0, 0.0, 0.0))
RUPTURE = "raise soil.E_MPa (250 times the stress on the tip keeps overlaps small), or exchange more often"


def memory_file() -> int:
    """A file in memory, for YADE's archive."""
    return os.memfd_create("rootsoil-archive", os.MFD_CLOEXEC)


def archive() -> bytes:
    """YADE's whole state. Without a suffix in the name it is binary and not compressed."""
    fd = memory_file()
    try:
        O.save(f"/proc/self/fd/{fd}")
        with open(f"/proc/self/fd/{fd}", "rb") as file:
            return file.read()
    finally:
        os.close(fd)


def unarchive(data: bytes) -> None:
    """Puts YADE into that state. Every reference into the old one is stale afterwards, and silently so."""
    fd = memory_file()
    try:
        with open(f"/proc/self/fd/{fd}", "wb") as file:
            file.write(data)
        O.load(f"/proc/self/fd/{fd}")
    finally:
        os.close(fd)


def read_forces(slots: list[int]) -> np.ndarray:
    """Present force and torque on each body, (bodies, 6)."""
    f, t = O.forces.f, O.forces.t
    rows = []
    for slot in slots:
        a, b = f(slot), t(slot)
        rows.append((a[0], a[1], a[2], b[0], b[1], b[2]))
    return np.array(rows).reshape(-1, 6)


def make_sample(recipe: dict[str, Any], path: Path, progress: Callable[[str], None]) -> dict[str, Any]:
    """Packs a sample and writes its file. Returns its description."""
    meta = packing.pack_sample(recipe, progress)
    write_soil_file(path, "sample", VERSION, {**meta, "recipe": recipe["packing_key"]}, archive())
    return meta


class Soil:
    """The state on this side. `start` holds density_N_h2_mm4, root_speed_mm_h, root_diameter_mm."""

    def __init__(self, recipe: dict[str, Any], start: dict[str, Any], progress: Callable[[str], None]):
        self.recipe, self.start, self.progress = recipe, start, progress
        self.wall_ids: list[int] = []
        self.obstacle_ids: list[int] = []
        self.slots: dict[int, int] = {}  # marker -> YADE's body
        self.free_slots: list[int] = []
        self.placed = False
        self.numbers: dict[str, float] = {}
        self.work = 0.0
        self.body = (np.zeros((0, 3)), np.zeros(0))

    # ---- beginning ------------------------------------------------------------------------------

    def build(self, sample: Path | None, listed: Balls, body: Balls) -> None:
        """Grains from the sample or as listed; the root, which fills `body`, comes with the first interval."""
        recipe, density = self.recipe, self.start["density_N_h2_mm4"]
        O.reset()
        if sample is not None:
            meta, data = read_soil_file(sample, "sample", VERSION)
            if meta["recipe"] != recipe["packing_key"]:
                raise Refused(
                    "the sample was packed for another recipe",
                    file=str(sample),
                    remedy="delete the file; the next run packs anew",
                )
            unarchive(data)
            self.wall_ids, self.obstacle_ids = meta["wall_ids"], meta["obstacle_ids"]
        else:
            make_materials(recipe, density)
            self.wall_ids = add_walls(recipe)
            self.obstacle_ids = add_obstacles(recipe)
            self._check_obstacles_among(*listed)
            for centre, radius in zip(*listed):
                O.bodies.append(add_grain(recipe, centre, radius))
        self._set_materials(density)
        self._carve_gaps()
        self.body = body
        O.engines = self._engines()
        O.dt = self._substep()
        check_functors(recipe)
        if recipe["cohesion_MPa"] > 0.0:
            bond_grains_in_touch()
        self._rebind()

    def _check_obstacles_among(self, centre: np.ndarray, radius: np.ndarray) -> None:
        """Refused: a listed grain lies in an obstacle. The other checks of listed grains are the program's."""
        for obstacle in self.recipe["obstacles"]:
            if obstacle["shape"] == "gap":
                continue
            hit = np.flatnonzero(inside_obstacle(self.recipe, obstacle, centre, OVERLAP_AT_MOST * radius))
            if len(hit):
                raise Refused(
                    f"{len(hit)} of the listed grains lie in the obstacle '{obstacle['name']}'",
                    key="soil.grains_file",
                    given="the first one at ({:g}, {:g}, {:g}) mm".format(*centre[hit[0]]),
                    allowed=f"at most {100 * OVERLAP_AT_MOST:.0f} % of a radius may reach into it",
                    remedy="leave these grains out of the file, or move the obstacle",
                )

    def _set_materials(self, density: float) -> None:
        """A sample is packed without knowing the root: density, cohesion and the root's friction come now."""
        recipe = self.recipe
        root = O.materials["root"]
        root.frictionAngle = np.radians(recipe["root_friction_deg"])
        for label in ("grain", "wall", "root"):
            O.materials[label].density = density
        if recipe["cohesion_MPa"] > 0.0:
            grain = O.materials["grain"]
            grain.isCohesive = True
            grain.normalCohesion = grain.shearCohesion = recipe["cohesion_MPa"]
        for body in O.bodies:
            if body.isClump:
                continue
            if is_sphere(body):
                radius = body.shape.radius
                body.state.mass = density * 4.0 / 3.0 * np.pi * radius**3
                body.state.inertia = vector([0.4 * body.state.mass * radius**2] * 3)
        for body in O.bodies:
            if body.isClump:
                O.bodies.updateClumpProperties(excludeList=[], discretization=10)
                break

    def _carve_gaps(self) -> None:
        for obstacle in self.recipe["obstacles"]:
            if obstacle["shape"] == "gap":
                self._erase(lambda p, r: inside_obstacle(self.recipe, obstacle, p, r))

    def _erase(self, where: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> int:
        """Erases grains by position (n, 3) and radius (n,); single ones only, clumps stay."""
        single = [b for b in grains() if not b.isClumpMember]
        if not single:
            return 0
        position = np.array([[*b.state.pos] for b in single])
        radius = np.array([b.shape.radius for b in single])
        hit = where(position, radius)
        for body, gone in zip(single, hit):
            if gone:
                O.bodies.erase(body.id)
        return int(hit.sum())

    def _engines(self) -> list[Any]:
        recipe = self.recipe
        engines = [wrapper.ForceResetter(), *contact_engines(recipe)]
        if recipe["walls"] != "rigid" or not recipe["listed_grains"]:
            pressure = recipe["confining_pressure_MPa"]
            flat = recipe["dimension"] == 2
            engines.append(
                packing.make_servo(
                    recipe,
                    self.wall_ids,
                    internalCompaction=False,
                    goal1=-pressure,
                    goal2=-pressure,
                    goal3=0.0 if flat else -pressure,
                    max_vel=2.0 * self.start["root_speed_mm_h"],
                    wall_right_activated=recipe["walls"] == "servo",  # the one that the root grows towards
                    wall_front_activated=not flat,
                    wall_back_activated=not flat,
                )
            )
        engines.append(wrapper.NewtonIntegrator(damping=recipe["damping"]))
        return engines

    def _substep(self) -> float:
        """The step in which a pressure wave crosses the smallest grain's radius, times the safety factor."""
        radii = [b.shape.radius for b in grains()]
        density = self.start["density_N_h2_mm4"]
        smallest = min(radii, default=0.5 * self.recipe["d_min_mm"])
        return self.recipe["step_safety"] * smallest * sqrt(density / self.recipe["E_MPa"])

    def _rebind(self) -> None:
        """References into YADE; after every load."""
        self.newton = next(e for e in O.engines if isinstance(e, wrapper.NewtonIntegrator))
        self.collider = next(e for e in O.engines if isinstance(e, wrapper.InsertionSortCollider))
        self.critical_step = self._substep()
        self.grain_count = len(grains())
        self.solid = solid_volume(self.recipe)
        self.row_ids: list[int] | None = None  # rows are listed anew in the next interval

    # ---- markers --------------------------------------------------------------------------------

    def _list_rows(self, ids: list[int]) -> None:
        """A row for each marker, then walls and obstacles: their bodies and where they are."""
        self.row_ids = ids
        self.row_states = [O.bodies[self.slots[m]].state for m in ids]
        self.row_position = np.array([[p[0], p[1], p[2]] for p in (s.pos for s in self.row_states)]).reshape(-1, 3)
        fixed = self.wall_ids[: 2 * self.recipe["dimension"]] + self.obstacle_ids
        self.row_slots = [self.slots[m] for m in ids] + fixed
        self.row_radius = np.array([O.bodies[self.slots[m]].shape.radius for m in ids])
        self.near = self.in_touch = list(enumerate(self.row_slots))
        self.collisions_seen = -1
        self.newton.maxVelocitySq = COLLIDE

    def _list_near(self) -> None:
        """Rows whose bounds meet another body's. Between two runs of the collider nothing else can come into touch."""
        self.collisions_seen = self.collider.numAction
        around, markers = O.interactions.withBodyAll, len(self.row_states)
        self.near = [(k, slot) for k, slot in enumerate(self.row_slots) if k >= markers or around(slot)]

    def _insert(self, marker: int, position: Any, radius: float) -> None:
        body = utils.sphere(vector(position), float(radius), material="root", dynamic=False)
        body.mask = ROOT_MASK
        # append never uses an id again: after 1e5 markers there would be 1e5 holes
        slot = O.bodies.insertAtId(body, self.free_slots.pop()) if self.free_slots else O.bodies.append(body)
        self.slots[marker] = slot

    def _update_markers(self, ids: list[int], start: np.ndarray, radius: np.ndarray) -> None:
        """Erases, inserts, changes radii: in this order."""
        if ids != self.row_ids:
            present = set(ids)
            for marker in [m for m in self.slots if m not in present]:
                slot = self.slots.pop(marker)
                O.bodies.erase(slot)
                self.free_slots.append(slot)
            for k, marker in enumerate(ids):
                if marker not in self.slots:
                    self._insert(marker, start[k], radius[k])
            self._list_rows(ids)
        other = np.flatnonzero(radius != self.row_radius).tolist()
        for k in other:
            O.bodies[self.row_slots[k]].shape.radius = float(radius[k])
        if other:
            self.row_radius = radius.copy()
            self.newton.maxVelocitySq = COLLIDE

    def _place(self, ids: list[int], start: np.ndarray, radius: np.ndarray) -> None:
        """Makes room for the root, puts it in and lets the grains come to rest around it."""
        body_mm, body_radius = np.concatenate([self.body[0], start]), np.concatenate([self.body[1], radius])
        for obstacle in self.recipe["obstacles"]:
            if obstacle["shape"] != "gap" and inside_obstacle(self.recipe, obstacle, body_mm, body_radius).any():
                raise Refused(
                    f"the root overlaps the obstacle '{obstacle['name']}' at the start",
                    key="soil.obstacle",
                    remedy="move the obstacle, or make the root shorter",
                )
        before = self.grain_count

        def overlaps(position: np.ndarray, grain_radius: np.ndarray) -> np.ndarray:
            hit = np.zeros(len(grain_radius), bool)
            for k in range(0, len(grain_radius), 256):
                part = slice(k, k + 256)
                distance = np.linalg.norm(position[part, None, :] - body_mm[None, :, :], axis=2)
                hit[part] = (distance < body_radius[None, :] + CARVE * grain_radius[part, None]).any(axis=1)
            return hit

        removed = self._erase(overlaps) if len(body_mm) else 0
        if before > 0 and removed == before:
            raise Refused(
                "the root leaves no room for a single grain",
                key="soil.box_to_mm",
                remedy="take a wider box or smaller grains",
            )
        for k, marker in enumerate(ids):
            self._insert(marker, start[k], radius[k])
        self._list_rows(ids)
        self.grain_count -= removed
        self.solid = solid_volume(self.recipe)
        O.dt = self.critical_step
        unbalanced = 0.0
        for _ in range(SETTLE_BLOCKS if self.grain_count and self.recipe["confining_pressure_MPa"] > 0.0 else 0):
            for _ in range(SETTLE_STEPS):
                O.step()
            unbalanced = utils.unbalancedForce()
            state = f"unbalanced {unbalanced:.3f}" if isfinite(unbalanced) else "nothing touches"
            self.progress(f"settling around the root: {state}")
            if not isfinite(unbalanced) or unbalanced < SETTLED:
                break
        if self.recipe["walls"] == "rigid":  # making room has cost pressure; from now on they stand still
            O.engines = [engine for engine in O.engines if not isinstance(engine, wrapper.TriaxialStressController)]
            for wall in self.wall_ids:
                O.bodies[wall].state.vel = vector((0, 0, 0))
        self.numbers["soil_settled_unbalanced"] = unbalanced if isfinite(unbalanced) else 0.0  # without a contact
        self.placed = True

    # ---- an interval ----------------------------------------------------------------------------

    def advance(
        self,
        interval: int,
        duration_h: float,
        motion: dict[str, np.ndarray],
        forces: Callable[[], dict[str, np.ndarray]],
    ) -> dict[str, float]:
        """Moves the root through one interval and fills in the mean force on every marker. Returns the numbers.

        ValueError, RuntimeError: something is not finite, overlaps absurdly, or is lost.
        """
        began = time.perf_counter()
        ids = motion["id"].tolist()
        start, end, radius = motion["start_mm"].copy(), motion["end_mm"].copy(), motion["radius_mm"].copy()
        spin = motion["spin_per_h"].copy()
        if not (duration_h > 0.0 and isfinite(start.sum() + end.sum() + radius.sum() + spin.sum())):
            raise ValueError("the root's motion is not finite, or the interval has no duration")
        if radius.min(initial=1.0) <= 0.0 or (ids != self.row_ids and len(set(ids)) != len(ids)):
            raise ValueError("a marker has no radius, or appears twice")
        if self.placed:
            self._update_markers(ids, start, radius)
        else:
            self._place(ids, start, radius)
            began = time.perf_counter()
        substeps = max(SUBSTEPS_AT_LEAST, ceil(duration_h / self.critical_step))
        O.dt = duration_h / substeps
        velocity = (end - self.row_position) / duration_h
        for state, v in zip(self.row_states, velocity.tolist()):
            state.vel = v
        turning = spin.tolist()
        for k, _ in self.near:
            if k < len(ids):
                self.row_states[k].angVel = turning[k]
        self.row_position = end  # within rounding

        first = O.iter
        # forces that are read are those at a substep's start: one more substep, and they are those of the middle
        samples = sorted({(2 * k + 1) * substeps // (2 * FORCE_SAMPLES) + 1 for k in range(FORCE_SAMPLES)})
        touching = [slot for _, slot in self.in_touch]
        readings = np.zeros((len(touching), 6))
        dem_s, done = 0.0, 0
        for sample in [*samples, substeps]:
            t = time.perf_counter()
            for _ in range(sample - done):
                O.step()
            done = sample
            dem_s += time.perf_counter() - t
            if sample < substeps:
                readings += read_forces(touching)
        loads = np.zeros((len(self.row_slots), 6))
        loads[[k for k, _ in self.in_touch]] = readings / len(samples)
        self._add_new_contacts(loads)
        force, torque = loads[:, :3], loads[:, 3:]
        if O.iter - first != substeps:
            raise RuntimeError(f"YADE made {O.iter - first} steps instead of {substeps}")

        layer = self.recipe["layer_mm"]
        n = len(ids)
        answer = forces()
        answer["mean_N"][:] = force[:n] / layer
        answer["mean_torque_Nmm"][:] = torque[:n] / layer
        stiffness = answer["contact_stiffness_N_mm"]
        stiffness[:] = 0.0
        for k in np.flatnonzero(np.any(force[:n] != 0.0, axis=1)).tolist():
            stiffness[k] = sum(c.phys.kn for c in O.bodies[self.row_slots[k]].intrs()) / layer
        if not isfinite(force.sum() + torque.sum() + stiffness.sum()):
            raise RuntimeError("a force on the root is not finite")

        self.work -= float((force[:n] * velocity).sum()) * duration_h / layer
        self._count(interval, substeps, velocity, force[n:] / layer)
        numbers = self.numbers
        numbers["soil_dem_s"] = numbers.get("soil_dem_s", 0.0) + dem_s
        numbers["soil_exchange_s"] = numbers.get("soil_exchange_s", 0.0) + time.perf_counter() - began - dem_s
        return self.numbers

    def _add_new_contacts(self, loads: np.ndarray) -> None:
        """At an interval's end: what has come into touch in it, and so had half its present force on the average."""
        if self.collisions_seen != self.collider.numAction:
            self._list_near()
        known, force = {k for k, _ in self.in_touch}, O.forces.f
        new = [(k, slot) for k, slot in self.near if k not in known and force(slot) != NO_FORCE]
        if new:
            loads[[k for k, _ in new]] = 0.5 * read_forces([slot for _, slot in new])
        loaded = set(np.flatnonzero(loads[:, :3].any(axis=1)).tolist())
        self.in_touch = [row for row in self.near if row[0] in loaded]

    def _count(self, interval: int, substeps: int, velocity: np.ndarray, fixed: np.ndarray) -> None:
        """What history.csv shows. In 2D forces and work are per mm of depth."""
        recipe, numbers = self.recipe, self.numbers
        speed = sqrt(np.einsum("ij,ij->i", velocity, velocity).max(initial=0.0))
        rate = speed / self.start["root_diameter_mm"]
        pressure, density = recipe["confining_pressure_MPa"], self.start["density_N_h2_mm4"]
        numbers["soil_inertial_number"] = (
            rate * recipe["d_mean_mm"] * sqrt(density / pressure) if pressure > 0.0 else 0.0
        )
        numbers["soil_substeps"] = float(substeps)
        numbers["soil_work_Nmm"] = self.work
        walls = 2 * recipe["dimension"]
        for k, name in enumerate(("x_from", "x_to", "y_from", "y_to", "z_from", "z_to")[:walls]):
            numbers[f"soil_wall_{name}_N"] = float(fixed[k, k // 2])
        obstacles = fixed[walls:].sum(axis=0)
        for k, axis in enumerate("xyz"):
            numbers[f"soil_obstacle_{axis}_N"] = float(obstacles[k])
        if interval % CHECK_EVERY and "soil_grains" in numbers:
            return
        self._look_closely()

    def _look_closely(self) -> None:
        """What is costly to see: overlaps, balance of forces, grains that left the box."""
        numbers = self.numbers
        overlap = max(0.0, utils.maxOverlapRatio())
        if not overlap <= OVERLAP_AT_MOST:
            raise RuntimeError(f"two grains overlap by {100 * overlap:.0f} % of the smaller radius; {RUPTURE}")
        everything = [b.id for b in O.bodies if not b.isClump]
        magnitudes = [O.forces.f(i).norm() for i in everything]
        total = sum(magnitudes)
        rest = max(abs(utils.sumForces(everything, axis)) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
        if not isfinite(total):
            raise RuntimeError(f"a force between grains is not finite; {RUPTURE}")
        unbalanced = utils.unbalancedForce()
        soil = grains()
        position = np.array([[b.state.pos[0], b.state.pos[1], b.state.pos[2]] for b in soil]).reshape(-1, 3)
        low, high = self._walls_now()
        free = slice(0, self.recipe["dimension"])
        margin = self.recipe["d_max_mm"]
        lost = ~((position > low - margin) & (position < high + margin))[:, free].all(axis=1)
        if lost.any():
            raise RuntimeError(f"{int(lost.sum())} of {len(soil)} grains have left the box; {RUPTURE}")
        numbers["soil_grains"] = float(len(soil))
        numbers["soil_slots"] = float(len(O.bodies))
        numbers["soil_overlap_max"] = overlap
        numbers["soil_unbalanced"] = unbalanced if isfinite(unbalanced) else 0.0
        numbers["soil_force_balance"] = rest / total if total > 0.0 else 0.0
        numbers["soil_coordination"] = 2.0 * O.interactions.countReal() / max(len(soil), 1)
        numbers["soil_solid_fraction"] = self.solid / float(np.prod(high - low))

    def _walls_now(self) -> tuple[np.ndarray, np.ndarray]:
        low, high = box_corners(self.recipe)
        for axis in range(self.recipe["dimension"]):
            low[axis] = O.bodies[self.wall_ids[2 * axis]].state.pos[axis]
            high[axis] = O.bodies[self.wall_ids[2 * axis + 1]].state.pos[axis]
        return low, high

    # ---- files ----------------------------------------------------------------------------------

    def save(self, path: Path) -> None:
        """Writes everything, then loads it in place: a run that goes on and one that begins with the file then add up
        their forces in the same order, and stay the same bit for bit."""
        meta = {
            "recipe": self.recipe,
            "start": self.start,
            "wall_ids": self.wall_ids,
            "obstacle_ids": self.obstacle_ids,
            "markers": list(self.slots.items()),
            "free_slots": self.free_slots,
            "placed": self.placed,
            "numbers": self.numbers,
            "work": self.work,
            "body": [a.tolist() for a in self.body],
        }
        data = archive()
        write_soil_file(path, "checkpoint", VERSION, meta, data)
        unarchive(data)
        self._rebind()

    def load(self, path: Path) -> None:
        """Takes up the state of a file that save() wrote, of the same recipe."""
        meta, data = read_soil_file(path, "checkpoint", VERSION)
        if meta["recipe"] != self.recipe:
            raise Refused(
                "the soil's checkpoint belongs to another soil",
                file=str(path),
                remedy="resume with the scene that began the run",
            )
        unarchive(data)
        self.start = meta["start"]
        self.wall_ids, self.obstacle_ids = meta["wall_ids"], meta["obstacle_ids"]
        self.slots = dict(meta["markers"])
        self.free_slots, self.placed = meta["free_slots"], meta["placed"]
        self.numbers, self.work = meta["numbers"], meta["work"]
        self.body = (np.array(meta["body"][0]).reshape(-1, 3), np.array(meta["body"][1]))
        self._rebind()
        check_functors(self.recipe)

    # ---- looking --------------------------------------------------------------------------------

    def snapshot(self) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        """Columns of the tables `grains` and `contacts` (message.hpp)."""
        soil = grains()
        stress = utils.bodyStressTensors()
        number = {b.id: k for k, b in enumerate(soil)}
        ids, place, force = [], [], []
        contacts = np.zeros(len(soil), np.int64)
        roots, walls, layer = set(self.slots.values()), set(self.wall_ids), self.recipe["layer_mm"]

        def name(i: int) -> int:
            return i if i in number else -1 if i in roots else -2 if i in walls else -3

        for c in O.interactions:
            if not c.isReal:
                continue
            ids.append((name(c.id1), name(c.id2)))
            at, total = c.geom.contactPoint, c.phys.normalForce + c.phys.shearForce
            place.append((at[0], at[1], at[2]))
            # YADE's is the one on the second body; in 2D per mm of depth
            force.append((-total[0] / layer, -total[1] / layer, -total[2] / layer))
            for i in (c.id1, c.id2):
                if i in number:
                    contacts[number[i]] += 1

        def tensor(body: Any) -> tuple[float, ...]:
            # YADE divides by the ball's volume; in a layer a grain is a disc
            s = stress[body.id]
            to_disc = 4.0 / 3.0 * body.shape.radius / self.recipe["layer_mm"] if self.recipe["dimension"] == 2 else 1.0
            return tuple(to_disc * x for x in (s[0][0], s[1][1], s[2][2], s[1][2], s[0][2], s[0][1]))

        grain_columns = {
            "id": np.array([b.id for b in soil], np.int64),
            "position_mm": np.array([[*b.state.pos] for b in soil]).reshape(-1, 3),
            "velocity_mm_h": np.array([[*b.state.vel] for b in soil]).reshape(-1, 3),
            "radius_mm": np.array([b.shape.radius for b in soil]),
            "contacts": contacts,
            "stress_MPa": np.array([tensor(b) for b in soil]).reshape(-1, 6),
        }
        contact_columns = {
            "ids": np.array(ids, np.int64).reshape(-1, 2),
            "position_mm": np.array(place).reshape(-1, 3),
            "force_N": np.array(force).reshape(-1, 3),
        }
        return grain_columns, contact_columns
