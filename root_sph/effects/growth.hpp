// SPDX-License-Identifier: MIT
// Growth: a source of mass where the tissue is soft and stretched (Eq. 1, 2 and 6).
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/profiles/root_profiles.hpp"

#include <functional>

namespace rootsoil {

/// A cell's softening is the gradient of the profile's integral along the root, taken with the operators that measure
/// its strain rate: lambda_i = -axis . sum_j (Lambda_j - Lambda_i) g_ij. A cell as long as the profile is steep cannot
/// follow its value at one point: the rate that its neighbours allow is an average, and the difference would stay
/// behind as stress where the growth zone ends (docs/decisions/0010). Equal to lambda(s) to second order.
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
