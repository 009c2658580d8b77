// SPDX-License-Identifier: MIT
#include "root_sph/model/whole_tissue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>

#include "root_sph/core/errors.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/kernels/wendland.hpp"
#include "root_sph/neighbours/components.hpp"

namespace rootsoil {
namespace {

// With the metric of cell_metric(shape, 1) q is the distance in cell lengths: 1 where two equal cells touch.
constexpr double cell_lengths = 1.0;  // eta; a pair, q < 2, leaves no room for a cell in between
constexpr double same_place = 0.25;   // in scenarios/cells and files of tools/make_cells.py the nearest are 0.6 apart
constexpr std::size_t most_named = 5;

/// What is wrong with a cloud of cells, and with which of them.
struct Flaw {
  std::string what, given, allowed;
  std::size_t cell = 0;  ///< the first to blame
};

/// \param joined look as well whether all hang together
template <int Dim>
std::optional<Flaw> find_flaw(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> shapes,
                              const std::function<std::string(std::size_t)>& name, bool joined) {
  std::vector<Mat<Dim>> metrics;
  for (const Mat<Dim>& shape : shapes) metrics.push_back(cell_metric<Dim>(shape, cell_lengths));
  const auto size_mm = [&](std::size_t i) { return 2.0 * std::pow(shapes[i].determinant(), -0.5 / Dim); };
  const auto part = [&](const std::vector<std::size_t>& cells) {
    const Nearest gap = nearest_outside<Dim>(cells, positions);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < std::min(most_named, cells.size()); ++k) names.push_back(name(cells[k]));
    return Flaw{fmt::format("{} of {} cells {} apart from the others: {}{}", cells.size(), positions.size(),
                            cells.size() == 1 ? "lies" : "lie", fmt::join(names, ", "),
                            cells.size() > most_named ? ", ..." : ""),
                fmt::format("{} is {:.4g} mm from the next, {}; they are {:.3g} and {:.3g} mm large", name(gap.inside),
                            gap.distance_mm, name(gap.outside), size_mm(gap.inside), size_mm(gap.outside)),
                "gaps in which no cell would fit", gap.inside};
  };

  // First what would make the search for pairs slow: cells far away, then cells in one place.
  if (const auto beyond = beyond_gap<Dim>(positions, metrics); !beyond.empty()) return part(beyond);
  if (const auto close = closer_than<Dim>(same_place, positions, metrics, most_named); !close.empty()) {
    std::vector<std::string> names;
    names.reserve(close.size());
    for (const auto& [i, j] : close) names.push_back(fmt::format("{} and {}", name(i), name(j)));
    const auto [i, j] = close.front();
    return Flaw{
        fmt::format("cells lie in one place: {}{}", fmt::join(names, "; "), close.size() == most_named ? "; ..." : ""),
        fmt::format("centres {:.4g} mm apart, cells {:.3g} and {:.3g} mm large", (positions[j] - positions[i]).norm(),
                    size_mm(i), size_mm(j)),
        fmt::format("centres at least {} of a cell's length apart", same_place), static_cast<std::size_t>(j)};
  }
  if (!joined) return std::nullopt;
  const auto groups = components(positions.size(), find_pairs<Dim>(positions, metrics).pairs);
  if (groups.size() > 1) return part(groups.back());
  return std::nullopt;
}

void refuse_flaw(const std::string& file, std::span<const MeasuredCell> cells, bool joined) {
  std::vector<Vec<3>> positions;
  std::vector<Mat<3>> shapes;
  for (const MeasuredCell& cell : cells) {
    positions.push_back(cell.position_mm);
    shapes.push_back(shape_matrix(cell));
  }
  const auto name = [&](std::size_t i) { return fmt::format("cell {} (line {})", cells[i].label, cells[i].line); };
  if (const auto flaw = find_flaw<3>(positions, shapes, name, joined)) {
    throw InputError({file, cells[flaw->cell].line, "root.cells_file", flaw->what, flaw->given, flaw->allowed,
                      "remove what the segmentation left behind (stray cells, specks, cells given twice), or add the "
                      "cells in between; are positions and semi-axes all in one unit?"});
  }
}

}  // namespace

void refuse_piles(const std::string& file, std::span<const MeasuredCell> cells) { refuse_flaw(file, cells, false); }

void refuse_parts(const std::string& file, std::span<const MeasuredCell> cells) { refuse_flaw(file, cells, true); }

void refuse_overlap(const std::string& file, double volume_scale) {
  constexpr double least = 0.5;  // 0.75 to 1.9 where ellipsoids touch; 0.15 to 0.4 where diameters are semi-axes
  if (volume_scale >= least) return;
  throw InputError({file, 0, "root.cells_file", "the cells overlap: together they are larger than the tissue",
                    fmt::format("volumes would have to be multiplied by {:.3g} to fill it once", volume_scale),
                    fmt::format("at least {}", least),
                    "are r1, r2 and r3 semi-axes, not diameters, and all in the unit of the positions?"});
}

template <int Dim>
void refuse_torn_lattice(const Scene& scene, const Tissue<Dim>& tissue) {
  const RootSection& root = scene.root;
  const bool regular = root.jitter == 0.0 && root.size_variation == 0.0 && root.curvature_per_mm == 0.0;
  if (!root.is_lattice() || regular) return;  // a regular lattice is of one piece
  const auto& cells = tissue.cells;
  const auto name = [&](std::size_t i) {
    const Vec<Dim> x = cells.position[i];
    return fmt::format("the cell at ({:.4g}) mm", fmt::join(x.data(), x.data() + Dim, ", "));
  };
  if (const auto flaw = find_flaw<Dim>(cells.position.values(), cells.shape.values(), name, true)) {
    scene.origins.fail(root.curvature_per_mm != 0.0 ? "root.curvature_per_mm"
                       : root.size_variation != 0.0 ? "root.size_variation"
                                                    : "root.jitter",
                       flaw->what, flaw->given, flaw->allowed, "lower curvature, size_variation or jitter");
  }
}

template <int Dim>
void refuse_thread(const Scene& scene, const Tissue<Dim>& tissue) {
  constexpr double most_slender = 1e5;  // a metre of a root 10 um thick
  double volume = 0.0, length = 0.0;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    volume += tissue.cells.volume[i];
    length = std::max(length, tissue.cells.distance_to_tip[i]);
  }
  const double section = volume / length;
  const double diameter = Dim == 2 ? section : std::sqrt(4.0 / std::numbers::pi * section);
  if (length <= most_slender * diameter) return;
  scene.origins.fail("root", "the root is a thread", fmt::format("{:.4g} mm long, {:.3g} mm thick", length, diameter),
                     fmt::format("at most {:.0e} times as long as thick", most_slender),
                     "make the root shorter or thicker; are all lengths in mm?");
}

/// Up to this many cells, those nearest to the one in the middle of the list.
template <int Dim>
std::vector<std::size_t> sample_of(const std::vector<Vec<Dim>>& positions, std::size_t most) {
  std::vector<std::size_t> cells(positions.size());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  if (cells.size() <= most) return cells;
  const Vec<Dim> middle = positions[positions.size() / 2];
  const auto distance = [&](std::size_t i) { return (positions[i] - middle).squaredNorm(); };
  std::nth_element(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(most), cells.end(),
                   [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  cells.resize(most);
  return cells;
}

template <int Dim>
void refuse_lonely_cells(const Scene& scene, const Tissue<Dim>& tissue, std::span<const Mat<Dim>> kernel_metrics) {
  // Dim directions need as many partners, and one more tells a slope from an offset. Two rows of cells have so many as
  // soon as a kernel reaches the next cell; shipped scenes have 9 to 24.
  constexpr std::int32_t least = Dim + 1;
  constexpr double inner = 0.99;         // of the kernel's reach: what lies at its very edge has no weight
  constexpr std::size_t enough = 10000;  // a piece of so many tells the median; all would take minutes for millions
  std::vector<Vec<Dim>> positions;
  std::vector<Mat<Dim>> metrics;
  for (const std::size_t i : sample_of<Dim>(tissue.cells.position.values(), enough)) {
    positions.push_back(tissue.cells.position[i]);
    metrics.push_back(kernel_metrics[i] / (inner * inner));
  }
  std::vector<std::int32_t> partners = find_pairs<Dim>(positions, metrics).neighbours;
  const auto middle = partners.begin() + std::ssize(partners) / 2;
  std::nth_element(partners.begin(), middle, partners.end());
  if (*middle >= least) return;
  const bool isotropic = scene.numerics.kernel == Kernel::isotropic;
  const double size = isotropic ? scene.numerics.H_bar * std::sqrt(static_cast<double>(Dim)) : scene.numerics.eta;
  scene.origins.fail(
      isotropic ? "numerics.H_bar" : "numerics.eta",
      "the kernel reaches too few cells for a gradient: the tissue would be dust",
      fmt::format("{}: it reaches {:.3g} cell lengths; half of the cells have {} partners or fewer",
                  isotropic ? scene.numerics.H_bar : scene.numerics.eta, kernel_support * size, *middle),
      fmt::format("at least {} partners for most cells", least),
      isotropic ? "raise it: the paper takes 2 to 8; or leave kernel out"
                : "raise it, or leave it out: the presets take 1.3 to 1.5; or make the root more than one cell thick");
}

template <int Dim>
void refuse_hasty_division(const Scene& scene, const Tissue<Dim>& tissue) {
  const DivisionSection* division = scene.find<DivisionSection>();
  if (!division) return;
  constexpr double most_times = 10.0;  // every axis of every cell just above the threshold: 4 (2D), 8 (3D)
  double cells = 0.0, divided = 0.0, worst = 0.0, longest_mm = 0.0;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    if (tissue.cells.clamped[i]) continue;
    const double at_mm = division_threshold_mm(*division, tissue.cells.distance_to_tip[i]);
    const double length_mm = longest_axis<Dim>(tissue.cells.shape[i]).length_mm;
    ++cells;
    divided += cells_when_divided<Dim>(tissue.cells.shape[i], at_mm);
    if (length_mm > worst * at_mm) {
      worst = length_mm / at_mm;
      longest_mm = length_mm;
    }
  }
  if (divided <= most_times * cells) return;
  scene.origins.fail(
      division->table.empty() ? "division.l0_mm" : "division.table",
      fmt::format("the {:.0f} cells that can move would divide into some {:.1e} at once", cells, divided),
      fmt::format("a cell {:.3g} mm long, {:.3g} times longer than the threshold at its place", longest_mm, worst),
      fmt::format("a threshold that makes at most {} cells of one", most_times),
      "is the threshold in mm? Give one near the length of the cells at the start, or start with smaller cells");
}

template void refuse_torn_lattice<2>(const Scene&, const Tissue<2>&);
template void refuse_torn_lattice<3>(const Scene&, const Tissue<3>&);
template void refuse_thread<2>(const Scene&, const Tissue<2>&);
template void refuse_thread<3>(const Scene&, const Tissue<3>&);
template void refuse_lonely_cells<2>(const Scene&, const Tissue<2>&, std::span<const Mat<2>>);
template void refuse_lonely_cells<3>(const Scene&, const Tissue<3>&, std::span<const Mat<3>>);
template void refuse_hasty_division<2>(const Scene&, const Tissue<2>&);
template void refuse_hasty_division<3>(const Scene&, const Tissue<3>&);

}  // namespace rootsoil
