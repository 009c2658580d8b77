// SPDX-License-Identifier: MIT
#include "root_sph/core/symmetric.hpp"

namespace rootsoil {

template <int Dim>
SymmetricEigen<Dim> symmetric_eigen(const Mat<Dim>& m) {
  const Eigen::SelfAdjointEigenSolver<Mat<Dim>> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <int Dim>
Mat<Dim> cholesky_factor(const Mat<Dim>& m) {
  return m.llt().matrixL();
}

template <int Dim>
bool is_positive_definite(const Mat<Dim>& m) {
  return m.llt().info() == Eigen::Success;
}

template SymmetricEigen<2> symmetric_eigen<2>(const Mat<2>&);
template SymmetricEigen<3> symmetric_eigen<3>(const Mat<3>&);
template Mat<2> cholesky_factor<2>(const Mat<2>&);
template Mat<3> cholesky_factor<3>(const Mat<3>&);
template bool is_positive_definite<2>(const Mat<2>&);
template bool is_positive_definite<3>(const Mat<3>&);

}  // namespace rootsoil
