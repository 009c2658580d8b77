// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// A scene file with every value that is used; reading it gives the same scene again.
std::string resolved_toml(const Scene& scene);

/// The same values as (path of the key, TOML text), in the same order.
using ResolvedValues = std::vector<std::pair<std::string, std::string>>;
ResolvedValues resolved_values(const Scene& scene);

}  // namespace rootsoil
