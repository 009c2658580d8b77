// SPDX-License-Identifier: MIT
#include "root_sph/effects/table.hpp"

#include <fmt/format.h>

#include <iterator>

#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/clamped_base/clamped_base.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/force/force.hpp"
#include "root_sph/effects/gravity/gravity.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/inertia_compensation/inertia_compensation.hpp"
#include "root_sph/effects/midline_damping/midline_damping.hpp"
#include "root_sph/effects/obstacle/obstacle.hpp"
#include "root_sph/effects/pair_resistance/pair_resistance.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/effects/probe/probe.hpp"
#include "root_sph/effects/response/response.hpp"
#include "root_sph/effects/sleep/sleep.hpp"
#include "root_sph/effects/soil_contact/soil_contact.hpp"
#include "root_sph/scene/read_scene.hpp"

namespace rootsoil {

std::span<const EffectSpec> effect_table() {
  static const std::vector<EffectSpec> table{
      pressure_effect(),
      response_effect(),
      anisotropy_effect(),
      growth_effect(),
      inertia_compensation_effect(),
      midline_damping_effect(),
      division_effect(),
      clamped_base_effect(),
      pair_resistance_effect(),
      obstacle_effect(),
      gravity_effect(),
      force_effect(),
      sleep_effect(),
      probe_effect(),
      soil_contact_effect(),
  };
  return table;
}

std::vector<std::string> active_effects(const Scene& scene) {
  std::vector<std::string> names;
  for (const EffectSpec& effect : effect_table()) {
    if (effect.called_for(scene)) names.push_back(effect.name);
  }
  return names;
}

const Language& language() {
  static const Language all = [] {
    std::vector<SectionSpec> sections;
    for (const EffectSpec& effect : effect_table()) {
      std::copy(effect.sections.begin(), effect.sections.end(), std::back_inserter(sections));
    }
    return Language(std::move(sections));
  }();
  return all;
}

namespace {

/// What the table knows about the scene, for the effects to know of each other.
Scene with_facts(Scene scene) {
  for (const EffectSpec& effect : effect_table()) {
    if (effect.push == Push::none || !effect.called_for(scene)) continue;
    scene.facts.pushed_by.push_back(effect.name);
    scene.facts.can_be_arrested = scene.facts.can_be_arrested || effect.push == Push::arrest;
  }
  return scene;
}

Scene soil_of(Scene scene) {
  for (const char* section : {"soil", "penetrometer"}) {
    if (scene.origins.has(section)) continue;
    scene.origins.fail("", fmt::format("section [{}] is missing", section), {}, {},
                       fmt::format("add it; rootsoil describe {} lists its keys", section));
  }
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                 const std::optional<std::string>& accuracy) {
  return with_facts(read_scene(language(), path, {.overrides = overrides, .accuracy = accuracy}));
}

Scene parse_scene(std::string_view text, std::string file_name, const std::vector<std::string>& overrides,
                  const std::optional<std::string>& accuracy) {
  return with_facts(
      parse_scene(language(), text, std::move(file_name), {.overrides = overrides, .accuracy = accuracy}));
}

Scene read_soil(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return soil_of(read_scene(language(), path, {.overrides = overrides, .soil_alone = true}));
}

Scene parse_soil(std::string_view text, std::string file_name, const std::vector<std::string>& overrides) {
  return soil_of(parse_scene(language(), text, std::move(file_name), {.overrides = overrides, .soil_alone = true}));
}

}  // namespace rootsoil
