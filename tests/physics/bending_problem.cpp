// SPDX-License-Identifier: MIT
// One beam of the bending tests with choices of the caller's, for tools/accuracy_cost.py. The last line of its output
// is JSON: measured over theoretical value of the part beyond one depth from the clamp, cells, steps, and how far it
// had come to rest.
#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string_view>

#include "bending.hpp"

namespace {

using namespace rootsoil;

/// cantilever: deflection over Timoshenko's; euler: buckling load over Euler's and Engesser's.
std::optional<physics::Ratio> bend(std::string_view problem, int cells_across,
                                   const std::vector<std::string>& overrides) {
  if (problem == "cantilever") return physics::cantilever<2>(cells_across, overrides);
  if (problem == "euler") return physics::buckling<2>(cells_across, overrides);
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const std::vector<std::string> given(argv + 1, argv + argc);
  constexpr int fewest = 3, most = 100;
  const int cells_across = given.size() < 2 ? 0 : std::atoi(given[1].c_str());
  try {
    if (cells_across >= fewest && cells_across <= most) {
      if (const auto ratio = bend(given[0], cells_across, {given.begin() + 2, given.end()})) {
        fmt::print("{{\"ratio\": {}, \"cells\": {}, \"steps\": {}, \"last_change\": {}}}\n", ratio->beam, ratio->cells,
                   ratio->steps, ratio->last_change);
        return 0;
      }
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(error.status());
  }
  fmt::print(stderr, "usage: bending_problem cantilever|euler CELLS_ACROSS({} to {}) [section.key=value]...\n", fewest,
             most);
  return static_cast<int>(ExitStatus::bad_input);
}
