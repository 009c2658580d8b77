// SPDX-License-Identifier: MIT
#include "root_sph/effects/division/division.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "root_sph/core/errors.hpp"
#include "root_sph/core/symmetric.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/value_table.hpp"

namespace rootsoil {

namespace {

void complete_division(Scene& scene) {
  check_one_of("division", "l0_mm", "table", scene.origins);
  const Rows& table = scene.find<DivisionSection>()->table;
  check_increasing(table, "division.table", "distances", scene.origins);
  if (scene.find<DivisionSection>()->asynchronous && scene.origins.has("root.cells_file")) {
    scene.origins.fail("division.asynchronous", "the cells of a file have the lengths that the file gives", {}, {},
                       "remove this key; cells of a file are in their cycle where their lengths say");
  }
  if (table.empty()) return;
  for (const std::string key : {"c_d", "s_d_per_mm2", "x_d_mm", "constant_beyond_mm"}) {
    if (!scene.origins.has("division." + key)) continue;
    scene.origins.fail("division." + key, "a table has no such thing", {}, {}, "give the table or the keys of Eq. 6");
  }
}

// clang-format off
SectionSpec division_section() {
  using namespace sections;
  using Di = DivisionSection;
  return section<Di>("division", optional, "A cell divides when its longest axis reaches l0 (c_d + s_d (s - x_d)^2).", {
    key(&Di::l0_mm, "l0_mm", "mm", above(0).up_to(1, microns), "Reference cell size; this or table.", "Eq. 6, Table 1"),
    key(&Di::c_d, "c_d", "-", above(0), "Scale of the threshold.", "Eq. 6, Table 1"),
    key(&Di::s_d_per_mm2, "s_d_per_mm2", "1/mm^2", at_least(0), "How fast the threshold rises.", "Eq. 6, Table 1"),
    key(&Di::x_d_mm, "x_d_mm", "mm", place_mm, "Distance from the tip of the smallest threshold.", "Eq. 6, Table 1"),
    key(&Di::constant_beyond_mm, "constant_beyond_mm", "mm", at_least(0).up_to(1e3, microns),
        "The threshold stays constant beyond this distance from the tip.", "paper 2.3"),
    key(&Di::table, "table", "mm, mm", above(0).up_to(1, microns),
        "[[distance from the tip, threshold], ...] in place of Eq. 6: linear in between, constant before and after.",
        "docs/decisions/0023").written_when([](const Di& s) { return !s.table.empty(); }),
    key(&Di::ends_at_mm, "ends_at_mm", "mm", above(0).up_to(1e3, microns),
        "No cell divides beyond this distance from the tip.", "docs/decisions/0023"),
    key(&Di::scatter, "scatter", "-", between(0, 0.5),
        "Standard deviation of the logarithm of the threshold, each cell's own.", "docs/decisions/0023"),
    key(&Di::asynchronous, "asynchronous", "-", any_number,
        "Cells of a lattice start somewhere in their cycle, at random: with unequal lengths.",
        "docs/decisions/0023"),
  }).completed_by(complete_division);
}
// clang-format on

double mean_of(const std::vector<double>& values) {
  return std::reduce(values.begin(), values.end()) / static_cast<double>(values.size());
}

/// The n-th number of a stream, as good as random: Steele, Lea & Flood, OOPSLA 2014 (SplitMix64).
std::uint64_t split_mix(std::uint64_t stream, std::uint64_t n) {
  std::uint64_t z = stream + (n + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// The n-th random number of a cell, above 0 and at most 1.
double uniform(std::int64_t seed, std::int64_t cell_id, std::uint64_t n) {
  const std::uint64_t stream = split_mix(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(cell_id));
  return static_cast<double>((split_mix(stream, n) >> 11) + 1) * 0x1p-53;
}

}  // namespace

double division_threshold_mm(const DivisionSection& d, double s_mm) {
  if (d.ends_at_mm && s_mm > *d.ends_at_mm) return std::numeric_limits<double>::infinity();
  if (!d.table.empty()) return value_at(d.table, s_mm);
  const double s = d.constant_beyond_mm ? std::min(s_mm, *d.constant_beyond_mm) : s_mm;
  return d.l0_mm * (d.c_d + d.s_d_per_mm2 * (s - d.x_d_mm) * (s - d.x_d_mm));
}

double mean_length_over_threshold(const DivisionSection& d) {
  return std::numbers::ln2 * std::exp(-0.5 * d.scatter * d.scatter);
}

double division_factor(const DivisionSection& d, std::int64_t seed, std::int64_t cell_id) {
  if (d.scatter == 0.0) return 1.0;
  const auto u = [&](std::uint64_t n) { return uniform(seed, cell_id, n); };
  return std::exp(d.scatter * std::sqrt(-2.0 * std::log(u(0))) *
                  std::cos(2.0 * std::numbers::pi * u(1)));  // Box, Muller
}

template <int Dim>
double cells_when_divided(const Mat<Dim>& shape, double threshold_mm) {
  double cells = 1.0;
  for (const double length_mm : axis_lengths_mm<Dim>(shape)) {
    cells *= std::exp2(std::max(0.0, std::ceil(std::log2(length_mm / threshold_mm))));
  }
  return cells;
}

template <int Dim>
void even_out_spacing(Solver<Dim>& solver) {
  constexpr double rate_over_strain_rate = 25.0;  // fast against a generation; mature tissue is left alone
  constexpr double adjacent = 1.3;  // ellipsoids this near to touching are neighbours in a file; diagonals are at 1.41
  constexpr double along = 0.8;     // cosine to the root axis
  Tissue<Dim>& tissue = solver.tissue();
  auto& cells = tissue.cells;
  std::vector<double> share(cells.size()), shift(cells.size(), 0.0);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double rate =
        rate_over_strain_rate * std::max(0.0, solver.axis().strain_rate_per_h(cells.distance_to_tip[i]));
    share[i] = 0.25 * std::min(0.2, rate * solver.window_h());
  }
  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = tissue.pairs.pairs[k];
      const Vec<Dim> r = cells.position[j] - cells.position[i];
      // 1 where two ellipsoids of equal shape touch
      const double distance2 = 0.125 * r.dot((cells.shape[i] + cells.shape[j]) * r);
      if (distance2 > adjacent * adjacent) continue;
      const double length = r.norm();
      const Vec<Dim> n = r / length;
      const double cosine = n.dot(cells.frame[i].col(0));
      if (std::abs(cosine) < along) continue;
      const double half_i = 1.0 / std::sqrt(n.dot(cells.shape[i] * n)),
                   half_j = 1.0 / std::sqrt(n.dot(cells.shape[j] * n));
      const double gap = (length - half_i - half_j) * (cosine > 0.0 ? 1.0 : -1.0);
      const double moved = (share[i] + share[j]) * gap;
      shift[i] += moved;
      shift[j] -= moved;
    }
  });
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i]) continue;
    const Vec<Dim> moved = shift[i] * cells.frame[i].col(0);
    cells.velocity[i] += tissue.velocity_gradient[i] * tissue.deformation[i].inverse() * moved;
    cells.position[i] += moved;
  }
}

std::string runaway_division(std::size_t cells, double shorter) {
  constexpr double most_cells = 2e7;           // as many as a lattice may have
  constexpr double most_times_shorter = 10.0;  // large cells at the start may become a meristem's, some 4 times shorter
  if (shorter > most_times_shorter) {
    return fmt::format("its {} cells are on average {:.1f} times shorter than those at the start (at most {:.0f})",
                       cells, shorter, most_times_shorter);
  }
  if (static_cast<double>(cells) <= most_cells) return {};
  return fmt::format("there would be {} cells (at most {:.0e})", cells, most_cells);
}

template <int Dim>
DivisionEffect<Dim>::DivisionEffect(Solver<Dim>& solver, const DivisionSection& division, std::int64_t seed)
    : solver_(solver), division_(division), seed_(seed), mean_volume_(mean_of(solver.tissue().cells.volume.values())) {
  solver.hooks().spacing.emplace_back("even spacing", [&solver](Tissue<Dim>&) { even_out_spacing<Dim>(solver); });
  solver.hooks().division.emplace_back("division", [this](Tissue<Dim>& tissue) { divide(tissue); });
}

/// Of a cell, if it were there.
template <int Dim>
double DivisionEffect<Dim>::threshold_mm(const Tissue<Dim>& tissue, std::size_t cell, double s_mm) const {
  return division_threshold_mm(division_, s_mm) * division_factor(division_, seed_, tissue.cells.cell_id[cell]);
}

/// Length now of a cell that reaches its threshold at the window's end. Cells can divide only at its start. Daughters
/// grow as their mother would: when all divide that would have to within the window, every cell is at its end, where
/// outputs are, as if each had divided in its time.
template <int Dim>
double DivisionEffect<Dim>::due_above_mm(const Tissue<Dim>& tissue, std::size_t cell) const {
  const double s_mm = tissue.cells.distance_to_tip[cell];
  const RootAxis<Dim>& axis = solver_.axis();
  return threshold_mm(tissue, cell, s_mm + solver_.window_h() * axis.flow_mm_h(s_mm)) *
         std::exp(-solver_.window_h() * std::max(0.0, axis.strain_rate_per_h(s_mm)));
}

template <int Dim>
void DivisionEffect<Dim>::divide(Tissue<Dim>& tissue) const {
  auto& cells = tissue.cells;
  const std::size_t mothers = cells.size();
  std::vector<char> divides(mothers);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < mothers; ++i) {
    const double l = due_above_mm(tissue, i);
    const Mat<Dim> above = cells.shape[i] - 4.0 / (l * l) * Mat<Dim>::Identity();
    // positive definite: every axis is shorter than the threshold. Cheaper than the axes themselves
    divides[i] =
        !cells.clamped[i] && !is_positive_definite<Dim>(above) && longest_axis<Dim>(cells.shape[i]).length_mm > l;
  }
  refuse_runaway(tissue, divides);
  for (std::size_t i = 0; i < mothers; ++i) {
    if (!divides[i]) continue;
    const LongestAxis<Dim> axis = longest_axis<Dim>(cells.shape[i]);
    const std::int64_t first = tissue.next_cell_id;
    tissue.next_cell_id += 2;
    cells.divide(i, axis.direction, axis.length_mm, first, first + 1);
  }
}

template <int Dim>
void DivisionEffect<Dim>::refuse_runaway(const Tissue<Dim>& tissue, const std::vector<char>& divides) const {
  const auto& cells = tissue.cells;
  const auto dividing = static_cast<std::size_t>(std::count(divides.begin(), divides.end(), 1));
  if (dividing == 0) return;
  const std::string trouble =
      runaway_division(cells.total() + dividing, std::pow(mean_volume_ / mean_of(cells.volume.values()), 1.0 / Dim));
  if (trouble.empty()) return;
  const auto length_mm = [&](std::size_t i) { return longest_axis<Dim>(cells.shape[i]).length_mm; };
  const auto at_mm = [&](std::size_t i) { return threshold_mm(tissue, i, cells.distance_to_tip[i]); };
  std::size_t worst = 0;  // the cell that is longest for its threshold
  double times = 0.0;
  for (std::size_t i = 0; i < divides.size(); ++i) {
    if (!divides[i] || length_mm(i) <= times * at_mm(i)) continue;
    worst = i;
    times = length_mm(i) / at_mm(i);
  }
  throw UnphysicalError(fmt::format(
      "the tissue divides without end at t = {:.5g} h: {}. Cell {}, {:.3g} mm long and {:.4g} mm from the "
      "tip, is {:.3g} "
      "times as long as the threshold there, {:.3g} mm ({}). Usual causes: l0_mm, "
      "s_d_per_mm2 or x_d_mm "
      "in other units than cells and root, a growth rate or a duration far too large",
      tissue.time_h, trouble, cells.cell_id[worst], length_mm(worst), cells.distance_to_tip[worst], times, at_mm(worst),
      division_.table.empty() ? fmt::format("division.l0_mm = {}", division_.l0_mm) : "division.table"));
}

EffectSpec division_effect() {
  return {.name = "division",
          .called_by = "[division]",
          .what = "cells divide across their longest axis (4.2, Eq. 6)",
          .exact = "mass, volume and momentum of a division; growth as without it",
          .sections = {division_section()},
          .called_for = [](const Scene& scene) { return scene.find<DivisionSection>() != nullptr; },
          .build =
              [](auto assembly) {
                assembly.template add<DivisionEffect<assembly.dimension>>(
                    *assembly.scene.template find<DivisionSection>(), assembly.scene.scene.seed);
              }};
}

template double cells_when_divided<2>(const Mat<2>&, double);
template double cells_when_divided<3>(const Mat<3>&, double);
template void even_out_spacing<2>(Solver<2>&);
template void even_out_spacing<3>(Solver<3>&);
template class DivisionEffect<2>;
template class DivisionEffect<3>;

}  // namespace rootsoil
