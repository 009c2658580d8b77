// SPDX-License-Identifier: MIT
#include "root_sph/exchange/kernel_cover.hpp"

#include <array>

namespace rootsoil {
namespace {

/// Half-widths of the box round the ellipsoid q < kernel_support.
template <int Dim>
Vec<Dim> box(const Mat<Dim>& metric) {
  const Mat<Dim> inverse = metric.inverse();
  return kernel_support * inverse.diagonal().cwiseSqrt();
}

template <int Dim>
std::vector<Vec<Dim>> boxes(std::span<const Mat<Dim>> metrics) {
  std::vector<Vec<Dim>> result;
  result.reserve(metrics.size());
  for (const Mat<Dim>& m : metrics) result.push_back(box<Dim>(m));
  return result;
}

}  // namespace

template <int Dim>
KernelCover<Dim>::KernelCover(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics)
    : positions_(positions), metrics_(metrics), grid_(positions, boxes<Dim>(metrics)) {
  row_.assign(static_cast<std::size_t>(grid_.bins()) + 1, 0);
  const auto for_each_bin = [&](std::size_t cell, auto&& body) {
    const Vec<Dim> half = box<Dim>(metrics[cell]);
    std::array<std::int64_t, Dim> first, last;
    for (int a = 0; a < Dim; ++a) {
      first[a] = grid_.coordinate(positions[cell][a] - half[a], a);
      last[a] = grid_.coordinate(positions[cell][a] + half[a], a);
    }
    std::array<std::int64_t, Dim> bin = first;
    while (bin[Dim - 1] <= last[Dim - 1]) {
      body(static_cast<std::size_t>(grid_.index(bin)));
      for (int a = 0; a < Dim; ++a) {
        if (++bin[a] <= last[a] || a == Dim - 1) break;
        bin[a] = first[a];
      }
    }
  };
  for (std::size_t c = 0; c < positions.size(); ++c) for_each_bin(c, [&](std::size_t b) { ++row_[b + 1]; });
  for (std::size_t b = 1; b < row_.size(); ++b) row_[b] += row_[b - 1];
  cells_.resize(static_cast<std::size_t>(row_.back()));
  std::vector<std::int64_t> next(row_.begin(), row_.end() - 1);
  for (std::size_t c = 0; c < positions.size(); ++c) {
    for_each_bin(c, [&](std::size_t b) { cells_[static_cast<std::size_t>(next[b]++)] = static_cast<std::int32_t>(c); });
  }
}

template class KernelCover<2>;
template class KernelCover<3>;

}  // namespace rootsoil
