// SPDX-License-Identifier: MIT
// Growth and anisotropy follow the soil's strength (the paper's Eq. 7, scene/response.hpp).
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

EffectSpec response_effect();

}  // namespace rootsoil
