// SPDX-License-Identifier: MIT
#include "root_sph/effects/anisotropy/anisotropy.hpp"

#include <cmath>

#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/response.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

void complete_anisotropy(const Scene& scene);

// clang-format off
SectionSpec anisotropy_section() {
  using namespace sections;
  using An = AnisotropySection;
  return section<An>("tissue.anisotropy", optional,
                     "Radial modulus along the root: E_R = E_A + (E_H - E_A)(c_e + (1 - c_e)/"
                     "(1 + exp(-s_e (s - x_e)))); absent: E_R = E_A.", {
    key(&An::E_radial_max_MPa, "E_radial_max_MPa", "MPa", modulus, "Largest radial modulus E_H.", "Table 1: 15000")
        .required().responds(),
    key(&An::x_e_mm, "x_e_mm", "mm", place_mm, "Distance from the tip of the transition.", "Eq. 6, Table 1")
        .required().responds(),
    key(&An::s_e_per_mm, "s_e_per_mm", "1/mm", at_least(0), "Slope of the transition.", "Eq. 6, Table 1")
        .required().responds(),
    key(&An::c_e, "c_e", "-", fraction, "Scale at the tip.", "Eq. 6, Table 1").required().responds(),
  }).completed_by(complete_anisotropy);
}
// clang-format on

const SectionSpec& anisotropy_specification() {
  static const SectionSpec spec = anisotropy_section();
  return spec;
}

/// E_R is monotonous in s, so its ends are at s = 0 and far away; it is not linear in p.
void complete_anisotropy(const Scene& scene) {
  constexpr int samples = 32;
  const auto [low, high] = responding_range_MPa(scene);
  std::vector<double> moduli;
  for (int i = 0; i <= (response_of(scene, "tissue.anisotropy") ? samples : 0); ++i) {
    const AnisotropySection a = *anisotropy_at(scene, low + (high - low) * i / samples);
    for (const double s : {0.0, 1e9}) moduli.push_back(radial_modulus_MPa(a, scene.tissue.E_axial_MPa, s));
  }
  check_compliance(scene, moduli);
}

}  // namespace

double radial_modulus_MPa(const AnisotropySection& a, double E_axial_MPa, double s_mm) {
  const double sigmoid = 1.0 / (1.0 + std::exp(-a.s_e_per_mm * (s_mm - a.x_e_mm)));
  return E_axial_MPa + (a.E_radial_max_MPa - E_axial_MPa) * (a.c_e + (1.0 - a.c_e) * sigmoid);
}

std::optional<AnisotropySection> anisotropy_at(const Scene& scene, double p_MPa) {
  if (!scene.find<AnisotropySection>()) return std::nullopt;
  return at_pressure<AnisotropySection>(scene, anisotropy_specification(), p_MPa);
}

ElasticConstants isotropic_constants(const TissueSection& t) {
  return {t.E_axial_MPa, t.E_axial_MPa, t.nu_axial, t.nu_radial, *t.G_MPa};
}

ElasticConstants elastic_constants(const Scene& scene, double s_mm, double p_MPa) {
  ElasticConstants constants = isotropic_constants(scene.tissue);
  if (const auto a = anisotropy_at(scene, p_MPa)) {
    constants.E_radial_MPa = radial_modulus_MPa(*a, constants.E_axial_MPa, s_mm);
  }
  return constants;
}

template <int Dim>
AnisotropyEffect<Dim>::AnisotropyEffect(Solver<Dim>& solver, const Scene& scene)
    : radial_modulus_(solver.tissue().cells.template declare<double>(
          {"radial_modulus", "MPa", "E_R at the cell, Eq. 6", Storage::scratch},
          on_division::recomputed<Dim, double>)) {
  Tissue<Dim>& tissue = solver.tissue();
  tissue.material.stiffness = &tissue.cells.template declare<Stiffness<Dim>>(
      {"stiffness", "MPa", "entries of C, and of the trace of S (1/MPa)", Storage::scratch},
      on_division::recomputed<Dim, Stiffness<Dim>>);
  solver.hooks().parameters.emplace_back("anisotropy", [this, &solver, scene](Tissue<Dim>& t) {
    const AnisotropySection anisotropy = *anisotropy_at(scene, t.perceived_MPa());
    const ElasticConstants uniform = isotropic_constants(scene.tissue);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      ElasticConstants here = uniform;
      here.E_radial_MPa =
          radial_modulus_MPa(anisotropy, uniform.E_axial_MPa, solver.mid_window_distance(t.cells.distance_to_tip[i]));
      radial_modulus_[i] = here.E_radial_MPa;
      (*t.material.stiffness)[i] = stiffness<Dim>(here);
    }
  });
}

template <int Dim>
void AnisotropyEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  columns.push_back({"radial_modulus", "MPa", "radial Young modulus of the tissue", 1, radial_modulus_.values()});
}

EffectSpec anisotropy_effect() {
  return {.name = "anisotropy",
          .called_by = "[tissue.anisotropy]",
          .what = "radial modulus that varies along the root (Eq. 4, 6)",
          .exact = "strains along a root without growth: Eq. 8",
          .sections = {anisotropy_specification()},
          .called_for = [](const Scene& scene) { return scene.find<AnisotropySection>() != nullptr; },
          .build = [](auto assembly) { assembly.template add<AnisotropyEffect<assembly.dimension>>(assembly.scene); }};
}

template class AnisotropyEffect<2>;
template class AnisotropyEffect<3>;

}  // namespace rootsoil
