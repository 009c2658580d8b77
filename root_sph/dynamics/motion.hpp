// SPDX-License-Identifier: MIT
// Newton's law with tensor inertia, per cell.
#pragma once

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Velocity after dt: R M^-1 R^T f, plus the acceleration that effects prescribe, then mass damping.
template <int Dim>
Vec<Dim> advanced_velocity(const Tissue<Dim>& tissue, std::size_t i, const Vec<Dim>& velocity, double dt_h) {
  const auto& cells = tissue.cells;
  const Vec<Dim>& inverse = tissue.inertia->inverse[i];
  const Vec<Dim> along_axes = cells.frame[i].transpose() * tissue.force[i];
  Vec<Dim> a = cells.frame[i] * along_axes.cwiseProduct(inverse);
  if (tissue.body_acceleration) a += (*tissue.body_acceleration)[i];
  return (velocity + dt_h * a) / (1.0 + dt_h * tissue.inertia->mass_damping_per_h);
}

}  // namespace rootsoil
