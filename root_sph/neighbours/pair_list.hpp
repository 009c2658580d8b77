// SPDX-License-Identifier: MIT
// Which cells interact: positions and metrics in, pairs of indices out. Knows no physics.
//
// Pairs are unique (i < j), sorted, and grouped in blocks such that the pairs of block b touch only
// cells of blocks b and b+1. All blocks of one parity can therefore be worked on at once, each adding
// to both cells of its pairs without atomics, and every cell receives its contributions in the same
// order whatever the number of threads: results are bit-identical.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "root_sph/core/types.hpp"

namespace rootsoil {

struct Pair {
  std::int32_t i, j;
};

struct PairBlock {
  std::int64_t first_cell, last_cell;  ///< [first, last)
  std::int64_t first_pair, last_pair;  ///< [first, last)
};

struct PairList {
  std::vector<Pair> pairs;
  std::vector<std::int64_t> row;  ///< pairs of cell i as first partner: [row[i], row[i+1])
  std::vector<PairBlock> blocks;
  std::vector<std::int32_t> neighbours;  ///< number of partners of each cell
};

/// Order in which cells should be stored so that pairs are close in memory and blocks are short: by the
/// slabs of a grid, slabs along the longest extent of the cloud. Returns new_to_old.
template <int Dim>
std::vector<std::int64_t> spatial_order(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics);

/// All pairs with sqrt(r^T (M_i + M_j)/2 r) < kernel_support. Any order of cells is correct; the order of
/// spatial_order() is fast.
template <int Dim>
PairList find_pairs(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics);

/// Calls body(block) for every block: even blocks in parallel, then odd blocks.
template <class Body>
void for_each_block(const PairList& list, Body&& body) {
  const auto blocks = static_cast<std::int64_t>(list.blocks.size());
  for (std::int64_t parity = 0; parity < 2; ++parity) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t b = parity; b < blocks; b += 2) body(list.blocks[static_cast<std::size_t>(b)]);
  }
}

}  // namespace rootsoil
