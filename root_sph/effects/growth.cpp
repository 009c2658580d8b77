// SPDX-License-Identifier: MIT
#include "root_sph/effects/growth.hpp"

#include <utility>

namespace rootsoil {

template <int Dim>
GrowthEffect<Dim>::GrowthEffect(Solver<Dim>& solver, std::function<SofteningProfile(double)> profile_at)
    : softening_(solver.tissue().cells.template declare<double>(
          {"softening", "ug/(mm^3 h)", "lambda at the cell, Eq. 6", Storage::scratch},
          on_division::recomputed<Dim, double>)) {
  solver.tissue().material.softening = &softening_;
  solver.hooks().parameters.emplace_back(
      "growth", [this, &solver, profile_at = std::move(profile_at)](Tissue<Dim>& t) {
        const SofteningProfile profile = profile_at(t.pressure_MPa);
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < t.cells.size(); ++i) {
          softening_[i] =
              t.cells.clamped[i] ? 0.0 : profile(solver.mid_window_distance(t.cells.distance_to_tip[i]));
        }
      });
}

template <int Dim>
void GrowthEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  columns.push_back({"softening", "ug/(mm^3 h)", "softening coefficient lambda", 1, softening_.values()});
}

template class GrowthEffect<2>;
template class GrowthEffect<3>;

}  // namespace rootsoil
