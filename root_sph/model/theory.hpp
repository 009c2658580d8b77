// SPDX-License-Identifier: MIT
// The closed form of a straight root that grows with nothing in its way: what a scene's parameters mean, for initial
// conditions, steps and expectations.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Axial and radial strain rate at a distance from the tip and a pressure differential, 1/h; 0 without growth or
/// pressure.
template <int Dim>
AxialRadial closed_form_rates(const Scene& scene, double s_mm, double p_MPa);

struct ClosedFormFlow {
  double tip_speed_mm_h = 0.0;
  double peak_rate_per_h = 0.0;
};
/// Of a root of this length.
template <int Dim>
ClosedFormFlow closed_form_flow(const Scene& scene, double length_mm, double p_MPa);

/// The largest tip speed that the root reaches in the scene, mm/h: it begins shorter than its growth zone and gains
/// speed, and the pressure may change. Follows length and pressure over time.
template <int Dim>
double fastest_tip_speed_mm_h(const Scene& scene);

/// Axial compression that stops growth over the pressure differential: 1 - nu_A, in 3D 1 - 2 nu_A.
template <int Dim>
double arrest_stress_per_pressure(const Scene& scene) {
  return 1.0 - (Dim - 1) * scene.tissue.nu_axial;
}

template <int Dim>
FreeGrowth free_growth(const Scene& scene);

}  // namespace rootsoil
