// SPDX-License-Identifier: MIT
#include "root_sph/scene/write_scene.hpp"

#include <fmt/format.h>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {

std::string resolved_toml(const Scene& scene) {
  std::string out = "# Every value that was used. Resolved by rootsoil " ROOTSOIL_VERSION ".\n";
  for (const SectionSpec& section : schema()) {
    for (std::size_t i = 0; i < section.count(scene); ++i) {
      out += fmt::format("\n{}\n", section_header(section));
      for (const KeySpec& key : section.keys) {
        if (!applies(section, key, scene, i) || supplied_by_response(key, scene)) continue;
        std::optional<Value> value = key.get(scene, i);
        if (!value) continue;
        if (key.type == ValueType::vector)
          std::get<Numbers>(*value).resize(static_cast<std::size_t>(scene.scene.dimension));
        out += fmt::format("{} = {}\n", key.name, toml_text(*value));
      }
    }
  }
  return out;
}

}  // namespace rootsoil
