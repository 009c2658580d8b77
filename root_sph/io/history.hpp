// SPDX-License-Identifier: MIT
// history.csv: a row of numbers per output time, on the disk as soon as append() returns.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rootsoil {

class HistoryWriter {
 public:
  /// The first column is the time. With continue_from_h, the rows that are there stay, except those later than
  /// that time and one cut off in the middle.
  HistoryWriter(std::filesystem::path path, const std::vector<std::string>& columns,
                std::optional<double> continue_from_h = {});
  HistoryWriter(const HistoryWriter&) = delete;
  HistoryWriter& operator=(const HistoryWriter&) = delete;
  ~HistoryWriter();

  /// One number per column, written with as many digits as reading it back exactly takes. What is not a number (not
  /// known yet, or of no cell) is left empty.
  void append(std::span<const double> values);

 private:
  std::filesystem::path path_;
  std::size_t columns_;
  int file_ = -1;
};

}  // namespace rootsoil
