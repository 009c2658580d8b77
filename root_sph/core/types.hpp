// SPDX-License-Identifier: MIT
// Small fixed-size vectors and matrices, and the unit system.
//
// Units everywhere: mm, h, MPa (= N/mm^2), forces in N (2D: N per mm of depth),
// biological mass in ug (2D: ug per mm of depth), inertia in N h^2/mm. A name
// that carries a value read or written by users ends with its unit.
#pragma once

#include <Eigen/Dense>

namespace rootsoil {

template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;

template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim>;

/// Number of components of a symmetric tensor.
template <int Dim>
inline constexpr int voigt_size = Dim*(Dim + 1) / 2;

/// Symmetric tensor, normal components first: 2D (11, 22, 12), 3D (11, 22, 33, 23, 13, 12).
/// Stresses hold the tensor's components; strain rates hold engineering shear (twice the component).
template <int Dim>
using Voigt = Eigen::Matrix<double, voigt_size<Dim>, 1>;

template <int Dim>
using VoigtMat = Eigen::Matrix<double, voigt_size<Dim>, voigt_size<Dim>>;

/// Stress vector -> symmetric matrix.
template <int Dim>
Mat<Dim> to_matrix(const Voigt<Dim>& s) {
  Mat<Dim> m;
  if constexpr (Dim == 2) {
    m << s[0], s[2], s[2], s[1];
  } else {
    m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  }
  return m;
}

/// Symmetric matrix -> stress vector.
template <int Dim>
Voigt<Dim> to_voigt(const Mat<Dim>& m) {
  Voigt<Dim> s;
  if constexpr (Dim == 2) {
    s << m(0, 0), m(1, 1), m(0, 1);
  } else {
    s << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1);
  }
  return s;
}

/// Symmetric strain-rate matrix -> strain vector with engineering shear.
template <int Dim>
Voigt<Dim> to_strain_voigt(const Mat<Dim>& m) {
  Voigt<Dim> s = to_voigt<Dim>(m);
  s.template tail<voigt_size<Dim> - Dim>() *= 2.0;
  return s;
}

}  // namespace rootsoil
