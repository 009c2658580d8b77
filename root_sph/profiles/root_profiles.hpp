// SPDX-License-Identifier: MIT
// How properties vary along the root: the paper's Eq. 6, as functions of s, the distance from the tip.
#pragma once

#include <vector>

namespace rootsoil {

/// E_R(s) = E_A + (E_H - E_A) (c_e + (1 - c_e)/(1 + exp(-s_e (s - x_e)))), MPa. Eq. 6, first.
struct RadialModulusProfile {
  double E_axial_MPa, E_radial_max_MPa, x_e_mm, s_e_per_mm, c_e;
  double operator()(double s_mm) const;
};

/// lambda(s), Eq. 6, second: lambda0 ((1 + c_g)/2 + (1 - c_g)/2 z exp(1/2 - z^2/2)), z = (s - x_g)/s_g, ug/(mm^3 h).
/// Clipped at 0 (to the letter it is negative below x_g - s_g when c_g < 0), and times a mature cut-off: to the
/// letter it tends to (1 + c_g)/2 lambda0, mature tissue would grow for ever. The cut-off falls from 1 to 0 as a
/// cubic between mature_at - width/2 and mature_at + width/2.
struct SofteningProfile {
  double lambda0_ug_mm3_h, x_g_mm, s_g_mm, c_g;
  double mature_at_mm = -1.0;  ///< negative: no cut-off
  double mature_width_mm = 0.0;
  double operator()(double s_mm) const;
};

/// Integral of lambda(s) from the tip, ug/(mm^2 h): a table with Simpson's rule between the nodes and cubic Hermite
/// interpolation, so fourth order in the step. Constant below 0 and beyond `length_mm`.
class SofteningIntegral {
 public:
  SofteningIntegral(const SofteningProfile& softening, double length_mm, double step_mm);
  double operator()(double s_mm) const;

 private:
  double step_mm_;
  std::vector<double> slope_, value_;
};

/// Division threshold of the longest axis, l(s) = l0 (c_d + s_d (s - x_d)^2), mm; constant beyond a distance.
/// Eq. 6, third.
struct DivisionThresholdProfile {
  double l0_mm, c_d, s_d_per_mm2, x_d_mm;
  double constant_beyond_mm = -1.0;  ///< negative: never constant
  double operator()(double s_mm) const;
};

}  // namespace rootsoil
