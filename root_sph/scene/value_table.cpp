// SPDX-License-Identifier: MIT
#include "root_sph/scene/value_table.hpp"

#include <fmt/format.h>

namespace rootsoil {

double value_at(const Rows& table, double x) {
  if (x <= table.front()[0]) return table.front()[1];
  for (std::size_t k = 1; k < table.size(); ++k) {
    const auto& [x0, v0] = table[k - 1];
    const auto& [x1, v1] = table[k];
    if (x < x1) return v0 + (v1 - v0) * (x - x0) / (x1 - x0);
  }
  return table.back()[1];
}

void check_increasing(const Rows& table, const std::string& key, const std::string& name, const Origins& origins) {
  if (!table.empty() && table.front()[0] < 0.0) {
    origins.fail(key, fmt::format("the {} begin below 0", name), fmt::format("{}", table.front()[0]), name + " from 0",
                 "begin with the value at 0");
  }
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (table[i - 1][0] < table[i][0]) continue;
    origins.fail(key, fmt::format("the {} do not increase", name),
                 fmt::format("{} after {}", table[i][0], table[i - 1][0]), "increasing " + name,
                 "sort the rows, and give each of them once");
  }
}

}  // namespace rootsoil
