// SPDX-License-Identifier: MIT
// What no single key can be judged by alone: the rules between keys, and the values that follow from others.
#pragma once

#include "root_sph/scene/origins.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// Throws InputError, or leaves a scene in which every value that others define is filled in.
void validate_and_complete(Scene& scene, const Origins& origins);

/// The same for a scene of which only the soil and the penetrometer count: there need not be a root.
void validate_and_complete_soil(Scene& scene, const Origins& origins);

}  // namespace rootsoil
