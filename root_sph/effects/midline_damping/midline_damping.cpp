// SPDX-License-Identifier: MIT
#include "root_sph/effects/midline_damping/midline_damping.hpp"

#include <algorithm>

namespace rootsoil {

template <int Dim>
MidlineDampingEffect<Dim>::MidlineDampingEffect(Solver<Dim>& solver, double rate_per_h) {
  Field<Dim, Vec<Dim>>& acceleration = solver.need_body_acceleration();
  solver.hooks().acceleration.emplace_back("inertia relief", [&solver, &acceleration, rate_per_h](Tissue<Dim>& t) {
    const auto& cells = t.cells;
    const double slice_mm = 4.0 * solver.axis().bin_mm();
    const auto slices = static_cast<std::size_t>(solver.axis().length_mm() / slice_mm) + 1;
    const auto slice_of = [&](std::size_t i) {
      return std::min(slices - 1, static_cast<std::size_t>(std::max(0.0, cells.distance_to_tip[i] / slice_mm)));
    };
    std::vector<Vec<Dim>> lateral(slices, Vec<Dim>::Zero());
    std::vector<double> volume(slices, 0.0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Vec<Dim> axis = cells.frame[i].col(0);
      lateral[slice_of(i)] += cells.volume[i] * (cells.velocity[i] - cells.velocity[i].dot(axis) * axis);
      volume[slice_of(i)] += cells.volume[i];
    }
    const double rate = std::min(rate_per_h, 0.5 / solver.window_h());  // a window must not turn the motion round
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t b = slice_of(i);
      if (!cells.clamped[i]) acceleration[i] -= rate / volume[b] * lateral[b];
    }
  });
}

double midline_damping_per_h(const Scene& scene) {
  if (!scene.numerics.has_inertia()) return 0.0;
  if (scene.numerics.midline_damping_per_h) return *scene.numerics.midline_damping_per_h;
  constexpr double faster_than_flutter_per_h = 5.0;
  const bool grows = scene.origins.has("growth");
  return grows && scene.root.is_clamped() && scene.facts.pushed_by.empty() ? faster_than_flutter_per_h : 0.0;
}

EffectSpec midline_damping_effect() {
  return {.name = "midline damping",
          .called_by = "[growth], [numerics] midline_damping_per_h",
          .what = "keeps numerical inertia from bending a long free root (hose flutter)",
          .exact = "a straight root stays straight",
          .called_for = [](const Scene& scene) { return midline_damping_per_h(scene) > 0.0; },
          .build =
              [](auto assembly) {
                assembly.template add<MidlineDampingEffect<assembly.dimension>>(midline_damping_per_h(assembly.scene));
              }};
}

template class MidlineDampingEffect<2>;
template class MidlineDampingEffect<3>;

}  // namespace rootsoil
