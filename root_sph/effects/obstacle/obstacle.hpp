// SPDX-License-Identifier: MIT
// A rigid obstacle that pushes cells back: penalty contact with Coulomb friction. Needs no soil engine.
#pragma once

#include "root_sph/effects/effect_spec.hpp"
#include "root_sph/effects/obstacle/shapes.hpp"

namespace rootsoil {

enum class ObstacleShape { plane, box, disc, sphere };
template <>
inline constexpr EnumName<ObstacleShape> enum_names<ObstacleShape>[] = {{ObstacleShape::plane, "plane"},
                                                                        {ObstacleShape::box, "box"},
                                                                        {ObstacleShape::disc, "disc"},
                                                                        {ObstacleShape::sphere, "sphere"}};

struct ObstacleSection {
  std::string name;
  ObstacleShape shape = ObstacleShape::plane;
  std::array<double, 3> position_mm{};   ///< a point of the plane, or the centre
  std::array<double, 3> normal{};        ///< plane: outward, towards the root (unit after validation)
  std::array<double, 3> half_size_mm{};  ///< box
  double angle_deg = 0.0;                ///< box: turned about z
  double radius_mm = 0.0;                ///< disc (2D), sphere (3D)
  double friction = 0.3;
  std::optional<double> contact_modulus_MPa;  ///< there after reading: E_axial_MPa where the scene gives none
};

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
/// \param sliding_N the limit, where it is known from before (of the step's start: what is left of the law is then the
///        gradient of a convex function, and an equilibrium can be found); absent: that of the present normal force
/// \param[in,out] slip_mm tangential displacement since contact began; shortened when friction slides
template <int Dim>
Vec<Dim> contact_force(const SurfacePoint<Dim>& surface, double half_extent_mm, double volume, double friction,
                       double contact_modulus_MPa, Vec<Dim>& slip_mm, std::optional<double> sliding_N = {});

template <int Dim>
class ObstacleEffect final : public Effect<Dim> {
 public:
  ObstacleEffect(Solver<Dim>& solver, ObstacleParameters<Dim> parameters);
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;
  Vec<Dim> contact_force_N() const override;
  Vec<Dim> tip_force_N(double within_mm) const override;
  void keep_awake(std::vector<char>& busy) const override;

 private:
  void find_near_cells(Tissue<Dim>& tissue);
  void bound_stiffness(const Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness) const;
  void add_stiffness(const Tissue<Dim>& tissue, std::vector<Mat<Dim>>& stiffness) const;
  void add_forces(Tissue<Dim>& tissue, SlipAdvance advance);
  void adapt_friction(const Tissue<Dim>& tissue, bool& matters);

  ObstacleParameters<Dim> parameters_;
  Solver<Dim>& solver_;
  Field<Dim, Vec<Dim>>& slip_;     ///< mm, zero out of contact
  Field<Dim, Vec<Dim>>& force_;    ///< N, of the latest step
  Field<Dim, double>* sliding_;    ///< N, that friction can carry; nullptr with inertia, where it is what it is
  std::vector<std::size_t> near_;  ///< cells that can touch within the window
};

EffectSpec obstacle_effect();

}  // namespace rootsoil
