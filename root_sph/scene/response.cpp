// SPDX-License-Identifier: MIT
#include "root_sph/scene/response.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

Response* find_response(Scene& scene, const std::string& target) {
  const auto found = std::find_if(scene.responses.begin(), scene.responses.end(),
                                  [&](const Response& r) { return r.section == target; });
  return found == scene.responses.end() ? nullptr : &*found;
}

Numbers numbers_of(const std::array<double, 2>& pair) { return {pair[0], pair[1]}; }
std::array<double, 2> pair_of(const Value& value) {
  const Numbers& numbers = std::get<Numbers>(value);
  return {numbers[0], numbers[1]};
}

KeySpec pressures_key(const std::string& target) {
  KeySpec key{.name = "p_MPa",
              .type = ValueType::pair,
              .unit = "MPa",
              .limits = sections::pressure,
              .meaning = "The two pressure differentials.",
              .source = "Eq. 7, paper 2.4",
              .required = true,
              .default_text = "required"};
  key.set = [target](Scene& scene, std::size_t, const Value& value) {
    find_response(scene, target)->p_MPa = pair_of(value);
  };
  key.get = [target](const Scene& scene, std::size_t) {
    return std::optional<Value>(numbers_of(response_of(scene, target)->p_MPa));
  };
  return key;
}

KeySpec pair_key(const SectionSpec& target, const KeySpec& key) {
  KeySpec pair{.name = key.name,
               .type = ValueType::pair,
               .unit = key.unit,
               .limits = key.limits,
               .meaning = fmt::format("As in [{}].", target.name),
               .source = "Eq. 7, Table 1",
               .default_text = "none"};
  pair.set = [section = target.name, name = key.name](Scene& scene, std::size_t, const Value& value) {
    find_response(scene, section)->pairs[name] = pair_of(value);
  };
  pair.get = [section = target.name, name = key.name](const Scene& scene, std::size_t) -> std::optional<Value> {
    const auto& pairs = response_of(scene, section)->pairs;
    const auto found = pairs.find(name);
    if (found == pairs.end()) return std::nullopt;
    return numbers_of(found->second);
  };
  return pair;
}

/// Every parameter is linear in p, so it stays within its range if it does at the lowest and the highest p.
void check_response(const Scene& scene, const SectionSpec& target, const std::string& name) {
  const Origins& origins = scene.origins;
  const Response& response = *response_of(scene, target.name);
  if (!origins.has(target.name)) {
    origins.fail(name, fmt::format("there is no [{}] that could respond", target.name), {}, {},
                 fmt::format("add [{}], or remove [{}]", target.name, name));
  }
  if (response.p_MPa[0] == response.p_MPa[1]) {
    origins.fail(name + ".p_MPa", "the two pressures are equal", toml_text(numbers_of(response.p_MPa)),
                 "two different pressures", "give the pressure of each parameter set");
  }
  if (response.pairs.empty()) {
    origins.fail(name, "no parameter is listed", {}, {},
                 fmt::format("give pairs for keys of [{0}]; rootsoil describe {0} lists them", target.name));
  }
  const bool extrapolate = scene.find<ResponseSection>()->extrapolate;
  for (const KeySpec& key : target.keys) {
    const auto found = response.pairs.find(key.name);
    if (found == response.pairs.end()) continue;
    for (const double p : responding_range_MPa(scene)) {
      const double number = responded(found->second, response.p_MPa, p, extrapolate);
      if (key.limits.contains(number)) continue;
      origins.fail(
          fmt::format("{}.{}", name, key.name),
          fmt::format("Eq. 7 gives {:.4g} at p = {} MPa{}", number, p,
                      p < scene.facts.pressure_MPa[0] ? ", which a root perceives that is pushed as hard" : ""),
          toml_text(numbers_of(found->second)), key.limits.text(),
          "set response.extrapolate = false, or choose p_MPa so that they enclose the pressure");
    }
  }
}

}  // namespace

double responded(const std::array<double, 2>& pair, const std::array<double, 2>& p_MPa, double p, bool extrapolate) {
  const double line = (p - p_MPa[1]) / (p_MPa[0] - p_MPa[1]);
  const double theta = extrapolate ? line : std::clamp(line, 0.0, 1.0);
  return theta * pair[0] + (1.0 - theta) * pair[1];
}

bool responds_to_perceived(const Scene& scene) {
  const ResponseSection* section = scene.find<ResponseSection>();
  return section && section->follows == Follows::perceived;
}

std::array<double, 2> responding_range_MPa(const Scene& scene) {
  const auto [low, high] = scene.facts.pressure_MPa;
  return {responds_to_perceived(scene) ? std::min(0.0, low) : low, high};
}

std::string response_section_name(const std::string& target) {
  return "response." + target.substr(target.rfind('.') + 1);
}

const Response* response_of(const Scene& scene, const std::string& target) {
  return find_response(const_cast<Scene&>(scene), target);
}

SectionSpec response_section(const SectionSpec& target) {
  const std::string name = response_section_name(target.name);
  SectionSpec spec{
      .name = name,
      .kind = SectionKind::optional,
      .meaning = fmt::format("Keys of [{}] as pairs: [value at the first pressure, value at the second].", target.name),
      .keys = {pressures_key(target.name)}};
  for (const KeySpec& key : target.keys) {
    if (key.responds) spec.keys.push_back(pair_key(target, key));
  }
  spec.count = [section = target.name](const Scene& scene) { return response_of(scene, section) ? 1u : 0u; };
  spec.add = [section = target.name](Scene& scene) { scene.responses.push_back({.section = section, .pairs = {}}); };
  spec.complete = [target, name](Scene& scene) { check_response(scene, target, name); };
  return spec;
}

}  // namespace rootsoil
