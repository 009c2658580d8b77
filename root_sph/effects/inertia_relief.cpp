// SPDX-License-Identifier: MIT
#include "root_sph/effects/inertia_relief.hpp"

#include <algorithm>

namespace rootsoil {
namespace {

/// The column that both share; whoever comes first declares it, and the pass that clears it.
template <int Dim>
void need_body_acceleration(Solver<Dim>& solver) {
  Tissue<Dim>& tissue = solver.tissue();
  if (tissue.body_acceleration) return;
  tissue.body_acceleration = &tissue.cells.template declare<Vec<Dim>>(
      {"body_acceleration", "mm/h^2", "acceleration that relieves numerical inertia", Storage::scratch},
      on_division::recomputed<Dim, Vec<Dim>>);
  solver.hooks().parameters.emplace_back("inertia relief", [](Tissue<Dim>& t) {
    for (Vec<Dim>& a : t.body_acceleration->values()) a.setZero();
  });
}

}  // namespace

template <int Dim>
InertiaCompensationEffect<Dim>::InertiaCompensationEffect(Solver<Dim>& solver) {
  need_body_acceleration<Dim>(solver);
  solver.hooks().parameters.emplace_back("inertia relief", [&solver](Tissue<Dim>& t) {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      if (t.cells.clamped[i]) continue;
      const double s = solver.mid_window_distance(t.cells.distance_to_tip[i]);
      (*t.body_acceleration)[i] += solver.axis().steady_acceleration(s) * t.cells.frame[i].col(0);
    }
  });
}

template <int Dim>
MidlineDampingEffect<Dim>::MidlineDampingEffect(Solver<Dim>& solver, double rate_per_h) {
  need_body_acceleration<Dim>(solver);
  solver.hooks().parameters.emplace_back("inertia relief", [&solver, rate_per_h](Tissue<Dim>& t) {
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
      if (!cells.clamped[i]) (*t.body_acceleration)[i] -= rate / volume[b] * lateral[b];
    }
  });
}

template class InertiaCompensationEffect<2>;
template class InertiaCompensationEffect<3>;
template class MidlineDampingEffect<2>;
template class MidlineDampingEffect<3>;

}  // namespace rootsoil
