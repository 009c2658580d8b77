// SPDX-License-Identifier: MIT
// Aitken's factor for an under-relaxed exchange: F <- F + factor (F_soil - F).
#pragma once

#include <algorithm>

namespace rootsoil {

/// The next factor, from the residuals r = F_soil - F of the last two intervals (Irons & Tuck 1969):
/// -factor (r_before . change)/|change|^2, change = r - r_before. Where the residual hardly changed the quotient says
/// nothing and the factor stays; it is kept within [0.1, 1].
inline double aitken_factor(double factor, double before_dot_change, double change_squared, double residual_squared) {
  constexpr double smallest = 0.1, largest = 1.0, hardly = 1e-12;
  if (!(change_squared > hardly * residual_squared)) return factor;
  return std::clamp(-factor * before_dot_change / change_squared, smallest, largest);
}

}  // namespace rootsoil
