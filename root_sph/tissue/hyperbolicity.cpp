// SPDX-License-Identifier: MIT
#include "root_sph/tissue/hyperbolicity.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

#include <cmath>
#include <numbers>

namespace rootsoil {
namespace {

/// Strain (engineering shear) of a plane displacement wave u exp(i n.x): B(n) u.
template <int Dim>
Eigen::Matrix<double, voigt_size<Dim>, Dim> wave_strain(const Vec<Dim>& n) {
  Eigen::Matrix<double, voigt_size<Dim>, Dim> b = Eigen::Matrix<double, voigt_size<Dim>, Dim>::Zero();
  for (int a = 0; a < Dim; ++a) b(a, a) = n[a];
  if constexpr (Dim == 2) {
    b(2, 0) = n[1];
    b(2, 1) = n[0];
  } else {
    b(3, 1) = n[2], b(3, 2) = n[1];
    b(4, 0) = n[2], b(4, 2) = n[0];
    b(5, 0) = n[1], b(5, 1) = n[0];
  }
  return b;
}

}  // namespace

template <int Dim>
VoigtMat<Dim> elastic_growth_tangent(const ElasticConstants& constants) {
  return compliance<Dim>(constants).inverse();
}

template <int Dim>
VoigtMat<Dim> pressure_deviator_tangent(const ElasticConstants& constants) {
  VoigtMat<Dim> tangent = compliance<Dim>(constants).inverse();
  for (int column = 0; column < voigt_size<Dim>; ++column) {
    tangent.col(column) = deviator<Dim>(tangent.col(column));
  }
  tangent.template topLeftCorner<Dim, Dim>().array() += bulk_modulus<Dim>(stiffness<Dim>(constants));
  return tangent;
}

template <int Dim>
AcousticFinding scan_acoustic_tensor(const VoigtMat<Dim>& tangent) {
  AcousticFinding worst;
  worst.smallest_real_MPa = 1e300;
  const double scale = tangent.cwiseAbs().maxCoeff();
  for (int degree = 0; degree < 180; ++degree) {
    const double angle = degree * std::numbers::pi / 180.0;
    Vec<Dim> n = Vec<Dim>::Zero();
    n[0] = std::cos(angle);
    n[1] = std::sin(angle);
    const auto b = wave_strain<Dim>(n);
    const Mat<Dim> gamma = b.transpose() * tangent * b;
    const auto eigenvalues = Eigen::EigenSolver<Mat<Dim>>(gamma, false).eigenvalues();
    for (int k = 0; k < Dim; ++k) {
      const double real = eigenvalues[k].real();
      const double imaginary = std::abs(eigenvalues[k].imag());
      const bool bad = real <= 0.0 || imaginary > 1e-9 * scale;
      const bool worse = imaginary > worst.largest_imaginary_MPa * (1.0 + 1e-9) ||
                         (worst.largest_imaginary_MPa <= 1e-9 * scale && real < worst.smallest_real_MPa);
      if (bad) worst.hyperbolic = false;
      if (worse) worst.angle_deg = degree;
      worst.smallest_real_MPa = std::min(worst.smallest_real_MPa, real);
      worst.largest_imaginary_MPa = std::max(worst.largest_imaginary_MPa, imaginary);
    }
  }
  return worst;
}

template VoigtMat<2> elastic_growth_tangent<2>(const ElasticConstants&);
template VoigtMat<3> elastic_growth_tangent<3>(const ElasticConstants&);
template VoigtMat<2> pressure_deviator_tangent<2>(const ElasticConstants&);
template VoigtMat<3> pressure_deviator_tangent<3>(const ElasticConstants&);
template AcousticFinding scan_acoustic_tensor<2>(const VoigtMat<2>&);
template AcousticFinding scan_acoustic_tensor<3>(const VoigtMat<3>&);

}  // namespace rootsoil
