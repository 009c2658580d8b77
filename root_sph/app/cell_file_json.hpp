// SPDX-License-Identifier: MIT
// What was found in a cell file, for summary.json and `check --json`.
#pragma once

#include <nlohmann/json.hpp>

#include "root_sph/model/measured_root.hpp"

namespace rootsoil {

inline nlohmann::ordered_json measured_numbers(const MeasuredRootReport& report) {
  nlohmann::ordered_json merged = nlohmann::ordered_json::array();
  for (const Merged& speck : report.merged) {
    merged.push_back({{"label", speck.label}, {"line", speck.line}, {"into", speck.into}});
  }
  const auto three = [](const Vec<3>& v) { return std::vector<double>{v[0], v[1], v[2]}; };
  return {{"cells", report.cells_in_file},         {"extent_mm", three(report.extent_mm)},
          {"tip_axis", report.tip_axis},           {"tip_found", report.tip_found},
          {"axis", three(report.tip_direction)},   {"lean_deg", report.lean_deg},
          {"smallest_mm", report.smallest_mm},     {"median_mm", report.median_mm},
          {"largest_mm", report.largest_mm},       {"most_slender", report.most_slender},
          {"cells_mm3", report.cells_mm3},         {"hull_mm3", report.hull_mm3},
          {"merged_specks", report.merged.size()}, {"merged", merged}};
}

}  // namespace rootsoil
