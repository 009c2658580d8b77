// SPDX-License-Identifier: MIT
// Radial modulus that varies along the root (Eq. 4 and 6).
#pragma once

#include "root_sph/effects/effect_spec.hpp"
#include "root_sph/tissue/elasticity.hpp"

namespace rootsoil {

struct AnisotropySection {
  double E_radial_max_MPa = 0.0, x_e_mm = 0.0, s_e_per_mm = 0.0, c_e = 0.0;
};

/// E_R(s) = E_A + (E_H - E_A) (c_e + (1 - c_e)/(1 + exp(-s_e (s - x_e)))), MPa, s from the tip. Eq. 6, first.
double radial_modulus_MPa(const AnisotropySection& anisotropy, double E_axial_MPa, double s_mm);

/// [tissue.anisotropy] at a pressure differential (Eq. 7 where it responds); nothing where the scene has none.
std::optional<AnisotropySection> anisotropy_at(const Scene& scene, double p_MPa);

/// The tissue's elastic constants at a distance from the tip and a pressure differential.
ElasticConstants elastic_constants(const Scene& scene, double s_mm, double p_MPa);
/// The same without anisotropy: E_R = E_A.
ElasticConstants isotropic_constants(const TissueSection& tissue);

template <int Dim>
class AnisotropyEffect final : public Effect<Dim> {
 public:
  AnisotropyEffect(Solver<Dim>& solver, const Scene& scene);
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;

 private:
  Field<Dim, double>& radial_modulus_;
};

EffectSpec anisotropy_effect();

}  // namespace rootsoil
