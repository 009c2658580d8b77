// SPDX-License-Identifier: MIT
#include "root_sph/io/cell_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"

namespace rootsoil {
namespace {

enum Column : std::size_t { label, x, y, z, e1x, e1y, e1z, e2x, e2y, e2z, r1, r2, r3, column_count };

constexpr std::array<std::string_view, column_count> column_names = {
    "Label", "pos.X (um)", "pos.Y (um)", "pos.Z (um)", "e1.X",    "e1.Y",   "e1.Z",
    "e2.X",  "e2.Y",       "e2.Z",       "r1 (um)",    "r2 (um)", "r3 (um)"};

constexpr double mm_per_um = 1e-3;
constexpr double axis_tolerance = 1e-2;      // of |e| - 1 and of e1.e2: files are rounded to a few digits
constexpr double largest_position_um = 1e7;  // beyond 10 m and outside these lengths the unit is not um
constexpr double smallest_axis_um = 1e-3;
constexpr double largest_axis_um = 1e5;
constexpr double largest_label = 9007199254740992.0;  // 2^53: whole numbers up to here are exact

// The CSV libraries at hand (Fast C++ CSV Parser, libcsv) want column titles byte by byte as expected or leave
// lines uncounted. Titles with any bytes for the micro sign, a list of all missing ones, and line numbers need
// the header taken apart here; splitting the rows in the same way is then all that is left.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> values;
  while (true) {
    const std::size_t first = line.find_first_not_of(" \t");
    const bool quoted = first != std::string_view::npos && line[first] == '"';
    const std::size_t closing = quoted ? line.find('"', first + 1) : 0;
    const std::size_t comma = closing == std::string_view::npos ? closing : line.find(',', closing);
    std::string_view value = line.substr(0, comma);
    const auto is_padding = [](char c) { return c == ' ' || c == '\t' || c == '"'; };
    while (!value.empty() && is_padding(value.front())) value.remove_prefix(1);
    while (!value.empty() && is_padding(value.back())) value.remove_suffix(1);
    values.push_back(value);
    if (comma == std::string_view::npos) return values;
    line.remove_prefix(comma + 1);
  }
}

// "pos.X (?m)" with any bytes but a letter or digit for "?" becomes "pos.X(um)", spaces aside; "(mm)" stays.
std::string plain_title(std::string_view title) {
  std::string plain;
  for (const char c : title) {
    if (c != ' ' && c != '\t') plain += c;
  }
  const auto is_alphanumeric = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const std::size_t open = plain.find('(');
  if (open == std::string::npos || !plain.ends_with("m)")) return plain;
  const std::string_view sign = std::string_view(plain).substr(open + 1, plain.size() - open - 3);
  if (sign.empty() || std::any_of(sign.begin(), sign.end(), is_alphanumeric)) return plain;
  return plain.substr(0, open) + "(um)";
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : rest_(text), name_(name) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  std::vector<MeasuredCell> read() {
    read_header();
    std::vector<MeasuredCell> cells;
    std::unordered_map<std::int64_t, int> line_of_label;
    while (next_line()) {
      cells.push_back(read_cell());
      const auto [first, is_new] = line_of_label.emplace(cells.back().label, line_number_);
      if (!is_new) {
        fail_at(label, "two cells have the same label",
                fmt::format("{}, also in line {}", cells.back().label, first->second), "every label once",
                "give each cell its own label");
      }
    }
    if (cells.empty()) {
      line_number_ = 0;
      fail({}, "the file holds no cells", "a header and no rows", "one row or more", "export the cells again");
    }
    return cells;
  }

 private:
  [[noreturn]] void fail(std::string key, std::string what, std::string given, std::string allowed,
                         std::string remedy) const {
    throw InputError({name_, line_number_, std::move(key), std::move(what), std::move(given), std::move(allowed),
                      std::move(remedy)});
  }
  [[noreturn]] void fail_at(Column column, std::string what, std::string given, std::string allowed,
                            std::string remedy = "correct this row, or export the cells again") const {
    fail(fmt::format("column '{}'", column_names[column]), std::move(what), std::move(given), std::move(allowed),
         std::move(remedy));
  }

  // Skips empty lines; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_number_;
      if (line_.ends_with('\r')) line_.remove_suffix(1);
      if (line_.find_first_not_of(" \t\r") != std::string_view::npos) return true;
    }
    return false;
  }

  void read_header() {
    if (!next_line()) {
      line_number_ = 0;
      fail({}, "the file is empty", {}, fmt::format("a header: {}", fmt::join(column_names, ", ")),
           "export the cells again");
    }
    const std::vector<std::string_view> titles = split(line_);
    width_ = titles.size();
    std::vector<std::string_view> missing;
    for (std::size_t column = 0; column < column_count; ++column) {
      const std::string wanted = plain_title(column_names[column]);
      const auto is_wanted = [&](std::string_view title) { return plain_title(title) == wanted; };
      const auto found = std::find_if(titles.begin(), titles.end(), is_wanted);
      if (found == titles.end()) {
        missing.push_back(column_names[column]);
        continue;
      }
      if (std::find_if(found + 1, titles.end(), is_wanted) != titles.end()) {
        fail_at(static_cast<Column>(column), "the column is there twice", printable(line_), "every column once",
                "remove one of them");
      }
      place_[column] = static_cast<std::size_t>(found - titles.begin());
    }
    if (!missing.empty()) {
      fail({}, fmt::format("columns are missing: {}", fmt::join(missing, ", ")), printable(line_),
           fmt::format("a header with {}, separated by commas, in any order", fmt::join(column_names, ", ")),
           "export position, axes and radii of the cells as CSV, in micrometres");
    }
  }

  // For messages: broken bytes would break the terminal or the log as well.
  static std::string printable(std::string_view text) {
    constexpr std::size_t longest = 200;
    std::string plain(text.substr(0, longest));
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return plain + (text.size() > longest ? "..." : "");
  }

  double number(const std::vector<std::string_view>& values, Column column) const {
    if (place_[column] >= values.size() || values[place_[column]].empty()) {
      fail_at(column, "the value is missing", fmt::format("a row of {} values", values.size()),
              fmt::format("{} values, as in the header", width_));
    }
    std::string_view text = values[place_[column]];
    const std::string given = printable(text);
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) {
      fail_at(column, "not a number", given, "a number such as 12.5 or 1.25e1");
    }
    if (error == std::errc::result_out_of_range || !std::isfinite(value)) {
      fail_at(column, "not a finite number, or beyond what a number can hold", given, "a finite number");
    }
    return value;
  }

  double number_within(const std::vector<std::string_view>& values, Column column, double lowest,
                       double highest) const {
    const double value = number(values, column);
    if (value < lowest || value > highest) {
      fail_at(column, "out of range", fmt::format("{}", value), fmt::format("{} to {} (um)", lowest, highest),
              "check that the file is in micrometres");
    }
    return value;
  }

  Vec<3> axis(const std::vector<std::string_view>& values, Column first) const {
    Vec<3> e;
    for (int i = 0; i < 3; ++i) e[i] = number(values, static_cast<Column>(first + i));
    const double length = e.stableNorm();
    if (!(std::abs(length - 1.0) <= axis_tolerance)) {
      fail_at(first, length == 0.0 ? "the axis is zero" : "the axis is not a unit vector",
              fmt::format("({}, {}, {}), length {}", e[0], e[1], e[2], length),
              fmt::format("length 1 within {}", axis_tolerance));
    }
    return e / length;
  }

  MeasuredCell read_cell() const {
    const std::vector<std::string_view> values = split(line_);
    if (std::any_of(values.begin() + static_cast<std::ptrdiff_t>(std::min(width_, values.size())), values.end(),
                    [](std::string_view value) { return !value.empty(); })) {
      fail({}, "the row has more values than the header has columns", fmt::format("{} values", values.size()),
           fmt::format("{} values", width_), "write numbers with a decimal point, not a comma");
    }
    MeasuredCell cell;
    const double number_of_label = number(values, label);
    if (number_of_label != std::floor(number_of_label) || std::abs(number_of_label) > largest_label) {
      fail_at(label, "not a whole number", fmt::format("{}", number_of_label), "a whole number up to 2^53");
    }
    cell.label = static_cast<std::int64_t>(number_of_label);
    for (const Column column : {x, y, z}) {
      cell.position_mm[column - x] =
          mm_per_um * number_within(values, column, -largest_position_um, largest_position_um);
    }

    const Vec<3> e1 = axis(values, e1x), e2 = axis(values, e2x);
    const double cosine = e1.dot(e2);
    if (std::abs(cosine) > axis_tolerance) {
      fail_at(e2x, "e1 and e2 are not orthogonal", fmt::format("e1.e2 = {}", cosine),
              fmt::format("0 within {}", axis_tolerance));
    }
    cell.axes.col(0) = e1;
    cell.axes.col(1) = (e2 - cosine * e1).normalized();
    cell.axes.col(2) = e1.cross(cell.axes.col(1));

    for (const Column column : {r1, r2, r3}) {
      const double r = number(values, column);
      if (r <= 0.0) fail_at(column, "a semi-axis must be positive", fmt::format("{}", r), "more than 0");
      cell.semi_axes_mm[column - r1] = mm_per_um * number_within(values, column, smallest_axis_um, largest_axis_um);
    }
    for (const Column column : {r2, r3}) {
      if (cell.semi_axes_mm[column - r1] > cell.semi_axes_mm[column - r1 - 1]) {
        fail_at(column, "the semi-axes are not in descending order",
                fmt::format("r1 = {}, r2 = {}, r3 = {}", number(values, r1), number(values, r2), number(values, r3)),
                "r1 >= r2 >= r3");
      }
    }
    return cell;
  }

  std::string_view rest_, line_;
  const std::string& name_;
  int line_number_ = 0;
  std::size_t width_ = 0;
  std::array<std::size_t, column_count> place_{};
};

}  // namespace

std::vector<MeasuredCell> parse_cell_file(std::string_view text, const std::string& name) {
  return Reader(text, name).read();
}

std::vector<MeasuredCell> read_cell_file(const std::filesystem::path& path) {
  std::error_code trouble;
  if (!std::filesystem::is_regular_file(path, trouble)) {
    throw InputError({.file = path.string(),
                      .key = "root.cells_file",
                      .what = "there is no such file",
                      .given = path.string(),
                      .allowed = "a CSV file of measured cells",
                      .remedy = "correct the path; a relative one starts at the scene file's folder"});
  }
  return parse_cell_file(read_whole_file(path), path.string());
}

Mat<3> shape_matrix(const MeasuredCell& cell) {
  return cell.axes * cell.semi_axes_mm.array().square().inverse().matrix().asDiagonal() * cell.axes.transpose();
}

double volume_mm3(const MeasuredCell& cell) { return 4.0 / 3.0 * std::numbers::pi * cell.semi_axes_mm.prod(); }

}  // namespace rootsoil
