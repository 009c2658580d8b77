// SPDX-License-Identifier: MIT
// Cells at the base are held: a condition on the cells at the start (model/initial_cells.hpp), nothing to construct.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

inline EffectSpec clamped_base_effect() {
  return {.name = "clamped base",
          .called_by = "[root] base",
          .what = "cells at the base are held",
          .exact = "they do not move",
          .called_for = [](const Scene& scene) { return scene.root.is_clamped(); },
          .build = [](auto) {}};
}

}  // namespace rootsoil
