// SPDX-License-Identifier: MIT
#include "root_sph/io/cell_file.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/csv_reader.hpp"

namespace rootsoil {
namespace {

using Titles = std::vector<std::string>;

constexpr double um_per_mm = 1e3;
constexpr double axis_tolerance = 1e-2;      // of |e| - 1 and of e1.e2: files are rounded to a few digits
constexpr double largest_position_um = 1e7;  // beyond 10 m and outside these lengths the unit is another one
constexpr double smallest_axis_um = 1e-3;
constexpr double largest_axis_um = 1e5;
constexpr double most_slender = 100.0;                // r1/r3; mature cells of real roots: some 30
constexpr double most_times_median = 100.0;           // sizes, volume^(1/3); from meristem to mature xylem: some 15
constexpr double largest_label = 9007199254740992.0;  // 2^53: whole numbers up to here are exact

double mm_in(LengthUnit unit) { return unit == LengthUnit::mm ? 1.0 : unit == LengthUnit::um ? 1e-3 : 1e-6; }

const char* plural(LengthUnit unit) {
  return unit == LengthUnit::mm ? "millimetres" : unit == LengthUnit::um ? "micrometres" : "nanometres";
}

std::optional<LengthUnit> unit_in(std::string_view title) {
  for (const auto& [unit, name] : enum_names<LengthUnit>) {
    if (holds_title({std::string(title)}, std::string(title.substr(0, title.find('('))) + fmt::format("({})", name))) {
      return unit;
    }
  }
  return std::nullopt;
}

/// How the file says what a cell's shape is.
enum class Shape { axes, inertia, ball };

/// The titles of the columns to read.
struct Layout {
  Titles titles;
  Shape shape = Shape::axes;
  bool diameters = false;
  std::size_t label = 0, position = 0, e1 = 0, e2 = 0, semi_axes = 0, inertia = 0;  ///< where they begin in titles
  std::optional<std::size_t> volume;

  std::size_t add(const Titles& more) {
    titles.insert(titles.end(), more.begin(), more.end());
    return titles.size() - more.size();
  }
};

/// "pos.X" as "pos.X (mm)" if the file has it so, as "pos.X (um)" if it does not have it at all.
Titles with_units(const Titles& held, const Titles& stems) {
  Titles titles;
  for (const std::string& stem : stems) {
    titles.push_back(stem + " (um)");
    for (const std::string& other : {stem + " (mm)", stem + " (nm)", stem}) {
      if (!holds_title(held, titles.back()) && holds_title(held, other)) titles.back() = other;
    }
  }
  return titles;
}

Layout layout_of(std::string_view text, const CellColumns& columns) {
  const Titles held = csv_titles(text);
  const auto given_or = [](const Titles& given, const Titles& otherwise) { return given.empty() ? otherwise : given; };
  const bool regionprops = holds_title(held, "centroid-0");
  Layout layout;
  layout.label = layout.add({!columns.label.empty()                                      ? columns.label
                             : holds_title(held, "label") && !holds_title(held, "Label") ? "label"
                                                                                         : "Label"});
  layout.position = layout.add(given_or(columns.position, regionprops ? Titles{"centroid-0", "centroid-1", "centroid-2"}
                                                                      : with_units(held, {"pos.X", "pos.Y", "pos.Z"})));
  const bool axes_given = !columns.semi_axes.empty() || !columns.diameters.empty() || !columns.e1.empty();
  if (!columns.inertia.empty() || (!axes_given && holds_title(held, "inertia_tensor-0-0"))) {
    layout.shape = Shape::inertia;
    layout.inertia =
        layout.add(given_or(columns.inertia, {"inertia_tensor-0-0", "inertia_tensor-0-1", "inertia_tensor-0-2",
                                              "inertia_tensor-1-1", "inertia_tensor-1-2", "inertia_tensor-2-2"}));
  } else if (!axes_given && !columns.volume.empty() && !holds_title(held, "e1.X")) {
    layout.shape = Shape::ball;
  } else {
    layout.e1 = layout.add(given_or(columns.e1, {"e1.X", "e1.Y", "e1.Z"}));
    layout.e2 = layout.add(given_or(columns.e2, {"e2.X", "e2.Y", "e2.Z"}));
    layout.diameters = !columns.diameters.empty();
    layout.semi_axes = layout.add(layout.diameters ? columns.diameters
                                                   : given_or(columns.semi_axes, with_units(held, {"r1", "r2", "r3"})));
  }
  if (!columns.volume.empty()) {
    layout.volume = layout.add({columns.volume});
  } else if (regionprops && holds_title(held, "area")) {
    layout.volume = layout.add({"area"});  // regionprops's word for the volume of a body in space
  }
  return layout;
}

CsvTable table_of(const Layout& layout) {
  return {.columns = {layout.titles.begin(), layout.titles.end()},
          .rows = "cells",
          .whole_remedy = "export the cells again",
          .header_remedy =
              "export position, axes and radii of the cells as CSV, in micrometres, or say in "
              "[root.columns] what the columns are called",
          .row_remedy = "correct this row, or export the cells again"};
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, const CellColumns& columns)
      : layout_(layout_of(text, columns)), table_(table_of(layout_)), csv_(text, name, table_), name_(name) {
    for (std::size_t column = 0; column < layout_.titles.size(); ++column) {
      units_.push_back(has_unit(column) ? unit_of(column, columns.unit) : LengthUnit::mm);
    }
  }

  std::vector<MeasuredCell> read() {
    std::vector<MeasuredCell> cells;
    std::unordered_map<std::int64_t, int> line_of_label;
    while (csv_.next_row()) {
      cells.push_back(read_cell());
      const auto [first, is_new] = line_of_label.emplace(cells.back().label, csv_.line_number());
      if (!is_new) {
        csv_.fail_at(layout_.label, "two cells have the same label",
                     fmt::format("{}, also in line {}", cells.back().label, first->second), "every label once",
                     "give each cell its own label");
      }
    }
    refuse_out_of_proportion(cells);
    return cells;
  }

 private:
  bool has_unit(std::size_t column) const {
    const bool axis = layout_.shape == Shape::axes && column >= layout_.e1 && column < layout_.e1 + 6;
    return column != layout_.label && !axis;
  }

  LengthUnit unit_of(std::size_t column, const std::optional<LengthUnit>& given) const {
    const std::optional<LengthUnit> titled = unit_in(layout_.titles[column]);
    if (titled && given && *titled != *given) {
      csv_.fail_at(column, "the title names another unit than root.columns.unit", layout_.titles[column],
                   fmt::format("the unit {}", name_of(*given)), "correct one of them");
    }
    if (!titled && !given) {
      csv_.fail_at(column, "the unit of this column is not known", layout_.titles[column],
                   "a title with (mm), (um) or (nm), or a unit in the scene",
                   "give the unit in the scene file: [root.columns] with unit = \"um\", \"mm\" or \"nm\"");
    }
    return titled ? *titled : *given;
  }

  double mm(std::size_t column) const { return mm_in(units_[column]); }

  /// A length, mm.
  double length_within(std::size_t column, double lowest_um, double highest_um, double factor = 1.0) const {
    const double value = csv_.number(column);
    const double length_mm = factor * mm(column) * value;
    if (!(length_mm * um_per_mm >= lowest_um && length_mm * um_per_mm <= highest_um)) {
      csv_.fail_at(column, "out of range", fmt::format("{}", value), fmt::format("{} to {} um", lowest_um, highest_um),
                   fmt::format("check that the column is in {}", plural(units_[column])));
    }
    return length_mm;
  }

  Vec<3> axis(std::size_t first) const {
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
    const double number_of_label = csv_.number(layout_.label);
    if (number_of_label != std::floor(number_of_label) || std::abs(number_of_label) > largest_label) {
      csv_.fail_at(layout_.label, "not a whole number", fmt::format("{}", number_of_label),
                   "a whole number up to 2^53");
    }
    cell.label = static_cast<std::int64_t>(number_of_label);
    for (std::size_t i = 0; i < 3; ++i) {
      cell.position_mm[static_cast<int>(i)] =
          length_within(layout_.position + i, -largest_position_um, largest_position_um);
    }
    if (layout_.shape == Shape::axes) read_axes(cell);
    if (layout_.shape == Shape::inertia) read_inertia(cell);
    if (layout_.shape == Shape::ball) {
      cell.semi_axes_mm.setConstant(std::cbrt(volume_mm3() * 3.0 / (4.0 * std::numbers::pi)));
    }
    if (cell.semi_axes_mm[0] > most_slender * cell.semi_axes_mm[2]) {
      csv_.fail_at(
          layout_.shape == Shape::axes ? layout_.semi_axes + 2 : layout_.inertia,
          "the cell is as thin as a thread or a leaf",
          fmt::format("r1 = {:.6g}, r3 = {:.6g}", cell.semi_axes_mm[0] * um_per_mm, cell.semi_axes_mm[2] * um_per_mm),
          fmt::format("r1 at most {} times r3", most_slender));
    }
    cell.volume_mm3 = layout_.volume ? volume_mm3() : ellipsoid_volume_mm3(cell);
    return cell;
  }

  void read_axes(MeasuredCell& cell) const {
    const Vec<3> e1 = axis(layout_.e1), e2 = axis(layout_.e2);
    const double cosine = e1.dot(e2);
    if (std::abs(cosine) > axis_tolerance) {
      csv_.fail_at(layout_.e2, "e1 and e2 are not orthogonal", fmt::format("e1.e2 = {}", cosine),
                   fmt::format("0 within {}", axis_tolerance));
    }
    cell.axes.col(0) = e1;
    cell.axes.col(1) = (e2 - cosine * e1).normalized();
    cell.axes.col(2) = e1.cross(cell.axes.col(1));

    const std::size_t r1 = layout_.semi_axes;
    for (std::size_t i = 0; i < 3; ++i) {
      const double r = csv_.number(r1 + i);
      if (r <= 0.0) csv_.fail_at(r1 + i, "a semi-axis must be positive", fmt::format("{}", r), "more than 0");
      cell.semi_axes_mm[static_cast<int>(i)] =
          length_within(r1 + i, smallest_axis_um, largest_axis_um, layout_.diameters ? 0.5 : 1.0);
    }
    for (std::size_t i = 1; i < 3; ++i) {
      if (cell.semi_axes_mm[static_cast<int>(i)] > cell.semi_axes_mm[static_cast<int>(i) - 1]) {
        csv_.fail_at(
            r1 + i, "the semi-axes are not in descending order",
            fmt::format("r1 = {}, r2 = {}, r3 = {}", csv_.number(r1), csv_.number(r1 + 1), csv_.number(r1 + 2)),
            "r1 >= r2 >= r3");
      }
    }
  }

  /// The inertia of unit mass is tr(C) 1 - C with the second moments C.
  void read_inertia(MeasuredCell& cell) const {
    std::array<double, 6> i{};
    for (std::size_t k = 0; k < 6; ++k) i[k] = mm(layout_.inertia + k) * mm(layout_.inertia + k) * number_of(k);
    Mat<3> inertia;
    inertia << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
    const Mat<3> moments = 0.5 * inertia.trace() * Mat<3>::Identity() - inertia;
    const Vec<3> values = Eigen::SelfAdjointEigenSolver<Mat<3>>(moments, Eigen::EigenvaluesOnly).eigenvalues();
    const double smallest_mm = smallest_axis_um / um_per_mm, largest_mm = largest_axis_um / um_per_mm;
    if (!(5.0 * values[0] >= smallest_mm * smallest_mm && 5.0 * values[2] <= largest_mm * largest_mm)) {
      csv_.fail_at(layout_.inertia, "no body has this inertia, or one far too flat, small or large",
                   fmt::format("second moments {:.3g}, {:.3g}, {:.3g} mm^2", values[0], values[1], values[2]),
                   fmt::format("semi-axes from {} to {} um", smallest_axis_um, largest_axis_um),
                   "remove this row if it is a speck of a voxel or two; is the inertia that of unit mass?");
    }
    set_covariance(cell, moments);
  }

  double number_of(std::size_t component) const { return csv_.number(layout_.inertia + component); }

  double volume_mm3() const {
    const std::size_t column = *layout_.volume;
    const double volume = csv_.number(column) * std::pow(mm(column), 3);
    const double smallest = std::pow(smallest_axis_um / um_per_mm, 3),
                 largest = std::pow(largest_axis_um / um_per_mm, 3);
    if (!(volume >= smallest && volume <= largest)) {
      csv_.fail_at(column, "out of range", fmt::format("{}", csv_.number(column)),
                   fmt::format("{:.3g} to {:.3g} mm^3", smallest, largest),
                   fmt::format("check that the column is in cubic {}", plural(units_[column])));
    }
    return volume;
  }

  /// Specks, which a segmentation leaves behind, and rows in another unit.
  void refuse_out_of_proportion(const std::vector<MeasuredCell>& cells) const {
    std::vector<double> sizes(cells.size());
    std::transform(cells.begin(), cells.end(), sizes.begin(), [](const auto& c) { return std::cbrt(c.volume_mm3); });
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
           "remove this row if it is background, or correct its size"});
    }
  }

  Layout layout_;
  CsvTable table_;
  CsvReader csv_;
  const std::string& name_;
  std::vector<LengthUnit> units_;  ///< of each column
};

}  // namespace

std::vector<MeasuredCell> parse_cell_file(std::string_view text, const std::string& name, const CellColumns& columns) {
  return Reader(text, name, columns).read();
}

std::vector<MeasuredCell> read_cell_file(const std::filesystem::path& path, const CellColumns& columns) {
  return parse_cell_file(read_users_file(path, "root.cells_file", "a CSV file of measured cells"), path.string(),
                         columns);
}

Mat<3> shape_matrix(const MeasuredCell& cell) {
  return cell.axes * cell.semi_axes_mm.array().square().inverse().matrix().asDiagonal() * cell.axes.transpose();
}

Mat<3> covariance(const MeasuredCell& cell) {
  return cell.axes * (cell.semi_axes_mm.array().square() / 5.0).matrix().asDiagonal() * cell.axes.transpose();
}

void set_covariance(MeasuredCell& cell, const Mat<3>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Mat<3>> principal(covariance);  // ascending
  cell.semi_axes_mm = (5.0 * principal.eigenvalues().reverse()).cwiseSqrt();
  cell.axes = principal.eigenvectors().rowwise().reverse();
  cell.axes.col(2) = cell.axes.col(0).cross(cell.axes.col(1));
}

double ellipsoid_volume_mm3(const MeasuredCell& cell) {
  return 4.0 / 3.0 * std::numbers::pi * cell.semi_axes_mm.prod();
}

}  // namespace rootsoil
