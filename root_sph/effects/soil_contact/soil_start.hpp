// SPDX-License-Identifier: MIT
// What a soil must know about the root that a scene describes, and how the two are coupled.
#pragma once

#include "root_sph/effects/soil_contact/soil_contact.hpp"
#include "root_sph/effects/soil_contact/soil_section.hpp"

namespace rootsoil {

/// Expected speed, the root's diameter, and its cells as balls. A root that is not expected to grow has speed 0; then
/// the scene must give the grains' density.
template <int Dim>
SoilStart soil_start(const Scene& scene, const Tissue<Dim>& tissue, double fastest_tip_speed_mm_h);

/// [soil.contact] as the effect takes it; markers exist where grains can be.
SoilContactParameters soil_contact_parameters(const Scene& scene, double step_h);

}  // namespace rootsoil
