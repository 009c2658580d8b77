// SPDX-License-Identifier: MIT
#include "root_sph/effects/response/response.hpp"

#include <cmath>

#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

void complete_response(Scene& scene) {
  if (scene.responses.empty()) {
    scene.origins.fail("response", "nothing responds", {}, {}, "add [response.growth] or [response.anisotropy]");
  }
  if (!scene.origins.has("pressure") && !scene.origins.has("turgor")) {
    scene.origins.fail("response", "the response follows the pressure differential, and there is none", {}, {},
                       "add [pressure] or [turgor]");
  }
}

/// Who pushes is known when all effects have read their sections.
void refuse_nothing_to_perceive(const Scene& scene) {
  if (!responds_to_perceived(scene) || scene.facts.can_be_arrested) return;
  scene.origins.fail("response.follows", "there is nothing that the root could perceive",
                     toml_text(std::string(name_of(Follows::perceived))), "a scene where something pushes on the tip",
                     "add [soil], [[obstacle]] or [force], or take follows out");
}

// clang-format off
SectionSpec all_responses_section() {
  using namespace sections;
  using Re = ResponseSection;
  return section<Re>("response", optional,
                     "Parameters that follow the pressure differential, between their values at two pressures.", {
    key(&Re::extrapolate, "extrapolate", "-", any_number,
        "Go on linearly outside the two pressures; false: hold.", "Eq. 7"),
    key(&Re::follows, "follows",
        "The pressure differential, or that less what [soil], [[obstacle]] and [force] exert on the tip against its "
        "growth over the root's section: from 0 to the differential.", "docs/decisions/0026"),
    key(&Re::over_h, "over_h", "h", at_least(0).up_to(1e4, seconds),
        "Time constant with which the root perceives what changes; 0: at once.", "docs/decisions/0026")
        .only_where("follows", {name_of(Follows::perceived)}),
    key(&Re::tip_length_mm, "tip_length_mm", "mm", above(0).up_to(1e3, microns),
        "Forces nearer to the tip are perceived.", "-")
        .only_where("follows", {name_of(Follows::perceived)}).defaults_to("the root's diameter at the start"),
  }).completed_by(complete_response);
}
// clang-format on

}  // namespace

double low_pass(double q, double now, double dt_h, double over_h) {
  return over_h > 0.0 ? q - std::expm1(-dt_h / over_h) * (now - q) : now;
}

template <int Dim>
PerceptionEffect<Dim>::PerceptionEffect(Solver<Dim>& solver, const EffectList<Dim>& effects,
                                        const ResponseSection& response)
    : solver_(solver),
      effects_(effects),
      tip_length_mm_(response.tip_length_mm ? *response.tip_length_mm
                                            : diameter_of<Dim>(mean_section<Dim>(solver.tissue(), solver.axis()))) {
  solver.hooks().perception.emplace_back("response", [this, over_h = response.over_h](Tissue<Dim>& t) {
    t.tip_thrust_MPa = low_pass(t.tip_thrust_MPa, tip_thrust_MPa(), solver_.window_h(), over_h);
  });
}

template <int Dim>
double PerceptionEffect<Dim>::tip_thrust_MPa() const {
  const auto& cells = solver_.tissue().cells;
  Vec<Dim> force_N = Vec<Dim>::Zero(), axis = Vec<Dim>::Zero();
  for (const auto& effect : effects_) force_N += effect->tip_force_N(tip_length_mm_);
  if (force_N.isZero(0.0)) return 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.distance_to_tip[i] <= tip_length_mm_) axis += cells.volume[i] * cells.frame[i].col(0);
  }
  return -force_N.dot(axis.normalized()) / mean_section<Dim>(solver_.tissue(), solver_.axis());
}

template <int Dim>
void PerceptionEffect<Dim>::save(NamedReals& reals) const {
  reals["response/tip_thrust_MPa"] = {solver_.tissue().tip_thrust_MPa};
}

template <int Dim>
void PerceptionEffect<Dim>::restore(const NamedReals& reals) {
  solver_.tissue().tip_thrust_MPa = reals.at("response/tip_thrust_MPa").at(0);
}

template <int Dim>
std::vector<std::pair<std::string, double>> PerceptionEffect<Dim>::history() const {
  return {{"perceived_pressure_MPa", solver_.tissue().perceived_MPa()}};
}

EffectSpec response_effect() {
  return {.name = "response",
          .called_by = "[response]",
          .what = "growth and anisotropy follow the soil's strength (Eq. 7), given or perceived at the tip",
          .exact = "parameters at two pressures, Eq. 7; under a force F those at p - F/section",
          .sections = {all_responses_section()},
          .called_for = [](const Scene& scene) { return scene.find<ResponseSection>() != nullptr; },
          .build =  // the effects whose keys respond read them
          [](auto assembly) {
            if (!responds_to_perceived(assembly.scene)) return;
            assembly.template add<PerceptionEffect<assembly.dimension>>(
                assembly.effects, *assembly.scene.template find<ResponseSection>());
          },
          .check_start = [](const Scene& scene, const auto&, const FreeGrowth&) { refuse_nothing_to_perceive(scene); }};
}

template class PerceptionEffect<2>;
template class PerceptionEffect<3>;

}  // namespace rootsoil
