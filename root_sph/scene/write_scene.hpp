// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// A scene file with every value that is used; reading it gives the same scene again.
std::string resolved_toml(const Language& language, const Scene& scene);

/// The same values as (path of the key, TOML text), in the same order.
using ResolvedValues = std::vector<std::pair<std::string, std::string>>;
ResolvedValues resolved_values(const Language& language, const Scene& scene);

/// The same values out of what resolved_toml has written. Nothing is checked and no file looked for: the scene may be
/// one that can't be read any more.
ResolvedValues values_of_resolved_toml(const std::string& text);

}  // namespace rootsoil
