// SPDX-License-Identifier: MIT
// A root without inertia that meets a soil: one balance in every coupling interval.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/soil/soil_scene.hpp"

namespace rootsoil::soil_test {
namespace {

using physics::record;

TEST(Explore, Plate) {
  for (const double k : {20.0, 50.0, 100.0, 200.0}) {
    for (const double T : {1e-3, 4e-3}) {
      for (const double mu : {0.0, 0.3}) {
      SoilRun<2> run({fmt::format("numerics.step_h={}", T)}, predicting(),
                     [&](const Scene& s) { auto p = plate(s, k); p.friction = mu; return std::make_unique<twins::HalfSpace>(p); }, balanced_text);
      double peak = 0, n = 0, sum = 0, sq = 0, last = 0; int it = 0, steps = 0;
      try {
      run.advance_to(1.1, [&] {
        const double f = run.axial_force_N() / arrest_N(run);
        it += run.solver.balance().iterations; ++steps;
        peak = std::max(peak, f); last = f;
        if (run.tissue.time_h < 0.8) return;
        n += 1; sum += f; sq += f * f;
      });
      } catch (const std::exception& e) { fmt::print("{} {} {}: {}\n", k, T, mu, e.what()); }
      fmt::print("k {} T {} mu {}: peak {:.5f} mean {:.5f} noise {:.2g} last {:.5f} it/step {:.2f} shortest {:.2g} work {:.5f} aside {:.4f} t {}\n", k, T, mu, peak, sum / n,
                 std::sqrt(std::max(0.0, sq / n - sum / n * sum / n)), last, double(it) / steps, run.solver.shortest_step_h(), run.contact.root_work_Nmm()/run.contact.soil_work_Nmm(), run.solver.axis().tip_mm()[1], run.tissue.time_h);
      std::fflush(stdout);
      }
    }
  }
}

}  // namespace
}  // namespace rootsoil::soil_test
