// SPDX-License-Identifier: MIT
// Pair terms besides the stress: what a scene may add to the one pair loop. Each exists only when called for.
#pragma once

#include <optional>

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// How many times faster than the tissue's stress the slip of the non-affine control creeps where tissue grows
/// (docs/decisions/0009).
inline constexpr double slip_creep_ratio = 40.0;

/// Resistance against pair motions that no velocity gradient can see (odd-even modes): the pair velocity minus
/// its affine part is damped, and its integral e is resisted by a small elastic penalty. docs/physics.md 5.4.
template <int Dim>
struct NonAffineControl {
  double damping;                        ///< alpha
  double stiffness_MPa;                  ///< fraction of E_axial times E_axial
  std::vector<Vec<Dim>> slip_mm;         ///< e of each pair, from i to j; survives a rebuild for pairs that survive
  std::vector<double> retention;         ///< what creep leaves of e in a step, of each pair; empty where nothing grows
  Field<Dim, Vec<Dim>>* start_position;  ///< mm, at the window's start
  Field<Dim, Mat<Dim>>* start_frame;
};

/// Damps the whole relative velocity of a pair, as the authors' code does. Only for comparison.
struct ArtificialViscosity {
  double coefficient;
};

/// What the terms share: a geometric weight a pair and a damping constant a cell.
template <int Dim>
struct PairTerms {
  std::optional<NonAffineControl<Dim>> non_affine;
  std::optional<ArtificialViscosity> viscosity;
  std::vector<double> weight;             ///< V_i V_j W/(r^2 + 0.3 min(V)^(2/Dim)), mm^(Dim-2); empty without terms
  Field<Dim, double>* damping = nullptr;  ///< half of sqrt(E_A M/V) V^(1/Dim), N h/mm^2; null where nothing damps

  bool any() const { return non_affine || viscosity; }
  bool damps() const { return viscosity || (non_affine && non_affine->damping > 0.0); }
};

/// Adds the columns that the terms of the scene need.
template <int Dim>
PairTerms<Dim> make_pair_terms(ParticleStore<Dim>& cells, double E_axial_MPa, std::optional<double> non_affine_damping,
                               double non_affine_stiffness, double artificial_viscosity);

/// What creep leaves of e in a step of tissue.step_h; nothing to set where nothing grows.
template <int Dim>
void set_slip_retention(const Tissue<Dim>& tissue, PairTerms<Dim>& terms);

/// Weights for new pairs; e moves from the old pairs to the new ones, turned with the tissue since the old window's
/// start: forgotten, an odd-even displacement freezes in. Where tissue grows it creeps away, faster than the tissue's
/// own stress, de/dt = -creep lambda/rho0 e: kept, an irregular growing tip bloats, and what the operators cannot
/// resolve of a growth profile stays behind as stress (measured, docs/decisions/0009).
template <int Dim>
void rebuild_pair_terms(const Tissue<Dim>& tissue, const PairList& old_pairs, PairTerms<Dim>& terms);

}  // namespace rootsoil
