// SPDX-License-Identifier: MIT
// Cells, and tables beside them, at one time: named columns ready to be written.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace rootsoil {

struct FrameColumn {
  std::string name;
  std::string unit;
  std::string meaning;
  int components = 1;  ///< 1 scalar; 3 vector or cell axes; 6 symmetric tensor (xx yy zz xy yz xz)
  std::variant<std::vector<double>, std::vector<std::int64_t>> values;  ///< cell by cell, cells * components
};

/// A table beside the cells: points, as surface markers or grains, with a column "position"; or, without one, a profile
/// along the root.
struct FrameTable {
  std::string name;
  std::vector<FrameColumn> columns;  ///< all with the same number of rows
};

struct Frame {
  double time_h = 0.0;
  std::int64_t step = 0;
  std::vector<FrameColumn> columns;  ///< all with the same number of cells
  std::vector<FrameTable> tables = {};
};

}  // namespace rootsoil
