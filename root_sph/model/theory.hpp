// SPDX-License-Identifier: MIT
// The closed form of a straight root that grows with nothing in its way: what a scene's parameters mean, for initial
// conditions, steps and expectations.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Axial and radial strain rate at a distance from the tip, 1/h; 0 without growth or pressure.
template <int Dim>
AxialRadial closed_form_rates(const Scene& scene, double s_mm, const Pressures& p);

struct ClosedFormFlow {
  double tip_speed_mm_h = 0.0;
  double peak_rate_per_h = 0.0;
};
/// Of a root of this length.
template <int Dim>
ClosedFormFlow closed_form_flow(const Scene& scene, double length_mm, const Pressures& p);
/// The largest of each, whatever the tissue perceives.
template <int Dim>
ClosedFormFlow fastest_flow(const Scene& scene, double length_mm, double p_MPa);

/// The largest tip speed that the root reaches in the scene, mm/h: it begins shorter than its growth zone and gains
/// speed, and the pressure may change. Follows length and pressure over time; what it may perceive counts at the end.
template <int Dim>
double fastest_tip_speed_mm_h(const Scene& scene);

/// Axial compression that stops growth at a distance from the tip: (p - Y)(1 - nu_A), in 3D (p - Y)(1 - 2 nu_A), MPa.
template <int Dim>
double arrest_stress_MPa(const Scene& scene, double s_mm, const Pressures& p);

/// And that stops the tip of a root of this length: the mean of the above, weighted with lambda. Where Y varies along
/// the root, tissue beyond it then shortens as fast as other tissue still grows.
template <int Dim>
double arrest_stress_MPa(const Scene& scene, const Pressures& p);

template <int Dim>
FreeGrowth free_growth(const Scene& scene);

}  // namespace rootsoil
