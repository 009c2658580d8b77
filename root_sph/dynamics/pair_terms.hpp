// SPDX-License-Identifier: MIT
// Pair terms besides the stress: what a scene may add to the one pair loop. Each exists only when called for.
#pragma once

#include <optional>

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// How many times faster than the tissue's stress the slip of the non-affine control creeps where tissue grows
/// (docs/decisions/0009).
inline constexpr double slip_creep_ratio = 40.0;

/// Of a pair (i, j), mm: how far j went from i beyond what i's gradient takes it (first column), or j's (second).
template <int Dim>
using PairSlip = Eigen::Matrix<double, Dim, 2>;

/// That of the pair (j, i).
template <int Dim>
PairSlip<Dim> reversed(const PairSlip<Dim>& slip) {
  return -slip.rowwise().reverse();
}

/// Resistance against pair motions that velocity gradients do not see: odd-even modes, and what varies within a cell.
/// The pair velocity minus its affine part is damped, and its integral e is resisted by an elastic penalty, with the
/// energy 1/4 c w (|e_i|^2 + |e_j|^2) of a pair. docs/physics.md 5.4.
template <int Dim>
struct NonAffineControl {
  double damping;                        ///< alpha
  double stiffness_MPa;                  ///< fraction of E_axial times E_axial
  std::vector<PairSlip<Dim>> slip_mm;    ///< e of each pair; survives a rebuild for pairs that survive
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
