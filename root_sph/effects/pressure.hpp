// SPDX-License-Identifier: MIT
// Uniform pressure differential (the paper's Eq. 5): turgor minus the perceived resistance of the soil.
#pragma once

#include "root_sph/effects/effect.hpp"

#include <array>

namespace rootsoil {

/// Piecewise linear in time, constant outside the table: rows (time_h, MPa), times rising.
double pressure_at(const std::vector<std::array<double, 2>>& table, double time_h);

template <int Dim>
class PressureEffect final : public Effect<Dim> {
 public:
  PressureEffect(Solver<Dim>& solver, std::vector<std::array<double, 2>> table);
};

}  // namespace rootsoil
