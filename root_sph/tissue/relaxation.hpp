// SPDX-License-Identifier: MIT
// What flow leaves of a stress, exactly, where strain comes at a constant rate: ds/dx = e - s with x = (lambda/rho0) t.
// The step may be many times as long as the relaxation takes, and its result is still that of short steps.
#pragma once

#include <cmath>

namespace rootsoil {

/// s after x relaxation times is kept s_0 + gained (strain times stiffness, all of the step's).
struct Relaxation {
  double kept;    ///< e^-x
  double gained;  ///< (1 - e^-x)/x
};

/// \param x duration over the relaxation time, >= 0
inline Relaxation relaxation(double x) {
  const double lost = -std::expm1(-x);
  return {1.0 - lost, x > 0.0 ? lost / x : 1.0};
}

/// The elastic volume strain beyond the yield strain, which relaxes where it is positive and stays where it is not,
/// after x relaxation times in which the volume strain came at a constant rate.
/// \param before at the step's start
/// \param strain of the step
inline double relaxed_tension(double before, double strain, double x) {
  const double unrelaxed = before + strain;
  if (before <= 0.0) {
    if (unrelaxed <= 0.0) return unrelaxed;
    return relaxation(x * (unrelaxed / strain)).gained * unrelaxed;  // relaxes from where it crosses 0
  }
  const auto [kept, gained] = relaxation(x);
  const double relaxed = kept * before + gained * strain;
  if (relaxed >= 0.0) return relaxed;
  return strain * (1.0 - std::log1p(-x * before / strain) / x);  // relaxes until it crosses 0
}

}  // namespace rootsoil
