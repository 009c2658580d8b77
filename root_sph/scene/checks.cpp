// SPDX-License-Identifier: MIT
#include "root_sph/scene/checks.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace rootsoil {
namespace {

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

/// The compliance matrix is positive definite where 0 < E_R < this.
double largest_radial_modulus_MPa(const TissueSection& tissue, int dimension) {
  const double nu2 = tissue.nu_axial * tissue.nu_axial;
  return dimension == 2 ? tissue.E_axial_MPa / nu2 : tissue.E_axial_MPa * (1 - tissue.nu_radial) / (2 * nu2);
}

}  // namespace

void check_name(const std::string& name, const std::string& path, const Origins& origins) {
  if (std::all_of(name.begin(), name.end(), is_name_character) && name.front() != '.') return;
  origins.fail(path, "this name cannot be the name of a folder or a column", toml_text(name),
               "letters, digits, _ - and dot, not beginning with a dot");
}

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

std::string existing_file(const Scene& scene, const std::string& key, const std::string& given) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path path = fs::absolute(fs::path(scene.file).parent_path() / given, error).lexically_normal();
  if (error || !fs::is_regular_file(path, error)) {
    scene.origins.fail(key, "there is no such file", toml_text(given), {},
                       fmt::format("looked for {}; the path starts from the scene file's folder", path.string()));
  }
  return path.string();
}

void check_compliance(const Scene& scene, const std::vector<double>& E_radial_MPa) {
  const double largest = largest_radial_modulus_MPa(scene.tissue, scene.scene.dimension);
  for (const double modulus : E_radial_MPa) {
    if (modulus > 0 && modulus < largest) continue;
    scene.origins.fail(modulus > 0 ? "tissue.nu_axial" : "tissue.anisotropy",
                       fmt::format("the compliance matrix is not positive definite where E_R = {:.6g} MPa", modulus),
                       scene.scene.dimension == 2 ? fmt::format("nu_axial = {}", scene.tissue.nu_axial)
                                                  : fmt::format("nu_axial = {}, nu_radial = {}", scene.tissue.nu_axial,
                                                                scene.tissue.nu_radial),
                       fmt::format("E_R above 0 and below {:.6g} MPa with these Poisson ratios", largest),
                       modulus > 0 ? "lower nu_axial or the radial modulus" : "raise c_e: Eq. 6 makes E_R negative");
  }
}

}  // namespace rootsoil
