// SPDX-License-Identifier: MIT
// A piece of tissue followed over time: the cell nearest to a point at the start and its descendants, or whatever
// lies in a bin of distances from the tip.
#pragma once

#include <array>
#include <optional>

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

struct ProbeSection {
  std::string name;
  std::optional<std::array<double, 3>> position_mm;         ///< the nearest cell at the start
  std::optional<std::array<double, 2>> distance_to_tip_mm;  ///< bin
};

/// Means over the probe's cells at one time, weighted by volume; not a number where there is no cell.
struct ProbeReading {
  double cells, volume, x_mm, y_mm, z_mm, distance_to_tip_mm, axial_strain_rate_per_h, axial_stress_MPa,
      radial_stress_MPa, density_ug_mm3, cell_length_mm;
  std::vector<double> values() const {
    return {cells,
            volume,
            x_mm,
            y_mm,
            z_mm,
            distance_to_tip_mm,
            axial_strain_rate_per_h,
            axial_stress_MPa,
            radial_stress_MPa,
            density_ug_mm3,
            cell_length_mm};
  }
};

template <int Dim>
class ProbeEffect final : public Effect<Dim> {
 public:
  ProbeEffect(Solver<Dim>& solver, ProbeSection section);

  ProbeReading read() const;
  std::optional<SideTable> side_table() const override;
  std::vector<double> side_row() const override { return read().values(); }

 private:
  ProbeSection section_;
  Solver<Dim>& solver_;
  Field<Dim, std::int64_t>* followed_ = nullptr;  ///< 1 for the cell at the point and its descendants
};

EffectSpec probe_effect();

}  // namespace rootsoil
