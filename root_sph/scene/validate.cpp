// SPDX-License-Identifier: MIT
#include "root_sph/scene/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/schema.hpp"

namespace rootsoil {
namespace {

namespace fs = std::filesystem;

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

/// Names become names of folders and columns.
void check_name(const std::string& name, const std::string& path, const Origins& origins) {
  if (std::all_of(name.begin(), name.end(), is_name_character) && name.front() != '.') return;
  origins.fail(path, "this name cannot be the name of a folder or a column", toml_text(name),
               "letters, digits, _ - and dot, not beginning with a dot");
}

std::string name_from_file(const std::string& file) {
  std::string name = fs::path(file).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_name_character(c); }, '_');
  return name.empty() || name.front() == '.' ? "scene" : name;
}

/// Exactly one of two keys.
void check_one_of(const std::string& element, const char* a, const char* b, const Origins& origins) {
  const std::string path_a = element + "." + a;
  const std::string path_b = element + "." + b;
  if (origins.has(path_a) && origins.has(path_b)) {
    origins.fail(path_b, fmt::format("{} and {} exclude each other", a, b), {}, {}, "give one of them");
  }
  if (!origins.has(path_a) && !origins.has(path_b)) {
    origins.fail(element, fmt::format("neither {} nor {} is given", a, b), {}, {}, "give one of them");
  }
}

template <class Element>
void complete_names(std::vector<Element>& elements, const std::string& section, const Origins& origins) {
  const SectionSpec& spec = *find_section(section);
  std::set<std::string> names;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    std::string& name = elements[i].name;
    const std::string path = key_path(spec, i, "name");
    if (name.empty()) {
      name = fmt::format("{}_{}", section, i + 1);
    } else {
      check_name(name, path, origins);
    }
    if (!names.insert(name).second) {
      origins.fail(path, fmt::format("two sections [[{}]] have the same name", section), toml_text(name), {},
                   "give each its own");
    }
  }
}

// ---- root -----------------------------------------------------------------------------------------

void check_cells_file(Scene& scene, const Origins& origins) {
  RootSection& root = scene.root;
  const std::string given = toml_text(root.cells_file);
  if (scene.scene.dimension != 3) {
    origins.fail("root.cells_file", "cells from microscopy are ellipsoids in space", given, {},
                 "set scene.dimension = 3");
  }
  std::error_code error;
  const fs::path path = fs::absolute(fs::path(scene.file).parent_path() / root.cells_file, error).lexically_normal();
  if (error || !fs::is_regular_file(path, error)) {
    origins.fail("root.cells_file", "there is no such file", given, {},
                 fmt::format("looked for {}; the path starts from the scene file's folder", path.string()));
  }
  root.cells_file = path.string();  // absolute, so that the resolved scene works from the run's folder too
}

void check_lattice(const Scene& scene, const Origins& origins) {
  const RootSection& root = scene.root;
  const double width_mm = 2 * root.radius_mm;
  constexpr double rounding = 1 + 1e-9;
  if (width_mm * rounding < root.cell_size_mm) {
    origins.fail("root.radius_mm", "the root is thinner than one cell", fmt::format("{}", root.radius_mm),
                 fmt::format("at least {} (half of cell_size_mm)", root.cell_size_mm / 2),
                 "make the radius larger or the cells smaller");
  }
  const double shortest_mm = root.cap ? std::max(root.radius_mm, root.cell_size_mm) : root.cell_size_mm;
  if (root.length_mm * rounding < shortest_mm) {
    origins.fail(
        "root.length_mm",
        root.cap ? "the root is shorter than its round tip, or than one cell" : "the root is shorter than one cell",
        fmt::format("{}", root.length_mm), fmt::format("at least {}", shortest_mm), "make the root longer");
  }
  if (std::abs(root.curvature_per_mm) * root.radius_mm >= 1) {
    origins.fail("root.curvature_per_mm", "the root is bent more sharply than it is thick",
                 fmt::format("{}", root.curvature_per_mm), fmt::format("-{0} to {0}", 1 / root.radius_mm),
                 "lower the curvature");
  }
  if (root.base == "clamped" && root.clamp_length_mm >= root.length_mm) {
    origins.fail("root.clamp_length_mm", "the whole root is clamped", fmt::format("{}", root.clamp_length_mm),
                 fmt::format("below length_mm = {}", root.length_mm), "shorten the clamp");
  }
  constexpr double most_cells = 2e7;
  const double section = scene.scene.dimension == 2 ? width_mm : std::numbers::pi * root.radius_mm * root.radius_mm;
  const double cells = root.length_mm * section / std::pow(root.cell_size_mm, scene.scene.dimension);
  if (cells > most_cells) {
    origins.fail("root.cell_size_mm", fmt::format("the root would have some {:.0e} cells", cells),
                 fmt::format("{}", root.cell_size_mm), fmt::format("at most {:.0e} cells", most_cells),
                 "are all lengths in mm? Otherwise take larger cells or a shorter root");
  }
}

// ---- response -------------------------------------------------------------------------------------

/// Eq. 7.
double theta(double p_MPa, const std::array<double, 2>& anchors_MPa, bool extrapolate) {
  const double t = (p_MPa - anchors_MPa[1]) / (anchors_MPa[0] - anchors_MPa[1]);
  return extrapolate ? t : std::clamp(t, 0.0, 1.0);
}

double interpolated(const std::array<double, 2>& values, double t) { return t * values[0] + (1 - t) * values[1]; }

std::array<double, 2> pressure_range_MPa(const PressureSection& pressure) {
  const auto [low, high] = std::minmax_element(pressure.table.begin(), pressure.table.end(),
                                               [](const auto& a, const auto& b) { return a[1] < b[1]; });
  return {(*low)[1], (*high)[1]};
}

/// Every parameter is linear in p, so it stays within its range if it does at the lowest and highest p.
void check_response_of(const std::string& name, const std::string& target, const Scene& scene, const Origins& origins) {
  const SectionSpec& spec = *find_section(name);
  if (spec.count(scene) == 0) return;
  if (!origins.has(target)) {
    origins.fail(name, fmt::format("there is no [{}] that could respond", target), {}, {},
                 fmt::format("add [{}], or remove [{}]", target, name));
  }
  const Numbers anchors = std::get<Numbers>(*spec.find("p_MPa")->get(scene, 0));
  const std::array<double, 2> p_MPa{anchors[0], anchors[1]};
  if (p_MPa[0] == p_MPa[1]) {
    origins.fail(name + ".p_MPa", "the two pressures are equal", toml_text(anchors), "two different pressures",
                 "give the pressure of each parameter set");
  }
  bool any = false;
  for (const KeySpec& key : spec.keys) {
    const std::optional<Value> value = key.get(scene, 0);
    if (key.name == "p_MPa" || !value) continue;
    any = true;
    const Numbers& pair = std::get<Numbers>(*value);
    for (const double p : pressure_range_MPa(*scene.pressure)) {
      const double number = interpolated({pair[0], pair[1]}, theta(p, p_MPa, scene.response->extrapolate));
      if (key.limits.contains(number)) continue;
      origins.fail(fmt::format("{}.{}", name, key.name), fmt::format("Eq. 7 gives {:.4g} at p = {} MPa", number, p),
                   toml_text(*value), key.limits.text(),
                   "set response.extrapolate = false, or choose p_MPa so that they enclose the pressure");
    }
  }
  if (!any) {
    origins.fail(name, "no parameter is listed", {}, {},
                 fmt::format("give pairs for keys of [{}]; rootsoil describe {} lists them", target, name));
  }
}

void check_response(const Scene& scene, const Origins& origins) {
  if (!scene.response->growth && !scene.response->anisotropy) {
    origins.fail("response", "nothing responds", {}, {}, "add [response.growth] or [response.anisotropy]");
  }
  if (!scene.pressure) {
    origins.fail("response", "the response follows the pressure differential, and there is none", {}, {},
                 "add [pressure]");
  }
  check_response_of("response.growth", "growth", scene, origins);
  check_response_of("response.anisotropy", "tissue.anisotropy", scene, origins);
}

// ---- elasticity -----------------------------------------------------------------------------------

/// The values that E_R takes along the root at one pressure: Eq. 6 is monotonous in s, from s = 0 to infinity.
std::array<double, 2> radial_modulus_ends_MPa(double E_axial_MPa, const AnisotropySection& a) {
  const double at_tip = 1 / (1 + std::exp(a.s_e_per_mm * a.x_e_mm));
  const double far_away = a.s_e_per_mm > 0 ? 1.0 : 0.5;
  const auto modulus = [&](double sigmoid) {
    return E_axial_MPa + (a.E_radial_max_MPa - E_axial_MPa) * (a.c_e + (1 - a.c_e) * sigmoid);
  };
  return {modulus(at_tip), modulus(far_away)};
}

std::vector<double> radial_moduli_MPa(const Scene& scene) {
  const double E_axial_MPa = scene.tissue.E_axial_MPa;
  if (!scene.tissue.anisotropy) return {E_axial_MPa};
  std::vector<double> moduli;
  const auto collect = [&](const AnisotropySection& a) {
    for (const double modulus : radial_modulus_ends_MPa(E_axial_MPa, a)) moduli.push_back(modulus);
  };
  if (!scene.response || !scene.response->anisotropy) {
    collect(*scene.tissue.anisotropy);
    return moduli;
  }
  const ResponseSection::Anisotropy& response = *scene.response->anisotropy;
  const auto [low, high] = pressure_range_MPa(*scene.pressure);
  constexpr int samples = 32;  // E_R is not linear in p
  for (int i = 0; i <= samples; ++i) {
    const double t = theta(low + (high - low) * i / samples, response.p_MPa, scene.response->extrapolate);
    const auto at = [&](const std::optional<std::array<double, 2>>& pair, double constant) {
      return pair ? interpolated(*pair, t) : constant;
    };
    const AnisotropySection& a = *scene.tissue.anisotropy;
    collect({at(response.E_radial_max_MPa, a.E_radial_max_MPa), at(response.x_e_mm, a.x_e_mm),
             at(response.s_e_per_mm, a.s_e_per_mm), at(response.c_e, a.c_e)});
  }
  return moduli;
}

/// The compliance matrix (Eq. 4; 2D: docs/physics.md 3) is positive definite where 0 < E_R < this.
double largest_radial_modulus_MPa(const TissueSection& tissue, int dimension) {
  const double nu2 = tissue.nu_axial * tissue.nu_axial;
  return dimension == 2 ? tissue.E_axial_MPa / nu2 : tissue.E_axial_MPa * (1 - tissue.nu_radial) / (2 * nu2);
}

void check_compliance(const Scene& scene, const Origins& origins) {
  const double largest = largest_radial_modulus_MPa(scene.tissue, scene.scene.dimension);
  for (const double modulus : radial_moduli_MPa(scene)) {
    if (modulus > 0 && modulus < largest) continue;
    origins.fail(modulus > 0 ? "tissue.nu_axial" : "tissue.anisotropy",
                 fmt::format("the compliance matrix is not positive definite where E_R = {:.6g} MPa", modulus),
                 scene.scene.dimension == 2
                     ? fmt::format("nu_axial = {}", scene.tissue.nu_axial)
                     : fmt::format("nu_axial = {}, nu_radial = {}", scene.tissue.nu_axial, scene.tissue.nu_radial),
                 fmt::format("E_R above 0 and below {:.6g} MPa with these Poisson ratios", largest),
                 modulus > 0 ? "lower nu_axial or the radial modulus" : "raise c_e: Eq. 6 makes E_R negative");
  }
}

// ---- obstacles, probes, output --------------------------------------------------------------------

void complete_obstacle(ObstacleSection& obstacle, std::size_t index, const Scene& scene, const Origins& origins) {
  const std::string element = key_path(*find_section("obstacle"), index);
  const int shape_dimension = obstacle.shape == "disc" ? 2 : obstacle.shape == "sphere" ? 3 : scene.scene.dimension;
  if (shape_dimension != scene.scene.dimension) {
    origins.fail(element + ".shape",
                 fmt::format("there is no {} in {} dimensions", obstacle.shape, scene.scene.dimension),
                 toml_text(obstacle.shape), scene.scene.dimension == 2 ? "plane, box, disc" : "plane, box, sphere",
                 fmt::format("use a {}", scene.scene.dimension == 2 ? "disc" : "sphere"));
  }
  if (obstacle.shape == "plane") {
    check_one_of(element, "normal", "angle_deg", origins);
    if (origins.has(element + ".angle_deg")) {
      const double angle = obstacle.angle_deg * std::numbers::pi / 180;
      obstacle.normal = {-std::sin(angle), std::cos(angle), 0.0};
      obstacle.angle_deg = 0.0;
    }
    std::array<double, 3>& n = obstacle.normal;
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(length > 1e-12) || !std::isfinite(length)) {
      origins.fail(element + ".normal", "the normal has no direction", toml_text(Numbers(n.begin(), n.end())),
                   "a vector that is not zero", "give the direction from the plane towards the root");
    }
    // a unit vector is left alone, so that a resolved scene reads back bit for bit
    if (std::abs(length - 1) > 1e-14) {
      for (double& component : n) component /= length;
    }
  }
  if (obstacle.contact_modulus_MPa == 0.0) obstacle.contact_modulus_MPa = scene.tissue.E_axial_MPa;
}

void check_probe(const ProbeSection& probe, std::size_t index, const Origins& origins) {
  const std::string element = key_path(*find_section("probe"), index);
  check_one_of(element, "position_mm", "distance_to_tip_mm", origins);
  if (probe.distance_to_tip_mm && !((*probe.distance_to_tip_mm)[0] < (*probe.distance_to_tip_mm)[1])) {
    const auto [from, to] = *probe.distance_to_tip_mm;
    origins.fail(element + ".distance_to_tip_mm", "the bin is empty", toml_text(Numbers{from, to}),
                 "[from, to] with from below to", "exchange or move its ends");
  }
}

void check_pressure(const PressureSection& pressure, const Origins& origins) {
  check_one_of("pressure", "differential_MPa", "table", origins);
  for (std::size_t i = 1; i < pressure.table.size(); ++i) {
    if (pressure.table[i - 1][0] < pressure.table[i][0]) continue;
    origins.fail("pressure.table", "the times do not increase",
                 fmt::format("{} after {}", pressure.table[i][0], pressure.table[i - 1][0]), "increasing times",
                 "sort the rows, and give each time once");
  }
}

// ---- soil -----------------------------------------------------------------------------------------

const char* const axis_name[] = {"x", "y", "z"};

void complete_grains(SoilSection& soil, const Scene& scene, const Origins& origins) {
  if (soil.d_range_mm && soil.d_mean_given_mm) {
    origins.fail("soil.d_mean_mm", "d_mean_mm and d_range_mm exclude each other", {}, {}, "give one of them");
  }
  if (!soil.d_range_mm && !soil.d_mean_given_mm) {
    origins.fail("soil", "the grains have no size", {}, {}, "give d_range_mm = [smallest, largest], or d_mean_mm");
  }
  if (soil.d_range_mm) {
    soil.d_min_mm = (*soil.d_range_mm)[0];
    soil.d_max_mm = (*soil.d_range_mm)[1];
    if (soil.d_min_mm > soil.d_max_mm) {
      origins.fail("soil.d_range_mm", "the smallest diameter is above the largest",
                   toml_text(Numbers{soil.d_min_mm, soil.d_max_mm}), "[smallest, largest]", "exchange them");
    }
    soil.d_mean_mm = 0.5 * (soil.d_min_mm + soil.d_max_mm);
    soil.d_spread = (soil.d_max_mm - soil.d_min_mm) / (soil.d_max_mm + soil.d_min_mm);
  } else {
    constexpr double usual_spread = 0.2;
    soil.d_mean_mm = *soil.d_mean_given_mm;
    if (!soil.d_spread_given) soil.d_spread_given = usual_spread;
    soil.d_spread = *soil.d_spread_given;
    soil.d_min_mm = soil.d_mean_mm * (1 - soil.d_spread);
    soil.d_max_mm = soil.d_mean_mm * (1 + soil.d_spread);
  }
  const std::string size_key = soil.d_range_mm ? "soil.d_range_mm" : "soil.d_mean_mm";
  constexpr double grains_across = 4.0;
  double grains = soil.dimension == 2 ? 0.83 : 0.6;
  for (int a = 0; a < soil.dimension; ++a) {
    const double side = soil.box_to_mm[a] - soil.box_from_mm[a];
    if (side < grains_across * soil.d_max_mm) {
      origins.fail(
          size_key,
          fmt::format("the grains are too large for the box, which is {:.6g} mm long in {}", side, axis_name[a]),
          fmt::format("largest diameter {:.6g} mm", soil.d_max_mm),
          fmt::format("at most {:.6g} mm", side / grains_across), "take smaller grains or a larger box");
    }
    grains *= side / soil.d_mean_mm;
  }
  constexpr double most_grains = 1e6;
  if (grains > most_grains && soil.grains_file.empty()) {
    origins.fail(size_key, fmt::format("the box would hold some {:.0e} grains", grains),
                 fmt::format("mean diameter {:.6g} mm", soil.d_mean_mm),
                 fmt::format("at most {:.0e} grains", most_grains),
                 "are all lengths in mm? Otherwise take larger grains or a smaller box");
  }
  if (!soil.grains_file.empty()) {
    std::error_code error;
    const fs::path path = fs::absolute(fs::path(scene.file).parent_path() / soil.grains_file, error).lexically_normal();
    if (error || !fs::is_regular_file(path, error)) {
      origins.fail("soil.grains_file", "there is no such file", toml_text(soil.grains_file), {},
                   fmt::format("looked for {}; the path starts from the scene file's folder", path.string()));
    }
    soil.grains_file = path.string();
  }
}

void check_packing(const SoilSection& soil, const Origins& origins) {
  // solid fractions outside these have never been packed by growing grains between walls (docs/soil.md)
  const auto [low, high] = soil.dimension == 2 ? std::pair(0.10, 0.30) : std::pair(0.30, 0.55);
  if (soil.porosity && !(*soil.porosity >= low && *soil.porosity <= high)) {
    origins.fail("soil.porosity", fmt::format("grains can't be packed like that in {} dimensions", soil.dimension),
                 fmt::format("{}", *soil.porosity), fmt::format("{} to {}", low, high),
                 "leave it out to take what compaction_friction_deg gives");
  }
  if (soil.rolling > 0 && soil.contact_law == "hertz_mindlin") {
    origins.fail("soil.rolling", "hertz_mindlin has no rolling resistance here", fmt::format("{}", soil.rolling), "0",
                 "take contact_law = \"linear\" or \"cohesive\"");
  }
  constexpr double softest = 20.0;
  if (soil.E_MPa < softest * soil.confining_pressure_MPa) {
    origins.fail("soil.E_MPa", "the confining pressure would press the grains into each other",
                 fmt::format("{}", soil.E_MPa),
                 fmt::format("at least {} times confining_pressure_MPa = {:.6g}", softest,
                             softest * soil.confining_pressure_MPa),
                 "raise E_MPa: 250 times the stress on the tip is a good value");
  }
  const bool nothing_presses = !soil.grains_file.empty() && soil.walls == "rigid" && soil.density_N_h2_mm4;
  if (soil.confining_pressure_MPa == 0 && !nothing_presses) {
    origins.fail("soil.confining_pressure_MPa", "without pressure there is nothing to pack by", "0", "above 0",
                 "0 is allowed only with grains_file, walls = \"rigid\" and density_N_h2_mm4");
  }
}

/// Distance of a point from the obstacle's surface, 0 inside. A clump counts as the ball around it.
double distance_mm(const SoilObstacle& o, const std::array<double, 3>& point, int dimension) {
  const double dx = point[0] - o.position_mm[0], dy = point[1] - o.position_mm[1];
  const double dz = dimension == 3 ? point[2] - o.position_mm[2] : 0.0;
  if (o.shape == "stone" || o.shape == "clump") return std::max(0.0, std::hypot(dx, dy, dz) - o.radius_mm);
  const double angle = o.angle_deg * std::numbers::pi / 180;
  const double u = std::cos(angle) * dx + std::sin(angle) * dy, v = -std::sin(angle) * dx + std::cos(angle) * dy;
  const bool plate = o.shape == "plate";
  const auto beyond = [](double at, double half) { return std::max(0.0, std::abs(at) - half); };
  return std::hypot(beyond(u, plate ? o.length_mm / 2 : o.half_size_mm[0]),
                    beyond(v, plate ? o.thickness_mm / 2 : o.half_size_mm[1]),
                    dimension == 3 ? beyond(dz, plate ? o.length_mm / 2 : o.half_size_mm[2]) : 0.0);
}

void check_soil_obstacle(const SoilObstacle& o, std::size_t index, const Scene& scene, const Origins& origins) {
  const SoilSection& soil = *scene.soil;
  const std::string element = key_path(*find_section("soil.obstacle"), index);
  for (int a = 0; a < soil.dimension; ++a) {
    if (o.position_mm[a] > soil.box_from_mm[a] && o.position_mm[a] < soil.box_to_mm[a]) continue;
    origins.fail(element + ".position_mm", fmt::format("'{}' lies outside the soil's box in {}", o.name, axis_name[a]),
                 fmt::format("{}", o.position_mm[a]), fmt::format("{} to {}", soil.box_from_mm[a], soil.box_to_mm[a]),
                 "move it, or make the box larger");
  }
  const RootSection& root = scene.root;
  if (o.shape == "gap" || !root.cells_file.empty() || root.curvature_per_mm != 0.0) return;  // the engine looks again
  constexpr int points = 200;
  for (int k = 0; k <= points; ++k) {
    const double x = (root.length_mm - root.radius_mm) * k / points;
    if (distance_mm(o, {x, 0, 0}, soil.dimension) >= root.radius_mm) continue;
    origins.fail(element + ".position_mm", fmt::format("the root overlaps '{}' at the start", o.name),
                 fmt::format("at x = {:.3g} mm", x), "an obstacle that the root does not touch at the start",
                 "move the obstacle, or make the root shorter");
  }
}

void check_room_for_root(const Scene& scene, const Origins& origins) {
  const SoilSection& soil = *scene.soil;
  const RootSection& root = scene.root;
  if (!root.cells_file.empty()) return;  // the engine looks when it places the root
  constexpr double grains_beside = 2.0;
  const double needed = root.radius_mm + grains_beside * soil.d_max_mm;
  for (int a = 1; a < soil.dimension; ++a) {
    if (soil.box_from_mm[a] <= -needed && soil.box_to_mm[a] >= needed) continue;
    origins.fail(soil.box_from_mm[a] <= -needed ? "soil.box_to_mm" : "soil.box_from_mm",
                 fmt::format("there is no room for the root, whose axis is {} = 0, and {} grains on either side",
                             axis_name[a], grains_beside),
                 fmt::format("{} from {} to {} mm", axis_name[a], soil.box_from_mm[a], soil.box_to_mm[a]),
                 fmt::format("from at most {:.6g} to at least {:.6g} mm", -needed, needed), "make the box wider");
  }
  if (root.length_mm + grains_beside * soil.d_max_mm > soil.box_to_mm[0]) {
    origins.fail("soil.box_to_mm", "there is no room ahead of the root's tip",
                 fmt::format("x to {} mm", soil.box_to_mm[0]),
                 fmt::format("above {:.6g} mm", root.length_mm + grains_beside * soil.d_max_mm),
                 "make the box longer; the root grows towards x = to");
  }
}

/// Everything about the soil that does not depend on the root.
void complete_soil_alone(Scene& scene, const Origins& origins) {
  SoilSection& soil = *scene.soil;
  const int dimension = scene.scene.dimension;
  if (soil.soil_dimension != 0 && soil.soil_dimension != dimension) {
    origins.fail("soil.dimension", fmt::format("a {}D root can't grow in a {}D soil", dimension, soil.soil_dimension),
                 fmt::format("{}", soil.soil_dimension), fmt::format("{}, as scene.dimension", dimension),
                 "leave it out, or change scene.dimension");
  }
  soil.dimension = dimension;
  for (int a = 0; a < dimension; ++a) {
    if (soil.box_from_mm[a] < soil.box_to_mm[a]) continue;
    origins.fail("soil.box_to_mm", fmt::format("the box is empty in {}", axis_name[a]),
                 fmt::format("{}", soil.box_to_mm[a]), fmt::format("above box_from_mm = {}", soil.box_from_mm[a]),
                 "exchange or move the corners");
  }
  complete_grains(soil, scene, origins);
  check_packing(soil, origins);
  complete_names(soil.obstacles, "soil.obstacle", origins);
  if (!scene.soil_contact) scene.soil_contact.emplace();
}

void check_soil(const Scene& scene, const Origins& origins) {
  check_room_for_root(scene, origins);
  for (std::size_t i = 0; i < scene.soil->obstacles.size(); ++i) {
    check_soil_obstacle(scene.soil->obstacles[i], i, scene, origins);
  }
}

void complete_penetrometer(Scene& scene, const Origins& origins) {
  PenetrometerSection& probe = *scene.penetrometer;
  if (!scene.soil) origins.fail("penetrometer", "there is no soil to push the probe into", {}, {}, "add [soil]");
  const SoilSection& soil = *scene.soil;
  constexpr double grains_ahead = 4.0;
  const double deepest = soil.box_to_mm[0] - soil.box_from_mm[0] - grains_ahead * soil.d_max_mm;
  if (probe.depth_mm > deepest * (1 + 1e-9)) {  // the message's own number is allowed
    origins.fail(
        "penetrometer.depth_mm", "the probe would meet the wall at the other end", fmt::format("{}", probe.depth_mm),
        fmt::format("at most {:.6g} mm: the box less {} grains", deepest, grains_ahead), "make the box longer");
  }
  for (int a = 1; a < soil.dimension; ++a) {
    const double widest = soil.box_to_mm[a] - soil.box_from_mm[a] - grains_ahead * soil.d_max_mm;
    if (probe.diameter_mm <= widest) continue;
    origins.fail("penetrometer.diameter_mm", "the probe leaves no room for grains beside it",
                 fmt::format("{}", probe.diameter_mm),
                 fmt::format("at most {:.6g} mm: the box less {} grains", widest, grains_ahead), "make the box wider");
  }
  if (probe.average_from_mm == 0.0) probe.average_from_mm = std::max(probe.depth_mm - 1.0, 0.5 * probe.depth_mm);
  if (probe.average_from_mm >= probe.depth_mm) {
    origins.fail("penetrometer.average_from_mm", "there is nothing to average",
                 fmt::format("{}", probe.average_from_mm), fmt::format("below depth_mm = {}", probe.depth_mm),
                 "average over 1 mm or more");
  }
  if (probe.friction_deg < 0.0) probe.friction_deg = soil.root_friction_deg;
  if (probe.interval_h == 0.0) probe.interval_h = 0.01 * probe.diameter_mm / probe.rate_mm_h;
}

void complete_output(Scene& scene, const Origins& origins) {
  OutputSection& output = scene.output;
  if (output.every_h > scene.scene.duration_h) {
    origins.fail("output.every_h", "the first frame would come after the end", fmt::format("{}", output.every_h),
                 fmt::format("at most duration_h = {}", scene.scene.duration_h), "write frames more often");
  }
  if (output.checkpoint_every_h == 0.0) output.checkpoint_every_h = output.every_h;
}

/// Grains push a root to and fro: there it rests only in the mean, and waking at every push would leave no rest.
void complete_sleep(Scene& scene, const Origins& origins) {
  if (scene.root.base != "clamped") {
    origins.fail("sleep", "a root with a free base has no part that must stay where it is", {}, {},
                 "take [sleep] out, or set root.base = \"clamped\"");
  }
  SleepSection& section = *scene.sleep;
  if (!section.strain_rate_per_h) section.strain_rate_per_h = scene.soil ? 5e-3 : 1e-4;
  if (!section.mean_over_h && scene.soil) section.mean_over_h = 0.1;
  if (!section.stress_change) section.stress_change = scene.soil ? 0.3 : 0.05;
}

}  // namespace

void validate_and_complete(Scene& scene, const Origins& origins) {
  if (scene.scene.name.empty()) {
    scene.scene.name = name_from_file(scene.file);
  } else {
    check_name(scene.scene.name, "scene.name", origins);
  }
  if (scene.root.cells_file.empty()) {
    check_lattice(scene, origins);
  } else {
    check_cells_file(scene, origins);
  }
  if (scene.tissue.G_MPa == 0.0) scene.tissue.G_MPa = scene.tissue.E_axial_MPa / (2 * (1 + scene.tissue.nu_axial));
  if (scene.pressure) check_pressure(*scene.pressure, origins);
  if (scene.response) check_response(scene, origins);
  check_compliance(scene, origins);
  complete_names(scene.obstacles, "obstacle", origins);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) complete_obstacle(scene.obstacles[i], i, scene, origins);
  complete_names(scene.probes, "probe", origins);
  for (std::size_t i = 0; i < scene.probes.size(); ++i) check_probe(scene.probes[i], i, origins);
  if (scene.sleep) complete_sleep(scene, origins);
  if (scene.soil) complete_soil_alone(scene, origins);
  if (scene.soil) check_soil(scene, origins);
  if (scene.penetrometer) complete_penetrometer(scene, origins);
  complete_output(scene, origins);
}

void validate_and_complete_soil(Scene& scene, const Origins& origins) {
  if (scene.scene.name.empty()) scene.scene.name = name_from_file(scene.file);
  if (!scene.soil)
    origins.fail("", "section [soil] is missing", {}, {}, "add it; rootsoil describe soil lists its keys");
  if (!scene.penetrometer) {
    origins.fail("", "section [penetrometer] is missing", {}, {},
                 "add it; rootsoil describe penetrometer lists its keys");
  }
  complete_soil_alone(scene, origins);
  complete_penetrometer(scene, origins);
}

}  // namespace rootsoil
