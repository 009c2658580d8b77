// SPDX-License-Identifier: MIT
#include "root_sph/scene/presets.hpp"

#include "root_sph/core/errors.hpp"

namespace rootsoil {
namespace {

struct Preset {
  const char* name;
  double eta;
  int window_steps;
  const char* gradient;
};

constexpr Preset presets[] = {
    {"fast", 1.5, 20, "quadratic_at_surface"},
    {"balanced", 1.5, 20, "quadratic_at_surface"},
    {"reference", 1.5, 20, "quadratic_at_surface"},
};

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& p : presets) names.emplace_back(p.name);
  return names;
}

NumericsSection preset(std::string_view accuracy) {
  for (const Preset& p : presets) {
    if (accuracy != p.name) continue;
    NumericsSection numerics;
    numerics.accuracy = p.name;
    numerics.eta = p.eta;
    numerics.window_steps = p.window_steps;
    numerics.gradient = p.gradient;
    return numerics;
  }
  ROOTSOIL_ASSERT(false && "unknown preset");
  return {};
}

}  // namespace rootsoil
