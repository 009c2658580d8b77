// SPDX-License-Identifier: MIT
// What preconditioners have in common: the order of cells along the root, and sums over their shares of the stiffness.
#pragma once

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "root_sph/dynamics/band_cholesky.hpp"
#include "root_sph/dynamics/tangent.hpp"

namespace rootsoil {

/// All cells from the base to the tip.
template <int Dim>
std::vector<std::int32_t> order_along_root(const ParticleStore<Dim>& cells) {
  std::vector<std::int32_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(-cells.distance_to_tip[a], a) < std::pair(-cells.distance_to_tip[b], b);
  });
  return order;
}

/// Calls body(cell) so that cells whose stencils meet are never worked on at once, and in the same order for any number
/// of threads: the cells along the root in chunks twice as long as a stencil, even ones first.
/// \param rank of each cell along the root
/// \param apart how many cells must lie between stencils that are worked on at once
/// \param make_body makes the body of a chunk
template <int Dim, class MakeBody>
void for_each_chunk(const std::vector<std::int32_t>& order, const std::vector<std::int32_t>& rank,
                    const Stencils<Dim>& stencils, std::int64_t apart, MakeBody&& make_body) {
  std::int64_t reach = 1;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    for (const auto& node : stencils.of(i)) reach = std::max<std::int64_t>(reach, std::abs(rank[node.cell] - rank[i]));
  }
  const std::int64_t length = 2 * reach + apart, cells = std::ssize(order), chunks = (cells + length - 1) / length;
  for (std::int64_t parity = 0; parity < 2; ++parity) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t c = parity; c < chunks; c += 2) {
      auto body = make_body();
      for (std::int64_t k = c * length; k < std::min(cells, (c + 1) * length); ++k) body(order[k]);
    }
  }
}

inline std::vector<std::int32_t> inverse_of(const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::int32_t>(k);
  return rank;
}

/// A root that nothing holds may move as a whole without any force: the matrix alone must not let it.
inline void hold_loosely(BandCholesky& matrix) {
  constexpr double share = 1e-6;
  double largest = 0.0;
  for (std::int64_t c = 0; c < matrix.rows(); ++c) largest = std::max(largest, matrix.column(c)[0]);
  for (std::int64_t c = 0; c < matrix.rows(); ++c) matrix.column(c)[0] += share * largest;
}

/// out[e] += sum_v a(v, column) a(v, column + e): a column of a^T a from its diagonal downwards.
template <int Rows>
void add_square(const NodeRows<Rows>& a, Eigen::Index column, double* __restrict out) {
  const Eigen::Index stride = a.cols(), length = stride - column;
  const double* const from = a.data() + column;
  double factor[Rows];
  for (int v = 0; v < Rows; ++v) factor[v] = from[v * stride];
  for (Eigen::Index e = 0; e < length; ++e) {
    double sum = 0.0;
    for (int v = 0; v < Rows; ++v) sum += factor[v] * from[v * stride + e];
    out[e] += sum;
  }
}

/// out[e] += sum_v (a(v, column) b(v, column + e) + b(v, column) a(v, column + e)): the same of a^T b + b^T a.
template <int Rows>
void add_cross(const NodeRows<Rows>& a, const NodeRows<Rows>& b, Eigen::Index column, double* __restrict out) {
  const Eigen::Matrix<double, Rows, 1> of_a = a.col(column), of_b = b.col(column);
  const double *const from_a = a.data() + column, *const from_b = b.data() + column;
  const Eigen::Index stride = a.cols(), length = stride - column;
  for (Eigen::Index e = 0; e < length; ++e) {
    double sum = 0.0;
    for (int v = 0; v < Rows; ++v) sum += of_a[v] * from_b[v * stride + e] + of_b[v] * from_a[v * stride + e];
    out[e] += sum;
  }
}

}  // namespace rootsoil
