// SPDX-License-Identifier: MIT
#include "root_sph/profiles/root_profiles.hpp"

#include <algorithm>
#include <cmath>

namespace rootsoil {

double RadialModulusProfile::operator()(double s_mm) const {
  const double sigmoid = 1.0 / (1.0 + std::exp(-s_e_per_mm * (s_mm - x_e_mm)));
  return E_axial_MPa + (E_radial_max_MPa - E_axial_MPa) * (c_e + (1.0 - c_e) * sigmoid);
}

double SofteningProfile::operator()(double s_mm) const {
  const double z = (s_mm - x_g_mm) / s_g_mm;
  const double bell = z * std::exp(0.5 - 0.5 * z * z);
  const double lambda = lambda0_ug_mm3_h * (0.5 * (1.0 + c_g) + 0.5 * (1.0 - c_g) * bell);
  if (lambda <= 0.0) return 0.0;
  if (mature_at_mm < 0.0) return lambda;
  if (mature_width_mm <= 0.0) return s_mm < mature_at_mm ? lambda : 0.0;
  const double t = std::clamp((mature_at_mm - s_mm) / mature_width_mm + 0.5, 0.0, 1.0);
  return lambda * t * t * (3.0 - 2.0 * t);
}

double DivisionThresholdProfile::operator()(double s_mm) const {
  const double s = constant_beyond_mm >= 0.0 ? std::min(s_mm, constant_beyond_mm) : s_mm;
  return l0_mm * (c_d + s_d_per_mm2 * (s - x_d_mm) * (s - x_d_mm));
}

}  // namespace rootsoil
