// SPDX-License-Identifier: MIT
// Grains that the user lists in a file instead of having them packed.
#pragma once

#include <vector>

#include "root_sph/exchange/soil_recipe.hpp"

namespace rootsoil {

inline constexpr double most_grains = 1e6;

/// Every row of soil.grains_file: a grain of the soil's size, in its plane (2D) and box, that no other one overlaps too
/// far. InputError names file, line and column. The box and the diameters must have been validated.
std::vector<SoilGrain> read_listed_grains(const SoilRecipe& soil);

}  // namespace rootsoil
