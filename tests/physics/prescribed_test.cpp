// SPDX-License-Identifier: MIT
// Forces that a scene prescribes, against exact answers.
#include "bending.hpp"
#include "growth.hpp"

namespace rootsoil::physics {
namespace {

/// A cantilever bent by its own weight. Beyond a section one depth from the clamp, from the tangent there, a beam of
/// length l under q per length bends by q (x^4 - 4 l x^3 + 6 l^2 x^2)/(24 E I) - q x^2/(2 kappa G A): of the shear's
/// q (l x - x^2/2)/(kappa G A) the tangent takes q l x/(kappa G A) along (Timoshenko).
TEST(Gravity, ACantileverBendsUnderItsWeight) {
  const std::string weight = "[gravity]\nacceleration_m_s2 = [0, 9.81e3]\ndensity_difference_kg_m3 = 1000\n";
  const BeamResult r = bend<2>(beam_case(2, 12) + weight, {}, 0.0);
  const double q = 1e-9 * 9.81e3 * 1000.0 * r.section.area;
  const double l = beam_length_mm - beam_depth_mm, x = r.beyond_mm;
  const double exact = q * (std::pow(x, 4) - 4.0 * l * std::pow(x, 3) + 6.0 * l * l * x * x) / (24.0 * r.section.EI) -
                       q * x * x / (2.0 * r.section.kGA);
  record("deflection/length", r.relative_mm / l);
  record("change in the last tenth", r.last_change);
  EXPECT_LT(r.last_change, 1e-3);
  expect_within_record("deflection/theory - 1", r.relative_mm / exact - 1.0);
}

/// Behind the force F on the tip the axial stress is p - F/W, and the strain rate that of free growth times
/// 1 - F/(p (1 - nu_A) W).
TEST(Force, SlowsGrowthAsTheClosedFormSays) {
  SceneRun<2> run(growth_case + "[force]\naxial_N = 0.04\ntable = [[0, 0], [0.3, 1]]\n", {"numerics.step_h=1e-4"});
  run.advance_to(0.8);
  constexpr double from_mm = 0.2, to_mm = 0.6;
  double measured = 0.0, exact = 0.0, free = 0.0;
  run.advance_to(1.6, [&] {
    const auto& cells = run.tissue.cells;
    const double width = 2.0 * radius_mm<2>(run.tissue, from_mm, to_mm);
    const double arrest_N = run.tissue.pressure_MPa * (1.0 - run.scene.tissue.nu_axial) * width;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double s = run.solver.past_window_distance(cells.distance_to_tip[i]);
      if (cells.clamped[i] || s < from_mm || s > to_mm) continue;
      const double rate = closed_form_rates<2>(run.scene, s, run.tissue.pressure_MPa).axial * run.solver.window_h();
      measured += cells.volume[i] * run.tissue.axial_strain[i];
      free += cells.volume[i] * rate;
      exact += cells.volume[i] * rate * (1.0 - 0.04 / arrest_N);
    }
  });
  record("rate/free rate", measured / free);
  if (run.tissue.inertia) record("inertia error", inertia_error(run.tissue, run.solver.axis(), run.solver.window_h()));
  EXPECT_LT(exact / free, 0.75);
  expect_within_record("rate/theory - 1", measured / exact - 1.0);
}

}  // namespace
}  // namespace rootsoil::physics
