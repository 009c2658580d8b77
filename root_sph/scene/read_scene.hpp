// SPDX-License-Identifier: MIT
// Scene file -> validated Scene. Everything wrong with it is an InputError that says where.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {

struct ReadOptions {
  /// "section.key=value" with the value in TOML (bare words are taken as text); elements of repeated sections are
  /// counted from 1: "obstacle.1.radius_mm=0.2".
  std::vector<std::string> overrides = {};
  std::optional<std::string> accuracy = {};  ///< in the place of [numerics] accuracy
  /// Only sections that mean something without a root, and the dimension and seed of [scene]; others are left alone, as
  /// long as their names and keys exist.
  bool soil_alone = false;
};

Scene read_scene(const Language& language, const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from text. `file_name` is for messages, and its folder the one that files in it are relative to.
Scene parse_scene(const Language& language, std::string_view text, std::string file_name,
                  const ReadOptions& options = {});

}  // namespace rootsoil
