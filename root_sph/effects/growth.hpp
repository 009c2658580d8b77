// SPDX-License-Identifier: MIT
// Growth: a source of mass where the tissue is soft and stretched (Eq. 1, 2 and 6).
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/profiles/root_profiles.hpp"

#include <functional>

namespace rootsoil {

template <int Dim>
class GrowthEffect final : public Effect<Dim> {
 public:
  /// \param profile_at lambda(s) at a pressure differential (MPa); constant unless the scene has a response
  GrowthEffect(Solver<Dim>& solver, std::function<SofteningProfile(double)> profile_at);
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;

 private:
  Field<Dim, double>& softening_;
};

}  // namespace rootsoil
