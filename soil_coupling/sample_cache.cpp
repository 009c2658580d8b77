// SPDX-License-Identifier: MIT
#include "soil_coupling/sample_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "root_sph/core/errors.hpp"
#include "soil_coupling/recipe_json.hpp"

namespace rootsoil {

namespace fs = std::filesystem;

fs::path sample_folder() {
  const auto given = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value ? value : "");
  };
  if (fs::path own = given("ROOTSOIL_CACHE"); !own.empty()) return own;
  if (fs::path cache = given("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "rootsoil" / "soil";
  if (fs::path home = given("HOME"); home.is_absolute()) return home / ".cache" / "rootsoil" / "soil";
  return fs::absolute("soil_cache");
}

fs::path ensure_sample(const SoilRecipe& recipe, const SoilProcessOptions& options) {
  const fs::path folder = sample_folder();
  std::error_code error;
  fs::create_directories(folder, error);
  fs::path sample = folder / ("sample_" + digest(packing_key(recipe)) + ".soil");
  if (!error && fs::exists(sample)) return sample;
  // looked at now, and not after minutes of packing
  if (!error && access(folder.c_str(), W_OK | X_OK) != 0) error.assign(errno, std::generic_category());
  if (error) {
    throw FileError(fmt::format("{}: {}", folder.string(), error.message()),
                    "set ROOTSOIL_CACHE to a folder for soil samples");
  }
  SoilProcess process(options);
  const std::string task =
      nlohmann::ordered_json{{"recipe", recipe_json(recipe)}, {"sample", path_code(sample)}}.dump();
  const Packet answer = process.ask({.kind = Kind::pack, .text = task});
  if (options.progress) {
    const auto made = nlohmann::json::parse(process.text_of(answer), nullptr, false);
    if (made.is_object()) {
      options.progress(
          fmt::format("packed {} grains of {:.3g} mm: porosity {:.3f}, {:.2f} contacts a grain; kept as {}",
                      made.value("grains", 0), made.value("d_mean_mm", 0.0), made.value("porosity", 0.0),
                      made.value("coordination", 0.0), sample.string()));
    }
  }
  return sample;
}

}  // namespace rootsoil
