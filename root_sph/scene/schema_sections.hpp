// SPDX-License-Identifier: MIT
// The sections that every scene has, or can have: what is simulated, the cells at the start, their tissue, how it is
// computed, what is written.
#pragma once

#include <vector>

#include "root_sph/scene/schema.hpp"

namespace rootsoil::sections {

SectionSpec scene_section();
SectionSpec root_section();
SectionSpec cell_columns_section();
SectionSpec tissue_section();
SectionSpec numerics_section();
SectionSpec output_section();

inline std::vector<SectionSpec> of_every_scene() {
  return {scene_section(),  root_section(),     cell_columns_section(),
          tissue_section(), numerics_section(), output_section()};
}

}  // namespace rootsoil::sections
