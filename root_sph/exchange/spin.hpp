// SPDX-License-Identifier: MIT
// What turns: one number in 2D, an axial vector in 3D.
#pragma once

#include <array>

#include "root_sph/core/types.hpp"

namespace rootsoil {

/// Angular velocity, angle or torque: one number in 2D, an axial vector in 3D.
template <int Dim>
using Spin = Eigen::Matrix<double, Dim == 2 ? 1 : 3, 1>;

template <int Dim>
Spin<Dim> cross(const Vec<Dim>& a, const Vec<Dim>& b) {
  if constexpr (Dim == 2) {
    return Spin<2>(a[0] * b[1] - a[1] * b[0]);
  } else {
    return a.cross(b);
  }
}

/// spin x r
template <int Dim>
Vec<Dim> turned(const Spin<Dim>& spin, const Vec<Dim>& r) {
  if constexpr (Dim == 2) {
    return spin[0] * Vec<2>(-r[1], r[0]);
  } else {
    return spin.cross(r);
  }
}

/// As an axial vector of three components; in 2D it turns about z.
template <int Dim>
std::array<double, 3> axial(const Spin<Dim>& spin) {
  if constexpr (Dim == 2) {
    return {0.0, 0.0, spin[0]};
  } else {
    return {spin[0], spin[1], spin[2]};
  }
}

/// The inverse of axial.
template <int Dim>
Spin<Dim> spin_of(const std::array<double, 3>& v) {
  if constexpr (Dim == 2) {
    return Spin<2>(v[2]);
  } else {
    return Spin<3>(v[0], v[1], v[2]);
  }
}

}  // namespace rootsoil
