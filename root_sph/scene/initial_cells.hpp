// SPDX-License-Identifier: MIT
// The cells at time 0: a capsule filled with a lattice, or cells measured by microscopy.
#pragma once

#include "root_sph/dynamics/tissue.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

struct InitialReport {
  double cell_size_mm = 0.0;  ///< typical length of a cell, volume^(1/Dim)
  double volume_scale = 1.0;  ///< cell file: factor on the ellipsoids' volumes that makes them fill the tissue
};

/// Fills the store: geometry, ids, clamped flags, distance_to_tip; stress and velocity zero, mass at rho0.
/// The root axis is x, the tip at the largest x, the clamp ends at x = 0. InputError when no cell results.
template <int Dim>
InitialReport make_initial_cells(const Scene& scene, Tissue<Dim>& tissue, double eta);

}  // namespace rootsoil
