// SPDX-License-Identifier: MIT
// Cells divide across their longest axis when it passes a threshold that varies along the root (4.2, Eq. 6).
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/profiles/root_profiles.hpp"

namespace rootsoil {

/// Moves cells along the root, by a little, from where their neighbours are dense to where they are sparse (Fickian
/// shifting; Lind et al. 2012). Spacing and cell length drift apart by a few per cent where the growth rate varies, and
/// that gap, shared by ever shorter cells, doubles relative to them in every generation until the file is torn. Along
/// the root only, and not within a diameter of the tip, where the surface itself is one-sided. Runs at the end of
/// a window.
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
