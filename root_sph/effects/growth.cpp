// SPDX-License-Identifier: MIT
#include "root_sph/effects/growth.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace rootsoil {

template <int Dim>
GrowthEffect<Dim>::GrowthEffect(Solver<Dim>& solver, std::function<SofteningProfile(double)> profile_at)
    : softening_(solver.tissue().cells.template declare<double>(
          {"softening", "ug/(mm^3 h)", "lambda at the cell, Eq. 6", Storage::scratch},
          on_division::recomputed<Dim, double>)) {
  solver.tissue().material.softening = &softening_;
  solver.hooks().operators.emplace_back(
      "growth", [this, &solver, profile_at = std::move(profile_at)](Tissue<Dim>& t) {
        const RootAxis<Dim>& axis = solver.axis();
        const auto& cells = t.cells;
        // held cells do not flow: the integral ends where they begin
        const SofteningIntegral integral(profile_at(t.pressure_MPa), axis.awake_length_mm(), 0.25 * axis.bin_mm());
        std::vector<double> flow(cells.size());
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < cells.size(); ++i) {
          flow[i] = cells.clamped[i] ? integral(axis.awake_length_mm())
                                     : integral(solver.mid_window_distance(cells.distance_to_tip[i]));
          softening_[i] = 0.0;
        }
        for_each_block(t.pairs, [&](const PairBlock& block) {
          for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
            const auto [i, j] = t.pairs.pairs[k];
            const double difference = flow[i] - flow[j];  // the axis points to the tip, against s
            softening_[i] += difference * t.gradients[k].at_i.dot(cells.frame[i].col(0));
            softening_[j] -= difference * t.gradients[k].at_j.dot(cells.frame[j].col(0));
          }
        });
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < cells.size(); ++i) {
          // the operators act on the window's start, where lengths are shorter than in its middle
          const double stretch = 1.0 + 0.5 * solver.window_h() * axis.strain_rate_per_h(cells.distance_to_tip[i]);
          softening_[i] = cells.clamped[i] ? 0.0 : std::max(0.0, softening_[i] / stretch);
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
