// SPDX-License-Identifier: MIT
#include "root_sph/effects/inertia_compensation/inertia_compensation.hpp"

namespace rootsoil {

template <int Dim>
InertiaCompensationEffect<Dim>::InertiaCompensationEffect(Solver<Dim>& solver) {
  Field<Dim, Vec<Dim>>& acceleration = solver.need_body_acceleration();
  solver.hooks().acceleration.emplace_back("inertia relief", [&solver, &acceleration](Tissue<Dim>& t) {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      if (t.cells.clamped[i]) continue;
      const double s = solver.mid_window_distance(t.cells.distance_to_tip[i]);
      acceleration[i] += solver.axis().steady_acceleration(s) * t.cells.frame[i].col(0);
    }
  });
}

EffectSpec inertia_compensation_effect() {
  return {.name = "inertia compensation",
          .called_by = "[growth]",
          .what = "cancels the leading error of numerical inertia in steady growth",
          .exact = "acceleration of a steady flow, e(L) v(L) - e(s) v(s)",
          .called_for =
              [](const Scene& scene) {
                return scene.origins.has("growth") && scene.numerics.has_inertia() &&
                       scene.numerics.inertia_compensation && scene.root.is_clamped();
              },
          .build = [](auto assembly) { assembly.template add<InertiaCompensationEffect<assembly.dimension>>(); }};
}

template class InertiaCompensationEffect<2>;
template class InertiaCompensationEffect<3>;

}  // namespace rootsoil
