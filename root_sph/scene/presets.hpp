// SPDX-License-Identifier: MIT
// What [numerics] accuracy stands for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

std::vector<std::string> preset_names();

/// The numerics of a preset; keys that the scene gives replace its values.
NumericsSection preset(std::string_view accuracy);

/// The step of a root that grows.
struct StepRule {
  double tip_cells_per_step = 0.0;  ///< inertia's share of the stress is of the order of its square
  double longest_step_h = 0.0;
};

StepRule step_rule(std::string_view accuracy);

/// What tools/accuracy_cost.py measured with a preset: a straight 2D root of regular cells, 8 across, that grows and
/// divides for 3 h. Irregular cells add to it.
struct PresetRecord {
  double discretisation_error = 0.0;  ///< rms over cells of the axial strain rate, relative, against the closed form
  double inertia_error = 0.0;         ///< mean; every run measures its own
  double ms_per_cell_hour = 0.0;      ///< processor time for one cell over one simulated hour
};

PresetRecord preset_record(std::string_view accuracy);

}  // namespace rootsoil
