// SPDX-License-Identifier: MIT
// Wendland's C2 kernel in a metric: q = sqrt(r^T M r), support q < 2.
//
// With M = Q/(4 eta^2), Q the shape matrix of the cell, the kernel stretches with the cell and keeps
// its number of neighbours through a ten-fold stretch; with M = 1/h^2 it is the usual isotropic kernel.
// Source: Wendland 1995; the metric form is that of adaptive SPH (Owen et al. 1998).
#pragma once

#include <numbers>

#include "root_sph/core/types.hpp"

namespace rootsoil {

/// Pairs interact where q < kernel_support.
inline constexpr double kernel_support = 2.0;

/// Normalisation for a unit metric: 2D 7/(4 pi), 3D 21/(16 pi).
template <int Dim>
inline constexpr double wendland_norm = (Dim == 2 ? 7.0 / 4.0 : 21.0 / 16.0) / std::numbers::pi;

/// W(q), 1/mm^Dim. sqrt_det = sqrt(det M).
template <int Dim>
double wendland(double q, double sqrt_det) {
  const double s = 1.0 - 0.5 * q;
  return q < kernel_support ? wendland_norm<Dim> * sqrt_det * s * s * s * s * (2.0 * q + 1.0) : 0.0;
}

/// -W'(q)/q, finite at q = 0: the gradient of W is -(this) M r.
template <int Dim>
double wendland_slope(double q, double sqrt_det) {
  const double s = 1.0 - 0.5 * q;
  return q < kernel_support ? wendland_norm<Dim> * sqrt_det * 5.0 * s * s * s : 0.0;
}

/// Metric of a cell-shaped kernel, M = Q/(4 eta^2). Q's eigenvalues are 4/length^2, so q = distance/(eta length)
/// along each axis of the cell: the kernel reaches 2 eta cell lengths.
template <int Dim>
Mat<Dim> cell_metric(const Mat<Dim>& shape, double eta) {
  return shape / (4.0 * eta * eta);
}

/// Metric of the isotropic kernel with smoothing length h (paper: h = H_bar sqrt(Dim) l0, docs/decisions).
template <int Dim>
Mat<Dim> isotropic_metric(double h_mm) {
  return Mat<Dim>::Identity() / (h_mm * h_mm);
}

}  // namespace rootsoil
