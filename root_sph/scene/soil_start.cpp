// SPDX-License-Identifier: MIT
#include "root_sph/scene/soil_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "root_sph/scene/model.hpp"

namespace rootsoil {
namespace {

/// Of a cell as a ball (2D: disc) of the same volume.
template <int Dim>
double ball_radius_mm(double volume) {
  return Dim == 2 ? std::sqrt(volume / std::numbers::pi) : std::cbrt(0.75 * volume / std::numbers::pi);
}

}  // namespace

template <int Dim>
SoilStart soil_start(const Scene& scene, const Solver<Dim>& solver) {
  const Tissue<Dim>& tissue = solver.tissue();
  SoilStart start;
  start.root_speed_mm_h = closed_form_flow<Dim>(scene, solver.axis().length_mm()).tip_speed_mm_h;
  double lateral_mm = 0.0;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    const Vec<Dim> x = tissue.cells.position[i];
    Vec3 centre{};
    std::copy_n(x.data(), Dim, centre.begin());
    start.body_mm.push_back(centre);
    start.body_radius_mm.push_back(ball_radius_mm<Dim>(tissue.cells.volume[i]));
    lateral_mm = std::max(lateral_mm, x.template tail<Dim - 1>().norm());
  }
  // of a lattice root as the scene says; cells from a file lie about the x axis
  start.root_diameter_mm = 2.0 * (scene.root.cells_file.empty() ? scene.root.radius_mm : lateral_mm);
  return start;
}

SoilContactParameters soil_contact_parameters(const Scene& scene) {
  ROOTSOIL_ASSERT(scene.soil && scene.soil_contact && scene.numerics.step_h);
  const SoilContactSection& section = *scene.soil_contact;
  SoilContactParameters parameters;
  parameters.marker_radius_mm = section.marker_radius_mm;
  parameters.marker_spacing = section.marker_spacing;
  parameters.map_width_cells = section.map_width_cells;
  const double window_h = scene.numerics.window_steps * *scene.numerics.step_h;
  parameters.windows_per_interval = std::max(1, static_cast<int>(std::lround(section.interval_h / window_h)));
  parameters.ramp_h = section.ramp_h;
  parameters.stiffness_predictor = section.stiffness_predictor;
  parameters.under_relaxation = section.under_relaxation;
  parameters.tip_length_mm = section.tip_length_mm;
  // no grain's centre leaves the box, and the root enters it through x = from
  const double entrance_mm = scene.soil->box_from_mm[0] - scene.soil->d_max_mm;
  parameters.near_soil = [entrance_mm](const Vec3& x) { return x[0] > entrance_mm; };
  return parameters;
}

template SoilStart soil_start<2>(const Scene&, const Solver<2>&);
template SoilStart soil_start<3>(const Scene&, const Solver<3>&);

}  // namespace rootsoil
