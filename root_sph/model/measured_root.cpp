// SPDX-License-Identifier: MIT
#include "root_sph/model/measured_root.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "root_sph/core/errors.hpp"
#include "root_sph/model/whole_tissue.hpp"

namespace rootsoil {
namespace {

constexpr double speck_share = 1.0 / 12.0;  // of the neighbours' volume; kernels of cells nearer in size than this pair
constexpr double touching = 1.3;            // of the distance at which ellipsoids touch: real cells fill the corners
constexpr double clear_axis = 1.5;          // variance along the axis over that across; a sphere has 1
constexpr double most_lean_deg = 60.0;      // from the asked axis; 54.7 is as far from one axis as from the others
constexpr double reported_lean_deg = 5.0;

struct Touching {
  std::size_t cell;
  double touch;
};

/// Who touches whom. Sweeps along x: no pair is further apart than both cells are long.
std::vector<std::vector<Touching>> contacts(std::span<const MeasuredCell> cells) {
  std::vector<Mat<3>> shapes;
  std::vector<double> reach;
  for (const MeasuredCell& cell : cells) {
    shapes.push_back(shape_matrix(cell));
    reach.push_back(touching * covariance(cell).diagonal().cwiseMax(0.0).cwiseSqrt()[0] * std::sqrt(5.0));
  }
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto begin_of = [&](std::size_t i) { return cells[i].position_mm[0] - reach[i]; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return begin_of(i) < begin_of(j); });
  std::vector<std::vector<Touching>> found(cells.size());
  for (auto first = order.begin(); first != order.end(); ++first) {
    const double end = cells[*first].position_mm[0] + reach[*first];
    for (auto second = first + 1; second != order.end() && begin_of(*second) <= end; ++second) {
      const Vec<3> offset = cells[*second].position_mm - cells[*first].position_mm;
      const double distance = touch(offset, shapes[*first], shapes[*second]);
      if (distance > touching) continue;
      found[*first].push_back({*second, distance});
      found[*second].push_back({*first, distance});
    }
  }
  return found;
}

template <class Values>
double median(Values values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Vec<3> direction_of(TipAxis axis) {
  const int number = static_cast<int>(axis) - static_cast<int>(TipAxis::plus_x);
  return (number % 2 ? -1.0 : 1.0) * Vec<3>::Unit(number / 2);
}

TipAxis nearest_axis(const Vec<3>& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return static_cast<TipAxis>(static_cast<int>(TipAxis::plus_x) + 2 * axis + (direction[axis] < 0.0 ? 1 : 0));
}

Vec<3> centroid(std::span<const MeasuredCell> cells) {
  Vec<3> sum = Vec<3>::Zero();
  double volume = 0.0;
  for (const MeasuredCell& cell : cells) {
    sum += cell.volume_mm3 * cell.position_mm;
    volume += cell.volume_mm3;
  }
  return sum / volume;
}

/// Towards the end with the smaller cells, else the narrower end, else that at the largest coordinate.
Vec<3> towards_tip(std::span<const MeasuredCell> cells, const Vec<3>& axis, std::string& how) {
  constexpr double end_share = 0.25;  // of the length
  constexpr double differ = 1.15;
  double low = 1e300, high = -1e300;
  for (const MeasuredCell& cell : cells) {
    low = std::min(low, axis.dot(cell.position_mm));
    high = std::max(high, axis.dot(cell.position_mm));
  }
  const auto at_end = [&](double sign, double length) {
    std::vector<double> volumes;
    for (const MeasuredCell& cell : cells) {
      const double x = axis.dot(cell.position_mm);
      if ((sign > 0.0 ? high - x : x - low) <= length) volumes.push_back(cell.volume_mm3);
    }
    return volumes;
  };
  const auto before = at_end(-1.0, end_share * (high - low)), behind = at_end(1.0, end_share * (high - low));
  const double sizes = median(before) / median(behind);
  const double widths =
      std::accumulate(before.begin(), before.end(), 0.0) / std::accumulate(behind.begin(), behind.end(), 0.0);
  for (const auto& [ratio, words] : {std::pair(sizes, "the end with the smaller cells"),
                                     std::pair(widths, "the narrower end; cells are as large at both")}) {
    if (ratio > differ || ratio < 1.0 / differ) {
      how = words;
      return ratio > 1.0 ? axis : Vec<3>(-axis);
    }
  }
  how = "the end of larger coordinates; the cells do not tell";
  return direction_of(nearest_axis(axis)).sum() > 0.0 ? axis : Vec<3>(-axis);
}

/// Cells that lie in one another, however different they are in size.
void refuse_nested(const std::string& file, std::span<const MeasuredCell> cells) {
  constexpr double nested = 0.2;  // the nearest in files of tools/make_cells.py --spread: 0.27
  const auto neighbours = contacts(cells);
  const auto name = [&](std::size_t i) { return fmt::format("cell {} (line {})", cells[i].label, cells[i].line); };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const Touching& other : neighbours[i]) {
      if (other.touch >= nested) continue;
      throw InputError(
          {file, std::max(cells[i].line, cells[other.cell].line), "root.cells_file",
           fmt::format("cells overlap: {} and {}", name(i), name(other.cell)),
           fmt::format("their centres are {:.3g} of the distance apart at which they would touch", other.touch),
           fmt::format("at least {}", nested), "remove the cell that was segmented twice, or correct its semi-axes"});
    }
  }
}

/// Directions spread evenly over the sphere (Fibonacci's spiral), and those along the axes.
std::vector<Vec<3>> directions(int count) {
  std::vector<Vec<3>> all;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count;
    const double angle = std::numbers::pi * (1.0 + std::sqrt(5.0)) * k;
    all.emplace_back(std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z);
  }
  for (int a = 0; a < 3; ++a) {
    all.push_back(Vec<3>::Unit(a));
    all.push_back(-Vec<3>::Unit(a));
  }
  return all;
}

/// Half the length along each coordinate axis of a cell.
Vec<3> half_extent(const MeasuredCell& cell) { return (5.0 * covariance(cell).diagonal()).cwiseSqrt(); }

/// Lowest and highest place of ellipsoids, times `reach`.
std::pair<Vec<3>, Vec<3>> extent(std::span<const MeasuredCell> cells, double reach = 1.0) {
  Vec<3> lower = Vec<3>::Constant(1e300), upper = -lower;
  for (const MeasuredCell& cell : cells) {
    lower = lower.cwiseMin(cell.position_mm - reach * half_extent(cell));
    upper = upper.cwiseMax(cell.position_mm + reach * half_extent(cell));
  }
  return {lower, upper};
}

/// Of the convex hull of these ellipsoids, times `reach`, between two planes across x. Planes that touch the hull
/// enclose it in many directions; along a ray from the middle the nearest of them ends it, and volume is the integral
/// of r^3/3 over rays.
double convex_hull_mm3(std::span<const MeasuredCell> cells, double reach, double from, double to) {
  static const std::vector<Vec<3>> normals = directions(1000);
  auto [lower, upper] = extent(cells, reach);
  lower[0] = from;
  upper[0] = to;
  const Vec<3> middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);  // scaled by which it is as wide as long
  const Mat<3> scale = half.cwiseInverse().asDiagonal();
  std::vector<double> support(normals.size(), 0.0);
  for (const MeasuredCell& cell : cells) {
    const Vec<3> x = scale * (cell.position_mm - middle);
    const Mat<3> moments = 5.0 * reach * reach * scale * covariance(cell) * scale;
    for (std::size_t k = 0; k < normals.size(); ++k) {
      support[k] = std::max(support[k], normals[k].dot(x) + std::sqrt(normals[k].dot(moments * normals[k])));
    }
  }
  double sum = 0.0;
  for (const Vec<3>& ray : normals) {
    double r = ray[0] == 0.0 ? 1e300 : 1.0 / std::abs(ray[0]);
    for (std::size_t k = 0; k < normals.size(); ++k) {
      const double along = normals[k].dot(ray);
      if (along > 0.0 && r * along > support[k]) r = support[k] / along;
    }
    sum += r * r * r;
  }
  return 4.0 / 3.0 * std::numbers::pi * half.prod() * sum / static_cast<double>(normals.size());
}

/// Of the body that a skin around ellipsoids, times `reach`, encloses: convex hulls of pieces as long as they are wide.
double skin_volume_mm3(std::span<const MeasuredCell> cells, double reach) {
  const auto [lower, upper] = extent(cells, reach);
  const Vec<3> lengths = upper - lower;
  constexpr double most_pieces = 1e4;
  const int pieces =
      static_cast<int>(std::clamp(std::round(lengths[0] / lengths.tail<2>().maxCoeff()), 1.0, most_pieces));
  const double length = lengths[0] / pieces;
  std::vector<std::vector<MeasuredCell>> in_piece(static_cast<std::size_t>(pieces));
  for (const MeasuredCell& cell : cells) {
    const auto piece_at = [&, from = lower[0]](double x) {
      return std::clamp(static_cast<int>((x - from) / length), 0, pieces - 1);
    };
    const double half = reach * half_extent(cell)[0];
    const int last = piece_at(cell.position_mm[0] + half);
    for (int p = piece_at(cell.position_mm[0] - half); p <= last; ++p) {
      in_piece[static_cast<std::size_t>(p)].push_back(cell);
    }
  }
  double volume = 0.0;
  for (int p = 0; p < pieces; ++p) {
    const auto& piece = in_piece[static_cast<std::size_t>(p)];
    const double from = lower[0] + p * length;
    if (!piece.empty()) volume += convex_hull_mm3(piece, reach, from, from + length);
  }
  return volume;
}

}  // namespace

double touch(const Vec<3>& offset, const Mat<3>& shape_a, const Mat<3>& shape_b) {
  const double a = std::sqrt(offset.dot(shape_a * offset)), b = std::sqrt(offset.dot(shape_b * offset));
  return a + b > 0.0 ? a * b / (a + b) : 0.0;
}

MeasuredCell merged(const MeasuredCell& a, const MeasuredCell& b) {
  MeasuredCell both = a;
  both.volume_mm3 = a.volume_mm3 + b.volume_mm3;
  const double share = b.volume_mm3 / both.volume_mm3;
  const Vec<3> offset = b.position_mm - a.position_mm;
  both.position_mm += share * offset;
  set_covariance(both, (1.0 - share) * covariance(a) + share * covariance(b) +
                           share * (1.0 - share) * offset * offset.transpose());
  return both;
}

std::vector<Merged> merge_specks(std::vector<MeasuredCell>& cells) {
  const auto neighbours = contacts(cells);
  std::vector<std::size_t> specks;
  std::vector<char> speck(cells.size(), 0), gone(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (neighbours[i].empty()) continue;
    std::vector<double> volumes;
    for (const Touching& other : neighbours[i]) volumes.push_back(cells[other.cell].volume_mm3);
    speck[i] = cells[i].volume_mm3 < speck_share * median(volumes);
    if (speck[i]) specks.push_back(i);
  }
  // The smallest first, so that one that touches nothing but larger specks goes with them.
  const std::vector<MeasuredCell> original = cells;
  const auto smaller = [&](std::size_t i, std::size_t j) { return original[i].volume_mm3 < original[j].volume_mm3; };
  std::stable_sort(specks.begin(), specks.end(), smaller);
  std::vector<Merged> merges;
  for (const std::size_t i : specks) {
    const Touching* host = nullptr;
    for (const Touching& other : neighbours[i]) {
      if (gone[other.cell] || !smaller(i, other.cell)) continue;
      const auto rank = [&](const Touching& t) { return std::pair<bool, double>(speck[t.cell], t.touch); };
      if (!host || rank(other) < rank(*host)) host = &other;
    }
    if (!host) continue;
    cells[host->cell] = merged(cells[host->cell], cells[i]);
    gone[i] = 1;
    merges.push_back({cells[i].label, cells[i].line, cells[host->cell].label});
  }
  std::size_t index = 0;
  std::erase_if(cells, [&](const MeasuredCell&) { return gone[index++] != 0; });
  return merges;
}

Vec<3> principal_axis(std::span<const MeasuredCell> cells) {
  const Vec<3> middle = centroid(cells);
  Mat<3> moments = Mat<3>::Zero();
  for (const MeasuredCell& cell : cells) {
    const Vec<3> offset = cell.position_mm - middle;
    moments += cell.volume_mm3 * (covariance(cell) + offset * offset.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Mat<3>> principal(moments);  // ascending
  if (principal.eigenvalues()[2] < clear_axis * principal.eigenvalues()[1]) return Vec<3>::Zero();
  return principal.eigenvectors().col(2);
}

void turn_to_x(std::vector<MeasuredCell>& cells, TipAxis asked, const std::string& file, MeasuredRootReport& report) {
  Vec<3> axis = principal_axis(cells);
  const auto refuse = [&](std::string what, std::string given, std::string allowed, std::string remedy) {
    throw InputError(
        {file, 0, "root.tip_axis", std::move(what), std::move(given), std::move(allowed), std::move(remedy)});
  };
  if (asked == TipAxis::found) {
    if (axis.isZero()) {
      refuse("no axis can be found from the cells: together they are about as wide as long", "tip_axis = \"auto\"",
             fmt::format("a root longer than wide: variance along it {} times that across", clear_axis),
             "give tip_axis, or cells of a longer piece of the root");
    }
    axis = towards_tip(cells, axis, report.tip_found);
    asked = nearest_axis(axis);
  } else {
    report.tip_found = "as asked";
    if (axis.isZero()) {
      axis = direction_of(asked);
      report.tip_found = "as asked; the cells are about as wide as long and tell no axis";
    }
    if (axis.dot(direction_of(asked)) < 0.0) axis = -axis;
  }
  const double lean_deg =
      std::atan2(axis.cross(direction_of(asked)).norm(), axis.dot(direction_of(asked))) * 180.0 / std::numbers::pi;
  if (lean_deg > most_lean_deg) {
    refuse("the root of the cell file lies across the axis that is asked for",
           fmt::format("tip_axis = \"{}\"; the cells' longest axis is ({:.3f}, {:.3f}, {:.3f}), {:.0f} degrees from it",
                       name_of(asked), axis[0], axis[1], axis[2], lean_deg),
           fmt::format("up to {} degrees, by which the root is then turned", most_lean_deg),
           fmt::format("tip_axis = \"auto\", or \"{}\" or its opposite", name_of(nearest_axis(axis))));
  }
  report.tip_direction = axis;
  report.tip_axis = name_of(asked);
  report.lean_deg = lean_deg;
  // Which way round does not matter to a root, but roundings depend on it: the cell furthest from the axis comes to +y,
  // so that a file turned in any way gives the same run.
  const Vec<3> middle = centroid(cells);
  Vec<3> furthest = Vec<3>::Zero();
  for (const MeasuredCell& cell : cells) {
    const Vec<3> offset = cell.position_mm - middle, across = offset - offset.dot(axis) * axis;
    if (across.squaredNorm() > furthest.squaredNorm()) furthest = across;
  }
  const Vec<3> y = furthest.isZero() ? axis.unitOrthogonal() : Vec<3>(furthest.normalized());
  Mat<3> turn;
  turn << axis.transpose(), y.transpose(), axis.cross(y).transpose();
  for (MeasuredCell& cell : cells) {
    cell.position_mm = turn * cell.position_mm;
    cell.axes = turn * cell.axes;
  }
}

double hull_volume_mm3(std::span<const MeasuredCell> cells) {
  // An ellipsoid that touches the faces of a box fills pi/6 of it. Those of second moments are larger than this, and
  // would stand out of the skin; how much tells the hull itself.
  constexpr double touching_share = std::numbers::pi / 6.0;
  const double ellipsoids = std::transform_reduce(cells.begin(), cells.end(), 0.0, std::plus<>(), ellipsoid_volume_mm3);
  double volume = 0.0, reach = 1.0;
  for (int pass = 0; pass < 3; ++pass) {  // then to a thousandth
    volume = skin_volume_mm3(cells, reach);
    reach = std::min(1.0, std::cbrt(touching_share * volume / ellipsoids));
  }
  return volume;
}

MeasuredRoot read_measured_root(const Scene& scene) {
  const CellColumns* columns = scene.find<CellColumns>();
  const std::string& file = scene.root.cells_file;
  MeasuredRoot root{.cells = read_cell_file(file, columns ? *columns : CellColumns{}), .report = {}};
  MeasuredRootReport& report = root.report;
  report.cells_in_file = root.cells.size();
  refuse_piles(file, root.cells);
  report.merged = merge_specks(root.cells);
  refuse_nested(file, root.cells);
  refuse_parts(file, root.cells);
  turn_to_x(root.cells, scene.root.tip_axis, file, report);

  const auto [lower, upper] = extent(root.cells);
  std::vector<double> volumes;
  for (const MeasuredCell& cell : root.cells) {
    volumes.push_back(cell.volume_mm3);
    report.most_slender = std::max(report.most_slender, cell.semi_axes_mm[0] / cell.semi_axes_mm[2]);
  }
  report.extent_mm = upper - lower;
  report.smallest_mm = std::cbrt(*std::min_element(volumes.begin(), volumes.end()));
  report.largest_mm = std::cbrt(*std::max_element(volumes.begin(), volumes.end()));
  report.median_mm = std::cbrt(median(volumes));
  report.cells_mm3 = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  report.hull_mm3 = hull_volume_mm3(root.cells);
  refuse_overlap(file, report.hull_mm3 / report.cells_mm3);
  return root;
}

std::vector<std::string> describe(const MeasuredRootReport& report) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{} cells in the file, {:.4g} mm long, {:.3g} and {:.3g} mm across", report.cells_in_file,
                              report.extent_mm[0], report.extent_mm[1], report.extent_mm[2]));
  lines.push_back(fmt::format(
      "tip towards {} ({}); axis ({:.4f}, {:.4f}, {:.4f}) in the file, turned by {:.1f} degrees{}", report.tip_axis,
      report.tip_found, report.tip_direction[0], report.tip_direction[1], report.tip_direction[2], report.lean_deg,
      report.lean_deg > reported_lean_deg ? ": the file leans" : ""));
  lines.push_back(
      fmt::format("sizes (cube roots of volumes) {:.3g} to {:.3g} mm, median {:.3g}: volumes span {:.3g}-fold; "
                  "r1/r3 up to {:.3g}",
                  report.smallest_mm, report.largest_mm, report.median_mm,
                  std::pow(report.largest_mm / report.smallest_mm, 3), report.most_slender));
  lines.push_back(fmt::format("cells fill {:.3g} of the hull, {:.4g} mm^3; volumes are multiplied by {:.4g}",
                              report.cells_mm3 / report.hull_mm3, report.hull_mm3, report.hull_mm3 / report.cells_mm3));
  constexpr std::size_t most_named = 5;
  std::string specks;
  for (std::size_t k = 0; k < std::min(most_named, report.merged.size()); ++k) {
    specks += fmt::format("{}{} (line {}) into {}", k ? ", " : ": ", report.merged[k].label, report.merged[k].line,
                          report.merged[k].into);
  }
  lines.push_back(fmt::format("{} specks merged into the cells that they touch{}{}", report.merged.size(), specks,
                              report.merged.size() > most_named ? ", ..." : ""));
  return lines;
}

}  // namespace rootsoil
