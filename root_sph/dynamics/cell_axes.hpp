// SPDX-License-Identifier: MIT
// The axes of a cell, from its shape matrix Q: eigenvalues 4/length^2.
#pragma once

#include <cmath>

#include "root_sph/core/types.hpp"

namespace rootsoil {

/// Direction (unit) and full length, 2/sqrt(zeta_1), mm.
template <int Dim>
struct LongestAxis {
  Vec<Dim> direction;
  double length_mm;
};
template <int Dim>
LongestAxis<Dim> longest_axis(const Mat<Dim>& shape);

/// Lengths of all axes, mm, longest first.
template <int Dim>
Vec<Dim> axis_lengths_mm(const Mat<Dim>& shape);

/// From the centre, along a direction (unit), to the plane across it that touches the cell, mm.
template <int Dim>
double half_extent(const Mat<Dim>& shape, const Vec<Dim>& direction) {
  return std::sqrt(direction.dot(shape.inverse() * direction));
}

}  // namespace rootsoil
