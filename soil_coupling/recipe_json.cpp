// SPDX-License-Identifier: MIT
#include "soil_coupling/recipe_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "root_sph/core/digest.hpp"

namespace rootsoil {
namespace {

using Json = nlohmann::ordered_json;

Json obstacle_json(const SoilObstacle& o) {
  return {{"name", o.name},
          {"shape", name_of(o.shape)},
          {"position_mm", o.position_mm},
          {"half_size_mm", o.half_size_mm},
          {"length_mm", o.length_mm},
          {"thickness_mm", o.thickness_mm},
          {"angle_deg", o.angle_deg},
          {"radius_mm", o.radius_mm},
          {"movable", o.movable}};
}

/// A gap is carved when the soil is built; a sample does not know of it.
Json obstacles_json(const SoilRecipe& recipe, bool packing_only) {
  Json list = Json::array();
  for (const SoilObstacle& o : recipe.obstacles) {
    if (!packing_only || o.shape != SoilShape::gap) list.push_back(obstacle_json(o));
  }
  return list;
}

Json packing_json(const SoilRecipe& r) {
  return {{"dimension", r.dimension},
          {"box_from_mm", r.box_from_mm},
          {"box_to_mm", r.box_to_mm},
          {"confining_pressure_MPa", r.confining_pressure_MPa},
          {"d_min_mm", r.d_min_mm},
          {"d_max_mm", r.d_max_mm},
          {"contact_law", name_of(r.contact_law)},
          {"E_MPa", r.E_MPa},
          {"poisson", r.poisson},
          {"friction_deg", r.friction_deg},
          {"rolling", r.rolling},
          {"porosity", r.porosity ? Json(*r.porosity) : Json()},
          {"compaction_friction_deg", r.compaction_friction_deg},
          {"damping", r.damping},
          {"seed", r.seed},
          {"obstacles", obstacles_json(r, true)}};
}

/// "" without grains.
std::string digest_of(const std::vector<SoilGrain>& grains) {
  std::string text;
  for (const SoilGrain& g : grains)
    text += fmt::format("{} {} {} {}\n", g.centre_mm[0], g.centre_mm[1], g.centre_mm[2], g.radius_mm);
  return text.empty() ? text : digest(text);
}

}  // namespace

std::string packing_key(const SoilRecipe& recipe) {
  constexpr int packing_version = 3;  // raise it when packing.py packs differently
  Json key = packing_json(recipe);
  key["packing_version"] = packing_version;
  return key.dump();
}

nlohmann::ordered_json recipe_json(const SoilRecipe& r) {
  Json json = packing_json(r);
  json["obstacles"] = obstacles_json(r, false);
  json["walls"] = name_of(r.walls);
  json["d_mean_mm"] = r.d_mean_mm;
  json["layer_mm"] = r.layer_mm();
  json["listed_grains"] = digest_of(r.grains);  // of what the file says, wherever it lies
  json["root_friction_deg"] = r.root_friction_deg;
  json["cohesion_MPa"] = r.cohesion_MPa;
  json["step_safety"] = r.step_safety;
  json["packing_key"] = packing_key(r);
  return json;
}

std::string path_code(const std::filesystem::path& path) {
  std::string code;
  for (const unsigned char c : path.string()) code += fmt::format("{:02x}", c);
  return code;
}

std::string digest(const std::string& text) { return fmt::format("{:016x}", fnv1a(text)); }

}  // namespace rootsoil
