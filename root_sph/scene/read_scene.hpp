// SPDX-License-Identifier: MIT
// Scene file -> validated Scene. Everything wrong with it is an InputError that says where.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// Overrides are "section.key=value" with the value in TOML (bare words are taken as text); elements of
/// repeated sections are counted from 1: "obstacle.1.radius_mm=0.2". `accuracy` overrides [numerics].
Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& set_overrides = {},
                 const std::optional<std::string>& accuracy = std::nullopt);

/// The same from text. `file_name` is for messages, and its folder the one that cells_file starts from.
Scene parse_scene(std::string_view text, std::string file_name, const std::vector<std::string>& set_overrides = {},
                  const std::optional<std::string>& accuracy = std::nullopt);

/// Only [soil], [penetrometer] and the dimension and seed of [scene]; other sections are left alone, as long as their
/// names and keys exist.
Scene read_soil(const std::filesystem::path& path, const std::vector<std::string>& set_overrides = {});
Scene parse_soil(std::string_view text, std::string file_name, const std::vector<std::string>& set_overrides = {});

}  // namespace rootsoil
