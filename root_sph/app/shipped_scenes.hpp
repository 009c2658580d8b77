// SPDX-License-Identifier: MIT
// Scenes by name: those that come with the program.
#pragma once

#include <filesystem>

namespace rootsoil {

/// The file that a user means: the one of this path, or where there is none the scene of this name that comes with the
/// program (with or without .toml). InputError, with the nearest name and where it looked, where there is neither.
std::filesystem::path find_scene(const std::filesystem::path& given);

}  // namespace rootsoil
