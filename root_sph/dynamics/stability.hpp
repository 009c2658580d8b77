// SPDX-License-Identifier: MIT
// Inertia from a stability bound: any geometry is linearly stable at the step that the user chose.
//
// Growth is quasi-static; inertia is a numerical device (mass scaling) and the step is the accuracy knob. The
// leapfrog is stable when M >= K dt^2/4. K is bounded row by row by the sum of the magnitudes of its entries
// (Gershgorin), separately along each material axis: lateral directions carry the large E_R, the axial one does
// not have to. docs/physics.md 5.5 and docs/decisions/0003.
#pragma once

#include "root_sph/dynamics/pair_terms.hpp"
#include "root_sph/dynamics/solver_options.hpp"
#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Row sums of the stiffness along the material axes of each cell, N/mm: stress, and the non-affine penalty.
template <int Dim>
std::vector<Vec<Dim>> bound_stiffness(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms);

/// Sets inverse_inertia (0 for clamped cells) and the damping constants of the pair terms.
/// \param stiffness from bound_stiffness, with what effects add (contact)
template <int Dim>
void set_inertia(Tissue<Dim>& tissue, PairTerms<Dim>& terms, const std::vector<Vec<Dim>>& stiffness, InertiaMode mode);

/// Twice the lowest axial frequency of a clamped rod of this tissue: settles a static case fastest. 1/h.
template <int Dim>
double critical_mass_damping(const Tissue<Dim>& tissue);

}  // namespace rootsoil
