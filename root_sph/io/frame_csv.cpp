// SPDX-License-Identifier: MIT
#include "root_sph/io/frame_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"

namespace rootsoil {
namespace {

std::vector<std::string> column_titles(const FrameColumn& column) {
  constexpr std::array vector = {"x", "y", "z"};
  constexpr std::array tensor = {"xx", "yy", "zz", "xy", "yz", "xz"};
  if (column.components == 1) return {column.name};
  std::vector<std::string> titles;
  for (std::size_t i = 0; i < static_cast<std::size_t>(column.components); ++i) {
    const std::string suffix = column.components == 3   ? vector[i]
                               : column.components == 6 ? tensor[i]
                                                        : std::to_string(i + 1);
    titles.push_back(column.name + "_" + suffix);
  }
  return titles;
}

}  // namespace

void write_frame_csv(const std::filesystem::path& path, const Frame& frame) {
  std::string text;
  auto out = std::back_inserter(text);
  std::size_t cells = 0;
  for (const FrameColumn& column : frame.columns) {
    for (const std::string& title : column_titles(column)) fmt::format_to(out, "{}{}", text.empty() ? "" : ",", title);
    const std::size_t values = std::visit([](const auto& list) { return list.size(); }, column.values);
    cells = values / static_cast<std::size_t>(column.components);
  }
  text += '\n';
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const char* separator = "";
    for (const FrameColumn& column : frame.columns) {
      const std::size_t width = static_cast<std::size_t>(column.components);
      const auto append = [&](const auto& values) {
        ROOTSOIL_ASSERT(values.size() == cells * width);
        for (std::size_t i = cell * width; i < (cell + 1) * width; ++i) {
          fmt::format_to(out, "{}{}", separator, values[i]);
          separator = ",";
        }
      };
      std::visit(append, column.values);
    }
    text += '\n';
  }
  write_text_atomically(path, text);
}

}  // namespace rootsoil
