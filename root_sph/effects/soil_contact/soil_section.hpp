// SPDX-License-Identifier: MIT
// The sections of the scene file about the soil that the root grows through.
#pragma once

#include <string>

#include "root_sph/exchange/soil_recipe.hpp"
#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// The soil that the root grows through: the recipe, as the engine takes it, and what the scene adds.
struct SoilSection : SoilRecipe {
  std::optional<std::array<double, 2>> d_range_mm;  ///< as given; after reading d_min_mm and d_max_mm
  std::optional<double> d_mean_given_mm;            ///< idem
  std::optional<double> d_spread_given;
  std::optional<std::int64_t> given_dimension;
};

/// How the root's surface and the soil exchange motion and forces.
struct SoilContactSection {
  double interval_h = 4e-3;                ///< between two exchanges, rounded to whole windows
  std::optional<double> marker_radius_mm;  ///< absent: one cell
  double marker_spacing = 0.6;             ///< of the radius
  double map_width_cells = 1.4;
  double ramp_h = 0.2;                  ///< forces rise from nothing over this time
  bool stiffness_predictor = false;     ///< for rigid walls
  bool under_relaxation = false;        ///< Aitken's
  std::optional<double> tip_length_mm;  ///< absent: a root's diameter
};

/// Where the grains would take very many substeps in an interval.
/// \param key of the interval
void refuse_long_interval(const Scene& scene, double density_N_h2_mm4, double interval_h, const std::string& key);

using PenetrometerSection = Penetrometer;

/// [soil], [[soil.obstacle]], [soil.contact], [penetrometer]
std::vector<SectionSpec> soil_sections();

}  // namespace rootsoil
