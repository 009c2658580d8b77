// SPDX-License-Identifier: MIT
// Every section of the scene file, by the file that defines its keys.
#pragma once

#include "root_sph/scene/schema.hpp"

namespace rootsoil::sections {

// schema_root.cpp
SectionSpec scene_section();
SectionSpec root_section();
SectionSpec tissue_section();
SectionSpec anisotropy_section();
SectionSpec pressure_section();

// schema_growth.cpp
SectionSpec growth_section();
SectionSpec division_section();
SectionSpec response_section();
SectionSpec response_growth_section();
SectionSpec response_anisotropy_section();

// schema_contact.cpp
SectionSpec obstacle_section();
SectionSpec soil_section();
SectionSpec soil_obstacle_section();
SectionSpec soil_contact_section();
SectionSpec penetrometer_section();

// schema_numerics.cpp
SectionSpec numerics_section();
SectionSpec non_affine_control_section();
SectionSpec sleep_section();
SectionSpec probe_section();
SectionSpec output_section();

}  // namespace rootsoil::sections
