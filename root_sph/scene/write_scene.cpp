// SPDX-License-Identifier: MIT
#include "root_sph/scene/write_scene.hpp"

#include <fmt/format.h>

#include <map>
#include <sstream>

#include "root_sph/core/version.hpp"

namespace rootsoil {
namespace {

/// Calls on_section(section, index) for every section that is present, and on_key(section, index, key, text) for every
/// value in it that is used.
template <class OnSection, class OnKey>
void for_each_value(const Language& language, const Scene& scene, OnSection&& on_section, OnKey&& on_key) {
  for (const SectionSpec& section : language.sections()) {
    for (std::size_t i = 0; i < section.count(scene); ++i) {
      on_section(section, i);
      for (const KeySpec& key : section.keys) {
        if (!language.applies(section, key, scene, i) || language.supplied_by_response(section, key, scene)) continue;
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

std::string resolved_toml(const Language& language, const Scene& scene) {
  std::string out = fmt::format("# Every value that was used. Resolved by rootsoil {}.\n", program_version);
  for_each_value(
      language, scene,
      [&](const SectionSpec& section, std::size_t) { out += fmt::format("\n{}\n", section_header(section)); },
      [&](const SectionSpec&, std::size_t, const KeySpec& key, const std::string& text) {
        out += fmt::format("{} = {}\n", key.name, text);
      });
  return out;
}

ResolvedValues resolved_values(const Language& language, const Scene& scene) {
  ResolvedValues values;
  for_each_value(
      language, scene, [](const SectionSpec&, std::size_t) {},
      [&](const SectionSpec& section, std::size_t i, const KeySpec& key, const std::string& text) {
        values.emplace_back(key_path(section, i, key.name), text);
      });
  return values;
}

ResolvedValues values_of_resolved_toml(const std::string& text) {
  ResolvedValues values;
  std::map<std::string, int> count;  // of the elements of [[section]]
  std::string element;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find(" = ");
    if (line.starts_with("[[")) {
      const std::string name = line.substr(2, line.find("]]") - 2);
      element = fmt::format("{}[{}]", name, ++count[name]);
    } else if (line.starts_with("[")) {
      element = line.substr(1, line.find(']') - 1);
    } else if (!line.starts_with("#") && equals != std::string::npos) {
      values.emplace_back(element + "." + line.substr(0, equals), line.substr(equals + 3));
    }
  }
  return values;
}

}  // namespace rootsoil
