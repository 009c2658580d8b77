// SPDX-License-Identifier: MIT
// The tissue in motion: the cells, and what the solver computes about them.
//
// Time is cut into windows of a few steps. In a window neighbours and gradient operators stay frozen and the
// tissue is followed from the window's start: the operators act on the positions at that time, and F, the
// deformation since then, turns the result into the present gradient. Rigid rotations and large stretches in a
// window are therefore exact, whatever its length (docs/decisions/0002).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "root_sph/core/particle_store.hpp"
#include "root_sph/neighbours/pair_list.hpp"
#include "root_sph/tissue/laws/laws.hpp"

namespace rootsoil {

/// Weights of a pair in the gradients of its two cells: grad u_i += (u_j - u_i) (x) at_i,
/// grad u_j += (u_i - u_j) (x) at_j. 1/mm.
template <int Dim>
struct PairGradient {
  Vec<Dim> at_i, at_j;
};

/// Material data in the form that the cell loop reads. A null column does not exist in this run, and the loop
/// is an instance without it.
template <int Dim>
struct Material {
  TissueLaw law = law_of<ElasticGrowth>;  ///< use_law sets it, with the columns that it carries
  double E_axial_MPa = 0.0;
  double rho0_ug_mm3 = 0.0;
  Stiffness<Dim> uniform = Stiffness<Dim>::Zero();   ///< where stiffness does not vary
  Field<Dim, Stiffness<Dim>>* stiffness = nullptr;   ///< where it does
  Field<Dim, double>* softening = nullptr;           ///< lambda, ug/(mm^3 h); growth
  Field<Dim, double>* yield = nullptr;               ///< MPa; growth with a threshold
  std::vector<Field<Dim, Voigt<Dim>>*> law_columns;  ///< what the law carries besides the stress

  const Stiffness<Dim>& stiffness_of(std::size_t cell) const { return stiffness ? (*stiffness)[cell] : uniform; }
};

/// What moves masses: without inertia there is none of it.
template <int Dim>
struct Inertia {
  Field<Dim, Vec<Dim>>& inverse;         ///< along the material axes, mm/(N h^2); 0 where held
  Field<Dim, Vec<Dim>>& start_velocity;  ///< at the window's start, mm/h
  double mass_damping_per_h = 0.0;
};

template <int Dim>
struct Tissue {
  ParticleStore<Dim> cells;
  Material<Dim> material;

  // Scratch of the solver, one value a cell.
  Field<Dim, Mat<Dim>>& velocity_gradient;  ///< with the window's frozen operators, 1/h
  Field<Dim, Mat<Dim>>& deformation;        ///< F since the window's start
  Field<Dim, Mat<Dim>>& nominal_force;      ///< V sigma_total F^-T, N mm
  Field<Dim, Vec<Dim>>& force;              ///< N
  Field<Dim, double>& axial_strain;         ///< since the window's start
  Field<Dim, std::int64_t>& window_index;   ///< index in the window before; -1: divided since

  PairList pairs;
  std::vector<PairGradient<Dim>> gradients;
  std::vector<double> kernel;  ///< W of each pair, 1/mm^Dim

  std::optional<Inertia<Dim>> inertia;                ///< absent: balance at every step
  Field<Dim, std::int64_t>* asleep = nullptr;         ///< 1 for clamped cells that will wake; null: none ever sleep
  Field<Dim, Vec<Dim>>* body_acceleration = nullptr;  ///< mm/h^2, constant over a window; null: none

  double time_h = 0.0;
  double step_h = 0.0;
  double pressure_MPa = 0.0;  ///< differential; total stress = stress - pressure 1
  /// Axial push of bodies outside on the tip, over the root's section, as the tissue perceives it: what responds to the
  /// pressure differential responds to this as well. 0 where it perceives nothing.
  double tip_thrust_MPa = 0.0;
  std::int64_t next_cell_id = 0;

  Tissue();
  /// Adds the columns of inertia, once.
  void need_inertia();
  /// What parameters respond to (Eq. 7): the pressure differential less the thrust on the tip, of which no pull and no
  /// more than the pressure counts.
  double perceived_MPa() const { return pressure_MPa - std::clamp(tip_thrust_MPa, 0.0, std::max(0.0, pressure_MPa)); }
  /// Clamped for good, and not part of the root that grows.
  bool is_base(std::size_t cell) const { return cells.clamped[cell] && !(asleep && (*asleep)[cell]); }
};

/// Chooses the law, and declares what it carries.
template <int Dim>
void use_law(Tissue<Dim>& tissue, TissueLaw law);

/// Kinetic (of the numerical inertia) and elastic energy, N mm.
struct Energies {
  double kinetic = 0.0, elastic = 0.0;
};

template <int Dim>
Energies energies(const Tissue<Dim>& tissue);

/// |sum of all forces - external| / sum of the magnitudes of the pair forces' parts: rounding, whatever happens.
template <int Dim>
double relative_momentum_residual(const Tissue<Dim>& tissue, const Vec<Dim>& external_N = Vec<Dim>::Zero());

extern template struct Tissue<2>;
extern template struct Tissue<3>;

}  // namespace rootsoil
