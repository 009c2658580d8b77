// SPDX-License-Identifier: MIT
#include "root_sph/app/shipped_scenes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/schema.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

/// Names without .toml, sorted. Empty where the folder is not there: the message then says only where it looked.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code trouble;
  for (const auto& entry : fs::directory_iterator(folder, trouble)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

fs::path find_scene(const fs::path& given) {
  const fs::path shipped = ROOTSOIL_SCENES_DIR;
  std::error_code trouble;
  if (fs::exists(given, trouble) && !fs::is_directory(given, trouble)) return given;
  const std::string name = given.extension() == ".toml" ? given.stem().string() : given.filename().string();
  const std::vector<std::string> names = names_in(shipped);
  // a path that leads somewhere is no name
  if (!given.has_parent_path() && std::find(names.begin(), names.end(), name) != names.end()) {
    return shipped / (name + ".toml");
  }
  if (fs::is_directory(given, trouble)) return given;  // whoever reads it says that it is a folder
  throw InputError(
      {.file = given.string(),
       .line = 0,
       .key = {},
       .what = "there is no such scene file",
       .given = {},
       .allowed = fmt::format("a file, or the name of a scene in {}: {}", shipped.string(), fmt::join(names, ", ")),
       .remedy = names.empty() ? "check the path"
                               : fmt::format("check the path, or did you mean {}?", nearest(name, names))});
}

}  // namespace rootsoil
