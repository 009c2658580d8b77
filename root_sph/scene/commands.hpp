// SPDX-License-Identifier: MIT
// What the commands of the program do. Each returns the exit status.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "root_sph/effects/soil_contact.hpp"
#include "root_sph/exchange/soil_recipe.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

struct RunOptions {
  std::filesystem::path out;
  int threads = 0;  ///< 0 = as many as OpenMP offers
  bool resume = false;
  std::optional<double> until_h;
  bool quiet = false;
};

/// A soil and how the root is coupled to it.
struct Soil {
  std::unique_ptr<SoilPort> port;  ///< none: the scene has no soil
  SoilContactParameters contact;
};
/// Makes the soil of a scene, told about the root. The program hands it in, since root_sph knows no soil.
using SoilMaker = std::function<Soil(const Scene&, const SoilStart&)>;

int run_scene(const Scene& scene, const RunOptions& options, const SoilMaker& make_soil = {});

/// Says what a run would do and what it would cost, without running.
int check_scene(const Scene& scene, bool json);

/// One row a cell; `time` in hours, or "last".
int export_run(const std::filesystem::path& run, const std::string& time, const std::filesystem::path& csv);

int list_effects(bool json);

}  // namespace rootsoil
