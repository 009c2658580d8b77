// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/band_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace rootsoil {
namespace {

constexpr std::int64_t block = 48;  // columns that are eliminated together

}  // namespace

void BandCholesky::reset(std::int64_t rows, std::int64_t band) {
  rows_ = rows;
  band_ = std::clamp<std::int64_t>(band, 0, std::max<std::int64_t>(rows - 1, 0));
  // a block's panel is a full rectangle: it reaches as far below the band as the block is wide
  stride_ = band_ + block + 1;
  entries_.setZero((rows_ + 1) * stride_ + block);
}

BandCholesky::View BandCholesky::view(std::int64_t row, std::int64_t column, std::int64_t rows, std::int64_t columns) {
  return {entries_.data() + column * stride_ + (row - column), rows, columns, Eigen::OuterStride<>(stride_ - 1)};
}

BandCholesky::ConstView BandCholesky::view(std::int64_t row, std::int64_t column, std::int64_t rows,
                                           std::int64_t columns) const {
  return {entries_.data() + column * stride_ + (row - column), rows, columns, Eigen::OuterStride<>(stride_ - 1)};
}

std::int64_t BandCholesky::rows_below(std::int64_t block_end) const {
  return std::max<std::int64_t>(0, std::min(band_, rows_ - block_end));
}

bool BandCholesky::factor() {
  for (std::int64_t j = 0; j < rows_; j += block) {
    const std::int64_t columns = std::min(block, rows_ - j), below = rows_below(j + columns);
    diagonal_ = view(j, j, columns, columns);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factors(diagonal_);  // in place
    if (factors.info() != Eigen::Success) return false;
    view(j, j, columns, columns).triangularView<Eigen::Lower>() = diagonal_;
    if (below == 0) continue;
    panel_ = view(j + columns, j, below, columns);
    diagonal_.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(panel_);
    view(j + columns, j, below, columns) = panel_;
    view(j + columns, j + columns, below, below).selfadjointView<Eigen::Lower>().rankUpdate(panel_, -1.0);
  }
  return true;
}

std::vector<double> BandCholesky::save() const {
  std::vector<double> saved{static_cast<double>(rows_), static_cast<double>(band_)};
  for (std::int64_t c = 0; c < rows_; ++c) saved.insert(saved.end(), column(c), column(c) + band_ + 1);
  return saved;
}

void BandCholesky::restore(const std::vector<double>& saved) {
  reset(static_cast<std::int64_t>(saved.at(0)), static_cast<std::int64_t>(saved.at(1)));
  const double* from = saved.data() + 2;
  for (std::int64_t c = 0; c < rows_; ++c, from += band_ + 1) std::copy(from, from + band_ + 1, column(c));
}

void BandCholesky::solve(Eigen::Ref<Eigen::VectorXd> x) const {
  for (std::int64_t j = 0; j < rows_; j += block) {
    const std::int64_t columns = std::min(block, rows_ - j), below = rows_below(j + columns);
    view(j, j, columns, columns).triangularView<Eigen::Lower>().solveInPlace(x.segment(j, columns));
    if (below > 0)
      x.segment(j + columns, below).noalias() -= view(j + columns, j, below, columns) * x.segment(j, columns);
  }
  for (std::int64_t j = (rows_ - 1) / block * block; j >= 0; j -= block) {
    const std::int64_t columns = std::min(block, rows_ - j), below = rows_below(j + columns);
    if (below > 0) {
      x.segment(j, columns).noalias() -=
          view(j + columns, j, below, columns).transpose() * x.segment(j + columns, below);
    }
    view(j, j, columns, columns).transpose().triangularView<Eigen::Upper>().solveInPlace(x.segment(j, columns));
  }
}

}  // namespace rootsoil
