// SPDX-License-Identifier: MIT
// A root that answers what it perceives ([response] follows = "perceived"): under a force F on its tip it is the root
// of the pressure p - F/section (docs/decisions/0026).
#include <fmt/format.h>

#include "growth.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/response/response.hpp"

namespace rootsoil::physics {
namespace {

using Texts = std::vector<std::string>;

const std::string responding = R"(
[scene]
name = "responding"
duration_h = 20
[root]
length_mm = 1
radius_mm = 0.06
cell_size_mm = 0.02
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
[pressure]
differential_MPa = 1
[growth]
x_g_mm = -0.05
c_g = -1
[response]
follows = "perceived"
over_h = 0
[response.growth]
p_MPa = [1, 0.5]
lambda0_ug_mm3_h = [4.3e5, 3e5]
s_g_mm = [0.37, 0.25]
[response.anisotropy]
p_MPa = [1, 0.5]
x_e_mm = [0.51, 0.4]
s_e_per_mm = [6, 12]
c_e = [0.2, 0.1]
[non_affine_control]
[output]
every_h = 1
)";
const std::string pushed = "[force]\naxial_N = 0.03\n";

Texts balanced_steps(Texts overrides = {}) {
  overrides.push_back("numerics.stepper=quasi_static");
  overrides.push_back("numerics.step_h=0.05");
  return overrides;
}

template <int Dim>
double force_over_section(const SceneRun<Dim>& run) {
  double thrust_N = 0.0;
  for (const auto& effect : run.model->effects) thrust_N -= effect->external_force_N()[0];
  return thrust_N / mean_section<Dim>(run.tissue, run.solver.axis());
}

/// E_R of each cell is that of the pressure p - F/section of the balance before, to rounding; lambda is measured by the
/// operators as that of a uniform scene.
TEST(Perception, ParametersAreThoseOfTheLowerPressure) {
  SceneRun<2> run(responding + pushed, balanced_steps());
  double felt_MPa = 1.0;  // nothing yet
  int windows = 0;
  run.solver.hooks().operators.emplace_back("test", [&](Tissue<2>& t) {
    const AnisotropySection anisotropy = *anisotropy_at(run.scene, felt_MPa);
    const double E_axial = run.scene.tissue.E_axial_MPa;
    const Field<2, Stiffness<2>>& stiff = *t.material.stiffness;
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      ElasticConstants exact = isotropic_constants(run.scene.tissue);
      exact.E_radial_MPa =
          radial_modulus_MPa(anisotropy, E_axial, run.solver.mid_window_distance(t.cells.distance_to_tip[i]));
      ASSERT_LT((stiff[i] - stiffness<2>(exact)).norm(), 1e-10 * stiff[i].norm()) << windows << ", " << i;
    }
    ++windows;
  });
  run.advance_to(0.5, [&] { felt_MPa = 1.0 - force_over_section(run); });
  EXPECT_GE(windows, 10);
  EXPECT_NEAR(felt_MPa, 0.75, 0.01);
}

/// Speeds of the tip after it has settled.
double speed_mm_h(const std::string& text, Texts overrides, double* perceived_MPa = nullptr) {
  SceneRun<2> run(text, balanced_steps(std::move(overrides)));
  run.advance_to(0.3);
  const double from_mm = run.solver.axis().tip_mm()[0], from_h = run.tissue.time_h;
  run.advance_to(0.8);
  if (perceived_MPa) *perceived_MPa = run.tissue.perceived_MPa();
  return (run.solver.axis().tip_mm()[0] - from_mm) / (run.tissue.time_h - from_h);
}

/// The uniform scene has the parameters of that pressure from the start, and no response.
TEST(Perception, AForceMakesTheRootOfTheLowerPressure) {
  double perceived_MPa = 0.0;
  const double felt = speed_mm_h(responding + pushed, {}, &perceived_MPa);
  const Scene scene = parse_scene(responding + pushed, "test.toml");
  const GrowthSection growth = *growth_at(scene, perceived_MPa);
  const AnisotropySection anisotropy = *anisotropy_at(scene, perceived_MPa);
  const std::string uniform = responding.substr(0, responding.find("[response]")) + "[non_affine_control]\n" + pushed +
                              "[output]\nevery_h = 1\n";
  const double given = speed_mm_h(uniform, {fmt::format("growth.lambda0_ug_mm3_h={}", growth.lambda0_ug_mm3_h),
                                            fmt::format("growth.s_g_mm={}", growth.s_g_mm),
                                            fmt::format("tissue.anisotropy.x_e_mm={}", anisotropy.x_e_mm),
                                            fmt::format("tissue.anisotropy.s_e_per_mm={}", anisotropy.s_e_per_mm),
                                            fmt::format("tissue.anisotropy.c_e={}", anisotropy.c_e)});
  std::string unfelt_text = responding;
  const std::string keys = "follows = \"perceived\"\nover_h = 0\n";
  unfelt_text.replace(unfelt_text.find(keys), keys.size(), "");
  const double unfelt = speed_mm_h(unfelt_text + pushed, {});
  record("perceived, MPa", perceived_MPa);
  record("speed/speed of a root that perceives nothing", felt / unfelt);
  EXPECT_LT(felt, 0.8 * unfelt);
  expect_within_record("speed/speed of the uniform scene - 1", felt / given - 1.0);
}

/// A tissue that does not grow keeps its section.
TEST(Perception, FollowsAStepOfForceWithItsTimeConstant) {
  const std::string elastic = strain_case + anisotropic +
                              "[response]\nfollows = \"perceived\"\nover_h = 0.6\n[response.anisotropy]\n"
                              "p_MPa = [1, 0]\nE_radial_max_MPa = [15000, 9000]\n" +
                              pushed;
  Texts overrides = balanced_steps({"root.cell_size_mm=0.04", "numerics.start=equilibrium"});
  std::string text = elastic;
  text.replace(text.find("E_radial_max_MPa = 15000\n"), std::string("E_radial_max_MPa = 15000\n").size(), "");
  SceneRun<2> run(text, overrides);
  double worst = 0.0;
  run.advance_to(3.0, [&] {
    const double exact = force_over_section(run) * -std::expm1(-run.tissue.time_h / 0.6);
    worst = std::max(worst, std::abs(run.tissue.tip_thrust_MPa / exact - 1.0));
  });
  EXPECT_NEAR(force_over_section(run), 0.15, 0.01);
  expect_within_record("thrust/exponential - 1", worst);
}

/// A root arrested by a wall pushes with p (1 - nu_A), and perceives the rest, p nu_A. It goes on to widen at its tip,
/// which pushes with more than the mean section.
void expect_arrest(double over_h) {
  SceneRun<2> run(responding + "[[obstacle]]\nshape = \"plane\"\nposition_mm = [1.02, 0]\nnormal = [-1, 0]\n",
                  balanced_steps({"root.cap=false", "obstacle.1.friction=0", "response.extrapolate=false",
                                  fmt::format("response.over_h={}", over_h)}));
  run.advance_to(0.3);
  double before = force_over_section(run), felt = run.tissue.tip_thrust_MPa, most = before, step = 0.0, worst = 0.0;
  run.advance_to(1.3, [&] {
    const double thrust_MPa = force_over_section(run);
    felt = low_pass(felt, thrust_MPa, run.solver.window_h(), over_h);
    worst = std::max(worst, std::abs(run.tissue.tip_thrust_MPa - felt));
    step = std::max(step, std::abs(thrust_MPa - before));
    most = std::max(most, thrust_MPa);
    before = thrust_MPa;
  });
  record("perceived, MPa", run.tissue.perceived_MPa());
  record("perceived less force/section, MPa", worst);
  EXPECT_LT(worst, 1e-15);
  EXPECT_EQ(run.solver.effort().unstable_steps, 0);
  expect_within_record("thrust/arresting thrust - 1", most / (1.0 - run.scene.tissue.nu_axial) - 1.0);
  expect_within_record("largest change in a step/p", step);
}

TEST(Perception, IsSteadyAtAWallAtOnce) { expect_arrest(0.0); }
TEST(Perception, IsSteadyAtAWallWithATimeConstant) { expect_arrest(0.5); }

}  // namespace
}  // namespace rootsoil::physics
