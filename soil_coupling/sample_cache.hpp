// SPDX-License-Identifier: MIT
// Packed samples are kept and used again: one file a recipe, named by the recipe's digest.
#pragma once

#include <filesystem>

#include "root_sph/exchange/soil_recipe.hpp"
#include "soil_coupling/soil_process.hpp"

namespace rootsoil {

/// $ROOTSOIL_CACHE, or rootsoil/soil in the user's cache folder ($XDG_CACHE_HOME, ~/.cache); without a home
/// ./soil_cache.
std::filesystem::path sample_folder();

/// The sample's file; packs it, in a process of its own, where it is not there yet.
std::filesystem::path ensure_sample(const SoilRecipe& recipe, const SoilProcessOptions& options);

}  // namespace rootsoil
