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

template <int Dim>
InertiaCompensationEffect<Dim>::InertiaCompensationEffect(Solver<Dim>& solver) {
  Tissue<Dim>& tissue = solver.tissue();
  tissue.steady_acceleration = &tissue.cells.template declare<double>(
      {"steady_acceleration", "mm/h^2", "axial acceleration of steady growth", Storage::scratch},
      on_division::recomputed<Dim, double>);
  solver.hooks().parameters.emplace_back("inertia compensation", [&solver](Tissue<Dim>& t) {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      const double s = solver.mid_window_distance(t.cells.distance_to_tip[i]);
      (*t.steady_acceleration)[i] = t.cells.clamped[i] ? 0.0 : solver.axis().steady_acceleration(s);
    }
  });
}

template class GrowthEffect<2>;
template class GrowthEffect<3>;
template class InertiaCompensationEffect<2>;
template class InertiaCompensationEffect<3>;

}  // namespace rootsoil
