// SPDX-License-Identifier: MIT
// Between cells and surface markers: motion goes from the cells to the markers, forces from the markers to the cells,
// by the same weights, so that neither force nor torque nor power is lost or made.
//
// The weights phi of a marker are moving least squares of first order over the cell-shaped kernels that reach it:
// sum phi_j = 1, sum phi_j x_j = x_m, sum x_j (x) grad phi_j = 1. Hence
//   u_m = sum phi_j u_j and spin_m = 1/2 sum grad phi_j x u_j   are exact for linear velocity fields, and
//   f_j = phi_j F + 1/2 T x grad phi_j                          has the force F and the torque x_m x F + T.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "root_sph/core/types.hpp"
#include "root_sph/exchange/spin.hpp"

namespace rootsoil {

template <int Dim>
class SurfaceMapping {
 public:
  /// Share of one cell in one marker.
  struct Share {
    std::int32_t cell;
    double weight;      ///< phi
    Vec<Dim> gradient;  ///< grad phi, 1/mm
  };

  /// \param markers positions, mm
  /// \param cells, shapes positions (mm) and Q (1/mm^2) of the cells, at least one
  /// \param width_cells reach of the weights is twice this many cell lengths. Where too few cells lie within it (a
  ///        marker off the tissue) it is widened until a linear field can be told from them.
  SurfaceMapping(std::span<const Vec<Dim>> markers, std::span<const Vec<Dim>> cells, std::span<const Mat<Dim>> shapes,
                 double width_cells);
  SurfaceMapping() = default;

  std::size_t markers() const { return row_.empty() ? 0 : row_.size() - 1; }
  std::span<const Share> shares(std::size_t marker) const {
    return {shares_.data() + row_[marker], shares_.data() + row_[marker + 1]};
  }
  /// Markers for which the width did not do.
  std::int64_t widened() const { return widened_; }

  /// sum phi_j v_j; v one a cell, vectors or numbers
  template <class Values>
  auto interpolate(std::size_t marker, const Values& v) const {
    using Sum = std::decay_t<decltype(v[0])>;
    const auto all = shares(marker);
    Sum sum = all[0].weight * v[static_cast<std::size_t>(all[0].cell)];
    for (const Share& s : all.subspan(1)) sum += s.weight * v[static_cast<std::size_t>(s.cell)];
    return sum;
  }
  /// 1/2 sum grad phi_j x v_j
  Spin<Dim> half_curl(std::size_t marker, std::span<const Vec<Dim>> v) const;
  /// f_j += phi_j F + 1/2 T x grad phi_j
  void spread(std::size_t marker, const Vec<Dim>& force_N, const Spin<Dim>& torque_Nmm, std::span<Vec<Dim>> f) const;

 private:
  std::vector<std::size_t> row_;  ///< shares of marker m: [row_[m], row_[m+1])
  std::vector<Share> shares_;
  std::int64_t widened_ = 0;
};

extern template class SurfaceMapping<2>;
extern template class SurfaceMapping<3>;

}  // namespace rootsoil
