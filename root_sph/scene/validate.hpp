// SPDX-License-Identifier: MIT
// What no single key can be judged by alone: the rules between keys, and the values that follow from others.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

struct Location {
  std::string file;  ///< or "from --set"
  int line = 0;
};

/// Where each section and key ("root", "root.radius_mm", "obstacle[2].name") was read.
class Origins {
 public:
  void add(const std::string& path, Location location) { locations_[path] = std::move(location); }
  bool has(const std::string& path) const { return locations_.count(path) > 0; }
  /// Of the path, or else of the nearest section around it.
  Location of(std::string path) const;

  [[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& given = {},
                         const std::string& allowed = {}, const std::string& remedy = {}) const;

 private:
  std::map<std::string, Location> locations_;
};

/// Throws InputError, or leaves a scene in which every value that others define is filled in.
void validate_and_complete(Scene& scene, const Origins& origins);

/// The same for a scene of which only the soil and the penetrometer count: there need not be a root.
void validate_and_complete_soil(Scene& scene, const Origins& origins);

}  // namespace rootsoil
