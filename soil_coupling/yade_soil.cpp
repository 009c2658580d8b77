// SPDX-License-Identifier: MIT
#include "soil_coupling/yade_soil.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "root_sph/core/errors.hpp"
#include "soil_coupling/recipe_json.hpp"
#include "soil_coupling/sample_cache.hpp"

namespace rootsoil {
namespace {

template <std::size_t N, class T>
void put(std::span<T> column, const std::vector<std::array<T, N>>& rows) {
  ROOTSOIL_ASSERT(column.size() == N * rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) std::copy(rows[i].begin(), rows[i].end(), column.begin() + N * i);
}

template <class T>
void put(std::span<T> column, const std::vector<T>& rows) {
  ROOTSOIL_ASSERT(column.size() == rows.size());
  std::copy(rows.begin(), rows.end(), column.begin());
}

template <std::size_t N, class T>
std::vector<std::array<T, N>> rows_of(std::span<const T> column) {
  std::vector<std::array<T, N>> rows(column.size() / N);
  for (std::size_t i = 0; i < rows.size(); ++i) std::copy_n(column.begin() + N * i, N, rows[i].begin());
  return rows;
}

bool all_finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

double grain_density_N_h2_mm4(const SoilRecipe& recipe, const SoilStart& start) {
  if (recipe.density_N_h2_mm4) return *recipe.density_N_h2_mm4;
  if (!(start.root_speed_mm_h > 0.0 && start.root_diameter_mm > 0.0 && recipe.confining_pressure_MPa > 0.0)) {
    throw InputError(
        {.file = {},
         .line = 0,
         .key = "soil.density_N_h2_mm4",
         .what = "the grains' density can't be derived: the root has no expected speed, or the soil no pressure",
         .given = fmt::format("speed {} mm/h, confining pressure {} MPa", start.root_speed_mm_h,
                              recipe.confining_pressure_MPa),
         .allowed = {},
         .remedy = "give soil.density_N_h2_mm4"});
  }
  return quasi_static_density_N_h2_mm4(recipe, start.root_speed_mm_h, start.root_diameter_mm);
}

YadeSoil::YadeSoil(const SoilRecipe& recipe, const SoilStart& start, const SoilProcessOptions& options)
    : recipe_(recipe), density_N_h2_mm4_(grain_density_N_h2_mm4(recipe, start)) {
  const nlohmann::ordered_json root{{"density_N_h2_mm4", density_N_h2_mm4_},
                                    {"root_speed_mm_h", std::max(start.root_speed_mm_h, 1e-6)},
                                    {"root_diameter_mm", start.root_diameter_mm > 0.0 ? start.root_diameter_mm : 1.0}};
  start_text_ = root.dump();
  const std::filesystem::path sample = recipe.grains.empty() ? ensure_sample(recipe, options) : std::filesystem::path();
  process_ = std::make_unique<SoilProcess>(options);

  SharedBlock& block = process_->block();
  const std::size_t rows = start.body_mm.size(), grains = recipe.grains.size();
  const std::size_t begin = column_offset(body_table, body_table.size(), rows);
  block.grow(column_offset(body_table, body_table.size(), grains, begin));
  put(block.column<double>(body_table, 0, rows), start.body_mm);
  put(block.column<double>(body_table, 1, rows), start.body_radius_mm);
  const std::span<double> centre = block.column<double>(body_table, 0, grains, begin),
                          radius = block.column<double>(body_table, 1, grains, begin);
  for (std::size_t i = 0; i < grains; ++i) {
    std::copy_n(recipe.grains[i].centre_mm.begin(), 3, centre.begin() + 3 * i);
    radius[i] = recipe.grains[i].radius_mm;
  }
  const std::string task = nlohmann::ordered_json{
      {"recipe", recipe_json(recipe_)},
      {"start", root},
      {"sample", path_code(sample)},
      {"grains", grains}}.dump();
  process_->ask({.kind = Kind::build, .text = task, .rows = rows});
}

std::vector<std::string> YadeSoil::number_names() const {
  std::vector<std::string> names{
      "soil_inertial_number", "soil_substeps",       "soil_work_Nmm",           "soil_grains",
      "soil_slots",           "soil_overlap_max",    "soil_unbalanced",         "soil_force_balance",
      "soil_coordination",    "soil_solid_fraction", "soil_settled_unbalanced", "soil_dem_s",
      "soil_exchange_s",      "soil_obstacle_x_N",   "soil_obstacle_y_N",       "soil_obstacle_z_N",
      "soil_wall_x_from_N",   "soil_wall_x_to_N",    "soil_wall_y_from_N",      "soil_wall_y_to_N"};
  if (recipe_.dimension == 3) names.insert(names.end(), {"soil_wall_z_from_N", "soil_wall_z_to_N"});
  return names;
}

SurfaceForces YadeSoil::advance(const SurfaceMotion& motion) {
  const std::size_t rows = motion.id.size();
  ROOTSOIL_ASSERT(motion.start_mm.size() == rows && motion.end_mm.size() == rows && motion.radius_mm.size() == rows);
  SharedBlock& block = process_->block();
  block.grow(std::max(column_offset(motion_table, motion_table.size(), rows),
                      column_offset(forces_table, forces_table.size(), rows)));
  put(block.column<std::int64_t>(motion_table, 0, rows), motion.id);
  put(block.column<double>(motion_table, 1, rows), motion.start_mm);
  put(block.column<double>(motion_table, 2, rows), motion.end_mm);
  const std::span<double> spin = block.column<double>(motion_table, 3, rows);
  if (motion.spin_per_h.empty()) {
    std::fill(spin.begin(), spin.end(), 0.0);
  } else {
    put(spin, motion.spin_per_h);
  }
  put(block.column<double>(motion_table, 4, rows), motion.radius_mm);

  const Packet answer = process_->ask({.kind = Kind::advance,
                                       .rows = rows,
                                       .interval = motion.interval,
                                       .time_h = motion.time_h,
                                       .duration_h = motion.duration_h});
  const auto wrong = [&](const std::string& what) {
    throw SoilError(
        fmt::format("the soil's answer in interval {}, at {:.6g} h, can't be used: {}. The last checkpoint is kept",
                    motion.interval, motion.time_h, what));
  };
  if (answer.rows != rows || answer.interval != motion.interval) {
    wrong(fmt::format("it has {} rows for interval {} instead of {}", answer.rows, answer.interval, rows));
  }
  const std::span<const double> force = block.column<double>(forces_table, 0, rows),
                                torque = block.column<double>(forces_table, 1, rows),
                                stiffness = block.column<double>(forces_table, 2, rows);
  if (!all_finite(force) || !all_finite(torque) || !all_finite(stiffness)) wrong("a force is not finite");
  SurfaceForces forces;
  forces.mean_N = rows_of<3>(force);
  forces.mean_torque_Nmm = rows_of<3>(torque);
  forces.contact_stiffness_N_mm.assign(stiffness.begin(), stiffness.end());
  const auto numbers = nlohmann::json::parse(process_->text_of(answer), nullptr, false);
  if (!numbers.is_object()) wrong("its numbers can't be read");
  for (const auto& [name, value] : numbers.items()) {
    if (!value.is_number()) wrong(name + " is not a number");
    forces.numbers[name] = value.get<double>();
  }
  for (const std::string& name : number_names()) {
    if (!forces.numbers.contains(name)) wrong(name + " is missing");
  }
  return forces;
}

void YadeSoil::save(const std::filesystem::path& file) {
  const std::string task = nlohmann::ordered_json{{"file", path_code(std::filesystem::absolute(file))}}.dump();
  process_->ask({.kind = Kind::save, .text = task});
}

void YadeSoil::load(const std::filesystem::path& file) {
  const std::string task = nlohmann::ordered_json{{"recipe", recipe_json(recipe_)},
                                                  {"start", nlohmann::json::parse(start_text_)},
                                                  {"file", path_code(std::filesystem::absolute(file))}}
                               .dump();
  process_->ask({.kind = Kind::load, .text = task});
}

SoilSnapshot YadeSoil::snapshot() {
  const Packet answer = process_->ask({.kind = Kind::snapshot});
  const auto text = nlohmann::json::parse(process_->text_of(answer), nullptr, false);
  const std::size_t rows = answer.rows, contacts = text.value("contacts", std::size_t{0});
  const SharedBlock& block = process_->block();
  const std::size_t begin = column_offset(grains_table, grains_table.size(), rows);
  if (column_offset(contacts_table, contacts_table.size(), contacts, begin) > block.size()) {
    throw SoilError("the soil's list of grains is longer than the shared memory");
  }
  const auto whole = [&](std::size_t k) {
    const std::span<const std::int64_t> column = block.column<std::int64_t>(grains_table, k, rows);
    return std::vector<std::int64_t>(column.begin(), column.end());
  };
  const auto vectors = [&](std::size_t k) {
    return rows_of<3>(std::span<const double>(block.column<double>(grains_table, k, rows)));
  };
  SoilSnapshot snapshot;
  snapshot.id = whole(0);
  snapshot.position_mm = vectors(1);
  snapshot.velocity_mm_h = vectors(2);
  const std::span<const double> radius = block.column<double>(grains_table, 3, rows);
  snapshot.radius_mm.assign(radius.begin(), radius.end());
  snapshot.contacts = whole(4);
  snapshot.stress_MPa = rows_of<6>(std::span<const double>(block.column<double>(grains_table, 5, rows)));
  snapshot.contact_ids =
      rows_of<2>(std::span<const std::int64_t>(block.column<std::int64_t>(contacts_table, 0, contacts, begin)));
  snapshot.contact_position_mm =
      rows_of<3>(std::span<const double>(block.column<double>(contacts_table, 1, contacts, begin)));
  snapshot.contact_force_N =
      rows_of<3>(std::span<const double>(block.column<double>(contacts_table, 2, contacts, begin)));
  return snapshot;
}

std::unique_ptr<SoilPort> make_yade_soil(const SoilRecipe& recipe, const SoilStart& start) {
  SoilProcessOptions options;
  options.log = start.log_file;
  options.threads = recipe.threads;
  options.progress = start.progress;
  return std::make_unique<YadeSoil>(recipe, start, options);
}

}  // namespace rootsoil
