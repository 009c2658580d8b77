// SPDX-License-Identifier: MIT
// Tables that users bring: CSV with a header. What is wrong in one is said with file, line and column.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rootsoil {

/// What a table holds, for messages.
struct CsvTable {
  std::vector<std::string_view> columns;  ///< all of them are needed, in any order, with others between
  std::string rows;                       ///< "cells"
  std::string whole_remedy;               ///< for an empty file
  std::string header_remedy;              ///< where columns are missing
  std::string row_remedy;                 ///< where a value is wrong
};

/// Reads the header, then row after row. Values are separated by commas, semicolons or tabs, whichever the header
/// holds most of; numbers have a decimal point, or all have a comma. Empty lines, a byte order mark, CRLF, quotes and
/// spaces around values don't matter, nor do the bytes that stand for the micro sign in a title.
class CsvReader {
 public:
  /// `text` and `table` must outlive the reader; `name` stands for the file in messages.
  CsvReader(std::string_view text, std::string name, const CsvTable& table);

  /// Goes to the next row; false at the end. InputError where there is no row at all, or one is too long.
  bool next_row();
  /// A finite number of the present row; `column` is its index in the table's columns.
  double number(std::size_t column) const;
  int line_number() const { return line_number_; }

  /// InputError about the present line, or about one of its values.
  [[noreturn]] void fail(std::string key, std::string what, std::string given, std::string allowed,
                         std::string remedy) const;
  [[noreturn]] void fail_at(std::size_t column, std::string what, std::string given, std::string allowed) const;
  [[noreturn]] void fail_at(std::size_t column, std::string what, std::string given, std::string allowed,
                            std::string remedy) const;

 private:
  bool next_line();
  void read_header();
  std::string with_decimal_point(std::size_t column, std::string_view text) const;

  std::string_view rest_, line_;
  std::string name_;
  const CsvTable& table_;
  std::vector<std::size_t> place_;        ///< of each of the table's columns in a row
  std::vector<std::string_view> values_;  ///< of the present row
  std::size_t width_ = 0;
  std::size_t rows_ = 0;
  int line_number_ = 0;
  char separator_ = ',';
  mutable char decimal_sign_ = 0;  ///< of the first number that has one
};

/// The titles in the first line that is not empty.
std::vector<std::string> csv_titles(std::string_view text);
/// Is this one among them? Spaces and how the micro sign is written don't matter.
bool holds_title(const std::vector<std::string>& titles, std::string_view wanted);

/// The text of a file that the user names under `key`; InputError where there is none.
std::string read_users_file(const std::filesystem::path& path, const std::string& key, const std::string& allowed);

}  // namespace rootsoil
