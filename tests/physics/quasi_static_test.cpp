// SPDX-License-Identifier: MIT
// Steps that end in balance, against exact answers: the same problems as with inertia, and those that inertia spoils.
#include <fmt/format.h>

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

/// Tip of a clamped column under a force that keeps its direction, beyond its Euler load: with k the sine of half the
/// angle at the tip, P/P_Euler = (2 K(k)/pi)^2, across 2 k L/K, along L (2 E/K - 1). Love, Elasticity, 263.
Vec<2> elastica_tip(double load_over_euler, double length_mm) {
  double low = 0.0, high = 1.0 - 1e-9;
  while (high - low > 1e-14) {
    const double k = 0.5 * (low + high), q = 2.0 * std::comp_ellint_1(k) / std::numbers::pi;
    (q * q < load_over_euler ? low : high) = k;
  }
  const double quarter = std::comp_ellint_1(low);
  return length_mm * Vec<2>(2.0 * std::comp_ellint_2(low) / quarter - 1.0, 2.0 * low / quarter);
}

/// A straight column, clamped and pressed on its last layer; nothing pushes it aside.
struct Column {
  static constexpr double length_mm = 2.0;
  SceneRun<2> run;
  double size_mm, held_to_load_mm, euler_N, load_N = 0.0, loaded = 0.0;

  explicit Column(int across)
      : run(beam_case(2, across, length_mm), balanced_steps({"numerics.step_h=1"})),
        size_mm(beam_depth_mm / across),
        // the held end is as one three quarters of a cell behind the first held layer
        held_to_load_mm(length_mm - 0.5 * size_mm + 0.75 * size_mm),
        euler_N(euler_load(section_of(run), held_to_load_mm)) {
    for (const auto& [id, x] : run.start) loaded += in_last_layer(id) ? 1.0 : 0.0;
    run.solver.hooks().forces.emplace_back("test load", [this](Tissue<2>& t, SlipAdvance) {
      for (std::size_t i = 0; i < t.cells.size(); ++i) {
        if (in_last_layer(t.cells.cell_id[i])) t.force[i][0] -= load_N / loaded;
      }
    });
  }
  bool in_last_layer(std::int64_t id) const { return run.start.at(id)[0] > length_mm - size_mm; }
  /// One step more, under so much of Euler's load. \return how far the tip is aside, mm
  double press(double load_over_euler) {
    load_N = load_over_euler * euler_N;
    run.advance_to(run.tissue.time_h + 1.0);
    double aside = 0.0;
    for (std::size_t i = 0; i < run.tissue.cells.size(); ++i) {
      if (in_last_layer(run.tissue.cells.cell_id[i])) aside += run.tissue.cells.position[i][1] / loaded;
    }
    return std::abs(aside);
  }
  double beyond_elastica(double aside_mm, double load_over_euler) const {
    return aside_mm / elastica_tip(load_over_euler, held_to_load_mm)[1] - 1.0;
  }
};

/// The solver must leave the straight balance by itself, and find the bent one.
TEST(QuasiStatic, AStraightColumnBucklesIntoTheElastica) {
  Column column(12);
  double worst = 0.0;
  for (int step = 1; step <= 16; ++step) {
    const double load = 0.9 + 0.025 * step;  // 1.3 in the end
    const double aside_mm = column.press(load);
    if (load < 0.985) {
      EXPECT_LT(aside_mm, 1e-3 * column.length_mm) << load;
    }
    if (load > 1.0999) worst = std::max(worst, std::abs(column.beyond_elastica(aside_mm, load)));
  }
  expect_within_record("tip across over the elastica's - 1 at 1.1 to 1.3 times Euler's load", worst);
  EXPECT_EQ(column.run.solver.effort().unstable_steps, 0);
}

/// A column 20 times as long as wide, pressed on its last layers by a force that grows to so much of Euler's load.
double tip_over_elastica(int across, double load_over_euler, double grows_for_h, double end_h) {
  constexpr double length_mm = 2.4, width_mm = 0.12, E_MPa = 1020.0;
  const double euler_N = std::pow(std::numbers::pi / (2.0 * length_mm), 2) * E_MPa * std::pow(width_mm, 3) / 12.0;
  SceneRun<2> run(fmt::format(R"(
[scene]
name = "column"
dimension = 2
duration_h = 1
[root]
length_mm = {}
radius_mm = {}
cell_size_mm = {}
cap = false
[tissue]
E_axial_MPa = {}
nu_axial = 0.06
nu_radial = 0.3
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0
s_e_per_mm = 0
c_e = 1
[pressure]
differential_MPa = 0.1
[force]
vector_N = [{}, 0]
table = [[0, 0], [{}, 1]]
distance_to_tip_mm = [0, {}]
[non_affine_control]
[numerics]
step_h = 0.02
[output]
every_h = 0.1
)",
                              length_mm, 0.5 * width_mm, width_mm / across, E_MPa, -load_over_euler * euler_N,
                              grows_for_h, 1.53 * width_mm / across),
                  balanced_steps());
  run.advance_to(end_h);
  EXPECT_EQ(run.solver.effort().unstable_steps, 0);
  return std::abs(run.solver.axis().tip_mm()[1]) / elastica_tip(load_over_euler, length_mm)[1];
}

/// Steps so short that the matrix is kept: what stiffness its softest mode had when the load was small says nothing of
/// later.
TEST(QuasiStatic, ALoadThatGrowsSlowlyIsWatched) {
  expect_within_record("tip across over the elastica's - 1", tip_over_elastica(3, 1.5, 0.8, 1.0) - 1.0);
}

/// At 3 times Euler's load the tip points back to the base. At once, in one step of a straight root, and slowly.
TEST(QuasiStatic, FarBeyondEulersLoadAColumnIsBent) {
  for (const auto& [across, load, grows_for_h] : {std::tuple{4, 3.0, 0.01}, {8, 2.0, 0.01}, {4, 2.0, 0.8}}) {
    expect_within_record(
        fmt::format("{} across under {} times in {} h: tip across over the elastica's - 1", across, load, grows_for_h),
        tip_over_elastica(across, load, grows_for_h, grows_for_h < 0.1 ? 0.1 : 1.0) - 1.0);
  }
}

/// A force that follows the tip (force.axial_N), at twice the load at which a weight would bend the column: a push F
/// from the side bends it by F/P (sin(b)/b - cos(b)) l, b = pi/2 sqrt(P/P_Euler), less than without it. From E I w'' =
/// P (w_l - w) + (F - P w_l') (l - x), Beck's column without its inertia (Timoshenko & Gere, 2.21).
TEST(QuasiStatic, AColumnUnderAForceThatFollowsItsTipStands) {
  constexpr int across = 12;
  constexpr double lateral_N = 5e-4;  // bends it by 5e-3 of the length: well above what a balance leaves
  const std::string text = beam_case(2, across, 2.0);  // slender: the load shortens it by .15 %
  const BeamResult plain = bend<2>(text, balanced_steps({"numerics.step_h=1"}), lateral_N);
  const double size_mm = beam_depth_mm / across, held_to_load_mm = plain.load_at_mm + 0.75 * size_mm;
  const double load_N = 2.0 * euler_load(plain.section, held_to_load_mm);
  const BeamResult pressed =
      bend<2>(text + fmt::format("[force]\naxial_N = {}\ndistance_to_tip_mm = [0, {}]\n", load_N, 1.1 * size_mm),
              balanced_steps({"numerics.step_h=1"}), lateral_N);
  const double b = 0.5 * std::numbers::pi * std::sqrt(2.0);
  const double theory = 3.0 * (std::sin(b) - b * std::cos(b)) / (b * b * b);
  record("deflection/deflection without it", pressed.deflection_mm / plain.deflection_mm);
  expect_within_record("deflection over that without it and theory - 1",
                       pressed.deflection_mm / plain.deflection_mm / theory - 1.0);
}

/// A root that runs into a wall is stopped by p (1 - nu_A) W, and hardly more at any time. W goes on growing: it is the
/// width at the start, times what the cells' second moment has gained since.
TEST(QuasiStatic, AWallStopsTheRoot) {
  const std::string wall = "[[obstacle]]\nshape = \"plane\"\nposition_mm = [1.02, 0]\nnormal = [-1, 0]\n";
  for (const std::string modulus : {"1020", "100000"}) {
    SceneRun<2> run(growth_case + wall,
                    balanced_steps({"root.cap=false", "root.cell_size_mm=0.02", "obstacle.1.friction=0",
                                    "obstacle.1.contact_modulus_MPa=" + modulus}));
    const auto radius = [&] { return radius_mm<2>(run.tissue, 0.1, 0.4); };
    const double width_over_radius = 2.0 * run.scene.root.radius_mm / radius();
    double largest = 0.0, force = 0.0, arrest = 0.0;
    run.advance_to(1.0, [&] {
      force = 0.0;
      for (const auto& effect : run.model->effects) force -= effect->contact_force_N()[0];
      arrest = run.tissue.pressure_MPa * (1.0 - run.scene.tissue.nu_axial) * width_over_radius * radius();
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
