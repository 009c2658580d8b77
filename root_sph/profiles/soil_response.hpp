// SPDX-License-Identifier: MIT
// Response of the tissue to soil strength: the paper's Eq. 7.
#pragma once

#include <array>

namespace rootsoil {

/// xi(p) = theta xi_1 + (1 - theta) xi_2 with theta linear, theta(p_1) = 1, theta(p_2) = 0.
struct SoilResponse {
  std::array<double, 2> p_MPa{};  ///< the pressure differentials at which the two sets were measured
  bool extrapolate = true;        ///< false: theta stays within [0, 1]

  double theta(double p) const;
  double interpolate(const std::array<double, 2>& set, double p) const {
    const double t = theta(p);
    return t * set[0] + (1.0 - t) * set[1];
  }
};

}  // namespace rootsoil
