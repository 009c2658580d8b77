// SPDX-License-Identifier: MIT
// Moves the tissue forward: windows of steps, each window with frozen neighbours and operators.
#pragma once

#include "root_sph/dynamics/gradient.hpp"
#include "root_sph/dynamics/hooks.hpp"
#include "root_sph/dynamics/material_update.hpp"
#include "root_sph/dynamics/pair_loop.hpp"
#include "root_sph/dynamics/quasi_static.hpp"
#include "root_sph/dynamics/root_axis.hpp"

namespace rootsoil {

/// The time after so many steps, h: to 1e-12 h, so that 300 steps of 0.001 h are 0.3 and not 0.30000000000000004.
/// A function of the count alone, so that it does not depend on where a run was interrupted.
double step_time_h(std::int64_t steps, double step_h);

/// What a run's steps have taken so far.
struct Effort {
  std::int64_t balance_iterations = 0;  ///< without inertia; of a step that was cut, those before it as well
  std::int64_t force_evaluations = 0;   ///< passes of the pair loop
  std::int64_t unstable_steps = 0;      ///< that ended in a balance that a small push would end
};

template <int Dim>
class Solver {
 public:
  explicit Solver(SolverOptions options) : options_(options) {
    tissue_.step_h = shortest_step_h_ = options.step_h;
    if (options.stepper != Stepper::quasi_static) tissue_.need_inertia();
  }

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
  const Effort& effort() const { return effort_; }

  /// The column of accelerations that are prescribed, mm/h^2; the first who needs it declares it. Cleared in every
  /// window.
  Field<Dim, Vec<Dim>>& need_body_acceleration();
  /// Replaces the cell-shaped kernel by an isotropic one.
  void use_isotropic_kernel(double h_mm) { options_.isotropic_h_mm = h_mm; }
  /// Of a cell's kernel, 1/mm^2.
  Mat<Dim> metric(std::size_t cell) const;
  /// Once all columns, terms and hooks exist.
  void prepare();
  /// Before the first window: finds neighbours and operators, and what follows from them, as that window will, so that
  /// a frame of time 0 has them. The window starts anew: no later result depends on this.
  void look();
  /// Advances by one window of `steps` steps. Throws UnphysicalError when the tissue breaks.
  void advance_window(int steps);
  /// Of the latest step, without inertia; of its parts, where it was cut, the last.
  const Balance& balance() const { return balance_; }
  /// Of the latest step, the largest of its parts.
  double imbalance() const { return imbalance_; }
  /// Of the run so far, h.
  double shortest_step_h() const { return shortest_step_h_; }
  /// Duration of the window under way, h; effects evaluate profiles at its middle.
  double window_h() const { return window_h_; }
  /// At the end of the latest window; before the first one, of the velocities at the start.
  double axial_strain_rate_per_h(std::size_t cell) const;
  /// Distance from the tip in the middle of the latest window of a cell that is at s at its end.
  double past_window_distance(double s_mm) const { return s_mm - 0.5 * window_h_ * axis_.flow_mm_h(s_mm); }
  /// Distance from the tip in the middle of the window of a cell that is at s at its start.
  double mid_window_distance(double s_mm) const { return s_mm + 0.5 * window_h_ * axis_.flow_mm_h(s_mm); }

  /// State beyond the cells' columns. Valid between windows.
  void save(std::map<std::string, std::vector<double>>& reals,
            std::map<std::string, std::vector<std::int64_t>>& integers) const;
  void restore(const std::map<std::string, std::vector<double>>& reals,
               const std::map<std::string, std::vector<std::int64_t>>& integers);

 private:
  std::vector<Mat<Dim>> metrics() const;
  void find_operators(const std::vector<Mat<Dim>>& metrics);
  void begin_window();
  void evaluate_forces(SlipAdvance advance);
  void symplectic_step();
  void predictor_corrector_step();
  void choose_inertia();
  void quasi_static_step();
  bool find_balance(bool downhill, double most_thrust_change);
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
  QuasiStatic<Dim> quasi_static_;
  Balance balance_;
  double imbalance_ = 0.0, shortest_step_h_ = 0.0;
  double thrust_ = 0.0;  ///< at the latest balance, Balance::thrust
  double window_h_ = 0.0;
  std::int64_t steps_ = 0;
  Effort effort_;
};

extern template class Solver<2>;
extern template class Solver<3>;

}  // namespace rootsoil
