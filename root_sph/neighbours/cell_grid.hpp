// SPDX-License-Identifier: MIT
// A regular grid over a cloud of points; bins are as wide as a part of the typical reach of a kernel.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "root_sph/core/types.hpp"

namespace rootsoil {

/// Half-widths of the box that holds every partner of a cell. A pair needs r^T (M_i + M_j) r / 2 < 4, so both
/// r^T M_i r < 8 and r^T M_j r < 8: the box of either cell's ellipsoid r^T M r < 8 is enough.
template <int Dim>
Vec<Dim> reach(const Mat<Dim>& metric);

template <int Dim>
class CellGrid {
 public:
  CellGrid(std::span<const Vec<Dim>> positions, std::span<const Vec<Dim>> reaches);

  std::int64_t bin_of(const Vec<Dim>& position) const;
  std::int64_t bins() const { return bins_; }
  /// Bin coordinate along axis a, clamped to the grid.
  std::int64_t coordinate(double x, int a) const;
  /// Bins are numbered with axis order()[0] slowest; order()[Dim-1] runs fastest and is contiguous.
  const std::array<int, Dim>& order() const { return order_; }
  std::int64_t index(const std::array<std::int64_t, Dim>& coordinates) const;

 private:
  Vec<Dim> lower_, width_;
  std::array<std::int64_t, Dim> count_{};
  std::array<int, Dim> order_{};
  std::int64_t bins_ = 0;
};

extern template class CellGrid<2>;
extern template class CellGrid<3>;

}  // namespace rootsoil
