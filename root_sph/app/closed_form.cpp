// SPDX-License-Identifier: MIT
#include "root_sph/app/closed_form.hpp"

#include <algorithm>
#include <cmath>

#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/model/theory.hpp"
#include "root_sph/scene/response.hpp"

namespace rootsoil {
namespace {

/// Distances from the tip, mm: most of them where the root grows.
std::vector<double> distances_mm(double length_mm, double zone_mm) {
  constexpr int in_zone = 200, behind = 40;
  const double end_mm = std::min(1.6 * zone_mm, length_mm);
  std::vector<double> s_mm;
  for (int k = 0; k <= in_zone; ++k) s_mm.push_back(k * end_mm / in_zone);
  if (end_mm < length_mm) {
    for (int k = 1; k <= behind; ++k) s_mm.push_back(end_mm + k * (length_mm - end_mm) / behind);
  }
  return s_mm;
}

/// Beyond it the axial rate stays below a twentieth of its peak, mm.
template <int Dim>
double growth_zone_mm(const Scene& scene, double length_mm, const Pressures& p) {
  constexpr int parts = 1000;
  std::vector<double> rate;
  for (int k = 0; k <= parts; ++k) {
    rate.push_back(closed_form_rates<Dim>(scene, k * length_mm / parts, p).axial);
  }
  const double least = 0.05 * *std::max_element(rate.begin(), rate.end());
  const auto last = std::find_if(rate.rbegin(), rate.rend(), [&](double r) { return r > least; });
  return static_cast<double>(std::min<std::ptrdiff_t>(rate.rend() - last, parts)) * length_mm / parts;
}

/// What the flow carries with it.
struct Carried {
  std::vector<double> speed_mm_h, relative_radius;
};

/// v' = axial rate and (ln r)' = radial rate/v, by the midpoint rule on a hundredth of the growth zone or less.
template <int Dim>
Carried carry(const Scene& scene, const std::vector<double>& s_mm, double steady_from_mm, const Pressures& p) {
  constexpr int substeps = 8;
  Carried carried;
  double v = 0.0, log_radius = 0.0;
  for (std::size_t k = 0; k < s_mm.size(); ++k) {
    for (int part = 0; k > 0 && part < substeps; ++part) {
      const double ds_mm = (s_mm[k] - s_mm[k - 1]) / substeps, middle_mm = s_mm[k - 1] + (part + 0.5) * ds_mm;
      const AxialRadial rate = closed_form_rates<Dim>(scene, middle_mm, p);
      const double v_middle = v + 0.5 * ds_mm * rate.axial;
      if (middle_mm > steady_from_mm && v_middle > 0.0) log_radius += ds_mm * rate.radial / v_middle;
      v += ds_mm * rate.axial;
    }
    carried.speed_mm_h.push_back(v);
    carried.relative_radius.push_back(std::exp(log_radius));
  }
  return carried;
}

/// Mean length of the cells at each distance, mm: a share of the longest's, which is at the threshold, or where the
/// threshold rises faster than cells grow, what the flow stretched it to since.
std::vector<double> steady_cell_length_mm(double mean_over_longest, const std::vector<double>& threshold_mm,
                                          const std::vector<double>& speed_mm_h) {
  std::vector<double> mean;
  double longest = 0.0;
  for (std::size_t k = 0; k < threshold_mm.size(); ++k) {
    const bool flows = k > 0 && speed_mm_h[k - 1] > 0.0;
    longest = flows ? std::min(threshold_mm[k], longest * speed_mm_h[k] / speed_mm_h[k - 1]) : threshold_mm[k];
    mean.push_back(longest * mean_over_longest);
  }
  return mean;
}

}  // namespace

template <int Dim>
FrameTable closed_form_table(const Scene& scene, const Solver<Dim>& solver) {
  const Pressures p(solver.tissue());
  const double p_MPa = p.differential_MPa, length_mm = solver.axis().length_mm();
  const auto growth = growth_at(scene, p.perceived_MPa);
  const double zone_mm = growth ? growth_zone_mm<Dim>(scene, length_mm, p) : length_mm;
  const std::vector<double> s_mm = distances_mm(length_mm, zone_mm);

  FrameTable table{"closed_form", {}};
  const auto add = [&](const char* name, const char* unit, const char* meaning, std::vector<double> values) {
    table.columns.push_back({name, unit, meaning, 1, std::move(values)});
  };
  const auto along = [&](auto&& at) {
    std::vector<double> values(s_mm.size());
    std::transform(s_mm.begin(), s_mm.end(), values.begin(), at);
    return values;
  };
  const auto strain = [&](double s) {
    const Stiffness<Dim> k = stiffness<Dim>(elastic_constants(scene, s, p.perceived_MPa));
    return visit_law<Dim>(scene.tissue.law, [&]<class Law>(Law) { return Law::equilibrium_strain(k, p_MPa); });
  };
  add("distance_to_tip", "mm", "from the tip along the root", s_mm);
  add("pressure_differential", "MPa", "the same all along the root", along([&](double) { return p_MPa; }));
  if (responds_to_perceived(scene)) {
    add("perceived_pressure", "MPa", "what parameters respond to (Eq. 7)",
        along([&](double) { return p.perceived_MPa; }));
  }
  add("arrest_stress", "MPa", "axial compression that stops growth",
      along([&](double s) { return arrest_stress_MPa<Dim>(scene, s, p); }));
  add("radial_modulus", "MPa", "E_R (Eq. 6, 7)",
      along([&](double s) { return elastic_constants(scene, s, p.perceived_MPa).E_radial_MPa; }));
  add("axial_strain", "1", "elastic, logarithmic (Eq. 8)", along([&](double s) { return strain(s).axial; }));
  add("radial_strain", "1", "elastic, logarithmic (Eq. 8)", along([&](double s) { return strain(s).radial; }));
  if (!growth) return table;

  const auto rates = [&](double s) { return closed_form_rates<Dim>(scene, s, p); };
  Carried carried = carry<Dim>(scene, s_mm, 0.25 * zone_mm, p);
  add("softening", "ug/(mm^3 h)", "lambda (Eq. 6, 7)", along([&](double s) { return softening_ug_mm3_h(*growth, s); }));
  if (!growth->yield.empty()) {
    add("yield_stress", "MPa", "beyond which tissue grows", along([&](double s) { return yield_MPa(*growth, s); }));
  }
  add("axial_strain_rate", "1/h", "of growth", along([&](double s) { return rates(s).axial; }));
  add("radial_strain_rate", "1/h", "of growth", along([&](double s) { return rates(s).radial; }));
  if (const DivisionSection* division = scene.find<DivisionSection>()) {
    const std::vector<double> threshold = along([&](double s) { return division_threshold_mm(*division, s); });
    add("cell_length", "mm", "mean, in steady growth",
        steady_cell_length_mm(mean_length_over_threshold(*division), threshold, carried.speed_mm_h));
    add("division_threshold", "mm", "of the longest axis (Eq. 6)", threshold);
  }
  add("speed_from_tip", "mm/h", "of the tissue, away from the tip", std::move(carried.speed_mm_h));
  add("relative_radius", "1", "in steady growth, over that at a quarter of the growth zone; 1 before",
      std::move(carried.relative_radius));
  return table;
}

template FrameTable closed_form_table<2>(const Scene&, const Solver<2>&);
template FrameTable closed_form_table<3>(const Scene&, const Solver<3>&);

}  // namespace rootsoil
