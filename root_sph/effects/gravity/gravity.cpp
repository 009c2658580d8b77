// SPDX-License-Identifier: MIT
#include "root_sph/effects/gravity/gravity.hpp"

#include "root_sph/core/vec3.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

SectionSpec gravity_section() {
  using namespace sections;
  using Gv = GravitySection;
  return section<Gv>(
      "gravity", optional, "Weight less buoyancy, on every cell by its volume.",
      {key(&Gv::acceleration_m_s2, "acceleration_m_s2", "m/s^2", between(-1e9, 1e9),
           "Of free fall; a root that grows down has it along +x. More than 9.81: a centrifuge.", "-")
           .required(),
       key(&Gv::density_difference_kg_m3, "density_difference_kg_m3", "kg/m^3", between(-1e4, 1e4),
           "Density of the tissue less that of what it displaces: some 1000 in air, 20 to 60 in water.", "-")
           .required()});
}

}  // namespace

template <int Dim>
Vec<Dim> body_force_N_mm3(const GravitySection& gravity) {
  constexpr double N_mm3_per_N_m3 = 1e-9;
  return N_mm3_per_N_m3 * gravity.density_difference_kg_m3 * shortened<Dim>(gravity.acceleration_m_s2);
}

template <int Dim>
GravityEffect<Dim>::GravityEffect(Solver<Dim>& solver, const GravitySection& gravity)
    : solver_(solver), body_force_N_mm3_(body_force_N_mm3<Dim>(gravity)) {
  solver.hooks().forces.emplace_back("gravity", [this](Tissue<Dim>& t, SlipAdvance) {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < t.cells.size(); ++i) t.force[i] += t.cells.volume[i] * body_force_N_mm3_;
  });
}

template <int Dim>
Vec<Dim> GravityEffect<Dim>::external_force_N() const {
  const auto& cells = solver_.tissue().cells;
  double volume = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) volume += cells.volume[i];
  return volume * body_force_N_mm3_;
}

EffectSpec gravity_effect() {
  return {
      .name = "gravity",
      .called_by = "[gravity]",
      .what = "weight less buoyancy of every cell",
      .exact = "a cantilever bent by its own weight (Timoshenko)",
      .push = Push::steady,
      .sections = {gravity_section()},
      .called_for = [](const Scene& scene) { return scene.find<GravitySection>() != nullptr; },
      .build =
          [](auto assembly) {
            assembly.template add<GravityEffect<assembly.dimension>>(*assembly.scene.template find<GravitySection>());
          }};
}

template Vec<2> body_force_N_mm3<2>(const GravitySection&);
template Vec<3> body_force_N_mm3<3>(const GravitySection&);
template class GravityEffect<2>;
template class GravityEffect<3>;

}  // namespace rootsoil
