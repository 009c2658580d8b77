// SPDX-License-Identifier: MIT
// The cell loop: from velocity gradients to stresses, frames, volumes and masses.
#pragma once

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Advances F, volume, frame, stress and mass of every cell by dt_h with the present velocity gradients, and
/// leaves nominal_force ready for the force loop.
///
/// The strain of the step is that of its stretch alone, in the axes of its start, and the frame turns by the Cayley
/// transform of the spin (Hughes & Winget 1980): a rigid rotation of any size gives no stress, and one on top of a
/// strain does not change its stress.
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

/// How a step with F = I + increment turns the frame of a cell, by its spin at mid-step, 2 (F - I)(F + I)^-1.
template <int Dim>
Mat<Dim> step_rotation(const Mat<Dim>& increment);

/// Strain of a step with F = I + increment = R U, in the axes of its start: ln U, whatever R, from its hyperbolic
/// tangent (F^T F - I)(F^T F + I)^-1 and to fifth order in it. The strain at mid-step, in the axes of the end, is
/// turned by half of R (a bent balance found in a step that turns cells by 0.2 rad took a tenth of its strain for
/// shear).
template <int Dim>
Mat<Dim> step_strain(const Mat<Dim>& increment);

/// The Q of an ellipsoid carried along by F: F^-T Q F^-1 (the paper's 4.2, finite form).
template <int Dim>
Mat<Dim> deformed_shape(const Mat<Dim>& shape, const Mat<Dim>& deformation) {
  const Mat<Dim> inverse = deformation.inverse();
  const Mat<Dim> q = inverse.transpose() * shape * inverse;
  return 0.5 * (q + q.transpose());
}

}  // namespace rootsoil
