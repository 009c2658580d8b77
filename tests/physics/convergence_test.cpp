// SPDX-License-Identifier: MIT
// Observed orders of convergence in growth, against a flow that is an exact answer: with E_R = E_A/nu_A nothing widens,
// so that the closed form's axial flow needs no shear anywhere.
#include "harness.hpp"
#include "scenes.hpp"

namespace rootsoil::physics {
namespace {

const std::vector<std::string> exact_flow{"root.radius_mm=0.04", "root.length_mm=1.6",
                                          "tissue.anisotropy.E_radial_max_MPa=17000", "tissue.anisotropy.c_e=1"};

/// Root mean square of the axial rate's error over cells and windows, share of the largest rate.
struct RateError {
  double interior = 0.0;  ///< more than a diameter from the tip and a quarter of the radius from the flank
  double all = 0.0;
};

RateError rate_error(int cells_across) {
  constexpr double settled_h = 0.1, end_h = 0.2, step_h = 1e-4, radius_mm = 0.04;
  std::vector<std::string> overrides = exact_flow;
  overrides.push_back("root.cell_size_mm=" + std::to_string(2.0 * radius_mm / cells_across));
  overrides.push_back("numerics.step_h=" + std::to_string(step_h));
  SceneRun<2> run(growth_case, overrides);
  run.advance_to(settled_h);
  double inner = 0.0, inner_cells = 0.0, every = 0.0, cells = 0.0;
  run.advance_to(end_h, [&] {
    const auto& c = run.tissue.cells;
    const double largest =
        closed_form_flow<2>(run.scene, run.solver.axis().length_mm(), run.tissue.pressure_MPa).peak_rate_per_h;
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (c.clamped[i]) continue;
      const double s = run.solver.past_window_distance(c.distance_to_tip[i]);
      const double rate = run.tissue.axial_strain[i] / run.solver.window_h();
      const double error = (rate - closed_form_rates<2>(run.scene, s, run.tissue.pressure_MPa).axial) / largest;
      every += error * error;
      cells += 1.0;
      if (s < 2.0 * radius_mm || std::abs(c.position[i][1]) > 0.75 * radius_mm) continue;
      inner += error * error;
      inner_cells += 1.0;
    }
  });
  const RateError found{std::sqrt(inner / inner_cells), std::sqrt(every / cells)};
  const std::string across = std::to_string(cells_across) + " across: axial rate: rms error ";
  expect_within_record(across + "in the interior", found.interior, 1e-5);
  expect_within_record(across + "of all cells", found.all, 1e-5);
  return found;
}

TEST(Convergence, SecondOrderInCellSizeInTheInteriorFirstOrBetterWithEdges) {
  const RateError coarse = rate_error(5), middle = rate_error(10), fine = rate_error(20);
  const double interior = 0.5 * std::log2(coarse.interior / fine.interior);
  const double all = 0.5 * std::log2(coarse.all / fine.all);
  record("order in the interior, 5 to 10", std::log2(coarse.interior / middle.interior));
  record("order in the interior, 10 to 20", std::log2(middle.interior / fine.interior));
  record("order with edges, 5 to 10", std::log2(coarse.all / middle.all));
  record("order with edges, 10 to 20", std::log2(middle.all / fine.all));
  expect_within_record("order in the interior: 2 less the measured", 2.0 - interior);
  EXPECT_GT(all, 1.0);  // 1.54
}

/// Mean over half an hour of the unbalanced axial force over p times the section.
double mean_inertia_error(double step_h, const std::string& compensation) {
  SceneRun<2> run(growth_case,
                  {"root.radius_mm=0.04", "root.length_mm=1.6", "root.cell_size_mm=0.013333333333333334",
                   "numerics.inertia_compensation=" + compensation, "numerics.step_h=" + std::to_string(step_h)});
  run.advance_to(0.5);
  double sum = 0.0, windows = 0.0;
  run.advance_to(1.0, [&] {
    sum += inertia_error(run.tissue, run.solver.axis(), run.solver.window_h());
    windows += 1.0;
  });
  expect_within_record("step " + std::to_string(step_h) + " h; compensation " + compensation + ": inertia error",
                       sum / windows, 1e-5);
  return sum / windows;
}

TEST(Convergence, InertiaErrorIsSecondOrderInTheStep) {
  const double plain = std::log2(mean_inertia_error(1e-3, "false") / mean_inertia_error(2.5e-4, "false")) / 2.0;
  const double compensated = std::log2(mean_inertia_error(1e-3, "true") / mean_inertia_error(2.5e-4, "true")) / 2.0;
  expect_within_record("order without compensation: 2 less the measured", 2.0 - plain);
  record("order with compensation", compensated);
  EXPECT_GT(compensated, 2.0);  // 2.8
}

}  // namespace
}  // namespace rootsoil::physics
