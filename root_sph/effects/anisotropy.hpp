// SPDX-License-Identifier: MIT
// Radial modulus that varies along the root (Eq. 4 and 6).
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/profiles/root_profiles.hpp"

#include <functional>

namespace rootsoil {

template <int Dim>
class AnisotropyEffect final : public Effect<Dim> {
 public:
  /// \param profile_at E_R(s) at a pressure differential (MPa); constant unless the scene has a response
  AnisotropyEffect(Solver<Dim>& solver, ElasticConstants constants,
                   std::function<RadialModulusProfile(double)> profile_at);
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;

 private:
  Field<Dim, double>& radial_modulus_;
};

}  // namespace rootsoil
