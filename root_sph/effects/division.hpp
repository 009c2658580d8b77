// SPDX-License-Identifier: MIT
// Cells divide across their longest axis when it passes a threshold that varies along the root (4.2, Eq. 6).
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/profiles/root_profiles.hpp"

namespace rootsoil {

/// Moves the cells of a file along the root, by a little, so that gaps and overlaps between them even out. Spacing and
/// cell length drift apart by a per cent where the growth rate varies, and a gap doubles relative to its cells in every
/// generation until the file is torn (docs/decisions/0007). Pair by pair and opposite, so the centroid of a file stays.
/// Uses the pairs of the window; runs at its end.
template <int Dim>
void even_out_spacing(Solver<Dim>& solver);

template <int Dim>
class DivisionEffect final : public Effect<Dim> {
 public:
  DivisionEffect(Solver<Dim>& solver, DivisionThresholdProfile threshold);
};

/// Longest axis of an ellipsoid: direction (unit) and full length 2/sqrt(zeta_1).
template <int Dim>
struct LongestAxis {
  Vec<Dim> direction;
  double length_mm;
};
template <int Dim>
LongestAxis<Dim> longest_axis(const Mat<Dim>& shape);

}  // namespace rootsoil
