// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/gradient.hpp"

#include <algorithm>
#include <cmath>

#include "root_sph/core/symmetric.hpp"
#include "root_sph/kernels/wendland.hpp"

namespace rootsoil {
namespace {

template <int Dim>
inline constexpr int basis_size = Dim + Dim*(Dim + 1) / 2;  // linear and quadratic monomials

template <int Dim>
using Basis = Eigen::Matrix<double, basis_size<Dim>, 1>;

template <int Dim>
Basis<Dim> basis(const Vec<Dim>& x) {
  Basis<Dim> p;
  if constexpr (Dim == 2) {
    p << x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1];
  } else {
    p << x[0], x[1], x[2], x[0] * x[0], x[1] * x[1], x[2] * x[2], x[0] * x[1], x[1] * x[2], x[0] * x[2];
  }
  return p;
}

double smooth_step(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Moments of a cell's neighbourhood in its own metric.
template <int Dim>
struct Neighbourhood {
  Mat<Dim> second = Mat<Dim>::Zero();
  Vec<Dim> first = Vec<Dim>::Zero();
  double length = 0.0;  ///< sum of weight |xi|, to measure `first` against
};

/// Inverse of a symmetric positive matrix on the directions that the neighbours span.
template <int Dim>
Mat<Dim> guarded_inverse(const Mat<Dim>& m, bool& degenerate) {
  constexpr double smallest_relative_eigenvalue = 0.02;
  const SymmetricEigen<Dim> eigen = symmetric_eigen<Dim>(m);
  Vec<Dim> values = eigen.values;
  const double largest = values[Dim - 1];
  degenerate = !(values[0] > smallest_relative_eigenvalue * largest) || largest <= 0.0;
  for (int a = 0; a < Dim; ++a) {
    values[a] = largest > 0.0 && values[a] > smallest_relative_eigenvalue * largest ? 1.0 / values[a] : 0.0;
  }
  return eigen.vectors * values.asDiagonal() * eigen.vectors.transpose();
}

/// First Dim rows of the inverse of the scaled moment matrix, with a ridge on the quadratic monomials: curvature is
/// taken to be small unless the neighbours say otherwise, so that irregular ones, or two rows that wave, do not invent
/// it (docs/decisions/0017). Linear fields stay exact. `trust` in [0, 1] fades to 0 where the neighbours do not span
/// space.
template <int Dim>
Eigen::Matrix<double, Dim, basis_size<Dim>> quadratic_fit(
    const Eigen::Matrix<double, basis_size<Dim>, basis_size<Dim>>& moment, double& trust) {
  constexpr double smallest_pivot = 1e-3, ridge = 0.05;
  using Moment = Eigen::Matrix<double, basis_size<Dim>, basis_size<Dim>>;
  // Eigen's sums begin at the first aligned element: without a fixed alignment the last bits would depend on where the
  // thread's stack lies.
  constexpr std::size_t cache_line = 64;
  const Basis<Dim> scale = moment.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  alignas(cache_line) Moment scaled = scale.asDiagonal() * moment * scale.asDiagonal();
  scaled.diagonal().template tail<basis_size<Dim> - Dim>().array() += ridge;
  alignas(cache_line) const Eigen::LDLT<Moment> factors(scaled);
  trust = smooth_step(factors.vectorD().minCoeff(), smallest_pivot, 4.0 * smallest_pivot);
  if (trust <= 0.0) return Eigen::Matrix<double, Dim, basis_size<Dim>>::Zero();
  alignas(cache_line) Eigen::Matrix<double, basis_size<Dim>, Dim> columns =
      Eigen::Matrix<double, basis_size<Dim>, Dim>::Zero();
  columns.template topRows<Dim>() = scale.template head<Dim>().asDiagonal();
  factors.solveInPlace(columns);
  return (scale.asDiagonal() * columns).transpose();
}

}  // namespace

template <int Dim>
GradientReport build_gradients(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics,
                               std::span<const double> volumes, const PairList& list, GradientMode mode,
                               std::vector<PairGradient<Dim>>& gradients, std::vector<double>& kernel) {
  const std::size_t cells = positions.size();
  gradients.resize(list.pairs.size());
  kernel.resize(list.pairs.size());
  std::vector<double> slope(list.pairs.size());
  std::vector<Mat<Dim>> root(cells);  // L^T of M = L L^T
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells; ++i) root[i] = cholesky_factor<Dim>(metrics[i]).transpose();

  std::vector<Neighbourhood<Dim>> around(cells);
  for_each_block(list, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = list.pairs[k];
      const Vec<Dim> r = positions[j] - positions[i];
      const Mat<Dim> metric = 0.5 * (metrics[i] + metrics[j]);
      const double q = std::sqrt(r.dot(metric * r));
      const double sqrt_det = std::sqrt(metric.determinant());
      kernel[k] = wendland<Dim>(q, sqrt_det);
      slope[k] = wendland_slope<Dim>(q, sqrt_det);
      if (mode == GradientMode::plain) {
        const Vec<Dim> g = slope[k] * (metric * r);  // -grad_i W
        gradients[k] = {volumes[j] * g, -volumes[i] * g};
        continue;
      }
      const auto add = [&](std::size_t cell, double weight, const Vec<Dim>& xi) {
        around[cell].second.noalias() += weight * xi * xi.transpose();
        around[cell].first += weight * xi;
        around[cell].length += weight * xi.norm();
      };
      add(i, volumes[j] * slope[k], root[i] * r);
      add(j, volumes[i] * slope[k], -(root[j] * r));
    }
  });
  GradientReport report;
  if (mode == GradientMode::plain) return report;

  // How much of the quadratic fit each cell gets, and room for its moments.
  using Moment = Eigen::Matrix<double, basis_size<Dim>, basis_size<Dim>>;
  std::vector<double> blend(cells, 0.0);
  std::vector<std::int64_t> slot(cells, -1);
  std::int64_t slots = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    if (mode == GradientMode::linear || list.neighbours[i] < basis_size<Dim> + 2) continue;
    // 0 in a regular interior, about 0.1 in an irregular one, 0.5 on a flat surface
    const double one_sided = around[i].length > 0.0 ? around[i].first.norm() / around[i].length : 0.0;
    blend[i] = mode == GradientMode::quadratic ? 1.0 : smooth_step(one_sided, 0.12, 0.3);
    if (blend[i] > 0.0) slot[i] = slots++;
  }
  std::vector<Moment> moments(static_cast<std::size_t>(slots), Moment::Zero());
  if (slots > 0) {
    for_each_block(list, [&](const PairBlock& block) {
      for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
        const auto [i, j] = list.pairs[k];
        if (slot[i] < 0 && slot[j] < 0) continue;
        const Vec<Dim> r = positions[j] - positions[i];
        const auto add = [&](std::size_t cell, double weight, const Vec<Dim>& xi) {
          if (slot[cell] < 0) return;
          moments[slot[cell]].template selfadjointView<Eigen::Lower>().rankUpdate(basis<Dim>(xi), weight);
        };
        add(i, volumes[j] * slope[k], root[i] * r);
        add(j, volumes[i] * slope[k], -(root[j] * r));
      }
    });
  }

  // Coefficients of the fit: gradient weight = weight L (fit basis(xi)).
  std::vector<Mat<Dim>> linear(cells);
  std::vector<Eigen::Matrix<double, Dim, basis_size<Dim>>> fit(static_cast<std::size_t>(slots));
  std::int64_t quadratic = 0, degenerate = 0;
#pragma omp parallel for schedule(static) reduction(+ : quadratic, degenerate)
  for (std::size_t i = 0; i < cells; ++i) {
    bool poor = false;
    linear[i] = guarded_inverse<Dim>(around[i].second, poor);
    degenerate += poor;
    if (slot[i] < 0) continue;
    double trust = 0.0;
    const Moment moment = moments[slot[i]].template selfadjointView<Eigen::Lower>();
    fit[slot[i]] = quadratic_fit<Dim>(moment, trust);
    const double share = blend[i] * trust;
    fit[slot[i]] *= share;
    fit[slot[i]].template leftCols<Dim>() += (1.0 - share) * linear[i];
    quadratic += share >= 0.5;
  }
  report.quadratic = quadratic;
  report.degenerate = degenerate;

#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const auto [i, j] = list.pairs[k];
    const Vec<Dim> r = positions[j] - positions[i];
    const auto weight = [&](std::size_t cell, double w, const Vec<Dim>& xi) -> Vec<Dim> {
      const Vec<Dim> local = slot[cell] < 0 ? Vec<Dim>(linear[cell] * xi) : Vec<Dim>(fit[slot[cell]] * basis<Dim>(xi));
      return w * (root[cell].transpose() * local);
    };
    gradients[k].at_i = weight(i, volumes[j] * slope[k], root[i] * r);
    gradients[k].at_j = weight(j, volumes[i] * slope[k], -(root[j] * r));
  }
  return report;
}

template GradientReport build_gradients<2>(std::span<const Vec<2>>, std::span<const Mat<2>>, std::span<const double>,
                                           const PairList&, GradientMode, std::vector<PairGradient<2>>&,
                                           std::vector<double>&);
template GradientReport build_gradients<3>(std::span<const Vec<3>>, std::span<const Mat<3>>, std::span<const double>,
                                           const PairList&, GradientMode, std::vector<PairGradient<3>>&,
                                           std::vector<double>&);

}  // namespace rootsoil
