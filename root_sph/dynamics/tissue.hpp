// SPDX-License-Identifier: MIT
// The tissue in motion: the cells, and what the solver computes about them.
//
// Time is cut into windows of a few steps. In a window neighbours and gradient operators stay frozen and the
// tissue is followed from the window's start: the operators act on the positions at that time, and F, the
// deformation since then, turns the result into the present gradient. Rigid rotations and large stretches in a
// window are therefore exact, whatever its length (docs/decisions/0002).
#pragma once

#include "root_sph/core/particle_store.hpp"
#include "root_sph/neighbours/pair_list.hpp"
#include "root_sph/tissue/elasticity.hpp"

#include <cstdint>
#include <vector>

namespace rootsoil {

/// Weights of a pair in the gradients of its two cells: grad u_i += (u_j - u_i) (x) at_i,
/// grad u_j += (u_i - u_j) (x) at_j. 1/mm.
template <int Dim>
struct PairGradient {
  Vec<Dim> at_i, at_j;
};

enum class TissueLaw { elastic_growth, pressure_deviator };

/// Material data in the form that the cell loop reads. A null column does not exist in this run, and the loop
/// is an instance without it.
template <int Dim>
struct Material {
  TissueLaw law = TissueLaw::elastic_growth;
  double E_axial_MPa = 0.0;
  double rho0_ug_mm3 = 0.0;
  Stiffness<Dim> uniform = Stiffness<Dim>::Zero();            ///< where stiffness does not vary
  Field<Dim, Stiffness<Dim>>* stiffness = nullptr;            ///< where it does
  Field<Dim, double>* softening = nullptr;                    ///< lambda, ug/(mm^3 h); growth
  Field<Dim, Voigt<Dim>>* deviatoric_stress = nullptr;        ///< tau of pressure_deviator

  const Stiffness<Dim>& stiffness_of(std::size_t cell) const { return stiffness ? (*stiffness)[cell] : uniform; }
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
  Field<Dim, Vec<Dim>>& inverse_inertia;    ///< along the material axes, mm/(N h^2); 0 where held
  Field<Dim, double>& axial_strain;         ///< since the window's start
  Field<Dim, Vec<Dim>>& start_velocity;     ///< at the window's start, mm/h
  Field<Dim, std::int64_t>& window_index;   ///< index in the window before; -1: divided since

  PairList pairs;
  std::vector<PairGradient<Dim>> gradients;
  std::vector<double> kernel;  ///< W of each pair, 1/mm^Dim

  Field<Dim, std::int64_t>* neighbours_at_rest = nullptr;  ///< of cells at rest; null: none ever rest
  Field<Dim, Vec<Dim>>* body_acceleration = nullptr;  ///< mm/h^2, constant over a window; null: none

  double time_h = 0.0;
  double step_h = 0.0;
  double pressure_MPa = 0.0;          ///< differential; total stress = stress - pressure 1
  double mass_damping_per_h = 0.0;
  std::int64_t next_cell_id = 0;

  Tissue();
};

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
