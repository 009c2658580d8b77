// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// A scene file with every value that is used; reading it gives the same scene again.
std::string resolved_toml(const Scene& scene);

}  // namespace rootsoil
