// SPDX-License-Identifier: MIT
// Gradient operators of the cells: weights of every pair, exact for linear fields, and nearly so for quadratic ones
// where the neighbourhood is one-sided.
//
// Weighted least squares in the cell's own metric, xi = L^T r with M = L L^T. The weight is V_j times the slope
// of the kernel, with which the linear fit is the usual corrected kernel gradient (Bonet & Lok 1999). A one-sided
// kernel with a linear fit misses the strain of the outer layers and bends too softly (cantilever 1.39 of theory
// at 6 cells across), so surface cells use a quadratic fit, blended in smoothly with the one-sidedness and regularised:
// it takes away most of that error and stays well-conditioned among irregular cells.
#pragma once

#include <span>

#include "root_sph/dynamics/solver_options.hpp"
#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

struct GradientReport {
  std::int64_t quadratic = 0;   ///< cells with at least half of the quadratic fit
  std::int64_t degenerate = 0;  ///< cells whose neighbours do not span space: gradient only where they do
};

/// Fills gradients and kernel for the pairs. positions mm, metrics 1/mm^2, volumes mm^Dim.
template <int Dim>
GradientReport build_gradients(std::span<const Vec<Dim>> positions, std::span<const Mat<Dim>> metrics,
                               std::span<const double> volumes, const PairList& list, GradientMode mode,
                               std::vector<PairGradient<Dim>>& gradients, std::vector<double>& kernel);

}  // namespace rootsoil
