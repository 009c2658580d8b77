// SPDX-License-Identifier: MIT
// What [numerics] accuracy stands for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

std::vector<std::string> preset_names();

/// The numerics of a preset; keys that the scene gives replace its values.
NumericsSection preset(std::string_view accuracy);

/// Relative error of the discretisation in space: rms over cells of the axial strain rate against the closed form, in a
/// straight 2D root of regular cells, 8 across, that grows and divides (measured; tests/cli/test_errors.py). It is that
/// of the cells' size, so the presets, which choose the step, share it. Case 1's strains are off by 0.0005. Irregular cells
/// add to it; so does inertia, which every run measures itself.
double discretisation_error(std::string_view accuracy);

}  // namespace rootsoil
