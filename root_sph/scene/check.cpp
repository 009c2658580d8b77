// SPDX-License-Identifier: MIT
// What a run would do and cost, without running it.
#include "root_sph/core/errors.hpp"
#include "root_sph/scene/commands.hpp"
#include "root_sph/scene/model.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/tissue/hyperbolicity.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <algorithm>
#include <cstdio>
#include <numeric>

namespace rootsoil {
namespace {

using Json = nlohmann::ordered_json;

template <int Dim>
AcousticFinding worst_acoustics(const Scene& scene) {
  ElasticConstants stiffest = elastic_constants(scene);
  if (scene.tissue.anisotropy) {
    stiffest.E_radial_MPa = radial_modulus_profile(scene, initial_pressure_MPa(scene))(1e9);
  }
  return scan_acoustic_tensor<Dim>(scene.tissue.law == "pressure_deviator" ? pressure_deviator_tangent<Dim>(stiffest)
                                                                           : elastic_growth_tangent<Dim>(stiffest));
}

template <int Dim>
double tissue_volume(const Tissue<Dim>& tissue) {
  const auto& volumes = tissue.cells.volume.values();
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

template <int Dim>
Json examine(const Scene& scene) {
  const AcousticFinding acoustics = worst_acoustics<Dim>(scene);
  BuiltModel<Dim> built = build_model<Dim>(scene);
  Solver<Dim>& solver = built.model->solver;
  Tissue<Dim>& tissue = solver.tissue();
  const std::size_t cells = tissue.cells.size();
  const ClosedFormFlow theory = closed_form_flow<Dim>(scene, solver.axis().length_mm());

  // two windows of the real thing tell the cost; nothing is written
  solver.advance_window(scene.numerics.window_steps);
  const auto start = std::chrono::steady_clock::now();
  solver.advance_window(scene.numerics.window_steps);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double steps = std::ceil(scene.scene.duration_h / tissue.step_h);
  // new tissue has the width of the first cells and, on average, 0.72 (1/(2 ln 2)) of the division threshold as length
  constexpr double longest_threshold_mm = 1.0;  // where a profile that never ends is read
  double growth = 1.0;
  if (scene.division) {
    const double volume_h = theory.tip_speed_mm_h * tissue_volume<Dim>(tissue) / solver.axis().length_mm();
    const double cell = std::pow(built.initial.cell_size_mm, Dim - 1) * 0.72 * division_profile(scene)(longest_threshold_mm);
    growth += 0.5 * volume_h * scene.scene.duration_h / cell / static_cast<double>(cells);
  }

  Json effects, fields, pair_terms, phases;
  for (const EffectEntry& entry : effect_table()) {
    const bool active = entry.called_for(scene);
    effects.push_back({{"name", entry.name}, {"section", entry.section}, {"active", active}, {"what", entry.what}});
    if (active && *entry.pair_term) pair_terms.push_back({{"effect", entry.name}, {"terms", entry.pair_term}});
  }
  std::size_t bytes = 0;
  for (const auto& field : tissue.cells.fields()) {
    fields.push_back({{"name", field->info().name},
                      {"unit", field->info().unit},
                      {"bytes_per_cell", field->bytes_per_cell()},
                      {"kept", field->info().storage == Storage::state ? "state" : "scratch"}});
    bytes += field->bytes_per_cell();
  }
  for (const auto& [name, unused] : solver.clock().seconds()) phases.push_back(name);
  const auto& terms = solver.pair_terms();
  const std::size_t pair_bytes = sizeof(Pair) + sizeof(PairGradient<Dim>) + sizeof(double) +
                                 (terms.any() ? sizeof(double) : 0) + (terms.non_affine ? sizeof(Vec<Dim>) : 0) +
                                 (terms.non_affine && scene.growth ? sizeof(double) : 0);  // retention
  const double pairs = static_cast<double>(tissue.pairs.pairs.size());
  const PresetRecord record = preset_record(scene.numerics.accuracy);
  return {{"scene", scene.scene.name},
          {"dimension", Dim},
          {"cells", cells},
          {"effects", effects},
          {"fields", fields},
          {"bytes_per_cell", bytes},
          {"pair_terms", pair_terms.is_null() ? Json::array() : pair_terms},
          {"bytes_per_pair", pair_bytes},
          {"pairs_per_cell", pairs / static_cast<double>(cells)},
          {"phases", phases},
          {"processes", scene.soil ? Json::array({"rootsoil", "yade"}) : Json::array({"rootsoil"})},
          {"law", scene.tissue.law},
          {"hyperbolic", acoustics.hyperbolic},
          {"smallest_acoustic_modulus_MPa", acoustics.smallest_real_MPa},
          {"accuracy", scene.numerics.accuracy},
          {"step_h", tissue.step_h},
          {"steps", steps},
          {"stable_step", "any: inertia follows the step"},
          {"inertia_error_at_start", inertia_error<Dim>(tissue, solver.axis(), solver.window_h())},
          {"discretisation_error", record.discretisation_error},
          {"preset_inertia_error", record.inertia_error},
          {"preset_ms_per_cell_hour", record.ms_per_cell_hour},
          {"closed_form_tip_speed_mm_h", theory.tip_speed_mm_h},
          {"closed_form_peak_strain_rate_per_h", theory.peak_rate_per_h},
          {"cells_per_step_at_the_tip", theory.tip_speed_mm_h * tissue.step_h / built.initial.cell_size_mm},
          {"estimated_run_s", seconds * steps / scene.numerics.window_steps * growth}};
}

void print(const Json& found) {
  fmt::print("{}: {}D, {} cells, law {}\n\neffects\n", found["scene"].get<std::string>(), found["dimension"].get<int>(),
             found["cells"].get<int>(), found["law"].get<std::string>());
  for (const Json& e : found["effects"]) {
    fmt::print("  {:<22} {:<15} {}\n", e["name"].get<std::string>(), e["active"].get<bool>() ? "active" : "not called for",
               e["what"].get<std::string>());
  }
  fmt::print("\nfields (bytes per cell)\n");
  for (const Json& f : found["fields"]) {
    fmt::print("  {:<22} {:>4}  {:<8} {}\n", f["name"].get<std::string>(), f["bytes_per_cell"].get<int>(),
               f["kept"].get<std::string>(), f["unit"].get<std::string>());
  }
  fmt::print("  {:<22} {:>4}\n\npair terms: stress", "together", found["bytes_per_cell"].get<int>());
  for (const Json& t : found["pair_terms"]) fmt::print("; {}: {}", t["effect"].get<std::string>(), t["terms"].get<std::string>());
  fmt::print(" ({} bytes a pair, {:.1f} pairs a cell)\n", found["bytes_per_pair"].get<int>(),
             found["pairs_per_cell"].get<double>());
  fmt::print("step: {:.4g} h, {:.0f} steps ({}); stable at any step, the step buys accuracy\n",
             found["step_h"].get<double>(), found["steps"].get<double>(), found["accuracy"].get<std::string>());
  fmt::print("discretisation error about {:.2g} %; inertia error ", 100.0 * found["discretisation_error"].get<double>());
  if (found["closed_form_tip_speed_mm_h"].get<double>() > 0.0) {
    fmt::print("{:.2g} % of p at the start, every run measures its own\n",
               100.0 * found["inertia_error_at_start"].get<double>());
  } else {
    fmt::print("fades as the root settles, every run measures it\n");
  }
  fmt::print("{} was measured in growth, 8 cells across: strain rate {:.2g} % off, inertia error {:.2g} %, {:.2g} ms for a "
             "cell and an hour (docs/accuracy_cost.md)\n",
             found["accuracy"].get<std::string>(), 100.0 * found["discretisation_error"].get<double>(),
             100.0 * found["preset_inertia_error"].get<double>(), found["preset_ms_per_cell_hour"].get<double>());
  fmt::print("hyperbolic: {} (smallest acoustic modulus {:.4g} MPa)\n", found["hyperbolic"].get<bool>() ? "yes" : "no",
             found["smallest_acoustic_modulus_MPa"].get<double>());
  if (found["closed_form_tip_speed_mm_h"].get<double>() > 0.0) {
    fmt::print("closed form: tip speed {:.4f} mm/h, peak strain rate {:.3f} /h; the tip moves {:.4f} cells a step\n",
               found["closed_form_tip_speed_mm_h"].get<double>(),
               found["closed_form_peak_strain_rate_per_h"].get<double>(),
               found["cells_per_step_at_the_tip"].get<double>());
  }
  fmt::print("estimated run time on this machine: {:.0f} s\n", found["estimated_run_s"].get<double>());
}

}  // namespace

int check_scene(const Scene& scene, bool json) {
  const Json found = scene.scene.dimension == 2 ? examine<2>(scene) : examine<3>(scene);
  if (json) {
    fmt::print("{}\n", found.dump(2));
  } else {
    print(found);
  }
  return static_cast<int>(ExitStatus::done);
}

int list_effects(bool json) {
  if (json) {
    Json list;
    for (const EffectEntry& e : effect_table()) {
      list.push_back({{"name", e.name}, {"section", e.section}, {"what", e.what}, {"pair_term", e.pair_term}});
    }
    fmt::print("{}\n", list.dump(2));
  } else {
    for (const EffectEntry& e : effect_table()) fmt::print("{:<22} {}\n{:<22} in the scene: {}\n", e.name, e.what, "", e.section);
  }
  return static_cast<int>(ExitStatus::done);
}

}  // namespace rootsoil
