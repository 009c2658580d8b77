// SPDX-License-Identifier: MIT
// A root that grows freely, against the closed form: the axial rate is lambda(s) p (1 - nu_A)/(rho0 E_A), in 3D with
// (1 - 2 nu_A), and the tip moves with its integral.
#pragma once

#include "harness.hpp"
#include "scenes.hpp"

namespace rootsoil::physics {

/// Lets the root settle, then measures until the end: tip speed, mean over that time; axial rate, rms over bins of its
/// error, as a share of the largest rate and relative to the rate at the bin where that is over a tenth of the largest.
template <int Dim>
void expect_closed_form(const std::string& text, const std::vector<std::string>& overrides, double settle_h,
                        double end_h) {
  constexpr double bin_mm = 0.05;
  SceneRun<Dim> run(text, overrides);
  run.advance_to(settle_h);

  struct Bin {
    double strain = 0.0, theory = 0.0, weight = 0.0;
  };
  std::vector<Bin> bins;
  const double from = run.solver.axis().tip_mm()[0], from_h = run.tissue.time_h;
  double worst_momentum = 0.0;
  double theoretical_path = 0.0;
  run.advance_to(end_h, [&] {
    const auto& cells = run.tissue.cells;
    const double window_h = run.solver.window_h();
    theoretical_path +=
        window_h *
        closed_form_flow<Dim>(run.scene, run.solver.axis().length_mm(), run.tissue.pressure_MPa).tip_speed_mm_h;
    worst_momentum = std::max(worst_momentum, relative_momentum_residual(run.tissue));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells.clamped[i]) continue;
      // s is that of the window's end, the strain that of its middle
      const double s = run.solver.past_window_distance(cells.distance_to_tip[i]);
      const auto b = static_cast<std::size_t>(std::max(0.0, s / bin_mm));
      if (b >= bins.size()) bins.resize(b + 1);
      bins[b].strain += cells.volume[i] * run.tissue.axial_strain[i];
      bins[b].theory +=
          cells.volume[i] * window_h * closed_form_rates<Dim>(run.scene, s, run.tissue.pressure_MPa).axial;
      bins[b].weight += cells.volume[i] * window_h;
    }
  });
  const double measured_h = run.tissue.time_h - from_h;

  double largest = 0.0, of_peak = 0.0, relative = 0.0;
  int all = 0, fast = 0;
  for (const Bin& bin : bins) {
    if (bin.weight > 0.0) largest = std::max(largest, bin.theory / bin.weight);
  }
  for (const Bin& bin : bins) {
    if (bin.weight <= 0.0) continue;
    const double theory = bin.theory / bin.weight, error = bin.strain / bin.weight - theory;
    if (theory < 0.01 * largest) continue;
    of_peak += std::pow(error / largest, 2);
    ++all;
    if (theory < 0.1 * largest) continue;
    relative += std::pow(error / theory, 2);
    ++fast;
  }

  const StressScatter stress = stress_scatter<Dim>(run.tissue, 0.0, run.solver.axis().length_mm() - 0.1, 1.0);
  record("cells", static_cast<double>(run.tissue.cells.size()));
  record("step, h", run.tissue.step_h);
  record("hours measured", measured_h);
  expect_within_record("tip speed: relative error", (run.solver.axis().tip_mm()[0] - from) / theoretical_path - 1.0);
  expect_within_record("axial rate: rms of bins/largest rate", std::sqrt(of_peak / all));
  expect_within_record("axial rate: rms of bins relative", std::sqrt(relative / fast));
  expect_within_record("axial stress: rms of sigma/p - 1", stress.axial);
  expect_within_record("radial stress: rms of sigma/p - 1", stress.radial);
  if (run.tissue.inertia) record("inertia error", inertia_error(run.tissue, run.solver.axis(), run.solver.window_h()));
  record("momentum residual, largest", worst_momentum);
  EXPECT_LT(worst_momentum, rounding_of_balance);
}

}  // namespace rootsoil::physics
