// SPDX-License-Identifier: MIT
#include "root_sph/neighbours/pair_list.hpp"

#include <algorithm>
#include <numeric>

#include "root_sph/kernels/wendland.hpp"
#include "root_sph/neighbours/cell_grid.hpp"

namespace rootsoil {
namespace {

template <int Dim>
std::vector<Vec<Dim>> reaches_of(std::span<const Mat<Dim>> metrics) {
  std::vector<Vec<Dim>> reaches(metrics.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < metrics.size(); ++i) reaches[i] = reach<Dim>(metrics[i]);
  return reaches;
}

/// Cells sorted by bin: the cells of bin b are cells[start[b]] ... cells[start[b+1] - 1], in rising order.
struct Bins {
  std::vector<std::int64_t> start;
  std::vector<std::int64_t> cells;
};

template <int Dim>
Bins sort_into_bins(const CellGrid<Dim>& grid, std::span<const Vec<Dim>> positions) {
  Bins bins;
  std::vector<std::int64_t> bin(positions.size());
  bins.start.assign(static_cast<std::size_t>(grid.bins()) + 1, 0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    bin[i] = grid.bin_of(positions[i]);
    ++bins.start[static_cast<std::size_t>(bin[i]) + 1];
  }
  std::partial_sum(bins.start.begin(), bins.start.end(), bins.start.begin());
  bins.cells.resize(positions.size());
  std::vector<std::int64_t> next(bins.start.begin(), bins.start.end() - 1);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    bins.cells[static_cast<std::size_t>(next[static_cast<std::size_t>(bin[i])]++)] = static_cast<std::int64_t>(i);
  }
  return bins;
}

/// Greedy blocks: each ends no earlier than the furthest partner of the block before it.
std::vector<PairBlock> make_blocks(const PairList& list, std::int64_t cells) {
  constexpr std::int64_t smallest_block = 48;
  std::vector<PairBlock> blocks;
  std::int64_t first = 0;
  std::int64_t must_reach = 0;
  while (first < cells) {
    const std::int64_t last = std::min(cells, std::max(must_reach, first + smallest_block));
    blocks.push_back(
        {first, last, list.row[static_cast<std::size_t>(first)], list.row[static_cast<std::size_t>(last)]});
    must_reach = last;
    for (std::int64_t k = blocks.back().first_pair; k < blocks.back().last_pair; ++k) {
      must_reach = std::max<std::int64_t>(must_reach, list.pairs[static_cast<std::size_t>(k)].j + 1);
    }
    first = last;
  }
  return blocks;
}

}  // namespace

template <int Dim>
std::vector<std::int64_t> spatial_order(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics) {
  const std::vector<Vec<Dim>> reaches = reaches_of<Dim>(metrics);
  const CellGrid<Dim> grid(positions, reaches);
  return sort_into_bins<Dim>(grid, positions).cells;
}

template <int Dim>
PairList find_pairs(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics) {
  const auto cells = static_cast<std::int64_t>(positions.size());
  const std::vector<Vec<Dim>> reaches = reaches_of<Dim>(metrics);
  const CellGrid<Dim> grid(positions, reaches);
  const Bins bins = sort_into_bins<Dim>(grid, positions);
  const std::array<int, Dim>& order = grid.order();

  // Pairs are found chunk by chunk in parallel and joined in order: independent of the number of threads.
  constexpr std::int64_t chunk_size = 256;
  const std::int64_t chunks = (cells + chunk_size - 1) / chunk_size;
  std::vector<std::vector<Pair>> found(static_cast<std::size_t>(chunks));
  PairList list;
  list.row.assign(static_cast<std::size_t>(cells) + 1, 0);

#pragma omp parallel for schedule(dynamic, 1)
  for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
    std::vector<Pair>& mine = found[static_cast<std::size_t>(chunk)];
    const std::int64_t last = std::min(cells, (chunk + 1) * chunk_size);
    for (std::int64_t i = chunk * chunk_size; i < last; ++i) {
      const std::size_t before = mine.size();
      const Vec<Dim>& xi = positions[static_cast<std::size_t>(i)];
      const Vec<Dim>& ri = reaches[static_cast<std::size_t>(i)];
      const Mat<Dim>& mi = metrics[static_cast<std::size_t>(i)];
      std::array<std::int64_t, Dim> lower{}, upper{};
      for (int a = 0; a < Dim; ++a) {
        lower[a] = grid.coordinate(xi[a] - ri[a], a);
        upper[a] = grid.coordinate(xi[a] + ri[a], a);
      }
      const auto visit_row = [&](std::array<std::int64_t, Dim> at) {
        at[order[Dim - 1]] = lower[order[Dim - 1]];
        const std::int64_t from = bins.start[static_cast<std::size_t>(grid.index(at))];
        at[order[Dim - 1]] = upper[order[Dim - 1]];
        const std::int64_t to = bins.start[static_cast<std::size_t>(grid.index(at)) + 1];
        for (std::int64_t k = from; k < to; ++k) {
          const std::int64_t j = bins.cells[static_cast<std::size_t>(k)];
          if (j <= i) continue;
          const Vec<Dim> r = positions[static_cast<std::size_t>(j)] - xi;
          const double q2 = 0.5 * r.dot((mi + metrics[static_cast<std::size_t>(j)]) * r);
          if (q2 < kernel_support * kernel_support) {
            mine.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
          }
        }
      };
      std::array<std::int64_t, Dim> at = lower;
      for (at[order[0]] = lower[order[0]]; at[order[0]] <= upper[order[0]]; ++at[order[0]]) {
        if constexpr (Dim == 2) {
          visit_row(at);
        } else {
          for (at[order[1]] = lower[order[1]]; at[order[1]] <= upper[order[1]]; ++at[order[1]]) visit_row(at);
        }
      }
      std::sort(mine.begin() + static_cast<std::ptrdiff_t>(before), mine.end(),
                [](const Pair& a, const Pair& b) { return a.j < b.j; });
      list.row[static_cast<std::size_t>(i) + 1] = static_cast<std::int64_t>(mine.size() - before);
    }
  }
  std::partial_sum(list.row.begin(), list.row.end(), list.row.begin());
  list.pairs.reserve(static_cast<std::size_t>(list.row.back()));
  for (const auto& part : found) list.pairs.insert(list.pairs.end(), part.begin(), part.end());

  list.neighbours.assign(static_cast<std::size_t>(cells), 0);
  for (const Pair& p : list.pairs) {
    ++list.neighbours[static_cast<std::size_t>(p.i)];
    ++list.neighbours[static_cast<std::size_t>(p.j)];
  }
  list.blocks = make_blocks(list, cells);
  return list;
}

template std::vector<std::int64_t> spatial_order<2>(std::span<const Vec<2>>, std::span<const Mat<2>>);
template std::vector<std::int64_t> spatial_order<3>(std::span<const Vec<3>>, std::span<const Mat<3>>);
template PairList find_pairs<2>(std::span<const Vec<2>>, std::span<const Mat<2>>);
template PairList find_pairs<3>(std::span<const Vec<3>>, std::span<const Mat<3>>);

}  // namespace rootsoil
