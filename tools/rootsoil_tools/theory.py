# SPDX-License-Identifier: MIT
"""Closed forms of the model along the root.

Units: mm, h, MPa, ug. s is the distance from the tip along the root (mm), p the pressure differential (MPa).
Equation numbers are those of the paper: Eq. 6 (profiles), Eq. 7 (response to soil strength), Eq. 8 (elastic strain).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike


def mature_factor(s: ArrayLike, mature_at: float | None, width: float) -> np.ndarray:
    """1 before the mature tissue, 0 in it, the cubic 3t^2 - 2t^3 over `width` (mm) centred on `mature_at` (mm)."""
    s = np.asarray(s, dtype=float)
    if mature_at is None:
        return np.ones_like(s)
    if width <= 0.0:
        return np.where(s < mature_at, 1.0, 0.0)
    t = np.clip((mature_at + width / 2.0 - s) / width, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def softening(
    s: ArrayLike,
    lambda0: float,
    x_g: float,
    s_g: float,
    c_g: float,
    mature_at: float | None = None,
    mature_width: float = 0.1,
) -> np.ndarray:
    """Softening coefficient lambda(s) (ug mm^-3 h^-1): Eq. 6, clipped at 0, times the mature cut-off."""
    s = np.asarray(s, dtype=float)
    u = (s - x_g) / s_g
    bell = lambda0 * ((1.0 + c_g) / 2.0 + (1.0 - c_g) / 2.0 * u * np.exp(0.5 - u * u / 2.0))
    return np.maximum(bell, 0.0) * mature_factor(s, mature_at, mature_width)


def radial_modulus(s: ArrayLike, E_A: float, E_H: float, x_e: float, s_e: float, c_e: float) -> np.ndarray:
    """Radial Young modulus E_R(s) (MPa): Eq. 6, from about E_A at the tip to E_H in the mature root."""
    s = np.asarray(s, dtype=float)
    return E_A + (E_H - E_A) * (c_e + (1.0 - c_e) / (1.0 + np.exp(-s_e * (s - x_e))))


def cumulative_integral(s: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Integral of f from s[0] to each s (trapezoids)."""
    return np.concatenate([[0.0], np.cumsum(np.diff(s) * (f[1:] + f[:-1]) / 2.0)])


@dataclass(frozen=True)
class Model:
    """The parameters of one scene at one pressure, with Eq. 7 already applied."""

    dimension: int
    p: float  # MPa
    E_A: float  # MPa
    nu_A: float
    nu_R: float
    rho0: float  # ug/mm^3
    growth: dict | None  # keyword arguments of softening()
    anisotropy: dict | None  # E_H, x_e, s_e, c_e of radial_modulus(); None: E_R = E_A

    def softening(self, s: ArrayLike) -> np.ndarray:
        """lambda(s), ug mm^-3 h^-1."""
        return softening(s, **self.growth) if self.growth else np.zeros_like(np.asarray(s, dtype=float))

    def radial_modulus(self, s: ArrayLike) -> np.ndarray:
        """E_R(s), MPa."""
        if self.anisotropy is None:
            return np.full_like(np.asarray(s, dtype=float), self.E_A)
        return radial_modulus(s, self.E_A, **self.anisotropy)

    def axial_strain(self) -> float:
        """Elastic axial strain under p: Eq. 8 in 2D, its 3D form otherwise."""
        return self.p * (1.0 - (self.dimension - 1) * self.nu_A) / self.E_A

    def radial_strain(self, s: ArrayLike) -> np.ndarray:
        """Elastic radial strain under p: Eq. 8 in 2D, its 3D form otherwise."""
        transverse = 1.0 if self.dimension == 2 else 1.0 - self.nu_R
        return self.p * (transverse / self.radial_modulus(s) - self.nu_A / self.E_A)

    def axial_rate(self, s: ArrayLike) -> np.ndarray:
        """Axial strain rate of growth (1/h): lambda/rho0 times the elastic axial strain. No growth under p <= 0."""
        return self.softening(s) / self.rho0 * max(self.axial_strain(), 0.0)

    def radial_rate(self, s: ArrayLike) -> np.ndarray:
        """Radial strain rate of growth (1/h): lambda/rho0 times the elastic radial strain. No growth under p <= 0."""
        return self.softening(s) / self.rho0 * (self.radial_strain(s) if self.p > 0.0 else 0.0)

    def grid(self, length: float) -> np.ndarray:
        """Distances from the tip (mm), fine enough to integrate over."""
        return np.linspace(0.0, length, 4001)

    def velocity(self, s: np.ndarray) -> np.ndarray:
        """Velocity away from the tip (mm/h) at the ascending distances s, s[0] = 0."""
        return cumulative_integral(s, self.axial_rate(s))

    def tip_speed(self, length: float) -> float:
        """Speed of the tip of a root of this length (mm), mm/h."""
        return float(self.velocity(self.grid(length))[-1])

    def growth_zone(self, length: float) -> float:
        """Distance from the tip (mm) beyond which the axial rate stays below 5 % of its peak; at most the length."""
        s = self.grid(length)
        rate = self.axial_rate(s)
        growing = np.flatnonzero(rate > 0.05 * rate.max())
        return float(s[min(growing[-1] + 1, s.size - 1)]) if growing.size else length

    def radius(self, s: np.ndarray, s_start: float, radius_start: float) -> np.ndarray:
        """Radius (mm) of a root in steady growth, dr/ds = r rate_R(s)/v(s) from (s_start, radius_start); NaN before."""
        fine = self.grid(float(np.max(s)))
        v = self.velocity(fine)
        slope = np.where(fine >= s_start, self.radial_rate(fine) / np.maximum(v, 1e-300), 0.0)
        logarithm = cumulative_integral(fine, slope)
        return np.where(s >= s_start, radius_start * np.exp(np.interp(s, fine, logarithm)), np.nan)

    def carried_to(self, s_start: float, duration: float, length: float) -> float:
        """Where (mm from the tip) tissue is after `duration` h that started at s_start mm; at most the length."""
        s = self.grid(length)
        v = self.velocity(s)
        moving = (s >= s_start) & (v > 0.0)
        if np.count_nonzero(moving) < 2:
            return s_start
        time = cumulative_integral(s[moving], 1.0 / v[moving])
        return float(np.interp(duration, time, s[moving]))


def pressure_at(scene: dict, time_h: float) -> float:
    """Pressure differential (MPa) of a scene at a time (h): a number, or piecewise linear in a table; absent: 0."""
    section = scene.get("pressure", {})
    if "table" in section:
        times, values = np.asarray(section["table"], dtype=float).T
        return float(np.interp(time_h, times, values))
    return float(section.get("differential_MPa", 0.0))


def respond(pair: list[float], p_pair: list[float], p: float, extrapolate: bool = True) -> float:
    """Eq. 7: theta xi_1 + (1 - theta) xi_2, theta linear in p, 1 at p_pair[0] and 0 at p_pair[1]."""
    theta = (p - p_pair[1]) / (p_pair[0] - p_pair[1])
    if not extrapolate:
        theta = min(max(theta, 0.0), 1.0)
    return theta * pair[0] + (1.0 - theta) * pair[1]


def _parameters(section: dict, response: dict, p: float, extrapolate: bool) -> dict:
    """The section's values, with those that respond to p replaced by Eq. 7."""
    p_pair = response.get("p_MPa")
    answered = {k: respond(v, p_pair, p, extrapolate) for k, v in response.items() if k != "p_MPa"}
    return {**section, **answered}


def model_of(scene: dict, time_h: float = 0.0) -> Model:
    """The closed form's parameters from a (resolved) scene file at a time (h)."""
    p = pressure_at(scene, time_h)
    response = scene.get("response", {})
    extrapolate = response.get("extrapolate", True)
    tissue = scene["tissue"]

    growth = None
    if "growth" in scene:
        g = _parameters(scene["growth"], response.get("growth", {}), p, extrapolate)
        growth = {
            "lambda0": g["lambda0_ug_mm3_h"],
            "x_g": g["x_g_mm"],
            "s_g": g["s_g_mm"],
            "c_g": g["c_g"],
            "mature_at": g.get("mature_at_mm"),
            "mature_width": g.get("mature_width_mm", 0.1),
        }
    anisotropy = None
    if "anisotropy" in tissue:
        a = _parameters(tissue["anisotropy"], response.get("anisotropy", {}), p, extrapolate)
        anisotropy = {"E_H": a["E_radial_max_MPa"], "x_e": a["x_e_mm"], "s_e": a["s_e_per_mm"], "c_e": a["c_e"]}
    return Model(
        dimension=int(scene["scene"].get("dimension", 2)),
        p=p,
        E_A=tissue["E_axial_MPa"],
        nu_A=tissue.get("nu_axial", 0.06),
        nu_R=tissue.get("nu_radial", 0.3),
        rho0=tissue.get("rho0_ug_mm3", 1000.0),
        growth=growth,
        anisotropy=anisotropy,
    )
