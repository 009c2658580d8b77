// SPDX-License-Identifier: MIT
#include "soil_coupling/twins/twin_state.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "root_sph/core/errors.hpp"

namespace rootsoil::twins {

void write_state(const std::filesystem::path& file, const std::string& kind, const State& state) {
  std::ofstream out(file);
  // the shortest text that reads back as the same number
  out << nlohmann::json{{"soil", kind}, {"state", state}}.dump() << '\n';
  out.close();
  if (!out) throw FileError(fmt::format("{}: the soil's state cannot be written", file.string()));
}

State read_state(const std::filesystem::path& file, const std::string& kind) {
  std::ifstream in(file);
  if (!in) throw FileError(fmt::format("{}: the soil's state cannot be read", file.string()));
  const nlohmann::json read = nlohmann::json::parse(in, nullptr, false);
  const std::string found = read.is_object() ? read.value("soil", "") : "";
  if (found != kind) {
    throw FileError(fmt::format("{}: damaged, or the state of another soil\n  given:   {}\n  allowed: {}",
                                file.string(), found.empty() ? "no state" : found, kind));
  }
  return read.at("state").get<State>();
}

}  // namespace rootsoil::twins
