// SPDX-License-Identifier: MIT
#include "root_sph/scene/presets.hpp"

#include <cmath>

#include "root_sph/core/errors.hpp"

namespace rootsoil {
namespace {

struct Preset {
  Accuracy accuracy;
  double eta;
  int window_steps;
  GradientMode gradient;
  StepRule step;
  double force_tolerance;
  PresetRecord measured;  // tests/tools/test_accuracy_cost.py and tests/cli/test_errors.py compare
};

// Presets differ in the step: shorter windows, another eta and the quadratic gradient everywhere gain little in growth
// for their time, and lose in bending or under pressure (docs/accuracy_cost.md). At 0.04 cells a step the tip of the 50
// h main job leaves its axis (docs/decisions/0003): 0.7 um at 50 h, growing as exp(0.13 t).
// clang-format off
constexpr auto edges_quadratic = GradientMode::quadratic_at_surface;
constexpr Preset presets[] = {
    // accuracy            eta  window  gradient         step                            tolerance  measured
    {Accuracy::fast,       1.5, 20,     edges_quadratic, {0.08, 1.0, 0.02, 1e-3, 1.5},   1e-3,      {0.0073, 0.0110, 0.00085, 0.60}},
    {Accuracy::balanced,   1.5, 20,     edges_quadratic, {0.04, 0.5, 0.01, 1e-3, 1.0},   1e-4,      {0.0073, 0.0086, 0.00022, 1.13}},
    {Accuracy::reference,  1.5, 20,     edges_quadratic, {0.02, 0.25, 0.005, 1e-3, 0.5}, 1e-5,      {0.0072, 0.0073, 0.000055, 2.17}},
};
// clang-format on

const Preset& find_preset(Accuracy accuracy) {
  for (const Preset& p : presets) {
    if (accuracy == p.accuracy) return p;
  }
  assertion_failed("there is such a preset", __FILE__, __LINE__);
}

}  // namespace

NumericsSection preset(Accuracy accuracy) {
  const Preset& p = find_preset(accuracy);
  NumericsSection numerics;
  numerics.accuracy = accuracy;
  numerics.eta = p.eta;
  numerics.window_steps = p.window_steps;
  numerics.gradient = p.gradient;
  numerics.force_tolerance = p.force_tolerance;
  return numerics;
}

StepRule step_rule(Accuracy accuracy) { return find_preset(accuracy).step; }

PresetRecord preset_record(Accuracy accuracy) { return find_preset(accuracy).measured; }

double discretisation_error(const NumericsSection& numerics, double cells_across) {
  // docs/accuracy_cost.csv, growth and division with the default's numerics, 4 to 16 cells across: within a tenth of
  // these orders (tests/tools/test_accuracy_cost.py). Below 4 and beyond 16 nothing was measured.
  constexpr double measured_across = 8.0;
  const PresetRecord record = preset_record(numerics.accuracy);
  return numerics.has_inertia() ? record.discretisation_error * std::pow(measured_across / cells_across, 1.4)
                                : record.error_in_balance * std::pow(measured_across / cells_across, 1.2);
}

bool is_coarser_than_measured(double cells_across) {
  constexpr double least = 3.5;  // a lattice fits some tenths of a cell more or fewer
  return cells_across < least;
}

}  // namespace rootsoil
