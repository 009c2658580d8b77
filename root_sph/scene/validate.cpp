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

void complete_output(Scene& scene, const Origins& origins) {
  OutputSection& output = scene.output;
  if (output.every_h > scene.scene.duration_h) {
    origins.fail("output.every_h", "the first frame would come after the end", fmt::format("{}", output.every_h),
                 fmt::format("at most duration_h = {}", scene.scene.duration_h), "write frames more often");
  }
  if (output.checkpoint_every_h == 0.0) output.checkpoint_every_h = output.every_h;
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
  complete_output(scene, origins);
}

}  // namespace rootsoil
