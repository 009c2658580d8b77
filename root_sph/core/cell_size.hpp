// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace rootsoil {

/// Edge of the square (3D: cube) with a cell's volume, mm. Not std::pow: where a compiler makes a loop of it that takes
/// several cells at once, pow(x, 0.5) is a square root for these and something else, in the last bit, for the cells
/// left over, and which these are depends on the number of threads.
///
/// \param volume mm^3 (2D: mm^2), >= 0
template <int Dim>
double cell_size_mm(double volume) {
  if constexpr (Dim == 2) {
    return std::sqrt(volume);
  } else {
    return std::cbrt(volume);
  }
}

}  // namespace rootsoil
