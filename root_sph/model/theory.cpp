// SPDX-License-Identifier: MIT
#include "root_sph/model/theory.hpp"

#include <algorithm>

#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/scene/response.hpp"

namespace rootsoil {

namespace {

/// At the start.
double length_mm(const Scene& scene) {
  constexpr double measured_length_mm = 0.5;  // of cells from a file, before they are read
  return scene.root.is_lattice() ? scene.root.length_mm : measured_length_mm;
}

}  // namespace

template <int Dim>
AxialRadial closed_form_rates(const Scene& scene, double s_mm, const Pressures& p) {
  const auto growth = growth_at(scene, p.perceived_MPa);
  if (!growth || pressure_rows(scene).empty()) return {0.0, 0.0};
  const double lambda_over_rho0_per_h = softening_ug_mm3_h(*growth, s_mm) / scene.tissue.rho0_ug_mm3;
  const double yield = yield_MPa(*growth, s_mm);
  const Stiffness<Dim> k = stiffness<Dim>(elastic_constants(scene, s_mm, p.perceived_MPa));
  return visit_law<Dim>(scene.tissue.law, [&]<class Law>(Law) {
    return Law::growth_rate(k, p.differential_MPa, lambda_over_rho0_per_h, yield);
  });
}

template <int Dim>
ClosedFormFlow closed_form_flow(const Scene& scene, double length_mm, const Pressures& p) {
  ClosedFormFlow flow;
  constexpr int parts = 2000;
  for (int k = 0; k < parts; ++k) {
    const double rate = closed_form_rates<Dim>(scene, (k + 0.5) * length_mm / parts, p).axial;
    flow.tip_speed_mm_h += rate * length_mm / parts;
    flow.peak_rate_per_h = std::max(flow.peak_rate_per_h, rate);
  }
  return flow;
}

template <int Dim>
ClosedFormFlow fastest_flow(const Scene& scene, double length_mm, double p_MPa) {
  ClosedFormFlow fastest = closed_form_flow<Dim>(scene, length_mm, p_MPa);
  if (!responds_to_perceived(scene)) return fastest;
  constexpr int parts = 8;
  for (int k = 0; k < parts; ++k) {
    const ClosedFormFlow flow = closed_form_flow<Dim>(scene, length_mm, Pressures(p_MPa, p_MPa * k / parts));
    fastest.tip_speed_mm_h = std::max(fastest.tip_speed_mm_h, flow.tip_speed_mm_h);
    fastest.peak_rate_per_h = std::max(fastest.peak_rate_per_h, flow.peak_rate_per_h);
  }
  return fastest;
}

template <int Dim>
double arrest_stress_MPa(const Scene& scene, double s_mm, const Pressures& p) {
  const auto growth = growth_at(scene, p.perceived_MPa);
  const double beyond_MPa = std::max(0.0, p.differential_MPa - (growth ? yield_MPa(*growth, s_mm) : 0.0));
  return (1.0 - (Dim - 1) * scene.tissue.nu_axial) * beyond_MPa;
}

template <int Dim>
double arrest_stress_MPa(const Scene& scene, const Pressures& p) {
  const auto growth = growth_at(scene, p.perceived_MPa);
  if (!growth || growth->yield.size() < 2) return arrest_stress_MPa<Dim>(scene, 0.0, p);
  constexpr int parts = 200;
  double sum = 0.0, weight = 0.0;
  for (int k = 0; k < parts; ++k) {
    const double s_mm = (k + 0.5) * length_mm(scene) / parts, lambda = softening_ug_mm3_h(*growth, s_mm);
    sum += lambda * arrest_stress_MPa<Dim>(scene, s_mm, p);
    weight += lambda;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

template <int Dim>
double fastest_tip_speed_mm_h(const Scene& scene) {
  constexpr int parts = 50;
  double length_mm = rootsoil::length_mm(scene);
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
  if (const Rows pressure = pressure_rows(scene); pressure.size() > 1) {
    for (const auto& [time_h, p_MPa] : pressure) {
      if (time_h > scene.scene.duration_h) break;
      consider(closed_form_flow<Dim>(scene, length_mm, p_MPa).tip_speed_mm_h);
    }
  }
  if (responds_to_perceived(scene)) {
    consider(fastest_flow<Dim>(scene, length_mm, scene.facts.pressure_MPa[1]).tip_speed_mm_h);
  }
  return fastest;
}

template <int Dim>
FreeGrowth free_growth(const Scene& scene) {
  return {.axial_rate_per_h = [scene](double s_mm,
                                      const Pressures& p) { return closed_form_rates<Dim>(scene, s_mm, p).axial; },
          .arrest_stress_MPa = [scene](const Pressures& p) { return arrest_stress_MPa<Dim>(scene, p); },
          .fastest_tip_speed_mm_h = fastest_tip_speed_mm_h<Dim>(scene)};
}

template AxialRadial closed_form_rates<2>(const Scene&, double, const Pressures&);
template AxialRadial closed_form_rates<3>(const Scene&, double, const Pressures&);
template ClosedFormFlow closed_form_flow<2>(const Scene&, double, const Pressures&);
template ClosedFormFlow fastest_flow<2>(const Scene&, double, double);
template ClosedFormFlow closed_form_flow<3>(const Scene&, double, const Pressures&);
template ClosedFormFlow fastest_flow<3>(const Scene&, double, double);
template double arrest_stress_MPa<2>(const Scene&, double, const Pressures&);
template double arrest_stress_MPa<3>(const Scene&, double, const Pressures&);
template double arrest_stress_MPa<2>(const Scene&, const Pressures&);
template double arrest_stress_MPa<3>(const Scene&, const Pressures&);
template double fastest_tip_speed_mm_h<2>(const Scene&);
template double fastest_tip_speed_mm_h<3>(const Scene&);
template FreeGrowth free_growth<2>(const Scene&);
template FreeGrowth free_growth<3>(const Scene&);

}  // namespace rootsoil
