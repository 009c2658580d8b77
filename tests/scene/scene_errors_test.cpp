// SPDX-License-Identifier: MIT
// Each way a scene can be wrong: the message names the place, the key and the way out.
#include <filesystem>
#include <fstream>
#include <ostream>

#include "tests/scene/scene_text.hpp"

namespace rootsoil::testing {
namespace {

struct Case {
  const char* name;
  std::string text;
  std::string key;    ///< expected, exactly
  std::string words;  ///< expected somewhere in the message
  int line = -1;      ///< expected where >= 0
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::string plane = "\n[[obstacle]]\nshape = \"plane\"\nposition_mm = [1, 0]\n";
const std::string response_growth = "\n[response.growth]\np_MPa = [1, 0.5]\n";

std::vector<Case> cases() {
  const std::string grown = minimal + pressure + growth;
  return {
      // the file
      {"not_toml", "[scene\n", "", "not TOML", 1},
      {"key_given_twice", replaced(minimal, "every_h = 1", "every_h = 1\nevery_h = 2"), "", "not TOML"},
      {"empty", "", "", "section [scene] is missing"},
      {"section_missing", replaced(minimal, "[output]\nevery_h = 1\n", ""), "", "section [output] is missing"},
      {"key_missing", replaced(minimal, "radius_mm = 0.05\n", ""), "root.radius_mm", "missing", 5},
      {"key_misspelt", replaced(minimal, "radius_mm", "raduis_mm"), "root.raduis_mm", "did you mean radius_mm?", 7},
      {"key_without_unit", replaced(minimal, "radius_mm", "radius"), "root.radius", "did you mean radius_mm?", 7},
      {"key_in_wrong_section", minimal + "radius_mm = 1\n", "output.radius_mm", "move it there", 15},
      {"key_outside_sections", "name = \"x\"\n" + minimal, "name", "name is a key of [scene]", 1},
      {"section_misspelt", minimal + "\n[growht]\n", "growht", "did you mean growth?", 16},
      {"inner_section_misspelt", minimal + "\n[tissue.anisotropi]\nc_e = 1\n", "tissue.anisotropi",
       "did you mean anisotropy?", 16},
      {"section_as_list", minimal + "\n[[pressure]]\ndifferential_MPa = 1\n", "pressure", "write [pressure] once"},
      {"section_as_number", "growth = 3\n" + minimal, "growth", "name of a section", 1},
      {"list_as_section", minimal + "\n[obstacle]\nshape = \"plane\"\n", "obstacle", "write [[obstacle]]"},

      // soil
      {"soil_key_unknown", minimal + "\n[soil]\nanything = 1\n", "soil.anything", "unknown key", 17},
      {"soil_key_missing", minimal + replaced(soil, "E_MPa = 300\n", ""), "soil.E_MPa", "missing"},
      {"soil_of_other_dimension", minimal + soil + "dimension = 3\n", "soil.dimension",
       "a 2D root can't grow in a 3D soil"},
      {"soil_box_empty", minimal + replaced(soil, "[2, 1]", "[2, -1]"), "soil.box_to_mm", "the box is empty in y"},
      {"soil_without_grain_size", minimal + replaced(soil, "d_range_mm = [0.08, 0.12]\n", ""), "soil",
       "the grains have no size"},
      {"soil_with_two_grain_sizes", minimal + soil + "d_mean_mm = 0.1\n", "soil.d_mean_mm", "exclude each other"},
      {"soil_range_reversed", minimal + replaced(soil, "[0.08, 0.12]", "[0.12, 0.08]"), "soil.d_range_mm",
       "[smallest, largest]"},
      {"soil_grains_larger_than_box", minimal + replaced(soil, "[0.08, 0.12]", "[1, 3]"), "soil.d_range_mm",
       "the grains are too large for the box"},
      {"soil_too_many_grains", minimal + replaced(soil, "[0.08, 0.12]", "[0.0005, 0.001]"), "soil.d_range_mm",
       "some 6e+06 grains"},
      {"soil_no_room_beside_the_root", minimal + replaced(soil, "[0.1, -1]", "[0.1, -0.2]"), "soil.box_from_mm",
       "there is no room for the root"},
      {"soil_no_room_ahead", minimal + replaced(soil, "[2, 1]", "[0.6, 1]"), "soil.box_to_mm",
       "ahead of the root's tip"},
      {"soil_too_soft", minimal + replaced(soil, "= 300", "= 0.9"), "soil.E_MPa", "at least 20 times"},
      {"soil_without_pressure", minimal + replaced(soil, "= 0.05", "= 0"), "soil.confining_pressure_MPa",
       "nothing to pack by"},
      {"soil_without_damping", minimal + soil + "damping = 0\n", "soil.damping", "don't come to rest"},
      {"soil_with_hardly_any_damping", minimal + soil + "damping = 0.009\n", "soil.damping", "0.01 to 0.95"},
      {"soil_friction_a_coefficient", minimal + soil + "friction_deg = 95\n", "soil.friction_deg", "this is an angle"},
      {"soil_density_negative", minimal + soil + "density_N_h2_mm4 = -1\n", "soil.density_N_h2_mm4", "at least 1e-20"},
      {"soil_density_twice", minimal + soil + "density_N_h2_mm4 = 1\ninertial_number_max = 0.01\n",
       "soil.inertial_number_max", "exclude each other"},
      {"soil_porosity_impossible", minimal + soil + "porosity = 0.6\n", "soil.porosity", "can't be packed like that"},
      {"soil_cohesion_of_other_law", minimal + soil + "cohesion_MPa = 0.1\n", "soil.cohesion_MPa",
       "only where contact_law is cohesive"},
      {"soil_rolling_of_other_law", minimal + soil + "rolling = 0.1\ncontact_law = \"hertz_mindlin\"\n", "soil.rolling",
       "no rolling resistance"},
      {"soil_grains_file_missing", minimal + soil + "grains_file = \"none.csv\"\n", "soil.grains_file", "no such file"},
      {"soil_obstacle_in_the_root", minimal + soil + replaced(stone, "[1, 0.3]", "[0.5, 0.1]"),
       "soil.obstacle[1].position_mm", "the root overlaps 'soil.obstacle_1'"},
      {"soil_plate_in_the_root",
       minimal + soil +
           "\n[[soil.obstacle]]\nshape = \"plate\"\nposition_mm = [0.3, 0.2]\nlength_mm = 0.5\nangle_deg = 45\n",
       "soil.obstacle[1].position_mm", "the root overlaps"},
      {"soil_obstacle_outside", minimal + soil + replaced(stone, "[1, 0.3]", "[1, 2]"), "soil.obstacle[1].position_mm",
       "outside the soil's box in y"},
      {"soil_obstacle_without_soil", minimal + stone, "soil.box_from_mm", "missing"},
      {"penetrometer_without_soil", minimal + penetrometer, "penetrometer", "no soil to push the probe into"},
      {"penetrometer_too_deep", minimal + soil + replaced(penetrometer, "= 1.2", "= 1.9"), "penetrometer.depth_mm",
       "the wall at the other end"},
      {"penetrometer_too_wide", minimal + soil + replaced(penetrometer, "= 0.5", "= 1.9"), "penetrometer.diameter_mm",
       "no room for grains"},
      {"penetrometer_nothing_to_average", minimal + soil + penetrometer + "average_from_mm = 1.3\n",
       "penetrometer.average_from_mm", "nothing to average"},

      // types
      {"text_for_number", replaced(minimal, "= 1020", "= \"1020\""), "tissue.E_axial_MPa", "write it without quotes",
       11},
      {"number_for_text", replaced(minimal, "\"small\"", "7"), "scene.name", "write it in quotes", 2},
      {"number_for_boolean", replaced(minimal, "duration_h", "allow_unstable = 1\nduration_h"), "scene.allow_unstable",
       "neither true nor false"},
      {"fraction_for_whole", replaced(minimal, "duration_h", "dimension = 2.0\nduration_h"), "scene.dimension",
       "not a whole number"},
      {"number_for_pair", minimal + "\n[[probe]]\ndistance_to_tip_mm = 1\n", "probe[1].distance_to_tip_mm",
       "two numbers"},
      {"pair_too_long", minimal + "\n[[probe]]\ndistance_to_tip_mm = [1, 2, 3]\n", "probe[1].distance_to_tip_mm",
       "two numbers"},
      {"vector_of_other_dimension", minimal + "\n[[probe]]\nposition_mm = [1, 2, 3]\n", "probe[1].position_mm",
       "2 numbers"},
      {"texts_of_numbers", minimal + "fields = [1]\n", "output.fields", "not a text"},
      {"rows_not_pairs", minimal + "\n[pressure]\ntable = [[0, 1], [2]]\n", "pressure.table", "[time, value] pair"},
      {"rows_empty", minimal + "\n[pressure]\ntable = []\n", "pressure.table", "empty"},
      {"not_a_choice", minimal + "\n[numerics]\nkernel = \"cel\"\n", "numerics.kernel", "did you mean cell?"},
      {"empty_text", replaced(minimal, "\"small\"", "\"\""), "scene.name", "empty"},

      // ranges
      {"not_finite", replaced(minimal, "= 1020", "= inf"), "tissue.E_axial_MPa", "not a finite number"},
      {"not_a_number", replaced(minimal, "= 1020", "= nan"), "tissue.E_axial_MPa", "not a finite number"},
      {"time_not_finite", minimal + "\n[pressure]\ntable = [[nan, 1]]\n", "pressure.table", "not a finite number"},
      {"negative_radius", replaced(minimal, "= 0.05", "= -0.05"), "root.radius_mm", "above 0", 7},
      {"zero_duration", replaced(minimal, "= 10", "= 0"), "scene.duration_h", "above 0", 3},
      {"negative_duration", replaced(minimal, "= 10", "= -1"), "scene.duration_h", "above 0"},
      {"four_dimensions", replaced(minimal, "duration_h", "dimension = 4\nduration_h"), "scene.dimension", "at most 3"},
      {"poisson_ratio", replaced(minimal, "= 1020", "= 1020\nnu_axial = 1.2"), "tissue.nu_axial", "below 1"},
      {"zero_step", minimal + "\n[numerics]\nstep_h = 0\n", "numerics.step_h", "above 0"},
      {"zero_every_h", replaced(minimal, "every_h = 1", "every_h = 0"), "output.every_h", "above 0"},
      {"microns", replaced(minimal, "cell_size_mm = 0.01", "cell_size_mm = 10"), "root.cell_size_mm",
       "are these microns?"},
      {"pascals", replaced(minimal, "= 1020", "= 1.02e9"), "tissue.E_axial_MPa", "are these Pa"},
      {"kilopascals", minimal + "\n[pressure]\ndifferential_MPa = 500\n", "pressure.differential_MPa", "are these Pa"},
      {"seconds", replaced(minimal, "= 10", "= 36000"), "scene.duration_h", "are these seconds?"},

      // keys that exclude or need one another
      {"cells_file_and_lattice", replaced(minimal, "length_mm", "cells_file = \"c.csv\"\nlength_mm"), "root.length_mm",
       "exclude each other"},
      {"tip_axis_without_cells_file", replaced(minimal, "length_mm", "tip_axis = \"+x\"\nlength_mm"), "root.tip_axis",
       "only together with cells_file"},
      {"columns_without_cells_file", minimal + "\n[root.columns]\nunit = \"um\"\n", "root.columns",
       "only together with cells_file"},
      {"clamp_of_free_base", replaced(minimal, "length_mm", "base = \"free\"\nclamp_length_mm = 0.1\nlength_mm"),
       "root.clamp_length_mm", "only where base is clamped"},
      {"mature_width_alone", grown + "mature_width_mm = 0.1\n", "growth.mature_width_mm",
       "only together with mature_at_mm"},
      {"pressure_empty", minimal + "\n[pressure]\n", "pressure", "neither differential_MPa nor table", 16},
      {"pressure_twice", minimal + pressure + "table = [[0, 1]]\n", "pressure.table", "exclude each other"},
      {"times_not_increasing", minimal + "\n[pressure]\ntable = [[0, 1], [2, 1], [2, 0.5]]\n", "pressure.table",
       "times do not increase"},
      {"times_below_0", minimal + "\n[pressure]\ntable = [[-1, 1], [2, 0.5]]\n", "pressure.table",
       "the times begin below 0"},
      {"distances_below_0", minimal + "\n[growth]\ntable = [[-0.1, 1e5], [1, 2e5]]\n", "growth.table",
       "the distances begin below 0"},
      {"division_empty", minimal + "\n[division]\n", "division", "neither l0_mm nor table"},
      {"division_twice", minimal + "\n[division]\nl0_mm = 0.01\ntable = [[0, 0.01]]\n", "division.table",
       "exclude each other"},
      {"division_table_not_increasing", minimal + "\n[division]\ntable = [[0, 0.01], [0, 0.02]]\n", "division.table",
       "distances do not increase"},
      {"division_table_and_parabola", minimal + "\n[division]\ntable = [[0, 0.01]]\nc_d = 2\n", "division.c_d",
       "a table has no such thing"},
      {"turgor_empty", minimal + "\n[turgor]\n", "turgor", "neither turgor_MPa nor table"},
      {"turgor_and_pressure", minimal + pressure + "\n[turgor]\nturgor_MPa = 1\n", "turgor", "is given already"},
      {"soil_twice", minimal + "\n[turgor]\nturgor_MPa = 1\nsoil_MPa = 0\nsoil_table = [[0, 0]]\n", "turgor.soil_table",
       "exclude each other"},
      {"distances_not_increasing", grown + "yield_profile = [[1, 0.1], [0, 0.2]]\n", "growth.yield_profile",
       "distances do not increase"},
      {"yield_twice", grown + "yield_MPa = 0.1\nyield_profile = [[1, 0.1]]\n", "growth.yield_profile",
       "exclude each other"},
      {"yield_profile_responds", grown + "yield_profile = [[1, 0.1]]\n" + response_growth + "yield_MPa = [0, 0.1]\n",
       "growth.yield_profile", "exclude each other"},
      {"growth_table_and_bell", grown + "table = [[0, 1e5]]\n", "growth.lambda0_ug_mm3_h", "exclude each other"},
      {"growth_table_not_increasing", minimal + "\n[growth]\ntable = [[1, 1e5], [1, 2e5]]\n", "growth.table",
       "distances do not increase"},
      {"growth_table_responds",
       minimal + pressure + "\n[growth]\ntable = [[0, 1e5]]\n" + response_growth + "x_g_mm = [0, 1]\n",
       "response.growth.x_g_mm", "does not respond"},
      {"growth_key_missing", minimal + "\n[growth]\nx_g_mm = 1\ns_g_mm = 1\nc_g = 0\n", "growth.lambda0_ug_mm3_h",
       "as a pair in [response.growth]"},

      // response
      {"response_empty", grown + "\n[response]\n", "response", "nothing responds"},
      {"response_without_parameters", grown + response_growth, "response.growth", "no parameter is listed"},
      {"response_without_pressure", minimal + growth + response_growth, "response", "add [pressure]"},
      {"response_without_growth", minimal + pressure + response_growth + "c_g = [0, 1]\n", "response.growth",
       "there is no [growth]"},
      {"response_without_anisotropy", minimal + pressure + "\n[response.anisotropy]\np_MPa = [1, 0.5]\nc_e = [0, 1]\n",
       "response.anisotropy", "there is no [tissue.anisotropy]"},
      {"response_pressures_equal", grown + "\n[response.growth]\np_MPa = [1, 1]\n", "response.growth.p_MPa", "equal"},
      {"response_given_twice", grown + response_growth + "c_g = [0, 1]\n", "response.growth.c_g",
       "is given in [growth] too"},
      {"response_leaves_range",
       replaced(grown, "s_g_mm = 0.37\n", "") + "\n[response.growth]\np_MPa = [0.5, 0.4]\n" + "s_g_mm = [0.1, 0.4]\n",
       "response.growth.s_g_mm", "Eq. 7 gives -1.4 at p = 1 MPa"},
      {"response_leaves_range_where_pushed",
       replaced(grown, "s_g_mm = 0.37\n", "") + "\n[response]\nfollows = \"perceived\"\n" + response_growth +
           "s_g_mm = [0.4, 0.1]\n",
       "response.growth.s_g_mm", "Eq. 7 gives -0.2 at p = 0 MPa, which a root perceives that is pushed as hard"},
      {"response_time_of_what_is_given",
       replaced(grown, "s_g_mm = 0.37\n", "") + "\n[response]\nover_h = 1\n" + response_growth +
           "s_g_mm = [0.4, 0.3]\n",
       "response.over_h", "only where follows is perceived"},

      // geometry
      {"thinner_than_a_cell", replaced(minimal, "= 0.05", "= 0.004"), "root.radius_mm", "thinner than one cell"},
      {"shorter_than_its_tip", replaced(minimal, "= 0.4", "= 0.04"), "root.length_mm", "shorter than its round tip"},
      {"bent_too_sharply", replaced(minimal, "length_mm", "curvature_per_mm = 20\nlength_mm"), "root.curvature_per_mm",
       "bent more sharply"},
      {"clamped_whole", replaced(minimal, "length_mm", "clamp_length_mm = 0.4\nlength_mm"), "root.clamp_length_mm",
       "whole root is clamped"},
      {"too_many_cells", replaced(minimal, "cell_size_mm = 0.01", "cell_size_mm = 1e-5"), "root.cell_size_mm",
       "would have some 4e+08 cells"},
      {"cells_file_missing",
       replaced(
           replaced(minimal, "length_mm = 0.4\nradius_mm = 0.05\ncell_size_mm = 0.01", "cells_file = \"none.csv\""),
           "[scene]", "[scene]\ndimension = 3"),
       "root.cells_file", "a/none.csv"},
      {"cells_file_in_2d",
       replaced(minimal, "length_mm = 0.4\nradius_mm = 0.05\ncell_size_mm = 0.01", "cells_file = \"none.csv\""),
       "root.cells_file", "set scene.dimension = 3"},

      // S positive definite
      {"compliance_2d", replaced(minimal, "= 1020", "= 1020\nnu_axial = 0.3") + anisotropy, "tissue.nu_axial",
       "below 11333.3 MPa"},
      {"compliance_3d",
       replaced(replaced(minimal, "= 1020", "= 1020\nnu_axial = 0.6"), "[scene]", "[scene]\ndimension = 3"),
       "tissue.nu_axial", "E_R = 1020"},
      {"radial_modulus_negative", minimal + replaced(anisotropy, "c_e = 0.2", "c_e = -1"), "tissue.anisotropy",
       "Eq. 6 makes E_R negative"},
      {"compliance_at_one_pressure",
       replaced(minimal, "= 1020", "= 1020\nnu_axial = 0.2") + pressure +
           replaced(anisotropy, "E_radial_max_MPa = 15000\n", "") +
           "\n[response.anisotropy]\np_MPa = [0.5, 0.75]\nE_radial_max_MPa = [5000, 16000]\n",
       "tissue.nu_axial", "below 25500 MPa"},

      // obstacles and probes
      {"obstacle_without_shape", minimal + "\n[[obstacle]]\nposition_mm = [1, 0]\n", "obstacle[1].shape", "missing",
       16},
      {"plane_without_direction", minimal + plane, "obstacle[1]", "neither normal nor angle_deg"},
      {"plane_with_two_directions", minimal + plane + "normal = [-1, 0]\nangle_deg = 90\n", "obstacle[1].angle_deg",
       "exclude each other"},
      {"plane_without_normal", minimal + plane + "normal = [0, 0]\n", "obstacle[1].normal",
       "too short or too long to tell its direction"},
      {"plane_with_radius", minimal + plane + "normal = [-1, 0]\nradius_mm = 1\n", "obstacle[1].radius_mm",
       "only where shape is disc or sphere"},
      {"box_without_size", minimal + "\n[[obstacle]]\nshape = \"box\"\nposition_mm = [1, 0]\n",
       "obstacle[1].half_size_mm", "missing"},
      {"disc_without_radius", minimal + "\n[[obstacle]]\nshape = \"disc\"\nposition_mm = [1, 0]\n",
       "obstacle[1].radius_mm", "missing"},
      {"sphere_in_2d", minimal + "\n[[obstacle]]\nshape = \"sphere\"\nposition_mm = [1, 0]\nradius_mm = 1\n",
       "obstacle[1].shape", "use a disc"},
      {"disc_in_3d",
       replaced(minimal, "[scene]", "[scene]\ndimension = 3") +
           "\n[[obstacle]]\nshape = \"disc\"\nposition_mm = [1, 0, 0]\nradius_mm = 1\n",
       "obstacle[1].shape", "use a sphere"},
      {"obstacles_of_one_name",
       minimal + plane + "angle_deg = 90\nname = \"a\"\n" + plane + "angle_deg = 90\nname = \"a\"\n",
       "obstacle[2].name", "same name", 26},
      {"probes_of_one_name",
       minimal + "\n[[probe]]\nposition_mm = [1, 0]\nname = \"probe_2\"\n" + "\n[[probe]]\nposition_mm = [1, 0]\n",
       "probe[2].name", "same name"},
      {"probe_nowhere", minimal + "\n[[probe]]\n", "probe[1]", "neither position_mm nor distance_to_tip_mm", 16},
      {"probe_twice", minimal + "\n[[probe]]\nposition_mm = [1, 0]\ndistance_to_tip_mm = [0, 1]\n",
       "probe[1].distance_to_tip_mm", "exclude each other"},
      {"probe_bin_empty", minimal + "\n[[probe]]\ndistance_to_tip_mm = [1, 1]\n", "probe[1].distance_to_tip_mm",
       "bin is empty"},

      // output, names
      {"output_after_the_end", replaced(minimal, "every_h = 1", "every_h = 11"), "output.every_h",
       "at most duration_h = 10"},
      {"name_of_no_folder", replaced(minimal, "\"small\"", "\"a/b\""), "scene.name", "name of a folder", 2},
  };
}

class SceneErrors : public ::testing::TestWithParam<Case> {};

TEST_P(SceneErrors, NamePlaceAndRemedy) {
  const Case& c = GetParam();
  const InputProblem problem = problem_of(c.text);
  const std::string message = format_input_problem(problem);
  EXPECT_EQ(problem.file, "a/test.toml");
  EXPECT_EQ(problem.key, c.key) << message;
  EXPECT_NE(message.find(c.words), std::string::npos) << message;
  if (c.line >= 0) {
    EXPECT_EQ(problem.line, c.line) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, SceneErrors, ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(SceneErrors, HaveLineGivenAllowedAndRemedy) {
  const InputProblem p = problem_of(replaced(minimal, "cell_size_mm = 0.01", "cell_size_mm = 10"));
  EXPECT_EQ(p.line, 8);
  EXPECT_EQ(p.given, "10");
  EXPECT_EQ(p.allowed, "a number above 0, at most 1");
  EXPECT_NE(p.remedy.find("10 um are 0.01 mm"), std::string::npos);
}

TEST(SceneErrors, InOverridesSayWhereTheyComeFrom) {
  const auto wrong = [](const std::string& override_text) { return problem_of(minimal, {override_text}); };
  EXPECT_EQ(wrong("root.radius_mm=-1").file, "from --set");
  EXPECT_EQ(wrong("root.radius_mm=-1").line, 0);
  EXPECT_EQ(wrong("root.radius_mm=-1").key, "root.radius_mm");
  EXPECT_EQ(wrong("root.raduis_mm=1").remedy.find("did you mean radius_mm?"), 0u);
  EXPECT_EQ(wrong("root.radius_mm").file, "from --set");
  EXPECT_EQ(wrong("=1").what, "this is not a key and a value");
  EXPECT_EQ(wrong("#=1").what, "this is not a key and a value");
  EXPECT_EQ(wrong("root..radius_mm=1").given, "root..radius_mm=1");
  EXPECT_EQ(wrong("scene.seed=1\n[growth]").what, "an override is one line");
  EXPECT_EQ(wrong("root=1").key, "root");
}

TEST(SceneErrors, InOverridesOfListElements) {
  const std::string text = minimal + plane + "angle_deg = 90\n";
  for (const char* wrong :
       {"obstacle.2.friction=1", "obstacle.0.friction=1", "obstacle.x.friction=1", "obstacle.1=1"}) {
    EXPECT_EQ(problem_of(text, {wrong}).allowed, "1 to 1") << wrong;
  }
}

TEST(SceneErrors, InAccuracySayWhereTheyComeFrom) {
  const InputProblem p = problem_of(minimal, {}, "balancd");
  EXPECT_EQ(p.file, "from --accuracy");
  EXPECT_NE(p.remedy.find("balanced"), std::string::npos);
}

TEST(SceneErrors, OfFiles) {
  const auto folder = std::filesystem::temp_directory_path();
  EXPECT_THROW(read_scene(folder / "there_is_no_such_scene.toml"), InputError);
  EXPECT_THROW(read_scene(folder), InputError);
}

}  // namespace
}  // namespace rootsoil::testing
