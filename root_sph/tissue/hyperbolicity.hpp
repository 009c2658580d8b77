// SPDX-License-Identifier: MIT
// Whether a tissue law transmits waves (and therefore settles) or makes them grow by themselves.
#pragma once

#include "root_sph/tissue/elasticity.hpp"

namespace rootsoil {

/// The worst direction of the acoustic tensor Gamma_ik = A_ijkl n_j n_l of a law with tangent A.
struct AcousticFinding {
  bool hyperbolic = true;          ///< every eigenvalue real and positive in every direction
  double smallest_real_MPa = 0.0;  ///< smallest real part
  double largest_imaginary_MPa = 0.0;
  double angle_deg = 0.0;  ///< direction of the worst case, from the root axis
};

/// Scans directions in steps of a degree in a plane through the root axis, which is enough for a transversely isotropic
/// tangent (any other is not meant here).
template <int Dim>
AcousticFinding scan_acoustic_tensor(const VoigtMat<Dim>& tangent);

}  // namespace rootsoil
