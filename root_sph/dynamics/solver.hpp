// SPDX-License-Identifier: MIT
// Moves the tissue forward: windows of steps, each window with frozen neighbours and operators.
#pragma once

#include "root_sph/dynamics/gradient.hpp"
#include "root_sph/dynamics/hooks.hpp"
#include "root_sph/dynamics/material_update.hpp"
#include "root_sph/dynamics/pair_loop.hpp"
#include "root_sph/dynamics/root_axis.hpp"
#include "root_sph/dynamics/stability.hpp"

#include <optional>

namespace rootsoil {

enum class Stepper {
  symplectic,           ///< leapfrog: one evaluation a step
  predictor_corrector,  ///< the paper's 4.4, made stable: two evaluations, half step and full step
};

/// The time after so many steps, h: to 1e-12 h, so that 300 steps of 0.001 h are 0.3 and not 0.30000000000000004.
/// A function of the count alone, so that it does not depend on where a run was interrupted.
double step_time_h(std::int64_t steps, double step_h);

struct SolverOptions {
  double step_h = 0.0;
  std::optional<double> isotropic_h_mm;  ///< smoothing length of the isotropic kernel; absent: cell-shaped
  double eta = 1.5;                      ///< reach of the cell-shaped kernel, cell lengths
  GradientMode gradient = GradientMode::quadratic_at_surface;
  Stepper stepper = Stepper::symplectic;
  InertiaMode inertia = InertiaMode::tensor;
  /// 1/h; absent: critical damping of the slowest axial mode, for static scenes
  std::optional<double> mass_damping_per_h = 0.0;
};

template <int Dim>
class Solver {
 public:
  explicit Solver(SolverOptions options) : options_(options) { tissue_.step_h = options.step_h; }

  Tissue<Dim>& tissue() { return tissue_; }
  const Tissue<Dim>& tissue() const { return tissue_; }
  PairTerms<Dim>& pair_terms() { return terms_; }
  RootAxis<Dim>& axis() { return axis_; }
  const RootAxis<Dim>& axis() const { return axis_; }
  Hooks<Dim>& hooks() { return hooks_; }
  const SolverOptions& options() const { return options_; }
  const PhaseClock& clock() const { return clock_; }
  const GradientReport& gradient_report() const { return gradient_report_; }
  std::int64_t steps() const { return steps_; }

  /// Replaces the cell-shaped kernel by an isotropic one.
  void use_isotropic_kernel(double h_mm) { options_.isotropic_h_mm = h_mm; }
  /// Once all columns, terms and hooks exist.
  void prepare();
  /// Advances by one window of `steps` steps. Throws UnphysicalError when the tissue breaks.
  void advance_window(int steps);
  /// Duration of the window under way, h; effects evaluate profiles at its middle.
  double window_h() const { return window_h_; }
  /// Distance from the tip in the middle of the window of a cell now at s.
  double mid_window_distance(double s_mm) const { return s_mm + 0.5 * window_h_ * axis_.flow_mm_h(s_mm); }

  /// State beyond the cells' columns. Valid between windows.
  void save(std::map<std::string, std::vector<double>>& reals,
            std::map<std::string, std::vector<std::int64_t>>& integers) const;
  void restore(const std::map<std::string, std::vector<double>>& reals,
               const std::map<std::string, std::vector<std::int64_t>>& integers);

 private:
  void begin_window();
  void evaluate_forces(SlipAdvance advance);
  void symplectic_step();
  void predictor_corrector_step();
  void end_window();
  void check_physical() const;

  SolverOptions options_;
  Tissue<Dim> tissue_;
  PairTerms<Dim> terms_;
  RootAxis<Dim> axis_;
  Hooks<Dim> hooks_;
  PhaseClock clock_;
  MaterialLoop<Dim> update_material_ = nullptr, predict_nominal_forces_ = nullptr;
  ForceLoop<Dim> add_forces_ = nullptr;
  std::vector<Vec<Dim>> step_velocity_;  ///< of the step's start, later of its end; predictor-corrector only
  GradientReport gradient_report_;
  double window_h_ = 0.0;
  std::int64_t steps_ = 0;
};

extern template class Solver<2>;
extern template class Solver<3>;

}  // namespace rootsoil
