// SPDX-License-Identifier: MIT
// A rigid obstacle that pushes cells back: penalty contact with Coulomb friction. Needs no soil engine.
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/effects/shapes.hpp"

namespace rootsoil {

template <int Dim>
struct ObstacleParameters {
  std::string name;
  RigidShape<Dim> shape;
  double friction = 0.3;
  double contact_modulus_MPa = 0.0;  ///< pressure per relative indentation of a cell
};

/// Contact of one cell with a rigid surface. Pure; the unit under test.
///
/// The cell is its ellipsoid: its surface lies h = sqrt(n^T Q^-1 n) from its centre along the normal n. With A the
/// cell's section across n (A = V/2h), the normal force is A E_c depth/(2h) and the tangential one a spring of the
/// same stiffness on the slip since contact began, limited to mu times the normal force.
///
/// \param[in,out] slip_mm tangential displacement since contact began; shortened when friction slides
template <int Dim>
Vec<Dim> contact_force(const SurfacePoint<Dim>& surface, double half_extent_mm, double volume, double friction,
                       double contact_modulus_MPa, Vec<Dim>& slip_mm);

template <int Dim>
class ObstacleEffect final : public Effect<Dim> {
 public:
  ObstacleEffect(Solver<Dim>& solver, ObstacleParameters<Dim> parameters);
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;
  Vec<Dim> contact_force_N() const override;

 private:
  void find_near_cells(Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness);
  void add_forces(Tissue<Dim>& tissue, SlipAdvance advance);

  ObstacleParameters<Dim> parameters_;
  Solver<Dim>& solver_;
  Field<Dim, Vec<Dim>>& slip_;   ///< mm, zero out of contact
  Field<Dim, Vec<Dim>>& force_;  ///< N, of the latest step
  std::vector<std::size_t> near_;      ///< cells that can touch within the window
};

}  // namespace rootsoil
