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

SofteningIntegral::SofteningIntegral(const SofteningProfile& softening, double length_mm, double step_mm) {
  const auto intervals = static_cast<std::size_t>(std::max(1.0, std::ceil(length_mm / step_mm)));
  step_mm_ = length_mm / static_cast<double>(intervals);
  slope_.push_back(softening(0.0));
  value_.push_back(0.0);
  for (std::size_t k = 0; k < intervals; ++k) {
    const double from = static_cast<double>(k) * step_mm_;
    slope_.push_back(softening(from + step_mm_));
    const double mean = (slope_[k] + 4.0 * softening(from + 0.5 * step_mm_) + slope_[k + 1]) / 6.0;
    value_.push_back(value_[k] + step_mm_ * mean);
  }
}

double SofteningIntegral::operator()(double s_mm) const {
  const double z = s_mm / step_mm_;
  if (z <= 0.0) return 0.0;
  const std::size_t intervals = value_.size() - 1;
  if (z >= static_cast<double>(intervals)) return value_.back();
  const auto k = static_cast<std::size_t>(z);
  const double t = z - static_cast<double>(k), u = 1.0 - t;
  return u * u * (1.0 + 2.0 * t) * value_[k] + t * t * (1.0 + 2.0 * u) * value_[k + 1] +
         step_mm_ * t * u * (u * slope_[k] - t * slope_[k + 1]);
}

double DivisionThresholdProfile::operator()(double s_mm) const {
  const double s = constant_beyond_mm >= 0.0 ? std::min(s_mm, constant_beyond_mm) : s_mm;
  return l0_mm * (c_d + s_d_per_mm2 * (s - x_d_mm) * (s - x_d_mm));
}

}  // namespace rootsoil
