// SPDX-License-Identifier: MIT
// A recipe as the driver reads it, and the part of it that a packed sample depends on.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "root_sph/exchange/soil_recipe.hpp"

namespace rootsoil {

/// Every value of the recipe, with the names of SoilRecipe; `packing_key` is added.
nlohmann::ordered_json recipe_json(const SoilRecipe& recipe);

/// What a sample depends on, as text: equal keys, equal samples.
std::string packing_key(const SoilRecipe& recipe);

/// A path's bytes as hexadecimal digits: JSON is UTF-8, names of files may be anything.
std::string path_code(const std::filesystem::path& path);

/// 16 hexadecimal digits (FNV-1a) of a text.
std::string digest(const std::string& text);

}  // namespace rootsoil
