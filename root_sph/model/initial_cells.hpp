// SPDX-License-Identifier: MIT
// The cells at time 0: a capsule filled with a lattice, or cells measured by microscopy.
#pragma once

#include <cmath>
#include <optional>

#include "root_sph/dynamics/tissue.hpp"
#include "root_sph/model/lattice.hpp"
#include "root_sph/model/measured_root.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

struct InitialReport {
  double cell_size_mm = 0.0;  ///< typical length of a cell, volume^(1/Dim)
  double volume_scale = 1.0;  ///< cell file: factor on the cells' volumes that makes them fill the tissue
  std::optional<Lattice> lattice = std::nullopt;
  std::optional<MeasuredRootReport> measured = std::nullopt;
  double volume = 0.0;  ///< of the cells that can move, mm^Dim
  double across = 0.0;  ///< cells across the root, on average along it
};

/// Smoothing length of the isotropic kernel (docs/physics.md 5.1).
inline double isotropic_kernel_mm(const NumericsSection& numerics, int dimension, double cell_size_mm) {
  return numerics.H_bar * std::sqrt(static_cast<double>(dimension)) * cell_size_mm;
}

/// Fills the store: geometry, ids, clamped flags, distance_to_tip; stress and velocity zero, mass at rho0.
/// The root axis is x, the tip at the largest x, the clamp ends at x = 0. InputError
/// where the cells are not one tissue (whole_tissue.hpp).
template <int Dim>
InitialReport make_initial_cells(const Scene& scene, Tissue<Dim>& tissue, double eta);

/// Throws what make_initial_cells would throw.
template <int Dim>
void refuse_unfit_cells(const Scene& scene);

}  // namespace rootsoil
