// SPDX-License-Identifier: MIT
// What can be chosen about the numerics of the solver, with the words that scenes use.
#pragma once

#include <optional>

#include "root_sph/core/enum_names.hpp"

namespace rootsoil {

enum class GradientMode { plain, linear, quadratic, quadratic_at_surface };
template <>
inline constexpr EnumName<GradientMode> enum_names<GradientMode>[] = {
    {GradientMode::plain, "plain"},
    {GradientMode::linear, "linear"},
    {GradientMode::quadratic, "quadratic"},
    {GradientMode::quadratic_at_surface, "quadratic_at_surface"}};

enum class Stepper {
  quasi_static,         ///< balance at the end of every step, without inertia
  symplectic,           ///< leapfrog: one evaluation a step
  predictor_corrector,  ///< the paper's 4.4, made stable: two evaluations, half step and full step
};
template <>
inline constexpr EnumName<Stepper> enum_names<Stepper>[] = {{Stepper::quasi_static, "quasi_static"},
                                                            {Stepper::symplectic, "symplectic"},
                                                            {Stepper::predictor_corrector, "predictor_corrector"}};

enum class InertiaMode { tensor, scalar };
template <>
inline constexpr EnumName<InertiaMode> enum_names<InertiaMode>[] = {{InertiaMode::tensor, "tensor"},
                                                                    {InertiaMode::scalar, "scalar"}};

struct SolverOptions {
  double step_h = 0.0;
  std::optional<double> isotropic_h_mm;  ///< smoothing length of the isotropic kernel; absent: cell-shaped
  double eta = 1.5;                      ///< reach of the cell-shaped kernel, cell lengths
  GradientMode gradient = GradientMode::quadratic_at_surface;
  Stepper stepper = Stepper::symplectic;
  InertiaMode inertia = InertiaMode::tensor;
  /// 1/h; absent: critical damping of the slowest axial mode, for static scenes
  std::optional<double> mass_damping_per_h = 0.0;
  double force_tolerance = 1e-4;  ///< quasi_static: rms force over the pressure differential times a cell's face
};

}  // namespace rootsoil
