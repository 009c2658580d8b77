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

}  // namespace rootsoil
