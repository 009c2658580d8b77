// SPDX-License-Identifier: MIT
// Which cells' kernels reach a point that need not be a cell: the look-up behind mapping and outline.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "root_sph/kernels/wendland.hpp"
#include "root_sph/neighbours/cell_grid.hpp"

namespace rootsoil {

template <int Dim>
class KernelCover {
 public:
  /// \param positions, metrics one a cell; both must outlive this object
  KernelCover(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics);

  /// body(cell, r = x_cell - x, q) for every cell with q = sqrt(r^T M_cell r) < kernel_support, in the cells' order.
  template <class Body>
  void at(const Vec<Dim>& x, Body&& body) const {
    std::array<std::int64_t, Dim> bin;
    for (int a = 0; a < Dim; ++a) bin[a] = grid_.coordinate(x[a], a);
    const auto b = static_cast<std::size_t>(grid_.index(bin));
    for (std::int64_t k = row_[b]; k < row_[b + 1]; ++k) {
      const auto cell = static_cast<std::size_t>(cells_[static_cast<std::size_t>(k)]);
      const Vec<Dim> r = positions_[cell] - x;
      const double q2 = r.dot(metrics_[cell] * r);
      if (q2 < kernel_support * kernel_support) body(cell, r, std::sqrt(q2));
    }
  }

 private:
  std::span<const Vec<Dim>> positions_;
  std::span<const Mat<Dim>> metrics_;
  CellGrid<Dim> grid_;
  std::vector<std::int64_t> row_;    ///< cells of bin b: [row_[b], row_[b+1])
  std::vector<std::int32_t> cells_;  ///< that reach into the bin
};

extern template class KernelCover<2>;
extern template class KernelCover<3>;

}  // namespace rootsoil
