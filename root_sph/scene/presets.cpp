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
  StepRule step;
  PresetRecord measured;  // in docs/accuracy_cost.csv; tests/tools/test_accuracy_cost.py compares
};

// Presets differ in the step: shorter windows, another eta and the quadratic gradient everywhere gain little in growth
// for their time, and lose in bending or under pressure (docs/accuracy_cost.md). At 0.04 cells a step the tip of the 50
// h main job leaves its axis (docs/decisions/0003): 0.7 um at 50 h, growing as exp(0.13 t).
constexpr Preset presets[] = {
    {"fast", 1.5, 20, "quadratic_at_surface", {0.02, 1e-3}, {0.0075, 0.0019, 0.46}},
    {"balanced", 1.5, 20, "quadratic_at_surface", {0.01, 1e-3}, {0.0072, 0.00013, 0.75}},
    {"reference", 1.5, 20, "quadratic_at_surface", {0.005, 1e-3}, {0.0072, 0.00031, 1.48}},
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

StepRule step_rule(std::string_view accuracy) { return find_preset(accuracy).step; }

PresetRecord preset_record(std::string_view accuracy) { return find_preset(accuracy).measured; }

}  // namespace rootsoil
