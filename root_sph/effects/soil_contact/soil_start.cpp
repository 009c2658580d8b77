// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/soil_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "root_sph/core/vec3.hpp"

namespace rootsoil {
namespace {

/// Of a cell as a ball (2D: disc) of the same volume.
template <int Dim>
double ball_radius_mm(double volume) {
  return Dim == 2 ? std::sqrt(volume / std::numbers::pi) : std::cbrt(0.75 * volume / std::numbers::pi);
}

}  // namespace

template <int Dim>
SoilStart soil_start(const Scene& scene, const Tissue<Dim>& tissue, double fastest_tip_speed_mm_h) {
  SoilStart start;
  start.root_speed_mm_h = fastest_tip_speed_mm_h;
  double lateral_mm = 0.0;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    const Vec<Dim> x = tissue.cells.position[i];
    start.body_mm.push_back(three<Dim>(x));
    start.body_radius_mm.push_back(ball_radius_mm<Dim>(tissue.cells.volume[i]));
    lateral_mm = std::max(lateral_mm, x.template tail<Dim - 1>().norm());
  }
  // of a lattice root as the scene says; cells from a file lie about the x axis
  start.root_diameter_mm = 2.0 * (scene.root.is_lattice() ? scene.root.radius_mm : lateral_mm);
  return start;
}

SoilContactParameters soil_contact_parameters(const Scene& scene, double step_h) {
  const SoilContactSection& section = *scene.find<SoilContactSection>();
  SoilContactParameters parameters;
  parameters.marker_radius_mm = section.marker_radius_mm;
  parameters.marker_spacing = section.marker_spacing;
  parameters.map_width_cells = section.map_width_cells;
  const double window_h = scene.numerics.steps_a_window() * step_h;
  parameters.windows_per_interval = std::max(1, static_cast<int>(std::lround(section.interval_h / window_h)));
  parameters.ramp_h = section.ramp_h;
  parameters.stiffness_predictor = section.stiffness_predictor;
  parameters.under_relaxation = section.under_relaxation;
  parameters.tip_length_mm = section.tip_length_mm;
  const SoilSection* soil = scene.find<SoilSection>();
  if (!soil) return parameters;  // of another kind, which has no box
  parameters.inertial_number_max = soil->inertial_number_max;
  // no grain's centre leaves the box, and the root enters it through x = from
  const double entrance_mm = soil->box_from_mm[0] - soil->d_max_mm;
  parameters.near_soil = [entrance_mm](const Vec3& x) { return x[0] > entrance_mm; };
  return parameters;
}

EffectSpec soil_contact_effect() {
  return {.name = "soil contact",
          .called_by = "[soil]",
          .what = "surface markers exchange motion and forces with grains in another process",
          .exact = "work and momentum; soils with a formula: half-space, bed of springs",
          .push = Push::arrest,
          .sections = soil_sections(),
          .called_for = [](const Scene& scene) { return scene.find<SoilContactSection>() != nullptr; },
          .build =
              [](auto assembly) {
                constexpr int Dim = assembly.dimension;
                if (!assembly.services.make_soil) return;
                const Scene& scene = assembly.scene;
                SoilStart start =
                    soil_start<Dim>(scene, assembly.solver.tissue(), assembly.free_growth.fastest_tip_speed_mm_h);
                start.log_file = assembly.services.soil_log;
                start.progress = [say = assembly.services.say](const std::string& text) {
                  if (say) say("soil: " + text);
                };
                SoilContactParameters parameters = soil_contact_parameters(scene, assembly.solver.options().step_h);
                parameters.free_growth = assembly.free_growth;
                assembly.template add<SoilContactEffect<Dim>>(std::move(parameters),
                                                              assembly.services.make_soil(scene, start));
              },
          .check_start =
              [](const Scene& scene, const auto& tissue, const FreeGrowth& growth) {
                const SoilSection* soil = scene.find<SoilSection>();
                if (!soil) return;  // of another kind
                const SoilStart start = soil_start(scene, tissue, growth.fastest_tip_speed_mm_h);
                refuse_long_interval(scene,
                                     expected_density_N_h2_mm4(*soil, start.root_speed_mm_h, start.root_diameter_mm),
                                     scene.find<SoilContactSection>()->interval_h, "soil.contact.interval_h");
              }};
}

template SoilStart soil_start<2>(const Scene&, const Tissue<2>&, double);
template SoilStart soil_start<3>(const Scene&, const Tissue<3>&, double);

}  // namespace rootsoil
