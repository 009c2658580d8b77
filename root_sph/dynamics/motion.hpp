// SPDX-License-Identifier: MIT
// Newton's law with tensor inertia, per cell.
#pragma once

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Velocity change over dt: R M^-1 R^T f, plus the steady acceleration that compensates inertia, then mass damping.
template <int Dim>
Vec<Dim> advanced_velocity(const Tissue<Dim>& tissue, std::size_t i, const Vec<Dim>& velocity, double dt_h) {
  const auto& cells = tissue.cells;
  const Vec<Dim>& inverse = tissue.inverse_inertia[i];
  Vec<Dim> a = cells.frame[i].transpose() * tissue.force[i];
  a = a.cwiseProduct(inverse);
  if (tissue.steady_acceleration) a[0] += (*tissue.steady_acceleration)[i];
  return (velocity + dt_h * (cells.frame[i] * a)) / (1.0 + dt_h * tissue.mass_damping_per_h);
}

}  // namespace rootsoil
