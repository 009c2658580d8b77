// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/cell_axes.hpp"

#include <cmath>

#include "root_sph/core/symmetric.hpp"

namespace rootsoil {

template <int Dim>
LongestAxis<Dim> longest_axis(const Mat<Dim>& shape) {
  const SymmetricEigen<Dim> eigen = symmetric_eigen<Dim>(shape);
  Vec<Dim> direction = eigen.vectors.col(0);
  // the sign of an eigenvector is arbitrary; fix it so that daughters keep their order
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  if (direction[largest] < 0.0) direction = -direction;
  return {direction, 2.0 / std::sqrt(eigen.values[0])};
}

template <int Dim>
Vec<Dim> axis_lengths_mm(const Mat<Dim>& shape) {
  return 2.0 * Eigen::SelfAdjointEigenSolver<Mat<Dim>>(shape, Eigen::EigenvaluesOnly)
                   .eigenvalues()
                   .cwiseSqrt()
                   .cwiseInverse();
}

template LongestAxis<2> longest_axis<2>(const Mat<2>&);
template LongestAxis<3> longest_axis<3>(const Mat<3>&);
template Vec<2> axis_lengths_mm<2>(const Mat<2>&);
template Vec<3> axis_lengths_mm<3>(const Mat<3>&);

}  // namespace rootsoil
