// SPDX-License-Identifier: MIT
// Cholesky factors of a symmetric positive definite band matrix, in blocks that Eigen's kernels work on. A root is a
// strip: ordered along it, its stiffness is such a band, and no ordering of a sparse matrix leaves less to do
// (docs/decisions/0021).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace rootsoil {

class BandCholesky {
 public:
  /// A zero matrix of so many rows, with entries up to `band` places below the diagonal.
  void reset(std::int64_t rows, std::int64_t band);

  std::int64_t rows() const { return rows_; }
  std::int64_t band() const { return band_; }
  /// Column c from its diagonal entry downwards: entry k is (c + k, c). Only the lower triangle is read.
  double* column(std::int64_t c) { return entries_.data() + c * stride_; }
  const double* column(std::int64_t c) const { return entries_.data() + c * stride_; }

  /// Replaces the matrix by its factor. False: it is not positive definite.
  bool factor();
  /// Solves with the factor, in place.
  void solve(Eigen::Ref<Eigen::VectorXd> x) const;
  /// Matrix or factor, to the last bit.
  std::vector<double> save() const;
  void restore(const std::vector<double>& saved);

 private:
  using View = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  using ConstView = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  /// Entries from (row, column), on or below the diagonal: as an ordinary matrix whose columns lie stride - 1 apart.
  View view(std::int64_t row, std::int64_t column, std::int64_t rows, std::int64_t columns);
  ConstView view(std::int64_t row, std::int64_t column, std::int64_t rows, std::int64_t columns) const;
  std::int64_t rows_below(std::int64_t block_end) const;

  std::int64_t rows_ = 0, band_ = 0, stride_ = 0;
  Eigen::VectorXd entries_;           ///< aligned: the order of sums must not depend on where it lies
  Eigen::MatrixXd diagonal_, panel_;  ///< of the block under way, contiguous
};

}  // namespace rootsoil
