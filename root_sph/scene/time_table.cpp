// SPDX-License-Identifier: MIT
#include "root_sph/scene/time_table.hpp"

#include <fmt/format.h>

namespace rootsoil {

double value_at(const Rows& table, double time_h) {
  if (time_h <= table.front()[0]) return table.front()[1];
  for (std::size_t k = 1; k < table.size(); ++k) {
    const auto& [t0, v0] = table[k - 1];
    const auto& [t1, v1] = table[k];
    if (time_h < t1) return v0 + (v1 - v0) * (time_h - t0) / (t1 - t0);
  }
  return table.back()[1];
}

void check_times(const Rows& table, const std::string& key, const Origins& origins, const std::string& what) {
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (table[i - 1][0] < table[i][0]) continue;
    origins.fail(key, fmt::format("the {}s do not increase", what),
                 fmt::format("{} after {}", table[i][0], table[i - 1][0]), fmt::format("increasing {}s", what),
                 fmt::format("sort the rows, and give each {} once", what));
  }
}

}  // namespace rootsoil
