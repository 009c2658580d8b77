// SPDX-License-Identifier: MIT
// The cell loop: from velocity gradients to stresses, frames, volumes and masses.
#pragma once

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Advances F, volume, frame, stress and mass of every cell by dt_h with the present velocity gradients, and
/// leaves nominal_force ready for the force loop.
///
/// The strain of the step is taken at its middle (L = grad u F_mid^-1) and the frame turns by the Cayley
/// transform of the spin (Hughes & Winget 1980): a rigid rotation of any size gives no stress.
template <int Dim>
using MaterialLoop = void (*)(Tissue<Dim>&, double dt_h);

enum class MaterialStep {
  advance,  ///< as above
  predict,  ///< only nominal_force, as it will be; the cells stay as they are
};

/// The instance for the law and the columns that exist.
template <int Dim>
MaterialLoop<Dim> choose_material_loop(const Material<Dim>& material, MaterialStep step = MaterialStep::advance);

/// nominal_force from the stresses as they are: V R sigma R^T F^-T - p V F^-T.
template <int Dim>
void update_nominal_forces(Tissue<Dim>& tissue);

/// Rotation by the spin of a step: (I - dt W/2)^-1 (I + dt W/2), exactly orthogonal.
template <int Dim>
Mat<Dim> cayley_rotation(const Mat<Dim>& spin_times_dt);

/// The Q of an ellipsoid carried along by F: F^-T Q F^-1 (the paper's 4.2, finite form).
template <int Dim>
Mat<Dim> deformed_shape(const Mat<Dim>& shape, const Mat<Dim>& deformation) {
  const Mat<Dim> inverse = deformation.inverse();
  const Mat<Dim> q = inverse.transpose() * shape * inverse;
  return 0.5 * (q + q.transpose());
}

}  // namespace rootsoil
