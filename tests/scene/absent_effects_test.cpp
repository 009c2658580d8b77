// SPDX-License-Identifier: MIT
// A scene that does not call for an effect runs, bit for bit, as if that effect had never been written.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "root_sph/io/files.hpp"
#include "root_sph/model/model.hpp"
#include "root_sph/scene/read_scene.hpp"
#include "tests/support/clouds.hpp"
#include "tests/support/every_effect.hpp"

namespace rootsoil {
namespace {

using Texts = std::vector<std::string>;

/// Sections that are refused without an effect.
const std::map<std::string, Texts> refused_without{
    {"pressure", {"response"}}, {"anisotropy", {"response"}}, {"growth", {"sleep"}}, {"clamped base", {"sleep"}}};
/// Keys that do without an effect that other keys call for, or give what its section gave.
const std::map<std::string, Texts> keys_instead{
    {"inertia compensation", {"numerics.inertia_compensation=false"}},
    {"midline damping", {"numerics.midline_damping_per_h=0"}},
    {"clamped base", {"root.base=free"}},
    {"response", {"tissue.anisotropy.x_e_mm=0.05", "tissue.anisotropy.s_e_per_mm=6", "tissue.anisotropy.c_e=0.2"}}};

Texts of(const std::map<std::string, Texts>& map, const std::string& name) {
  return map.contains(name) ? map.at(name) : Texts{};
}

/// A section, "tissue.anisotropy", that a scene has.
using HasSection = std::function<bool(const std::string&)>;

/// The scene of every effect, or what it has of it.
struct SceneFile {
  std::string text;
  Texts overrides;

  SceneFile(const HasSection& has, const Texts& keys) {
    std::istringstream lines(read_whole_file(test::every_effect));
    bool kept = true;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('[')) {
        const std::size_t from = line.find_first_not_of('[');
        kept = has(line.substr(from, line.find(']') - from));
      }
      if (kept) text += line + '\n';
    }
    for (const std::string& key : keys) {
      if (has(key.substr(0, key.rfind('.', key.find('='))))) overrides.push_back(key);
    }
  }

  Scene read() const { return parse_scene(text, "every_effect.toml", overrides); }

  /// By a program whose table does not have the effect.
  Scene read_without_its_language(const EffectSpec& absent) const {
    std::vector<SectionSpec> sections;
    for (const EffectSpec& effect : effect_table()) {
      if (effect.name != absent.name) {
        std::copy(effect.sections.begin(), effect.sections.end(), std::back_inserter(sections));
      }
    }
    Scene scene = parse_scene(Language(sections), text, "every_effect.toml", {.overrides = overrides});
    for (const EffectSpec& effect : effect_table()) {
      if (effect.name == absent.name || effect.push == Push::none || !effect.called_for(scene)) continue;
      scene.facts.pushed_by.push_back(effect.name);
      scene.facts.can_be_arrested = scene.facts.can_be_arrested || effect.push == Push::arrest;
    }
    return scene;
  }
};

/// With all effects but one.
SceneFile all_without(const EffectSpec& absent, int dimension) {
  Texts names = of(refused_without, absent.name), keys = test::in_dimension(dimension);
  names.push_back(absent.name);
  for (const std::string& name : names) {
    const Texts more = of(keys_instead, name);
    keys.insert(keys.end(), more.begin(), more.end());
  }
  for (const SectionSpec& section : absent.sections) names.push_back(section.name);
  const HasSection has = [&names](const std::string& section) {
    return std::none_of(names.begin(), names.end(),
                        [&](const std::string& name) { return section == name || section.starts_with(name + "."); });
  };
  return SceneFile(has, keys);
}

/// A root that grows, with a step that follows from what it does.
SceneFile growth_alone(int dimension) {
  const std::set<std::string> sections{"scene", "root", "tissue", "pressure", "growth", "output"};
  return SceneFile([&sections](const std::string& section) { return sections.contains(section); },
                   test::in_dimension(dimension));
}

/// What some windows leave: every column, and the phases that ran.
struct Outcome {
  std::map<std::string, std::vector<double>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
  std::set<std::string> phases;
};

template <int Dim>
Outcome run(const Scene& scene) {
  const auto model = build_model<Dim>(
      scene, {.make_soil = [](const Scene&, const SoilStart&) { return std::make_unique<test::NoSoil>(); }});
  for (int window = 0; window < 4; ++window) model->solver.advance_window(5);
  Outcome outcome;
  for (const auto& field : model->solver.tissue().cells.fields()) {
    outcome.reals[field->info().name].assign(field->reals().begin(), field->reals().end());
    outcome.integers[field->info().name].assign(field->integers().begin(), field->integers().end());
  }
  for (const auto& [phase, seconds] : model->solver.clock().seconds()) outcome.phases.insert(phase);
  return outcome;
}

template <class Dimension>
class AbsentEffect : public ::testing::Test {};
TYPED_TEST_SUITE(AbsentEffect, test::BothDimensions, test::DimensionName);

/// The scene runs as by a program that does not have the effect.
template <int Dim>
void expect_the_same_without(const EffectSpec& absent, const SceneFile& file) {
  const Outcome found = run<Dim>(file.read()), expected = run<Dim>(file.read_without_its_language(absent));
  EXPECT_EQ(found.phases, expected.phases);
  EXPECT_EQ(found.integers, expected.integers);
  ASSERT_EQ(found.reals.size(), expected.reals.size());
  for (const auto& [name, values] : expected.reals) EXPECT_TRUE(found.reals.at(name) == values) << name << " differs";
}

TYPED_TEST(AbsentEffect, LeavesTheBitsOfAllOthers) {
  constexpr int dim = TypeParam::value;
  for (const EffectSpec& absent : effect_table()) {
    SCOPED_TRACE(absent.name);
    const SceneFile file = all_without(absent, dim);
    ASSERT_FALSE(absent.called_for(file.read()));
    expect_the_same_without<dim>(absent, file);
  }
}

TYPED_TEST(AbsentEffect, LeavesTheBitsOfGrowthAlone) {
  constexpr int dim = TypeParam::value;
  const SceneFile file = growth_alone(dim);
  const Scene scene = file.read();
  for (const EffectSpec& absent : effect_table()) {
    if (absent.called_for(scene)) continue;
    SCOPED_TRACE(absent.name);
    expect_the_same_without<dim>(absent, file);
  }
  EXPECT_LT(active_effects(scene).size(), 6u);
}

}  // namespace
}  // namespace rootsoil
