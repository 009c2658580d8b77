// SPDX-License-Identifier: MIT
#include "root_sph/effects/pair_resistance/pair_resistance.hpp"

#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

SectionSpec non_affine_control_section() {
  using namespace sections;
  using Nc = NonAffineControlSection;
  return section<Nc>(
      "non_affine_control", optional, "Damps and resists pair motions that no velocity gradient can see.",
      {key(&Nc::damping, "damping", "-", at_least(0), "Damping alpha.", "docs/physics.md 5.4"),
       key(&Nc::stiffness, "stiffness", "-", at_least(0), "Elastic penalty, times E_A.", "docs/decisions/0009")});
}

template <int Dim>
void build_pair_resistance(Assembly<Dim> assembly) {
  const Scene& scene = assembly.scene;
  const auto* control = scene.find<NonAffineControlSection>();
  const bool moves_masses = assembly.solver.tissue().inertia.has_value();
  assembly.solver.pair_terms() =
      make_pair_terms<Dim>(assembly.solver.tissue().cells, scene.tissue.E_axial_MPa,
                           control ? std::optional<double>(moves_masses ? control->damping : 0.0) : std::nullopt,
                           control ? control->stiffness : 0.0, scene.numerics.artificial_viscosity);
}

}  // namespace

EffectSpec pair_resistance_effect() {
  return {.name = "pair resistance",
          .called_by = "[non_affine_control], [numerics] artificial_viscosity",
          .what = "resists pair motions that no gradient sees; artificial viscosity for comparison",
          .exact = "momentum is kept; affine motion costs nothing",
          .pair_term = "velocity, history of slip",
          .sections = {non_affine_control_section()},
          .called_for =
              [](const Scene& scene) {
                return scene.find<NonAffineControlSection>() || scene.numerics.artificial_viscosity > 0.0;
              },
          .build = [](auto assembly) { build_pair_resistance<assembly.dimension>(assembly); }};
}

}  // namespace rootsoil
