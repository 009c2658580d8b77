// SPDX-License-Identifier: MIT
// Weight less buoyancy: a body force on the tissue.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

struct GravitySection {
  std::array<double, 3> acceleration_m_s2{};
  double density_difference_kg_m3 = 0.0;
};

/// Force per volume, N/mm^3 (in 2D per mm of depth): density difference times acceleration, in N/m^3 times 1e-9.
template <int Dim>
Vec<Dim> body_force_N_mm3(const GravitySection& gravity);

template <int Dim>
class GravityEffect final : public Effect<Dim> {
 public:
  GravityEffect(Solver<Dim>& solver, const GravitySection& gravity);
  Vec<Dim> external_force_N() const override;

 private:
  const Solver<Dim>& solver_;
  Vec<Dim> body_force_N_mm3_;
};

EffectSpec gravity_effect();

}  // namespace rootsoil
