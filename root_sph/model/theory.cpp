// SPDX-License-Identifier: MIT
#include "root_sph/model/theory.hpp"

#include <algorithm>

#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/pressure/pressure.hpp"

namespace rootsoil {

template <int Dim>
AxialRadial closed_form_rates(const Scene& scene, double s_mm, double p_MPa) {
  const auto growth = growth_at(scene, p_MPa);
  if (!growth || !scene.find<PressureSection>()) return {0.0, 0.0};
  const double lambda_over_rho0_per_h = softening_ug_mm3_h(*growth, s_mm) / scene.tissue.rho0_ug_mm3;
  const Stiffness<Dim> k = stiffness<Dim>(elastic_constants(scene, s_mm, p_MPa));
  return visit_law<Dim>(scene.tissue.law,
                        [&]<class Law>(Law) { return Law::growth_rate(k, p_MPa, lambda_over_rho0_per_h); });
}

template <int Dim>
ClosedFormFlow closed_form_flow(const Scene& scene, double length_mm, double p_MPa) {
  ClosedFormFlow flow;
  constexpr int parts = 2000;
  for (int k = 0; k < parts; ++k) {
    const double rate = closed_form_rates<Dim>(scene, (k + 0.5) * length_mm / parts, p_MPa).axial;
    flow.tip_speed_mm_h += rate * length_mm / parts;
    flow.peak_rate_per_h = std::max(flow.peak_rate_per_h, rate);
  }
  return flow;
}

template <int Dim>
double fastest_tip_speed_mm_h(const Scene& scene) {
  constexpr int parts = 50;
  constexpr double measured_length_mm = 0.5;  // of cells from a file, before they are read
  double length_mm = scene.root.is_lattice() ? scene.root.length_mm : measured_length_mm;
  double fastest = 0.0;
  const auto consider = [&](double speed) {
    constexpr double rounding = 1e-3;  // of the sum over a longer root
    if (speed > (1.0 + rounding) * fastest) fastest = speed;
  };
  for (int k = 0; k <= parts; ++k) {
    const double time_h = scene.scene.duration_h * k / parts;
    const double speed = closed_form_flow<Dim>(scene, length_mm, pressure_MPa(scene, time_h)).tip_speed_mm_h;
    consider(speed);
    length_mm += speed * scene.scene.duration_h / parts;
  }
  // a short peak between two of these times counts as well
  if (const PressureSection* pressure = scene.find<PressureSection>(); pressure && pressure->table.size() > 1) {
    for (const auto& [time_h, p_MPa] : pressure->table) {
      if (time_h > scene.scene.duration_h) break;
      consider(closed_form_flow<Dim>(scene, length_mm, p_MPa).tip_speed_mm_h);
    }
  }
  return fastest;
}

template <int Dim>
FreeGrowth free_growth(const Scene& scene) {
  return {.axial_rate_per_h =
              [scene](double s_mm) { return closed_form_rates<Dim>(scene, s_mm, pressure_MPa(scene, 0.0)).axial; },
          .arrest_stress_per_pressure = arrest_stress_per_pressure<Dim>(scene),
          .fastest_tip_speed_mm_h = fastest_tip_speed_mm_h<Dim>(scene)};
}

template AxialRadial closed_form_rates<2>(const Scene&, double, double);
template AxialRadial closed_form_rates<3>(const Scene&, double, double);
template ClosedFormFlow closed_form_flow<2>(const Scene&, double, double);
template ClosedFormFlow closed_form_flow<3>(const Scene&, double, double);
template double fastest_tip_speed_mm_h<2>(const Scene&);
template double fastest_tip_speed_mm_h<3>(const Scene&);
template FreeGrowth free_growth<2>(const Scene&);
template FreeGrowth free_growth<3>(const Scene&);

}  // namespace rootsoil
