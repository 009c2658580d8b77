// SPDX-License-Identifier: MIT
// Keeps numerical inertia from bending a long free root (docs/decisions/0003).
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Damps the lateral velocity of the midline. Tissue with inertia that flows towards the tip of a long cantilever
/// makes it flutter like a garden hose once its momentum, rho_M V^2 times the section, nears the Euler load; growth
/// without inertia does not. Only the mean over a slice is damped: radial growth is not resisted.
template <int Dim>
class MidlineDampingEffect final : public Effect<Dim> {
 public:
  MidlineDampingEffect(Solver<Dim>& solver, double rate_per_h);
};

/// numerics.midline_damping_per_h, or what suits the scene: a root that something pushes is to be resisted by its
/// tissue and nothing else.
double midline_damping_per_h(const Scene& scene);

EffectSpec midline_damping_effect();

}  // namespace rootsoil
