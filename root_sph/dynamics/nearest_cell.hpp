// SPDX-License-Identifier: MIT
// Which cell lies nearest to a point, and how far it is in lengths of cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

struct NearestCell {
  std::size_t cell = 0;  ///< whose centre is nearest
  /// Least distance from a cell's centre, in lengths of that cell in the point's direction: 0.5 on its surface.
  double cell_lengths = std::numeric_limits<double>::infinity();
};

/// \param tissue with a cell at least
template <int Dim>
NearestCell nearest_cell(const Tissue<Dim>& tissue, const Vec<Dim>& point_mm) {
  const auto& cells = tissue.cells;
  NearestCell nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Vec<Dim> r = cells.position[i] - point_mm;
    nearest.cell_lengths = std::min(nearest.cell_lengths, 0.5 * std::sqrt(r.dot(cells.shape[i] * r)));
    if (r.squaredNorm() >= least) continue;
    least = r.squaredNorm();
    nearest.cell = i;
  }
  return nearest;
}

}  // namespace rootsoil
