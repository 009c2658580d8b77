// SPDX-License-Identifier: MIT
#include "root_sph/scene/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/response.hpp"
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

SectionSpec SectionSpec::completed_by(std::function<void(Scene&)> check) && {
  complete = std::move(check);
  return std::move(*this);
}

SectionSpec SectionSpec::also_without_root() && {
  without_root = true;
  return std::move(*this);
}

Language::Language(std::vector<SectionSpec> of_effects) {
  for (SectionSpec& section : sections::of_every_scene()) sections_.push_back(std::move(section));
  std::vector<SectionSpec> responses;
  for (const SectionSpec& section : of_effects) {
    const bool responds =
        std::any_of(section.keys.begin(), section.keys.end(), [](const KeySpec& k) { return k.responds; });
    if (responds) responses.push_back(response_section(section));
  }
  for (SectionSpec& section : of_effects) {
    const bool holds_responses = section.name == "response";
    sections_.push_back(std::move(section));
    if (holds_responses) std::move(responses.begin(), responses.end(), std::back_inserter(sections_));
  }
}

const SectionSpec* Language::find(std::string_view name) const {
  const auto found =
      std::find_if(sections_.begin(), sections_.end(), [&](const SectionSpec& s) { return s.name == name; });
  return found == sections_.end() ? nullptr : &*found;
}

bool Language::applies(const SectionSpec& section, const KeySpec& key, const Scene& scene, std::size_t index) const {
  if (!key.condition) return true;
  const KeySpec* other = section.find(key.condition->key);
  ROOTSOIL_ASSERT(other != nullptr);
  const std::optional<Value> value = other->get(scene, index);
  if (key.condition->absent) return !value;
  if (key.condition->values.empty()) return value.has_value();
  const auto& words = key.condition->values;
  return value && std::find(words.begin(), words.end(), std::get<std::string>(*value)) != words.end();
}

bool Language::supplied_by_response(const SectionSpec& section, const KeySpec& key, const Scene& scene) const {
  const Response* response = key.responds ? response_of(scene, section.name) : nullptr;
  return response && response->pairs.contains(key.name);
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
