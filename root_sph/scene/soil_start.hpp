// SPDX-License-Identifier: MIT
// What a soil must know about the root that a scene describes, and how the two are coupled.
#pragma once

#include "root_sph/dynamics/solver.hpp"
#include "root_sph/effects/soil_contact.hpp"
#include "root_sph/exchange/soil_recipe.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// Expected speed from the closed form, the root's diameter, and its cells as balls. A root that is not expected to
/// grow has speed 0; then the scene must give the grains' density.
template <int Dim>
SoilStart soil_start(const Scene& scene, const Solver<Dim>& solver);

/// [soil.contact] as the effect takes it. The step must be known (numerics.step_h); markers exist where grains can be.
SoilContactParameters soil_contact_parameters(const Scene& scene);

}  // namespace rootsoil
