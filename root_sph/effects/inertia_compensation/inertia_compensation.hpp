// SPDX-License-Identifier: MIT
// Cancels the leading axial error of numerical inertia in steady growth (docs/decisions/0003).
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// The acceleration that the flow along the root must have, e(L) v(L) - e(s) v(s), is given to the cells rather than
/// paid for by stress (docs/physics.md 5.9).
template <int Dim>
class InertiaCompensationEffect final : public Effect<Dim> {
 public:
  explicit InertiaCompensationEffect(Solver<Dim>& solver);
};

EffectSpec inertia_compensation_effect();

}  // namespace rootsoil
