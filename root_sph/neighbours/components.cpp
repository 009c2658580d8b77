// SPDX-License-Identifier: MIT
#include "root_sph/neighbours/components.hpp"

#include <algorithm>
#include <numeric>

#include "root_sph/kernels/wendland.hpp"
#include "root_sph/neighbours/cell_grid.hpp"

namespace rootsoil {
namespace {

template <int Dim>
std::vector<std::size_t> sorted_along(int axis, std::span<const Vec<Dim>> positions) {
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return positions[i][axis] < positions[j][axis]; });
  return order;
}

template <int Dim>
int longest_axis_of(std::span<const Vec<Dim>> positions) {
  Vec<Dim> lower = positions.front(), upper = positions.front();
  for (const Vec<Dim>& x : positions) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  int axis = 0;
  (upper - lower).maxCoeff(&axis);
  return axis;
}

}  // namespace

template <int Dim>
std::vector<std::size_t> beyond_gap(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics) {
  // A pair lies within the reach of both of its cells, so intervals of half the reach about them overlap.
  std::vector<Vec<Dim>> half(positions.size());
  std::transform(metrics.begin(), metrics.end(), half.begin(),
                 [](const Mat<Dim>& metric) { return Vec<Dim>(0.5 * reach<Dim>(metric)); });
  std::vector<std::size_t> beyond;
  double widest = 0.0;
  for (int a = 0; a < Dim; ++a) {
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto begin_of = [&](std::size_t i) { return positions[i][a] - half[i][a]; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return begin_of(i) < begin_of(j); });
    double end = order.empty() ? 0.0 : begin_of(order.front());
    for (auto cell = order.begin(); cell != order.end(); ++cell) {
      if (begin_of(*cell) - end > widest) {
        widest = begin_of(*cell) - end;
        const bool first_side = cell - order.begin() <= order.end() - cell;
        beyond.assign(first_side ? order.begin() : cell, first_side ? cell : order.end());
      }
      end = std::max(end, positions[*cell][a] + half[*cell][a]);
    }
  }
  std::sort(beyond.begin(), beyond.end());
  return beyond;
}

std::vector<std::vector<std::size_t>> components(std::size_t cells, std::span<const Pair> pairs) {
  // Union-find with path halving.
  std::vector<std::size_t> parent(cells);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root_of = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [i, j] : pairs) {
    const std::size_t a = root_of(static_cast<std::size_t>(i)), b = root_of(static_cast<std::size_t>(j));
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> group_of(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const std::size_t root = root_of(i);
    if (root == i) {
      group_of[i] = groups.size();
      groups.emplace_back();
    }
    groups[group_of[root]].push_back(i);
  }
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

template <int Dim>
Nearest nearest_outside(std::span<const std::size_t> group, std::span<const Vec<Dim>> positions) {
  const int axis = longest_axis_of<Dim>(positions);
  std::vector<std::size_t> outside = sorted_along<Dim>(axis, positions);
  std::erase_if(outside, [&](std::size_t i) { return std::binary_search(group.begin(), group.end(), i); });
  Nearest best{0, 0, 1e300};
  for (const std::size_t i : group) {
    const double at = positions[i][axis];
    const auto middle = std::lower_bound(outside.begin(), outside.end(), at,
                                         [&](std::size_t j, double x) { return positions[j][axis] < x; });
    // outwards on either side, as far as something nearer than the best may lie
    const auto look_at = [&](std::size_t j) {
      const double distance = (positions[j] - positions[i]).norm();
      if (distance < best.distance_mm) best = {i, j, distance};
      return std::abs(positions[j][axis] - at) < best.distance_mm;
    };
    for (auto j = middle; j != outside.end() && look_at(*j); ++j) {
    }
    for (auto j = middle; j != outside.begin() && look_at(*std::prev(j)); --j) {
    }
  }
  return best;
}

template <int Dim>
std::vector<Pair> closer_than(double q, std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics,
                              std::size_t at_most) {
  std::vector<Pair> found;
  if (positions.empty()) return found;
  const int axis = longest_axis_of<Dim>(positions);
  const std::vector<std::size_t> order = sorted_along<Dim>(axis, positions);
  for (auto first = order.begin(); first != order.end(); ++first) {
    const std::size_t i = *first;
    const double furthest = reach<Dim>(metrics[i])[axis] * q / kernel_support;
    for (auto second = first + 1; second != order.end(); ++second) {
      const std::size_t j = *second;
      const Vec<Dim> r = positions[j] - positions[i];
      if (r[axis] > furthest) break;
      if (0.5 * r.dot((metrics[i] + metrics[j]) * r) >= q * q) continue;
      found.push_back({static_cast<std::int32_t>(std::min(i, j)), static_cast<std::int32_t>(std::max(i, j))});
      if (found.size() == at_most) return found;
    }
  }
  return found;
}

template std::vector<std::size_t> beyond_gap<2>(std::span<const Vec<2>>, std::span<const Mat<2>>);
template std::vector<std::size_t> beyond_gap<3>(std::span<const Vec<3>>, std::span<const Mat<3>>);
template Nearest nearest_outside<2>(std::span<const std::size_t>, std::span<const Vec<2>>);
template Nearest nearest_outside<3>(std::span<const std::size_t>, std::span<const Vec<3>>);
template std::vector<Pair> closer_than<2>(double, std::span<const Vec<2>>, std::span<const Mat<2>>, std::size_t);
template std::vector<Pair> closer_than<3>(double, std::span<const Vec<3>>, std::span<const Mat<3>>, std::size_t);

}  // namespace rootsoil
