// SPDX-License-Identifier: MIT
// A root that grows onto a smooth plate is a column that its own growth loads: thrust rises to the arresting force
// p (1 - nu_A) W where the root is shorter than Euler's length, and to Euler's load where it is longer.
#include <fmt/format.h>

#include "tests/physics/bending.hpp"
#include "tests/soil/soil_scene.hpp"

namespace rootsoil {
namespace {

using physics::record;

/// 8 cells across. The growth zone is short: tissue that grows by a strain e also creeps when it is bent, by e E/(p (1
/// - nu_A)) times its elastic bend, and a long zone folds before the column does.
std::string column(double length_mm) {
  return fmt::format(R"(
[scene]
name = "column"
duration_h = 10
[root]
length_mm = {}
radius_mm = 0.12
cell_size_mm = 0.03
[tissue]
E_axial_MPa = 200
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 2e4
x_g_mm = 0.12
s_g_mm = 0.1
c_g = -0.95
mature_at_mm = 0.36
mature_width_mm = 0.06
[non_affine_control]
[numerics]
stepper = "quasi_static"
step_h = 2e-3
[output]
every_h = 1
)",
                     length_mm);
}

struct Pressed {
  double largest_N = 0.0, at_end_N = 0.0, aside_mm = 0.0;
  double arrest_N = 0.0, euler_N = 0.0;
};

/// Grows onto a smooth plate that is tilted a little: the imperfection.
Pressed press(double length_mm, double hours) {
  constexpr double tilt = 0.01, gap_mm = 0.004;
  soil_test::SoilRun<2> run(
      {}, soil_test::predicting(),
      [&](const Scene& scene) {
        twins::HalfSpaceParameters p = soil_test::plate(scene, 20.0, gap_mm);
        p.outward = Eigen::Vector3d(-1.0, tilt, 0.0).normalized();
        return std::make_unique<twins::HalfSpace>(p);
      },
      column(length_mm));
  Pressed found;
  found.arrest_N = soil_test::arrest_N(run);
  found.euler_N = physics::euler_load(physics::section_of(run), length_mm);
  run.advance_to(hours, [&] { found.largest_N = std::max(found.largest_N, run.axial_force_N()); });
  found.at_end_N = run.axial_force_N();
  found.aside_mm = std::abs(run.solver.axis().tip_mm()[1]);
  return found;
}

TEST(Buckling, TheCriticalLengthOnAPlateIsEulers) {
  const Pressed below = press(1.2, 2.0);
  record("below: Euler's load/arrest force", below.euler_N / below.arrest_N);
  record("below: tip aside (mm)", below.aside_mm);
  ASSERT_GT(below.euler_N, 1.5 * below.arrest_N);
  physics::expect_within_record("below: force/arrest force - 1", below.at_end_N / below.arrest_N - 1.0);
  EXPECT_EQ(below.at_end_N, below.largest_N);  // it still presses harder
  EXPECT_LT(below.aside_mm, 0.03);

  const Pressed above = press(2.1, 2.0);
  // load and length: F = pi^2 E I/(4 L^2), so the length that this root's largest force belongs to is
  const double length_ratio = std::sqrt(above.euler_N / above.largest_N);
  record("above: Euler's load/arrest force", above.euler_N / above.arrest_N);
  record("above: force/arrest force", above.at_end_N / above.arrest_N);
  record("above: tip aside (mm)", above.aside_mm);
  ASSERT_LT(above.euler_N, 0.7 * above.arrest_N);
  physics::expect_within_record("critical length/Euler's - 1", length_ratio - 1.0);
  EXPECT_GT(above.aside_mm, 0.1);
}

}  // namespace
}  // namespace rootsoil
