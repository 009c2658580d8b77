// SPDX-License-Identifier: MIT
// What the commands of the program do. Each returns the exit status.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

struct RunOptions {
  std::filesystem::path out;
  int threads = 0;  ///< 0 = as many as OpenMP offers
  bool resume = false;
  std::optional<double> until_h;
  bool quiet = false;
};

/// \param make_soil for scenes with [soil]
int run_scene(const Scene& scene, const RunOptions& options, const SoilMaker& make_soil = {});

/// Says what a run would do and what it would cost, without running.
int check_scene(const Scene& scene, bool json);

/// One row a cell; `time` in hours, or "last".
int export_run(const std::filesystem::path& run, const std::string& time, const std::filesystem::path& csv);

int list_effects(bool json);

}  // namespace rootsoil
