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
  double discretisation_error;
};

constexpr Preset presets[] = {
    {"fast", 1.5, 20, "quadratic_at_surface", 0.006},
    {"balanced", 1.5, 20, "quadratic_at_surface", 0.006},
    {"reference", 1.5, 20, "quadratic_at_surface", 0.006},
};

const Preset& find_preset(std::string_view accuracy) {
  for (const Preset& p : presets) {
    if (accuracy == p.name) return p;
  }
  assertion_failed("there is such a preset", __FILE__, __LINE__);
}

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& p : presets) names.emplace_back(p.name);
  return names;
}

NumericsSection preset(std::string_view accuracy) {
  const Preset& p = find_preset(accuracy);
  NumericsSection numerics;
  numerics.accuracy = p.name;
  numerics.eta = p.eta;
  numerics.window_steps = p.window_steps;
  numerics.gradient = p.gradient;
  return numerics;
}

double discretisation_error(std::string_view accuracy) { return find_preset(accuracy).discretisation_error; }

}  // namespace rootsoil
