// SPDX-License-Identifier: MIT
// Small roots in free growth, against the closed form.
#include "growth.hpp"

#include <numeric>

namespace rootsoil::physics {
namespace {

TEST(Growth, ClosedForm2D) { expect_closed_form<2>(growth_case + division, {"root.radius_mm=0.03"}, 0.5, 3.0); }

/// Every cell divides at once, and its daughters in the next window: the tissue stays as it was.
TEST(Growth, BurstOfDivisions) {
  SceneRun<2> run(growth_case + division, {"root.radius_mm=0.03", "root.length_mm=0.6", "division.l0_mm=0.007",
                                           "division.s_d_per_mm2=0", "numerics.step_h=2e-4"});
  const std::size_t before = run.tissue.cells.size();
  run.advance_to(0.05);
  const std::size_t after = run.tissue.cells.size();
  run.advance_to(1.0);
  const StressScatter stress = stress_scatter<2>(run.tissue, 0.0, run.solver.axis().length_mm() - 0.1, 1.0);
  record("cells after/before the burst", static_cast<double>(after) / static_cast<double>(before));
  expect_within_record("axial stress: rms of sigma/p - 1", stress.axial);
  expect_within_record("radial stress: rms of sigma/p - 1", stress.radial);
  record("momentum residual", relative_momentum_residual(run.tissue));
  EXPECT_GE(after, 3 * before);
  EXPECT_LT(relative_momentum_residual(run.tissue), rounding_of_balance);
}

/// All cells start with the same length. In step, those of one place divide within an hour and then not for a cycle;
/// with random phases about as many in every hour.
TEST(Growth, AsynchronousDivisionsAreSpreadOverTheCycle) {
  const auto spread = [](const std::string& asynchronous, const std::string& scatter) {
    SceneRun<2> run(growth_case + division, {"growth.x_g_mm=-0.2", "root.radius_mm=0.03", "division.s_d_per_mm2=0",
                                             "numerics.stepper=quasi_static", "division.asynchronous=" + asynchronous,
                                             "division.scatter=" + scatter});
    std::vector<double> divisions;
    auto before = static_cast<double>(run.tissue.cells.total());
    for (int hour = 1; hour <= 8; ++hour) {
      run.advance_to(hour);
      const auto now = static_cast<double>(run.tissue.cells.total());
      divisions.push_back((now - before) / before);
      before = now;
    }
    const double mean = std::reduce(divisions.begin(), divisions.end()) / 8.0;
    double square = 0.0;
    for (const double d : divisions) square += (d - mean) * (d - mean);
    return std::sqrt(square / 8.0) / mean;
  };
  const double in_step = spread("false", "0"), at_random = spread("true", "0.1");
  record("divisions of an hour, standard deviation over mean, in step", in_step);
  record("at random", at_random);
  EXPECT_LT(at_random, 0.3 * in_step);
}

}  // namespace
}  // namespace rootsoil::physics
