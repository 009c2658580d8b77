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

/// Relative error of the discretisation in space and time at a preset: the tip's way in 2 h of a straight 2D root of regular
/// cells, 8 across, that grows without division, against the closed form (measured; tests/cli/test_errors.py). Case 1's
/// strains are off by 0.0005 at each of them. Division and irregular cells add to it; so does inertia, which
/// every run measures itself.
double discretisation_error(std::string_view accuracy);

}  // namespace rootsoil
