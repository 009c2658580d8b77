// SPDX-License-Identifier: MIT
// The one table of effects.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

std::span<const EffectSpec> effect_table();

/// Names of the effects that the scene calls for, in the table's order.
std::vector<std::string> active_effects(const Scene& scene);

/// The scene file's language: the sections of every scene and those of the effects.
const Language& language();

// Reading and writing scenes in this language (scene/read_scene.hpp, scene/write_scene.hpp).
Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
                 const std::optional<std::string>& accuracy = {});
Scene parse_scene(std::string_view text, std::string file_name, const std::vector<std::string>& overrides = {},
                  const std::optional<std::string>& accuracy = {});
/// Only [soil], [penetrometer] and the dimension and seed of [scene].
Scene read_soil(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});
Scene parse_soil(std::string_view text, std::string file_name, const std::vector<std::string>& overrides = {});

}  // namespace rootsoil
