// SPDX-License-Identifier: MIT
#include "root_sph/tissue/hyperbolicity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace rootsoil {
namespace {

/// Eigenvalues of the acoustic tensor Gamma_ik = A_ijkl n_j n_l for n = (cos, sin, 0), A a transversely isotropic
/// tangent that need not be symmetric: two waves in the plane of n and the axis, and one across it.
template <int Dim>
std::array<std::complex<double>, Dim> acoustic_moduli(const VoigtMat<Dim>& a, double cosine, double sine) {
  constexpr int shear12 = Dim == 2 ? 2 : 5;
  const double g = a(shear12, shear12);
  const double gamma11 = a(0, 0) * cosine * cosine + g * sine * sine;
  const double gamma22 = g * cosine * cosine + a(1, 1) * sine * sine;
  const double gamma12 = (a(0, 1) + g) * cosine * sine, gamma21 = (a(1, 0) + g) * cosine * sine;
  const double mean = 0.5 * (gamma11 + gamma22), half = 0.5 * (gamma11 - gamma22);
  const std::complex<double> root = std::sqrt(std::complex<double>(half * half + gamma12 * gamma21));
  if constexpr (Dim == 2) {
    return {mean - root, mean + root};
  } else {
    return {mean - root, mean + root, a(4, 4) * cosine * cosine + a(3, 3) * sine * sine};
  }
}

}  // namespace

template <int Dim>
AcousticFinding scan_acoustic_tensor(const VoigtMat<Dim>& tangent) {
  AcousticFinding worst;
  worst.smallest_real_MPa = 1e300;
  const double scale = tangent.cwiseAbs().maxCoeff();
  for (int degree = 0; degree < 180; ++degree) {
    const double angle = degree * std::numbers::pi / 180.0;
    for (const std::complex<double> modulus : acoustic_moduli<Dim>(tangent, std::cos(angle), std::sin(angle))) {
      const double real = modulus.real();
      const double imaginary = std::abs(modulus.imag());
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

template AcousticFinding scan_acoustic_tensor<2>(const VoigtMat<2>&);
template AcousticFinding scan_acoustic_tensor<3>(const VoigtMat<3>&);

}  // namespace rootsoil
