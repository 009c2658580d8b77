// SPDX-License-Identifier: MIT
// Uniform pressure differential (the paper's Eq. 5): turgor minus the perceived resistance of the soil.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Piecewise linear in time, constant before the first and after the last row. One row = constant.
struct PressureSection {
  Rows table;  ///< (time_h, differential_MPa), times increasing
};

/// Of a scene at a time, MPa; 0 where it has no pressure.
double pressure_MPa(const Scene& scene, double time_h);

template <int Dim>
class PressureEffect final : public Effect<Dim> {
 public:
  PressureEffect(Solver<Dim>& solver, Rows table);
};

EffectSpec pressure_effect();

}  // namespace rootsoil
