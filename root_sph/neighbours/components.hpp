// SPDX-License-Identifier: MIT
// Which cells hang together, and which lie in one place: positions and metrics in, indices out. Knows no physics.
#pragma once

#include <span>
#include <vector>

#include "root_sph/core/types.hpp"
#include "root_sph/neighbours/pair_list.hpp"

namespace rootsoil {

/// The cells on the smaller side of the widest gap across an axis that no pair of find_pairs() spans; empty where there
/// is none. Sorts and looks at no pair: what it finds would put all other cells in one bin of a grid.
template <int Dim>
std::vector<std::size_t> beyond_gap(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics);

/// Cells that are joined by pairs, directly or through others: the largest group first, each in rising order.
std::vector<std::vector<std::size_t>> components(std::size_t cells, std::span<const Pair> pairs);

/// A cell of a group and the one outside that is nearest to it. The group is in rising order and not everything.
struct Nearest {
  std::size_t inside = 0, outside = 0;
  double distance_mm = 0.0;
};
template <int Dim>
Nearest nearest_outside(std::span<const std::size_t> group, std::span<const Vec<Dim>> positions);

/// Pairs with sqrt(r^T (M_i + M_j)/2 r) < q, i < j; the first few only, so that any number of cells may lie in one
/// place.
template <int Dim>
std::vector<Pair> closer_than(double q, std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics,
                              std::size_t at_most);

}  // namespace rootsoil
