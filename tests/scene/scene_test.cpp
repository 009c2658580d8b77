// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "root_sph/core/version.hpp"
#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/obstacle/obstacle.hpp"
#include "root_sph/effects/pair_resistance/pair_resistance.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/effects/probe/probe.hpp"
#include "root_sph/effects/sleep/sleep.hpp"
#include "root_sph/effects/soil_contact/soil_section.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/scene/response.hpp"
#include "root_sph/scene/schema.hpp"
#include "root_sph/scene/write_scene.hpp"
#include "tests/scene/scene_text.hpp"

namespace rootsoil::testing {
namespace {

const std::string everything = R"([scene]
name = "all-of_it.2"
dimension = 3
duration_h = 12.5
seed = 9007199254740993
allow_unstable = true

[root]
length_mm = 0.1
radius_mm = 0.05
cell_size_mm = 0.010000000000000002
jitter = 0.3
size_variation = 0.5
curvature_per_mm = -0.2
base_obliquity_deg = 10
cap = false
base = "clamped"
clamp_length_mm = 0.02

[tissue]
law = "pressure_deviator"
E_axial_MPa = 1020
nu_axial = 0.05
nu_radial = 0.25
G_MPa = 400
rho0_ug_mm3 = 1000.5

[tissue.anisotropy]
x_e_mm = 0.51
c_e = 0.2

[pressure]
table = [[0, 1], [5, 0.5], [7.5, 0.75]]

[growth]
x_g_mm = -0.05
c_g = -1
mature_at_mm = 2
mature_width_mm = 0.2

[division]
l0_mm = 0.01
c_d = 1.5
s_d_per_mm2 = 45
x_d_mm = 0.12
constant_beyond_mm = 0.5
ends_at_mm = 0.6
scatter = 0.1
asynchronous = true

[response]
extrapolate = false
follows = "perceived"
over_h = 0.5
tip_length_mm = 0.1

[response.growth]
p_MPa = [0.987, 0.625]
lambda0_ug_mm3_h = [4e5, 3e5]
s_g_mm = [0.37, 0.3]
yield_MPa = [0.2, 0.1]

[response.anisotropy]
p_MPa = [0.825, 0.5]
E_radial_max_MPa = [15000, 14000]
s_e_per_mm = [1.3, 4]

[non_affine_control]
damping = 0.4
stiffness = 0.06

[[obstacle]]
name = "wall"
shape = "plane"
position_mm = [1, 0, 0]
normal = [-3, 1, 0.5]

[[obstacle]]
shape = "plane"
position_mm = [1, 0, 0]
angle_deg = 60
friction = 0.1

[[obstacle]]
shape = "box"
position_mm = [1, 0.1, 0]
half_size_mm = [0.1, 0.2, 0.3]
angle_deg = 30
contact_modulus_MPa = 77

[[obstacle]]
shape = "sphere"
position_mm = [1, 0, 0.2]
radius_mm = 0.3

[[probe]]
position_mm = [0.1, 0, 0]

[[probe]]
name = "zone"
distance_to_tip_mm = [0.2, 0.3]

[gravity]
acceleration_m_s2 = [0, 9.81, 0]
density_difference_kg_m3 = 40

[force]
axial_N = 1e-3
table = [[0, 0], [1, 1]]
distance_to_tip_mm = [0, 0.05]

[soil]
box_from_mm = [0.02, -2, -2.5]
box_to_mm = [4, 2, 2.5]
walls = "servo"
confining_pressure_MPa = 0.1
d_mean_mm = 0.2
d_spread = 0.3
contact_law = "cohesive"
E_MPa = 300
poisson = 0.25
friction_deg = 28
root_friction_deg = 12
rolling = 0.1
cohesion_MPa = 0.01
density_N_h2_mm4 = 1e-4
porosity = 0.4
seed = 3
step_safety = 0.4
damping = 0.2
threads = 2

[[soil.obstacle]]
name = "block"
shape = "box"
position_mm = [2, 0.5, 0]
half_size_mm = [0.1, 0.2, 0.3]
angle_deg = 30

[[soil.obstacle]]
shape = "plate"
position_mm = [3, 0, 0]
length_mm = 1
thickness_mm = 0.05

[[soil.obstacle]]
shape = "stone"
position_mm = [2, -1, 0]
radius_mm = 0.4
movable = true

[soil.contact]
interval_h = 3e-3
marker_radius_mm = 0.02
marker_spacing = 0.5
map_width_cells = 1.6
ramp_h = 0.1
stiffness_predictor = true
under_relaxation = true
tip_length_mm = 0.2

[penetrometer]
diameter_mm = 0.5
cone_angle_deg = 60
rate_mm_h = 0.4
depth_mm = 2
average_from_mm = 1.5
friction_deg = 10
seeds = 2
interval_h = 0.01
turgor_MPa = 1

[sleep]
strain_rate_per_h = 2e-3
mean_over_h = 0.2
stress_change = 0.1

[numerics]
accuracy = "reference"
step_h = 3e-4
window_steps = 10
kernel = "isotropic"
eta = 1.3
H_bar = 4.5
gradient = "linear"
stepper = "predictor_corrector"
inertia = "scalar"
inertia_compensation = false
mass_damping_per_h = 3
midline_damping_per_h = 2
artificial_viscosity = 0.6
start = "rest"

[output]
every_h = 0.5
checkpoint_every_h = 2
fields = ["position", "stress"]
picture = true
)";

TEST(Scene, MinimalGetsDefaults) {
  const Scene s = parse(replaced(minimal, "name = \"small\"\n", ""));
  EXPECT_EQ(s.scene.name, "test");
  EXPECT_EQ(s.scene.dimension, 2);
  EXPECT_DOUBLE_EQ(*s.tissue.G_MPa, 1020 / (2 * 1.06));
  EXPECT_EQ(s.output.checkpoint_every_h, s.output.every_h);
  EXPECT_EQ(s.numerics.accuracy, Accuracy::balanced);
  EXPECT_EQ(s.file, "a/test.toml");
}

TEST(Scene, AbsentSectionsAreAbsent) {
  const Scene s = parse(minimal);
  EXPECT_FALSE(s.find<AnisotropySection>() || s.find<PressureSection>() || s.find<GrowthSection>() ||
               s.find<DivisionSection>() || s.find<ResponseSection>() || s.find<NonAffineControlSection>());
  EXPECT_TRUE(s.all<ObstacleSection>().empty() && s.all<ProbeSection>().empty() && s.responses.empty());
  const std::string resolved = resolved_toml(language(), s);
  for (const SectionSpec& section : language().sections()) {
    const bool always = section.kind == SectionKind::required || section.kind == SectionKind::defaulted;
    EXPECT_EQ(resolved.find(section_header(section) + "\n") != std::string::npos, always) << section.name;
  }
}

TEST(Scene, EmptySectionsWithDefaultsArePresent) {
  const Scene s = parse(minimal + "\n[non_affine_control]\n");
  ASSERT_TRUE(s.find<NonAffineControlSection>());
  EXPECT_EQ(s.find<NonAffineControlSection>()->damping, NonAffineControlSection{}.damping);
}

TEST(Scene, ToleranceOfSleepFollowsTheSoil) {
  const Scene alone = parse(minimal + "\n[sleep]\n");
  ASSERT_TRUE(alone.find<SleepSection>());
  EXPECT_EQ(alone.find<SleepSection>()->strain_rate_per_h, 1e-4);
  EXPECT_FALSE(alone.find<SleepSection>()->mean_over_h);
  EXPECT_EQ(alone.find<SleepSection>()->stress_change, 0.05);
  const std::string keys = "strain_rate_per_h = 2e-3\nmean_over_h = 0.2\nstress_change = 0.1\n";
  const Scene among_grains = parse(replaced(everything, keys, ""));
  EXPECT_EQ(among_grains.find<SleepSection>()->strain_rate_per_h, 5e-3);
  EXPECT_EQ(among_grains.find<SleepSection>()->mean_over_h, 0.1);
  EXPECT_EQ(among_grains.find<SleepSection>()->stress_change, 0.3);
  EXPECT_EQ(parse(everything).find<SleepSection>()->stress_change, 0.1);
}

TEST(Scene, EverythingIsRead) {
  const Scene s = parse(everything);
  EXPECT_EQ(s.scene.seed, 9007199254740993);  // more than a double holds
  EXPECT_EQ(s.root.cell_size_mm, 0.010000000000000002);
  EXPECT_EQ(s.root.clamp_length_mm, 0.02);
  EXPECT_EQ(s.find<PressureSection>()->table.at(2)[1], 0.75);
  EXPECT_EQ(s.find<GrowthSection>()->mature_at_mm, 2.0);
  EXPECT_EQ(s.find<DivisionSection>()->constant_beyond_mm, 0.5);
  EXPECT_FALSE(s.find<ResponseSection>()->extrapolate);
  EXPECT_EQ(s.find<ResponseSection>()->follows, Follows::perceived);
  EXPECT_EQ(s.find<ResponseSection>()->over_h, 0.5);
  EXPECT_EQ(s.find<ResponseSection>()->tip_length_mm, 0.1);
  EXPECT_EQ(responding_range_MPa(s), (std::array{0.0, 1.0}));
  EXPECT_EQ(response_of(s, "growth")->pairs.at("s_g_mm")[1], 0.3);
  EXPECT_FALSE(response_of(s, "growth")->pairs.contains("c_g"));
  EXPECT_EQ(response_of(s, "tissue.anisotropy")->pairs.at("E_radial_max_MPa")[1], 14000.0);
  ASSERT_EQ(s.all<ObstacleSection>().size(), 4u);
  EXPECT_EQ(s.all<ObstacleSection>()[2].name, "obstacle_3");
  EXPECT_EQ(s.all<ObstacleSection>()[2].half_size_mm[2], 0.3);
  EXPECT_EQ(s.all<ObstacleSection>()[2].contact_modulus_MPa, 77.0);
  EXPECT_EQ(s.all<ObstacleSection>()[3].contact_modulus_MPa, 1020.0);
  EXPECT_EQ((*s.all<ProbeSection>().at(0).position_mm)[0], 0.1);
  EXPECT_EQ((*s.all<ProbeSection>().at(1).distance_to_tip_mm)[1], 0.3);
  EXPECT_EQ(s.numerics.window_steps, 10);
  EXPECT_EQ(s.numerics.step_h, 3e-4);
  EXPECT_EQ(s.output.fields.at(1), "stress");
}

TEST(Scene, TheSoilIsCompleted) {
  const Scene s = parse(minimal + soil + stone + penetrometer);
  ASSERT_TRUE(s.find<SoilSection>() && s.find<SoilContactSection>() && s.find<PenetrometerSection>());
  EXPECT_EQ(s.find<SoilSection>()->dimension, 2);
  EXPECT_DOUBLE_EQ(s.find<SoilSection>()->d_mean_mm, 0.1);
  EXPECT_DOUBLE_EQ(s.find<SoilSection>()->d_spread, 0.2);
  EXPECT_DOUBLE_EQ(s.find<SoilSection>()->layer_mm(), 0.1);
  EXPECT_EQ(s.find<SoilSection>()->obstacles.at(0).name, "soil.obstacle_1");
  EXPECT_EQ(s.find<SoilSection>()->walls, SoilWalls::mixed);
  EXPECT_DOUBLE_EQ(*s.find<PenetrometerSection>()->average_from_mm, 0.6);
  EXPECT_DOUBLE_EQ(*s.find<PenetrometerSection>()->interval_h, 0.01);
  EXPECT_DOUBLE_EQ(*s.find<PenetrometerSection>()->friction_deg, s.find<SoilSection>()->root_friction_deg);
  const Scene by_mean = parse(minimal + replaced(soil, "d_range_mm = [0.08, 0.12]", "d_mean_mm = 0.1"));
  EXPECT_DOUBLE_EQ(by_mean.find<SoilSection>()->d_max_mm, 0.12);
  EXPECT_EQ(parse(everything).find<SoilSection>()->layer_mm(), 1.0);
}

TEST(Scene, APenetrometerNeedsNoRoot) {
  const Scene s = parse_soil("[scene]\nseed = 4\n" + soil + penetrometer, "a/clay.toml");
  EXPECT_EQ(s.scene.name, "clay");
  EXPECT_EQ(s.find<SoilSection>()->dimension, 2);
  EXPECT_NO_THROW(parse_soil(minimal + soil + penetrometer, "a/clay.toml"));
  EXPECT_THROW(parse_soil(soil, "a/clay.toml"), InputError);
  EXPECT_THROW(parse_soil(soil + penetrometer + "[growht]\n", "a/clay.toml"), InputError);
}

/// I = rate d sqrt(rho/P); the example of docs/soil.md: 0.5 mm/h, 0.8 mm, d = 0.2 mm, P = 0.1 MPa, I = 0.01.
TEST(Scene, TheInertialNumberGivesTheDensity) {
  SoilRecipe r;
  r.d_mean_mm = 0.2;
  r.confining_pressure_MPa = 0.1;
  EXPECT_NEAR(quasi_static_density_N_h2_mm4(r, 0.5, 0.8), 6.4e-4, 1e-12);
  r.inertial_number_max = 1e-3;
  EXPECT_NEAR(quasi_static_density_N_h2_mm4(r, 0.5, 0.8), 6.4e-6, 1e-14);
}

TEST(Scene, PlanesHaveUnitNormalsTowardsTheRoot) {
  const Scene s = parse(everything);
  const double length = std::hypot(3, 1, 0.5);
  EXPECT_DOUBLE_EQ(s.all<ObstacleSection>()[0].normal[0], -3 / length);
  EXPECT_DOUBLE_EQ(s.all<ObstacleSection>()[0].normal[2], 0.5 / length);
  EXPECT_DOUBLE_EQ(s.all<ObstacleSection>()[1].normal[0], -std::sqrt(3.0) / 2);  // a plane at 60 degrees to the root
  EXPECT_NEAR(s.all<ObstacleSection>()[1].normal[1], 0.5, 1e-15);
}

TEST(Scene, ResolvedSceneReadsBackTheSame) {
  for (const std::string& text : {minimal, everything, minimal + anisotropy + pressure + growth,
                                  minimal + "\n[pressure]\ntable = [[3, 0.5]]\n"}) {
    const std::string once = resolved_toml(language(), parse(text));
    EXPECT_EQ(resolved_toml(language(), parse(once)), once);
    EXPECT_NE(once.find(program_version), std::string::npos);
  }
}

TEST(Scene, EveryKeyIsWrittenUnlessItMeansNothing) {
  const Scene scene = parse(everything);
  const std::string resolved = resolved_toml(language(), scene);
  // the only keys that this scene has no place for
  const std::set<std::string> left_out = {"growth.yield_profile",
                                          "turgor.soil_MPa",
                                          "turgor.soil_table",
                                          "root.cells_file",
                                          "root.tip_axis",
                                          "root.columns.unit",
                                          "root.columns.label",
                                          "root.columns.position",
                                          "root.columns.e1",
                                          "root.columns.e2",
                                          "root.columns.semi_axes",
                                          "root.columns.diameters",
                                          "root.columns.inertia_tensor",
                                          "root.columns.volume",
                                          "pressure.differential_MPa",
                                          "force.vector_N",
                                          "numerics.force_tolerance",
                                          "soil.d_range_mm",
                                          "soil.grains_file",
                                          "soil.inertial_number_max",
                                          "soil.compaction_friction_deg"};
  for (const SectionSpec& section : language().sections()) {
    for (const KeySpec& key : section.keys) {
      const std::string name = section.name + "." + key.name;
      const bool given = resolved.find("\n" + key.name + " = ") != std::string::npos;
      EXPECT_EQ(given, left_out.count(name) == 0) << name;
    }
  }
}

TEST(Scene, ResolvedTextSurvivesAnyCharacter) {
  EXPECT_EQ(toml_text(std::string("a\"b\\c\ne\x7f\xc3\xa9")), "\"a\\\"b\\\\c\\u000ae\\u007f\xc3\xa9\"");
  EXPECT_EQ(toml_text(1.0), "1.0");
  EXPECT_EQ(toml_text(0.1), "0.1");
  EXPECT_EQ(toml_text(1e300), "1e+300");
  EXPECT_EQ(toml_text(std::int64_t{3}), "3");
}

TEST(Scene, WholeNumbersServeAsNumbers) { EXPECT_EQ(parse(minimal).tissue.E_axial_MPa, 1020.0); }

TEST(Scene, OneCellWideIsAllowed) { EXPECT_NO_THROW(parse(replaced(minimal, "= 0.05", "= 0.005"))); }

TEST(Scene, CellsFileStartsFromTheScenesFolder) {
  const auto folder = std::filesystem::temp_directory_path() / "rootsoil_scene_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "cells.csv") << "Label\n";
  const std::string lattice = "length_mm = 0.4\nradius_mm = 0.05\ncell_size_mm = 0.01";
  std::ofstream(folder / "s.toml") << replaced(replaced(minimal, lattice, "cells_file = \"./cells.csv\""), "[scene]",
                                               "[scene]\ndimension = 3");
  const Scene s = read_scene(folder / "s.toml");
  EXPECT_EQ(s.root.cells_file, (folder / "cells.csv").string());
  EXPECT_EQ(parse(resolved_toml(language(), s)).root.cells_file, s.root.cells_file);  // from any other folder
  std::filesystem::remove_all(folder);
}

/// p = turgor less the soil's pressure, at any time; a table of either gives one of both.
TEST(Scene, TurgorLessTheSoilIsThePressure) {
  const std::string turgor = minimal + "\n[turgor]\nturgor_MPa = 0.75\n";
  EXPECT_EQ(parse(turgor).facts.pressure_MPa, (std::array{0.75, 0.75}));
  EXPECT_EQ(pressure_rows(parse(turgor)), pressure_rows(parse(minimal + "\n[pressure]\ndifferential_MPa = 0.75\n")));
  EXPECT_EQ(pressure_MPa(parse(turgor + "soil_MPa = 0.25\n"), 3.0), 0.5);
  const Scene both =
      parse(minimal + "\n[turgor]\ntable = [[1, 0.5], [3, 1]]\nsoil_table = [[0, 0], [2, 0.25], [4, 0.5]]\n");
  for (const auto& [time_h, p] : Rows{{0.0, 0.5}, {1.0, 0.375}, {2.0, 0.5}, {2.5, 0.5625}, {3.0, 0.625}, {9.0, 0.5}}) {
    EXPECT_DOUBLE_EQ(pressure_MPa(both, time_h), p) << time_h;
  }
  EXPECT_EQ(both.facts.pressure_MPa, (std::array{0.375, 0.625}));
  const std::string once = resolved_toml(language(), both);
  EXPECT_EQ(resolved_toml(language(), parse(once)), once);
}

TEST(Scene, OverridesReplaceAddAndReachListElements) {
  const std::string text = minimal + "\n[[obstacle]]\nshape = \"plane\"\nposition_mm = [1, 0]\nangle_deg = 90\n";
  const Scene s = parse(text, {"root.radius_mm=0.07", "pressure.differential_MPa = 0.5", "obstacle.1.friction=0.9",
                               "numerics.kernel=isotropic",
                               "tissue.anisotropy={E_radial_max_MPa=2000, x_e_mm=1, "
                               "s_e_per_mm=1, c_e=0}",
                               "output.fields=[\"position\"]", "root.radius_mm=0.08"});
  EXPECT_EQ(s.root.radius_mm, 0.08);
  EXPECT_EQ(s.find<PressureSection>()->table.at(0)[1], 0.5);
  EXPECT_EQ(s.all<ObstacleSection>().at(0).friction, 0.9);
  EXPECT_EQ(s.all<ObstacleSection>().at(0).shape, ObstacleShape::plane);
  EXPECT_EQ(s.numerics.kernel, Kernel::isotropic);
  EXPECT_EQ(s.find<AnisotropySection>()->E_radial_max_MPa, 2000.0);
  EXPECT_EQ(s.tissue.E_axial_MPa, 1020.0);
  EXPECT_EQ(s.output.fields.at(0), "position");
}

TEST(Scene, AccuracyFillsOnlyWhatTheSceneLeavesOut) {
  for (const std::string& name : names_of<Accuracy>()) {
    const NumericsSection numerics = preset(*from_name<Accuracy>(name));
    const Scene s = parse_scene(minimal + "\n[numerics]\naccuracy = \"balanced\"\neta = 1.1\n", "test.toml", {}, name);
    EXPECT_EQ(name_of(s.numerics.accuracy), name);
    EXPECT_EQ(s.numerics.eta, 1.1);
    EXPECT_EQ(s.numerics.window_steps, numerics.window_steps);
    EXPECT_EQ(s.numerics.gradient, numerics.gradient);
  }
}

TEST(Scene, PaperTable1IsAccepted) {
  // Case 1: c_e = -1 with s_e = 0 means E_R = E_A, and c_e = 1 means E_R = E_H
  for (const char* c_e : {"-1", "1"}) {
    const std::string table_1 =
        replaced(replaced(anisotropy, "s_e_per_mm = 6", "s_e_per_mm = 0"), "c_e = 0.2", std::string("c_e = ") + c_e);
    EXPECT_NO_THROW(parse(minimal + table_1)) << c_e;
  }
}

TEST(Nearest, CountsSwappedLettersOnce) {
  EXPECT_EQ(nearest("raduis_mm", {"length_mm", "radius_mm", "cap"}), "radius_mm");
  EXPECT_EQ(nearest("ab", {"ca", "ba"}), "ba");
  EXPECT_EQ(nearest("", {"abc", "a"}), "a");
  EXPECT_EQ(nearest(std::string(100000, 'x'), {"abc"}), "abc");
}

TEST(Describe, CoversEverySectionAndKeyIn100Columns) {
  const std::string text = language().describe({});
  for (const SectionSpec& section : language().sections()) {
    EXPECT_NE(text.find(section_header(section)), std::string::npos);
    const std::string own = language().describe(section.name);
    EXPECT_NE(text.find(own), std::string::npos);
    for (const KeySpec& key : section.keys) {
      EXPECT_NE(own.find("\n  " + key.name + " "), std::string::npos) << key.name;
      EXPECT_FALSE(key.meaning.empty() || key.unit.empty() || key.source.empty()) << key.name;
    }
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

TEST(Describe, NamesTheNearestSection) {
  try {
    language().describe("growht");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.problem().remedy, "did you mean growth?");
  }
}

}  // namespace
}  // namespace rootsoil::testing
