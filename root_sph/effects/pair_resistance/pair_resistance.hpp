// SPDX-License-Identifier: MIT
// Pair terms besides the stress (dynamics/pair_terms.hpp): non-affine control, and artificial viscosity for comparison.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Damps and resists pair motions that no velocity gradient can see (docs/physics.md 5.4).
struct NonAffineControlSection {
  double damping = 0.5;    ///< alpha
  double stiffness = 2.0;  ///< times E_axial (docs/decisions/0009)
};

EffectSpec pair_resistance_effect();

}  // namespace rootsoil
