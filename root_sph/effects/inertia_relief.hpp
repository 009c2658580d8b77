// SPDX-License-Identifier: MIT
// Two ways to keep numerical inertia from showing: prescribed accelerations that stand for what a root without inertia
// would do (docs/decisions/0003).
#pragma once

#include "root_sph/effects/effect.hpp"

namespace rootsoil {

/// Cancels the leading axial error in steady growth: the acceleration that the flow along the root must have,
/// e(L) v(L) - e(s) v(s), is given to the cells rather than paid for by stress (docs/physics.md 5.9).
template <int Dim>
class InertiaCompensationEffect final : public Effect<Dim> {
 public:
  explicit InertiaCompensationEffect(Solver<Dim>& solver);
};

/// Damps the lateral velocity of the midline. Tissue with inertia that flows towards the tip of a long cantilever
/// makes it flutter like a garden hose once its momentum, rho_M V^2 times the section, nears the Euler load; growth
/// without inertia does not. Only the mean over a slice is damped: radial growth is not resisted.
template <int Dim>
class MidlineDampingEffect final : public Effect<Dim> {
 public:
  MidlineDampingEffect(Solver<Dim>& solver, double rate_per_h);
};

}  // namespace rootsoil
