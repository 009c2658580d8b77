// SPDX-License-Identifier: MIT
// The state of a twin as a file: numbers by name, exact to the last bit.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rootsoil::twins {

using State = std::map<std::string, std::vector<double>>;

/// FileError when it can't be written.
void write_state(const std::filesystem::path& file, const std::string& kind, const State& state);
/// FileError when it is missing, damaged or the state of another kind of soil.
State read_state(const std::filesystem::path& file, const std::string& kind);

}  // namespace rootsoil::twins
