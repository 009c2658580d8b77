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

/// The relative error of the discretisation at a preset: the largest of Case 1's strains (Eq. 8) and the tip speed of a
/// growing root, both against closed forms on straight roots of regular cells, measured (docs/decisions/0003). What
/// inertia adds is measured in every run.
double discretisation_error(std::string_view accuracy);

}  // namespace rootsoil
