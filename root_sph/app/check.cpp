// SPDX-License-Identifier: MIT
// What a run would do and cost, without running it.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "root_sph/app/cell_file_json.hpp"
#include "root_sph/app/commands.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/model/model.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/tissue/hyperbolicity.hpp"

namespace rootsoil {
namespace {

using Json = nlohmann::ordered_json;

template <int Dim>
AcousticFinding worst_acoustics(const Scene& scene) {
  constexpr double far_away_mm = 1e9;  // where the tissue is stiffest
  const ElasticConstants stiffest = elastic_constants(scene, far_away_mm, pressure_MPa(scene, 0.0));
  return scan_acoustic_tensor<Dim>(tangent_of<Dim>(scene.tissue.law, stiffness<Dim>(stiffest)));
}

template <int Dim>
double tissue_volume(const Tissue<Dim>& tissue) {
  const auto& volumes = tissue.cells.volume.values();
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

/// check makes the cells, looks for their neighbours and moves them through two windows. Of very many that takes a
/// while, and memory; then it says so first.
template <int Dim>
void announce_patience(const Scene& scene) {
  constexpr double unannounced_s = 3.0;
  constexpr double s_per_cell = Dim == 2 ? 3e-5 : 9e-5,
                   bytes_per_cell = Dim == 2 ? 2.2e3 : 7e3;  // measured, one thread
  if (!scene.root.is_lattice()) return;                      // nobody has measured so many
  const double cells = asked_volume(scene.root, Dim) / std::pow(scene.root.cell_size_mm, Dim);
  if (cells * s_per_cell < unannounced_s) return;
  fmt::print(stderr,
             "check makes all {:.2g} million cells to see what a run costs: some {:.0f} s, and {:.2g} GB of memory\n",
             1e-6 * cells, cells * s_per_cell, 1e-9 * cells * bytes_per_cell);
}

template <int Dim>
Json examine(const Scene& scene) {
  announce_patience<Dim>(scene);
  const AcousticFinding acoustics = worst_acoustics<Dim>(scene);
  const std::unique_ptr<Model<Dim>> model = build_model<Dim>(scene);
  Solver<Dim>& solver = model->solver;
  Tissue<Dim>& tissue = solver.tissue();
  const std::size_t cells = tissue.cells.size();
  const ClosedFormFlow theory = closed_form_flow<Dim>(scene, solver.axis().length_mm(), tissue.pressure_MPa);

  // two windows of the real thing tell the cost; nothing is written
  solver.advance_window(scene.numerics.steps_a_window());
  const auto start = std::chrono::steady_clock::now();
  solver.advance_window(scene.numerics.steps_a_window());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double steps = std::ceil(scene.scene.duration_h / tissue.step_h);
  // new tissue has the width of the first cells and the mean length of steady growth
  constexpr double longest_threshold_mm = 1.0;  // where a profile that never ends is read
  double growth = 1.0;
  if (const DivisionSection* division = scene.find<DivisionSection>()) {
    const double volume_h = theory.tip_speed_mm_h * tissue_volume<Dim>(tissue) / solver.axis().length_mm();
    const double at_mm = std::min(longest_threshold_mm, division->ends_at_mm.value_or(longest_threshold_mm));
    const double length_mm = mean_length_over_threshold(*division) * division_threshold_mm(*division, at_mm);
    const double cell = std::pow(model->initial.cell_size_mm, Dim - 1) * length_mm;
    growth += 0.5 * volume_h * scene.scene.duration_h / cell / static_cast<double>(cells);
  }

  Json effects, fields, pair_terms, phases;
  for (const EffectSpec& entry : effect_table()) {
    const bool active = entry.called_for(scene);
    effects.push_back({{"name", entry.name}, {"section", entry.called_by}, {"active", active}, {"what", entry.what}});
    if (active && !entry.pair_term.empty()) pair_terms.push_back({{"effect", entry.name}, {"terms", entry.pair_term}});
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
                                 (terms.any() ? sizeof(double) : 0) + (terms.non_affine ? sizeof(PairSlip<Dim>) : 0) +
                                 (terms.non_affine && tissue.material.softening ? sizeof(double) : 0);  // retention
  const double pairs = static_cast<double>(tissue.pairs.pairs.size());
  const PresetRecord record = preset_record(scene.numerics.accuracy);
  Json lattice, lattice_text;
  if (const auto& fit = model->initial.lattice) {
    lattice = lattice_numbers(*fit, scene.root, model->initial.volume, Dim);
    lattice_text = describe_lattice(*fit, scene.root, model->initial.volume, Dim);
  }
  Json measured, measured_text;
  if (const auto& root = model->initial.measured) {
    measured = measured_numbers(*root);
    measured_text = describe(*root);
  }
  Json found{{"scene", scene.scene.name},
             {"dimension", Dim},
             {"cells", cells},
             {"lattice", lattice},
             {"lattice_text", lattice_text},
             {"cell_file", measured},
             {"cell_file_text", measured_text},
             {"effects", effects},
             {"fields", fields},
             {"bytes_per_cell", bytes},
             {"pair_terms", pair_terms.is_null() ? Json::array() : pair_terms},
             {"bytes_per_pair", pair_bytes},
             {"pairs_per_cell", pairs / static_cast<double>(cells)},
             {"phases", phases},
             {"processes", scene.origins.has("soil") ? Json::array({"rootsoil", "yade"}) : Json::array({"rootsoil"})},
             {"law", name_of(scene.tissue.law)},
             {"hyperbolic", acoustics.hyperbolic},
             {"smallest_acoustic_modulus_MPa", acoustics.smallest_real_MPa},
             {"accuracy", name_of(scene.numerics.accuracy)},
             {"stepper", name_of(scene.numerics.stepper)},
             {"step_h", tissue.step_h},
             {"steps", steps},
             {"stable_step", tissue.inertia ? "any: inertia follows the step" : "any: every step ends in balance"},
             {"discretisation_error", discretisation_error(scene.numerics, model->initial.across)},
             {"cells_across", model->initial.across},
             {"preset_discretisation_error", record.discretisation_error},
             {"closed_form_tip_speed_mm_h", theory.tip_speed_mm_h},
             {"closed_form_peak_strain_rate_per_h", theory.peak_rate_per_h},
             {"cells_per_step_at_the_tip", theory.tip_speed_mm_h * tissue.step_h / model->initial.cell_size_mm},
             {"estimated_run_s", seconds * steps / scene.numerics.steps_a_window() * growth}};
  if (tissue.inertia) {
    found["inertia_error_at_start"] = inertia_error<Dim>(tissue, solver.axis(), solver.window_h());
    found["preset_inertia_error"] = record.inertia_error;
    found["preset_ms_per_cell_hour"] = record.ms_per_cell_hour;
  } else {
    found["force_imbalance_at_start"] = solver.balance().imbalance;
    found["iterations_at_start"] = solver.balance().iterations;
  }
  return found;
}

/// What a run's steps in time cost in accuracy.
std::string error_text(const Json& found) {
  if (found.contains("force_imbalance_at_start")) {
    return fmt::format("forces balance to {:.2g} of p at the start, in {} iterations; every run prints its own",
                       found["force_imbalance_at_start"].get<double>(), found["iterations_at_start"].get<int>());
  }
  if (found["closed_form_tip_speed_mm_h"].get<double>() <= 0.0) {
    return "inertia error fades as the root settles, every run measures it";
  }
  return fmt::format("inertia error {:.2g} % of p at the start, every run measures its own",
                     100.0 * found["inertia_error_at_start"].get<double>());
}

void print(const Json& found) {
  fmt::print("{}: {}D, {} cells, law {}\n", found["scene"].get<std::string>(), found["dimension"].get<int>(),
             found["cells"].get<int>(), found["law"].get<std::string>());
  if (const Json& text = found["lattice_text"]; text.is_string()) fmt::print("lattice: {}\n", text.get<std::string>());
  for (const Json& line : found["cell_file_text"]) fmt::print("cell file: {}\n", line.get<std::string>());
  fmt::print("\neffects\n");
  for (const Json& e : found["effects"]) {
    fmt::print("  {:<22} {:<15} {}\n", e["name"].get<std::string>(),
               e["active"].get<bool>() ? "active" : "not called for", e["what"].get<std::string>());
  }
  fmt::print("\nfields (bytes per cell)\n");
  for (const Json& f : found["fields"]) {
    fmt::print("  {:<22} {:>4}  {:<8} {}\n", f["name"].get<std::string>(), f["bytes_per_cell"].get<int>(),
               f["kept"].get<std::string>(), f["unit"].get<std::string>());
  }
  fmt::print("  {:<22} {:>4}\n\npair terms: stress", "together", found["bytes_per_cell"].get<int>());
  for (const Json& t : found["pair_terms"])
    fmt::print("; {}: {}", t["effect"].get<std::string>(), t["terms"].get<std::string>());
  fmt::print(" ({} bytes a pair, {:.1f} pairs a cell)\n", found["bytes_per_pair"].get<int>(),
             found["pairs_per_cell"].get<double>());
  fmt::print("step: {:.4g} h, {:.0f} steps ({}); stable at any step, the step buys accuracy\n",
             found["step_h"].get<double>(), found["steps"].get<double>(), found["accuracy"].get<std::string>());
  fmt::print("{:.3g} cells across: discretisation error about {:.2g} %; {}\n", found["cells_across"].get<double>(),
             100.0 * found["discretisation_error"].get<double>(), error_text(found));
  if (is_coarser_than_measured(found["cells_across"].get<double>())) fmt::print("{}\n", coarser_than_measured);
  if (found.contains("preset_inertia_error")) {
    fmt::print(
        "{} was measured in growth, 8 cells across: strain rate {:.2g} % off, inertia error {:.2g} %, {:.2g} ms for a "
        "cell and an hour (docs/accuracy_cost.md)\n",
        found["accuracy"].get<std::string>(), 100.0 * found["preset_discretisation_error"].get<double>(),
        100.0 * found["preset_inertia_error"].get<double>(), found["preset_ms_per_cell_hour"].get<double>());
  }
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
    for (const EffectSpec& e : effect_table()) {
      list.push_back({{"name", e.name},
                      {"section", e.called_by},
                      {"what", e.what},
                      {"exact", e.exact},
                      {"pair_term", e.pair_term},
                      {"pushes", e.push != Push::none}});
    }
    fmt::print("{}\n", list.dump(2));
  } else {
    for (const EffectSpec& e : effect_table()) {
      fmt::print("{:<22} {}\n{:<22} in the scene: {}\n", e.name, e.what, "", e.called_by);
    }
  }
  return static_cast<int>(ExitStatus::done);
}

}  // namespace rootsoil
