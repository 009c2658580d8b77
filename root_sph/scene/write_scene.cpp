// SPDX-License-Identifier: MIT
#include "root_sph/scene/write_scene.hpp"

#include <fmt/format.h>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {
namespace {

/// Calls on_section(section, index) for every section that is present, and on_key(section, index, key, text) for every
/// value in it that is used.
template <class OnSection, class OnKey>
void for_each_value(const Scene& scene, OnSection&& on_section, OnKey&& on_key) {
  for (const SectionSpec& section : schema()) {
    for (std::size_t i = 0; i < section.count(scene); ++i) {
      on_section(section, i);
      for (const KeySpec& key : section.keys) {
        if (!applies(section, key, scene, i) || supplied_by_response(key, scene)) continue;
        std::optional<Value> value = key.get(scene, i);
        if (!value) continue;
        if (key.type == ValueType::vector)
          std::get<Numbers>(*value).resize(static_cast<std::size_t>(scene.scene.dimension));
        on_key(section, i, key, toml_text(*value));
      }
    }
  }
}

}  // namespace

std::string resolved_toml(const Scene& scene) {
  std::string out = "# Every value that was used. Resolved by rootsoil " ROOTSOIL_VERSION ".\n";
  for_each_value(
      scene,
      [&](const SectionSpec& section, std::size_t) { out += fmt::format("\n{}\n", section_header(section)); },
      [&](const SectionSpec&, std::size_t, const KeySpec& key, const std::string& text) {
        out += fmt::format("{} = {}\n", key.name, text);
      });
  return out;
}

ResolvedValues resolved_values(const Scene& scene) {
  ResolvedValues values;
  for_each_value(
      scene, [](const SectionSpec&, std::size_t) {},
      [&](const SectionSpec& section, std::size_t i, const KeySpec& key, const std::string& text) {
        values.emplace_back(key_path(section, i, key.name), text);
      });
  return values;
}

}  // namespace rootsoil
