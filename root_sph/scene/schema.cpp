// SPDX-License-Identifier: MIT
#include "root_sph/scene/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil {

bool Limits::contains(double number) const {
  return (low_open ? number > low : number >= low) && (high_open ? number < high : number <= high);
}

bool Limits::bounded() const { return std::isfinite(low) || std::isfinite(high); }

std::string Limits::text() const {
  std::string out;
  if (std::isfinite(low)) out = fmt::format("{} {}", low_open ? "above" : "at least", low);
  if (std::isfinite(high))
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", high_open ? "below" : "at most", high);
  return out;
}

Limits Limits::up_to(double highest, std::string remedy) const {
  Limits limits = *this;
  limits.high = highest;
  limits.above_remedy = std::move(remedy);
  return limits;
}

const KeySpec* SectionSpec::find(std::string_view key) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const KeySpec& k) { return k.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

const std::vector<SectionSpec>& schema() {
  using namespace sections;
  static const std::vector<SectionSpec> table{
      scene_section(),
      root_section(),
      tissue_section(),
      anisotropy_section(),
      pressure_section(),
      growth_section(),
      division_section(),
      response_section(),
      response_growth_section(),
      response_anisotropy_section(),
      non_affine_control_section(),
      sleep_section(),
      obstacle_section(),
      probe_section(),
      numerics_section(),
      output_section(),
      soil_section(),
      soil_obstacle_section(),
      soil_contact_section(),
      penetrometer_section(),
  };
  return table;
}

const SectionSpec* find_section(std::string_view name) {
  const std::vector<SectionSpec>& t = schema();
  const auto found = std::find_if(t.begin(), t.end(), [&](const SectionSpec& s) { return s.name == name; });
  return found == t.end() ? nullptr : &*found;
}

bool applies(const SectionSpec& section, const KeySpec& key, const Scene& scene, std::size_t index) {
  if (!key.condition) return true;
  const KeySpec* other = section.find(key.condition->key);
  ROOTSOIL_ASSERT(other != nullptr);
  const std::optional<Value> value = other->get(scene, index);
  if (key.condition->absent) return !value;
  if (key.condition->values.empty()) return value.has_value();
  const auto& words = key.condition->values;
  return value && std::find(words.begin(), words.end(), std::get<std::string>(*value)) != words.end();
}

bool supplied_by_response(const KeySpec& key, const Scene& scene) {
  if (key.response_section.empty()) return false;
  const SectionSpec& section = *find_section(key.response_section);
  return section.count(scene) > 0 && section.find(key.name)->get(scene, 0).has_value();
}

std::string key_path(const SectionSpec& section, std::size_t index, std::string_view key) {
  std::string path = section.name;
  if (section.kind == SectionKind::repeated) path += fmt::format("[{}]", index + 1);
  return key.empty() ? path : fmt::format("{}.{}", path, key);
}

std::string section_header(const SectionSpec& section) {
  return section.kind == SectionKind::repeated ? fmt::format("[[{}]]", section.name)
                                               : fmt::format("[{}]", section.name);
}

}  // namespace rootsoil
