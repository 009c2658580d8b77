// SPDX-License-Identifier: MIT
// Steps that end in balance, against exact answers: the same problems as with inertia, and those that inertia spoils.
#include "bending.hpp"
#include "growth.hpp"
#include "strain.hpp"

namespace rootsoil::physics {
namespace {

using Texts = std::vector<std::string>;

Texts balanced_steps(Texts overrides = {}) {
  overrides.push_back("numerics.stepper=quasi_static");
  return overrides;
}

TEST(QuasiStatic, Growth2D) {
  expect_closed_form<2>(growth_case + division, balanced_steps({"root.radius_mm=0.03"}), 0.5, 3.0);
}

TEST(QuasiStatic, GrowthAboveARestingTip2D) { expect_closed_form<2>(resting_tip_case, balanced_steps(), 1.0, 4.0); }

TEST(QuasiStatic, Growth3D) {
  expect_closed_form<3>(growth_case + division,
                        balanced_steps({"scene.dimension=3", "root.radius_mm=0.03", "root.length_mm=0.6",
                                        "tissue.anisotropy.E_radial_max_MPa=12000"}),
                        0.5, 2.0);
}

TEST(QuasiStatic, StrainOfIsotropicTissue2D) {
  expect_theoretical_strain<2>(strain_case, balanced_steps({"root.length_mm=1", "root.radius_mm=0.05"}), 0.1, 0.7);
}

TEST(QuasiStatic, StrainOfBalancedTissue2D) {
  expect_theoretical_strain<2>(strain_case + balanced, balanced_steps({"root.length_mm=1", "root.radius_mm=0.05"}), 0.3,
                               0.7);
}

TEST(QuasiStatic, StrainOfIsotropicTissue3D) {
  expect_theoretical_strain<3>(
      strain_case, balanced_steps({"scene.dimension=3", "root.length_mm=0.4", "root.radius_mm=0.03"}), 0.1, 0.3);
}

TEST(QuasiStatic, Cantilever) {
  expect_within_record("6 across: deflection beyond one depth", cantilever<2>(6, balanced_steps()).beam - 1.0);
  expect_within_record("12 across: deflection beyond one depth", cantilever<2>(12, balanced_steps()).beam - 1.0);
  expect_within_record("3D 8 across: deflection beyond one depth", cantilever<3>(8, balanced_steps()).beam - 1.0);
}

/// Little of the load is across the axis, and near the Euler load little holds it.
TEST(QuasiStatic, EulerLoad) {
  const Texts fine = balanced_steps({"numerics.force_tolerance=1e-11"});
  expect_within_record("6 across: Euler load beyond one depth", buckling<2>(6, fine).beam - 1.0);
  expect_within_record("12 across: Euler load beyond one depth", buckling<2>(12, fine).beam - 1.0);
}

/// Weight across the axis, with the program's own step: what a critically damped axial wave does not wait for.
TEST(QuasiStatic, ACantileverBendsUnderItsWeightInOneStep) {
  const std::string weight = "[gravity]\nacceleration_m_s2 = [0, 9.81e3]\ndensity_difference_kg_m3 = 1000\n";
  const BeamResult r = bend<2>(beam_case(2, 12) + weight, balanced_steps({"numerics.step_h=1"}), 0.0);
  const double q = 1e-9 * 9.81e3 * 1000.0 * r.section.area;
  const double l = beam_length_mm - beam_depth_mm, x = r.beyond_mm;
  const double exact = q * (std::pow(x, 4) - 4.0 * l * std::pow(x, 3) + 6.0 * l * l * x * x) / (24.0 * r.section.EI) -
                       q * x * x / (2.0 * r.section.kGA);
  EXPECT_LT(r.last_change, 1e-3);
  expect_within_record("deflection/theory - 1", r.relative_mm / exact - 1.0);
}

/// Tip speed after two hours, against steps eight times as short.
TEST(QuasiStatic, IsSecondOrderInTheStep) {
  const auto speed = [](const std::string& step_h) {
    SceneRun<2> run(growth_case, balanced_steps({"root.radius_mm=0.04", "root.cell_size_mm=0.01333",
                                                 "numerics.force_tolerance=1e-7", "numerics.step_h=" + step_h}));
    run.advance_to(1.6);
    const double from = run.solver.axis().tip_mm()[0];
    run.advance_to(2.4);
    return (run.solver.axis().tip_mm()[0] - from) / 0.8;
  };
  const double exact = speed("0.0125"), coarse = speed("0.2") / exact - 1.0, fine = speed("0.1") / exact - 1.0;
  record("error in steps of 0.2 h", coarse);
  expect_within_record("error in steps of 0.1 h", fine, 1e-6);
  record("order", std::log2(coarse / fine));
  EXPECT_GT(std::log2(coarse / fine), 1.8);
}

/// A root that runs into a wall is stopped by p (1 - nu_A) W, and hardly more at any time.
TEST(QuasiStatic, AWallStopsTheRoot) {
  const std::string wall = "[[obstacle]]\nshape = \"plane\"\nposition_mm = [1.02, 0]\nnormal = [-1, 0]\n";
  for (const std::string modulus : {"1020", "100000"}) {
    SceneRun<2> run(growth_case + wall,
                    balanced_steps({"root.cap=false", "root.cell_size_mm=0.02", "obstacle.1.friction=0",
                                    "obstacle.1.contact_modulus_MPa=" + modulus}));
    double largest = 0.0, force = 0.0, arrest = 0.0;
    run.advance_to(1.0, [&] {
      force = 0.0;
      for (const auto& effect : run.model->effects) force -= effect->contact_force_N()[0];
      arrest = run.tissue.pressure_MPa * (1.0 - run.scene.tissue.nu_axial) * 2.0 * radius_mm<2>(run.tissue, 0.1, 0.4);
      largest = std::max(largest, force / arrest);
    });
    expect_within_record("modulus " + modulus + ": force/arresting force - 1", force / arrest - 1.0);
    expect_within_record("modulus " + modulus + ": largest force/arresting force - 1", largest - 1.0);
  }
}

/// What follows from the stepper is said by the steps themselves: no columns of inertia, no device against it.
TEST(QuasiStatic, HasNoInertia) {
  const SceneRun<2> run(growth_case, balanced_steps());
  for (const char* column : {"inverse_inertia", "start_velocity", "pair_damping", "body_acceleration"}) {
    EXPECT_EQ(run.tissue.cells.find(column), nullptr) << column;
  }
  EXPECT_TRUE(run.solver.hooks().acceleration.empty());
}

}  // namespace
}  // namespace rootsoil::physics
