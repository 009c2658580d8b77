// SPDX-License-Identifier: MIT
// Uniform pressure differential (the paper's Eq. 5): turgor minus the perceived resistance of the soil, given as one
// number ([pressure]) or apart ([turgor]).
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Piecewise linear in time, constant before the first and after the last row. One row = constant.
struct PressureSection {
  Rows table;  ///< (time_h, differential_MPa), times increasing
};

/// Tables as above.
struct TurgorSection {
  Rows turgor;                         ///< (time_h, MPa)
  Rows soil = {std::array{0.0, 0.0}};  ///< (time_h, MPa) that the soil takes
};

/// Of a scene over time, whichever section it has: (time_h, MPa); empty where there is no pressure.
Rows pressure_rows(const Scene& scene);

/// Of a scene at a time, MPa; 0 where it has no pressure.
double pressure_MPa(const Scene& scene, double time_h);

template <int Dim>
class PressureEffect final : public Effect<Dim> {
 public:
  PressureEffect(Solver<Dim>& solver, Rows table);
};

EffectSpec pressure_effect();

}  // namespace rootsoil
