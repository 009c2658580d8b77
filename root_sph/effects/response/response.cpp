// SPDX-License-Identifier: MIT
#include "root_sph/effects/response/response.hpp"

#include "root_sph/scene/response.hpp"
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

SectionSpec all_responses_section() {
  using namespace sections;
  using Re = ResponseSection;
  return section<Re>("response", optional,
                     "Parameters that follow the pressure differential, between their values at two pressures.",
                     {key(&Re::extrapolate, "extrapolate", "-", any_number,
                          "Go on linearly outside the two pressures; false: hold.", "Eq. 7")})
      .completed_by(complete_response);
}

}  // namespace

EffectSpec response_effect() {
  return {.name = "response",
          .called_by = "[response]",
          .what = "growth and anisotropy follow the soil's strength (Eq. 7)",
          .exact = "parameters at two pressures, Eq. 7",
          .sections = {all_responses_section()},
          .called_for = [](const Scene& scene) { return scene.find<ResponseSection>() != nullptr; },
          .build = [](auto) {}};  // the effects whose keys respond read them
}

}  // namespace rootsoil
