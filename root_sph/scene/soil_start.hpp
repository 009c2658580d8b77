// SPDX-License-Identifier: MIT
// What a soil must know about the root that a scene describes.
#pragma once

#include "root_sph/dynamics/solver.hpp"
#include "root_sph/exchange/soil_recipe.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// Expected speed from the closed form, the root's diameter, and its cells as balls. A root that is not expected to
/// grow has speed 0; then the scene must give the grains' density.
template <int Dim>
SoilStart soil_start(const Scene& scene, const Solver<Dim>& solver);

}  // namespace rootsoil
