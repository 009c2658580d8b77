// SPDX-License-Identifier: MIT
#include "root_sph/neighbours/cell_grid.hpp"

#include <algorithm>
#include <cmath>

#include "root_sph/kernels/wendland.hpp"

namespace rootsoil {

template <int Dim>
Vec<Dim> reach(const Mat<Dim>& metric) {
  // extent of the ellipsoid r^T M r < c along axis a is sqrt(c (M^-1)_aa)
  const Mat<Dim> inverse = metric.inverse();
  return (2.0 * kernel_support * kernel_support * inverse.diagonal()).cwiseSqrt();
}

template <int Dim>
CellGrid<Dim>::CellGrid(std::span<const Vec<Dim>> positions, std::span<const Vec<Dim>> reaches) {
  Vec<Dim> upper = Vec<Dim>::Constant(-1e300);
  lower_ = -upper;
  Vec<Dim> mean_reach = Vec<Dim>::Zero();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    lower_ = lower_.cwiseMin(positions[i]);
    upper = upper.cwiseMax(positions[i]);
    mean_reach += reaches[i];
  }
  if (positions.empty()) lower_ = upper = Vec<Dim>::Zero();
  mean_reach /= std::max<double>(1.0, static_cast<double>(positions.size()));
  width_ = (0.5 * mean_reach).cwiseMax(1e-12);

  const Vec<Dim> extent = upper - lower_;
  for (int a = 0; a < Dim; ++a) order_[a] = a;
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return extent[a] > extent[b]; });

  // a sparse cloud (a strongly bent root) must not cost memory: widen bins until they are few
  const double most = 8.0 * static_cast<double>(positions.size()) + 64.0;
  while ((extent.cwiseQuotient(width_).array() + 1.0).prod() > most) width_ *= 1.3;
  bins_ = 1;
  for (int a = 0; a < Dim; ++a) {
    count_[a] = static_cast<std::int64_t>(extent[a] / width_[a]) + 1;
    bins_ *= count_[a];
  }
}

template <int Dim>
std::int64_t CellGrid<Dim>::coordinate(double x, int a) const {
  const double c = std::floor((x - lower_[a]) / width_[a]);
  return static_cast<std::int64_t>(std::clamp(c, 0.0, static_cast<double>(count_[a] - 1)));
}

template <int Dim>
std::int64_t CellGrid<Dim>::index(const std::array<std::int64_t, Dim>& coordinates) const {
  std::int64_t bin = 0;
  for (const int a : order_) bin = bin * count_[a] + coordinates[a];
  return bin;
}

template <int Dim>
std::int64_t CellGrid<Dim>::bin_of(const Vec<Dim>& position) const {
  std::array<std::int64_t, Dim> c{};
  for (int a = 0; a < Dim; ++a) c[a] = coordinate(position[a], a);
  return index(c);
}

template Vec<2> reach<2>(const Mat<2>&);
template Vec<3> reach<3>(const Mat<3>&);
template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace rootsoil
