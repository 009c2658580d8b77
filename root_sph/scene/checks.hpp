// SPDX-License-Identifier: MIT
// Checks that sections share. Each throws an InputError that names file, line and key.
#pragma once

#include <fmt/format.h>

#include <set>
#include <string>
#include <vector>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// Names become names of folders and columns.
void check_name(const std::string& name, const std::string& path, const Origins& origins);

/// Exactly one of two keys of a section must be given.
void check_one_of(const std::string& element, const char* a, const char* b, const Origins& origins);

/// Absolute path of a file that a scene names relative to itself, so that the resolved scene works from the run's
/// folder.
std::string existing_file(const Scene& scene, const std::string& key, const std::string& given);

/// The compliance matrix (Eq. 4; 2D: docs/physics.md 3) must be positive definite for each of these radial moduli, MPa.
void check_compliance(const Scene& scene, const std::vector<double>& E_radial_MPa);

/// Fills in names that are left out ("probe_2"), and checks the others.
template <class Element>
void complete_names(std::vector<Element>& elements, const std::string& section, const Origins& origins) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    std::string& name = elements[i].name;
    const std::string path = fmt::format("{}[{}].name", section, i + 1);
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

}  // namespace rootsoil
