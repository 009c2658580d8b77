// SPDX-License-Identifier: MIT
// Small symmetric matrices. Eigen's decompositions take tens of seconds to compile: only symmetric.cpp holds them.
#pragma once

#include "root_sph/core/types.hpp"

namespace rootsoil {

template <int Dim>
struct SymmetricEigen {
  Vec<Dim> values;   ///< ascending
  Mat<Dim> vectors;  ///< in columns, orthonormal, of arbitrary sign
};

/// By iteration, not by the roots of the characteristic polynomial: exact axes even where two values nearly agree.
template <int Dim>
SymmetricEigen<Dim> symmetric_eigen(const Mat<Dim>& m);

/// L of the positive definite matrix m = L L^T.
template <int Dim>
Mat<Dim> cholesky_factor(const Mat<Dim>& m);

/// Cheaper than the eigenvalues.
template <int Dim>
bool is_positive_definite(const Mat<Dim>& m);

}  // namespace rootsoil
