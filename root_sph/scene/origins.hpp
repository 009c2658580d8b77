// SPDX-License-Identifier: MIT
// Where each value of a scene was read, for messages.
#pragma once

#include <map>
#include <string>
#include <utility>

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

}  // namespace rootsoil
