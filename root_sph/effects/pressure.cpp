// SPDX-License-Identifier: MIT
#include "root_sph/effects/pressure.hpp"

#include <utility>

namespace rootsoil {

double pressure_at(const std::vector<std::array<double, 2>>& table, double time_h) {
  if (time_h <= table.front()[0]) return table.front()[1];
  for (std::size_t k = 1; k < table.size(); ++k) {
    const auto& [t0, p0] = table[k - 1];
    const auto& [t1, p1] = table[k];
    if (time_h < t1) return p0 + (p1 - p0) * (time_h - t0) / (t1 - t0);
  }
  return table.back()[1];
}

template <int Dim>
PressureEffect<Dim>::PressureEffect(Solver<Dim>& solver, std::vector<std::array<double, 2>> table) {
  solver.tissue().pressure_MPa = pressure_at(table, 0.0);
  if (table.size() == 1) return;  // constant: nothing to do in a step
  const auto set = [table = std::move(table)](Tissue<Dim>& tissue) {
    tissue.pressure_MPa = pressure_at(table, tissue.time_h);
  };
  // profiles may follow the pressure, so it is known at the window's start as well
  solver.hooks().window_start.emplace_back("pressure", set);
  solver.hooks().step_start.emplace_back("pressure", set);
}

template class PressureEffect<2>;
template class PressureEffect<3>;

}  // namespace rootsoil
