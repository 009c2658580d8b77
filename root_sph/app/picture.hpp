// SPDX-License-Identifier: MIT
// overview.png at the end of a run, drawn by tools/overview.py.
#pragma once

#include <filesystem>
#include <string>

namespace rootsoil {

struct Picture {
  bool drawn = false;
  std::string what_happened;  ///< a sentence
};

/// Draws the picture of a finished run. Never fails the run.
/// \param quiet without the tool's own lines; its errors are shown all the same
Picture draw_picture(const std::filesystem::path& run, bool quiet);

}  // namespace rootsoil
