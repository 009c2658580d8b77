// SPDX-License-Identifier: MIT
#include "root_sph/exchange/surface_mapping.hpp"

#include "root_sph/core/errors.hpp"
#include "root_sph/core/symmetric.hpp"
#include "root_sph/exchange/kernel_cover.hpp"

namespace rootsoil {
namespace {

template <int Dim>
struct Candidate {
  std::size_t cell;
  Vec<Dim> r;  ///< from the marker to the cell
  double q;
};

/// Wendland's C2 without its norm: every cell counts as one, whatever its size.
double kernel_shape(double q) {
  const double s = 1.0 - 0.5 * q;
  return s * s * s * s * (2.0 * q + 1.0);
}

/// Appends the weights of a marker; false (and nothing appended) where the cells do not span the space.
///
/// About the weighted centre of the cells the constant and the linear part decouple: with y = L^T (x - centre),
/// L L^T = Q of the nearest cell, and C = mean of y y^T, phi_j = w_j/W (1 + y_m^T C^-1 y_j).
template <int Dim>
bool append_weights(const std::vector<Candidate<Dim>>& near, std::span<const Mat<Dim>> shapes,
                    std::vector<typename SurfaceMapping<Dim>::Share>& shares) {
  constexpr double smallest_spread = 0.02;  // variance of the cells' centres, in half cell lengths
  if (near.empty()) return false;
  const Candidate<Dim>* nearest = &near[0];
  double total = 0.0;
  Vec<Dim> centre = Vec<Dim>::Zero();
  for (const Candidate<Dim>& c : near) {
    if (c.q < nearest->q) nearest = &c;
    total += kernel_shape(c.q);
    centre += kernel_shape(c.q) * c.r;
  }
  centre /= total;
  const Mat<Dim> scale = cholesky_factor<Dim>(shapes[nearest->cell]);
  Mat<Dim> spread = Mat<Dim>::Zero();
  for (const Candidate<Dim>& c : near) {
    const Vec<Dim> y = scale.transpose() * (c.r - centre);
    spread += kernel_shape(c.q) / total * y * y.transpose();
  }
  const SymmetricEigen<Dim> eigen = symmetric_eigen<Dim>(spread);
  if (!(eigen.values[0] > smallest_spread)) return false;
  const Mat<Dim> inverse = eigen.vectors * eigen.values.cwiseInverse().asDiagonal() * eigen.vectors.transpose();
  const Vec<Dim> marker = scale.transpose() * -centre;
  for (const Candidate<Dim>& c : near) {
    const Vec<Dim> y = inverse * (scale.transpose() * (c.r - centre));
    const double w = kernel_shape(c.q) / total;
    shares.push_back({static_cast<std::int32_t>(c.cell), w * (1.0 + marker.dot(y)), w * (scale * y)});
  }
  return true;
}

/// For a marker with too few cells about it: wider and wider, over all cells. Cells on a line (or one cell) leave
/// only the constant part.
template <int Dim>
void append_widened(const Vec<Dim>& marker, std::span<const Vec<Dim>> cells, std::span<const Mat<Dim>> shapes,
                    double width_cells, std::vector<typename SurfaceMapping<Dim>::Share>& shares) {
  std::vector<Candidate<Dim>> near;
  constexpr double widest_cells = 1e3;
  for (double width = 1.3 * width_cells; width < widest_cells; width *= 1.3) {
    near.clear();
    for (std::size_t j = 0; j < cells.size(); ++j) {
      const Vec<Dim> r = cells[j] - marker;
      const double q = std::sqrt(r.dot(cell_metric<Dim>(shapes[j], width) * r));
      if (q < kernel_support) near.push_back({j, r, q});
    }
    if (append_weights<Dim>(near, shapes, shares)) return;
  }
  ROOTSOIL_ASSERT(!near.empty());
  double total = 0.0;
  for (const Candidate<Dim>& c : near) total += kernel_shape(c.q);
  for (const Candidate<Dim>& c : near) {
    shares.push_back({static_cast<std::int32_t>(c.cell), kernel_shape(c.q) / total, Vec<Dim>::Zero()});
  }
}

}  // namespace

template <int Dim>
SurfaceMapping<Dim>::SurfaceMapping(std::span<const Vec<Dim>> markers, std::span<const Vec<Dim>> cells,
                                    std::span<const Mat<Dim>> shapes, double width_cells) {
  std::vector<Mat<Dim>> metrics;
  metrics.reserve(shapes.size());
  for (const Mat<Dim>& shape : shapes) metrics.push_back(cell_metric<Dim>(shape, width_cells));
  const KernelCover<Dim> cover(cells, metrics);
  row_.assign(1, 0);
  std::vector<Candidate<Dim>> near;
  for (const Vec<Dim>& x : markers) {
    near.clear();
    cover.at(x, [&](std::size_t cell, const Vec<Dim>& r, double q) { near.push_back({cell, r, q}); });
    if (!append_weights<Dim>(near, shapes, shares_)) {
      ++widened_;
      append_widened<Dim>(x, cells, shapes, width_cells, shares_);
    }
    row_.push_back(shares_.size());
  }
}

template <int Dim>
Spin<Dim> SurfaceMapping<Dim>::half_curl(std::size_t marker, std::span<const Vec<Dim>> v) const {
  Spin<Dim> sum = Spin<Dim>::Zero();
  for (const Share& s : shares(marker)) sum += 0.5 * cross<Dim>(s.gradient, v[static_cast<std::size_t>(s.cell)]);
  return sum;
}

template <int Dim>
void SurfaceMapping<Dim>::spread(std::size_t marker, const Vec<Dim>& force_N, const Spin<Dim>& torque_Nmm,
                                 std::span<Vec<Dim>> f) const {
  for (const Share& s : shares(marker)) {
    f[static_cast<std::size_t>(s.cell)] += s.weight * force_N + 0.5 * turned<Dim>(torque_Nmm, s.gradient);
  }
}

template class SurfaceMapping<2>;
template class SurfaceMapping<3>;

}  // namespace rootsoil
