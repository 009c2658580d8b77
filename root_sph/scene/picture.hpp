// SPDX-License-Identifier: MIT
// overview.png at the end of a run, drawn by tools/overview.py.
#pragma once

#include <filesystem>
#include <string>

namespace rootsoil {

/// Draws the picture of a finished run; returns a sentence about what happened. Never fails the run.
std::string draw_picture(const std::filesystem::path& run);

}  // namespace rootsoil
