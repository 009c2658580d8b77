// SPDX-License-Identifier: MIT
// The one pair loop: gradients from velocities, forces from stresses and pair terms.
#pragma once

#include "root_sph/dynamics/pair_terms.hpp"
#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// grad u_i = sum_j (u_j - u_i) (x) g_ij.
template <int Dim>
void compute_velocity_gradients(Tissue<Dim>& tissue);

/// How far e of the non-affine control moves in a force evaluation, h: for the force itself, and for good.
struct SlipAdvance {
  double used_h, kept_h;
};

/// f_i = sum_j (A_i g_ij - A_j g_ji) with A = V sigma_total F^-T: the exact adjoint of the gradient (virtual work),
/// so momentum is kept pair by pair and a free surface is traction-free by itself. Plus the pair terms.
/// force must be zero on entry.
template <int Dim>
using ForceLoop = void (*)(Tissue<Dim>&, PairTerms<Dim>&, SlipAdvance);

/// The instance with exactly the terms that exist; chosen once, when the scene is built.
template <int Dim>
ForceLoop<Dim> choose_force_loop(const PairTerms<Dim>& terms, bool grows);

}  // namespace rootsoil
