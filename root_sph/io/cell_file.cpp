// SPDX-License-Identifier: MIT
#include "root_sph/io/cell_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/csv_reader.hpp"

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
constexpr double most_slender = 100.0;                // r1/r3; mature cells of real roots: some 30
constexpr double most_times_median = 100.0;           // sizes, volume^(1/3); from meristem to mature xylem: some 15
constexpr double largest_label = 9007199254740992.0;  // 2^53: whole numbers up to here are exact

const CsvTable table{.columns = {column_names.begin(), column_names.end()},
                     .rows = "cells",
                     .whole_remedy = "export the cells again",
                     .header_remedy = "export position, axes and radii of the cells as CSV, in micrometres",
                     .row_remedy = "correct this row, or export the cells again"};

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : csv_(text, name, table), name_(name) {}

  std::vector<MeasuredCell> read() {
    std::vector<MeasuredCell> cells;
    std::unordered_map<std::int64_t, int> line_of_label;
    while (csv_.next_row()) {
      cells.push_back(read_cell());
      const auto [first, is_new] = line_of_label.emplace(cells.back().label, csv_.line_number());
      if (!is_new) {
        csv_.fail_at(label, "two cells have the same label",
                     fmt::format("{}, also in line {}", cells.back().label, first->second), "every label once",
                     "give each cell its own label");
      }
    }
    refuse_out_of_proportion(cells);
    return cells;
  }

 private:
  double number_within(Column column, double lowest, double highest) const {
    const double value = csv_.number(column);
    if (value < lowest || value > highest) {
      csv_.fail_at(column, "out of range", fmt::format("{}", value), fmt::format("{} to {} (um)", lowest, highest),
                   "check that the file is in micrometres");
    }
    return value;
  }

  Vec<3> axis(Column first) const {
    Vec<3> e;
    for (int i = 0; i < 3; ++i) e[i] = csv_.number(first + static_cast<std::size_t>(i));
    const double length = e.stableNorm();
    if (!(std::abs(length - 1.0) <= axis_tolerance)) {
      csv_.fail_at(first, length == 0.0 ? "the axis is zero" : "the axis is not a unit vector",
                   fmt::format("({}, {}, {}), length {}", e[0], e[1], e[2], length),
                   fmt::format("length 1 within {}", axis_tolerance));
    }
    return e / length;
  }

  MeasuredCell read_cell() const {
    MeasuredCell cell;
    cell.line = csv_.line_number();
    const double number_of_label = csv_.number(label);
    if (number_of_label != std::floor(number_of_label) || std::abs(number_of_label) > largest_label) {
      csv_.fail_at(label, "not a whole number", fmt::format("{}", number_of_label), "a whole number up to 2^53");
    }
    cell.label = static_cast<std::int64_t>(number_of_label);
    for (const Column column : {x, y, z}) {
      cell.position_mm[column - x] = mm_per_um * number_within(column, -largest_position_um, largest_position_um);
    }

    const Vec<3> e1 = axis(e1x), e2 = axis(e2x);
    const double cosine = e1.dot(e2);
    if (std::abs(cosine) > axis_tolerance) {
      csv_.fail_at(e2x, "e1 and e2 are not orthogonal", fmt::format("e1.e2 = {}", cosine),
                   fmt::format("0 within {}", axis_tolerance));
    }
    cell.axes.col(0) = e1;
    cell.axes.col(1) = (e2 - cosine * e1).normalized();
    cell.axes.col(2) = e1.cross(cell.axes.col(1));

    for (const Column column : {r1, r2, r3}) {
      const double r = csv_.number(column);
      if (r <= 0.0) csv_.fail_at(column, "a semi-axis must be positive", fmt::format("{}", r), "more than 0");
      cell.semi_axes_mm[column - r1] = mm_per_um * number_within(column, smallest_axis_um, largest_axis_um);
    }
    for (const Column column : {r2, r3}) {
      if (cell.semi_axes_mm[column - r1] > cell.semi_axes_mm[column - r1 - 1]) {
        csv_.fail_at(column, "the semi-axes are not in descending order",
                     fmt::format("r1 = {}, r2 = {}, r3 = {}", csv_.number(r1), csv_.number(r2), csv_.number(r3)),
                     "r1 >= r2 >= r3");
      }
    }
    if (cell.semi_axes_mm[0] > most_slender * cell.semi_axes_mm[2]) {
      csv_.fail_at(r3, "the cell is as thin as a thread or a leaf",
                   fmt::format("r1 = {}, r3 = {}", csv_.number(r1), csv_.number(r3)),
                   fmt::format("r1 at most {} times r3", most_slender));
    }
    return cell;
  }

  /// Specks, which a segmentation leaves behind, and rows in another unit.
  void refuse_out_of_proportion(const std::vector<MeasuredCell>& cells) const {
    std::vector<double> sizes(cells.size());
    std::transform(cells.begin(), cells.end(), sizes.begin(), [](const auto& c) { return std::cbrt(volume_mm3(c)); });
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + std::ssize(sorted) / 2, sorted.end());
    const double median = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (sizes[i] * most_times_median >= median && sizes[i] <= most_times_median * median) continue;
      throw InputError(
          {name_,
           cells[i].line,
           {},
           fmt::format("cell {} is out of proportion", cells[i].label),
           fmt::format("{:.3g} mm large (cube root of its volume), the median cell {:.3g} mm", sizes[i], median),
           fmt::format("up to {} times smaller or larger than the median cell", most_times_median),
           "remove this row if it is a speck or background, or correct its semi-axes"});
    }
  }

  CsvReader csv_;
  const std::string& name_;
};

}  // namespace

std::vector<MeasuredCell> parse_cell_file(std::string_view text, const std::string& name) {
  return Reader(text, name).read();
}

std::vector<MeasuredCell> read_cell_file(const std::filesystem::path& path) {
  return parse_cell_file(read_users_file(path, "root.cells_file", "a CSV file of measured cells"), path.string());
}

Mat<3> shape_matrix(const MeasuredCell& cell) {
  return cell.axes * cell.semi_axes_mm.array().square().inverse().matrix().asDiagonal() * cell.axes.transpose();
}

double volume_mm3(const MeasuredCell& cell) { return 4.0 / 3.0 * std::numbers::pi * cell.semi_axes_mm.prod(); }

}  // namespace rootsoil
