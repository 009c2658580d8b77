// SPDX-License-Identifier: MIT
// Growth: a source of mass where the tissue is soft and stretched (Eq. 1, 2 and 6).
#pragma once

#include <functional>

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

struct GrowthSection {
  double lambda0_ug_mm3_h = 0.0, x_g_mm = 0.0, s_g_mm = 0.0, c_g = 0.0;
  std::optional<double> mature_at_mm;  ///< absent: Eq. 6 to the letter, growth never ends
  double mature_width_mm = 0.1;
  Rows yield{};  ///< (mm from the tip, MPa), distances increasing; none: Eq. 2, anything stretched grows
  Rows table{};  ///< (mm from the tip, ug/(mm^3 h)), distances increasing, in place of Eq. 6
};

/// lambda(s): the table, linear between its rows, or Eq. 6, second: lambda0 ((1 + c_g)/2 + (1 - c_g)/2 z exp(1/2 -
/// z^2/2)), z = (s - x_g)/s_g, ug/(mm^3 h). Clipped at 0 (to the letter it is negative below x_g - s_g when c_g < 0),
/// and times a mature cut-off: to the letter it tends to (1 + c_g)/2 lambda0, mature tissue would grow for ever. The
/// cut-off falls from 1 to 0 as a cubic between mature_at - width/2 and mature_at + width/2.
double softening_ug_mm3_h(const GrowthSection& growth, double s_mm);

/// Stress beyond which the tissue grows: linear between the rows and constant beyond them, MPa; 0 where there are none.
double yield_MPa(const GrowthSection& growth, double s_mm);

/// Integral from the tip of a function of s, such as lambda, ug/(mm^2 h): a table with Simpson's rule between the nodes
/// and cubic Hermite interpolation, so fourth order in the step. Constant below 0 and beyond `length_mm`.
class IntegralFromTip {
 public:
  IntegralFromTip(const std::function<double(double s_mm)>& function, double length_mm, double step_mm);
  double operator()(double s_mm) const;

 private:
  double step_mm_;
  std::vector<double> slope_, value_;
};

/// [growth] at a pressure differential (Eq. 7 where it responds); nothing where the scene has none.
std::optional<GrowthSection> growth_at(const Scene& scene, double p_MPa);

/// A cell's softening is the gradient of the profile's integral along the root, taken with the operators that measure
/// its strain rate: lambda_i = -axis . sum_j (Lambda_j - Lambda_i) g_ij. A cell as long as the profile is steep cannot
/// follow its value at one point: the rate that its neighbours allow is an average, and the difference would stay
/// behind as stress where the growth zone ends (docs/decisions/0010). Equal to lambda(s) to second order.
///
/// Its yield stress is lambda Y over lambda, both measured so: the flow is the integral of lambda (p - Y).
template <int Dim>
class GrowthEffect final : public Effect<Dim> {
 public:
  GrowthEffect(Solver<Dim>& solver, const Scene& scene);
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;

 private:
  /// The gradient along the root of a function's integral, with the operators, at every cell; 0 where held.
  void measure(const Tissue<Dim>& tissue, const std::function<double(double s_mm)>& function,
               Field<Dim, double>& gradient) const;

  Solver<Dim>& solver_;
  Field<Dim, double>& softening_;
  Field<Dim, double>* yield_ = nullptr;  ///< with a threshold only
};

EffectSpec growth_effect();

}  // namespace rootsoil
