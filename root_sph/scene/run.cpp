// SPDX-License-Identifier: MIT
// The only run loop.
#include "root_sph/core/errors.hpp"
#include "root_sph/core/interruption.hpp"
#include "root_sph/effects/probe.hpp"
#include "root_sph/io/checkpoint.hpp"
#include "root_sph/io/files.hpp"
#include "root_sph/io/history.hpp"
#include "root_sph/io/series.hpp"
#include "root_sph/scene/commands.hpp"
#include "root_sph/scene/model.hpp"
#include "root_sph/scene/picture.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/scene/progress.hpp"
#include "root_sph/scene/recorder.hpp"
#include "root_sph/scene/resume.hpp"
#include "root_sph/scene/run_log.hpp"
#include "root_sph/scene/soil_start.hpp"
#include "root_sph/scene/write_scene.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <omp.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace rootsoil {
namespace {

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// A run in its folder: advances, records, writes.
template <int Dim>
class Run {
 public:
  /// \param checkpoint of this scene, to go on from
  Run(const Scene& scene, const RunOptions& options, const RunFolder& folder,
      const std::optional<Checkpoint>& checkpoint, const SoilMaker& make_soil);
  ExitStatus go();

 private:
  void record();
  void write_checkpoint_file();
  void resume_from(const Checkpoint& checkpoint);
  std::filesystem::path own_file(std::int64_t step) const;
  void write_own_files();
  void remove_old_own_files() const;
  void write_summary(const std::string& status) const;
  std::int64_t steps_per(double interval_h) const {
    return std::max<std::int64_t>(1, std::llround(interval_h / model().solver.tissue().step_h));
  }
  Model<Dim>& model() { return *built_.model; }
  const Model<Dim>& model() const { return *built_.model; }
  std::int64_t divisions() const {
    return static_cast<std::int64_t>(model().solver.tissue().cells.total()) - cells_start_;
  }

  Scene scene_;
  const RunOptions& options_;
  std::filesystem::path folder_;
  BuiltModel<Dim> built_;
  RunLog log_;
  std::unique_ptr<SeriesWriter> series_;
  std::unique_ptr<HistoryWriter> history_;
  struct ProbeFile {
    ProbeEffect<Dim>* probe;
    std::unique_ptr<HistoryWriter> file;
  };
  std::vector<ProbeFile> probe_files_;

  std::int64_t cells_start_ = 0;
  LengthMark last_row_;
  double inertia_error_ = 0.0;  ///< at the latest row
  double inertia_error_max_ = 0.0, momentum_residual_max_ = 0.0;
  std::int64_t degenerate_max_ = 0;
  double pair_steps_ = 0.0;
  std::int64_t steps_done_ = 0;  ///< in this session
  double wall_s_ = 0.0;
  double checkpoint_h_ = 0.0;
  std::int64_t checkpoint_step_ = -1;
};

template <int Dim>
Run<Dim>::Run(const Scene& scene, const RunOptions& options, const RunFolder& folder,
              const std::optional<Checkpoint>& checkpoint, const SoilMaker& make_soil)
    : scene_(scene),
      options_(options),
      folder_(folder.path()),
      built_(build_model<Dim>(scene)),
      log_(folder.path() / "run.log", options.quiet) {
  const Tissue<Dim>& tissue = model().solver.tissue();
  if (make_soil) {
    SoilStart start = soil_start<Dim>(scene, model().solver);
    start.log_file = (folder_ / "soil.log").string();
    start.progress = [this](const std::string& text) { log_.info("soil: {}", text); };
    Soil soil = make_soil(scene, start);
    if (soil.port) add_soil_contact<Dim>(scene, model(), std::move(soil.contact), std::move(soil.port));
  }
  cells_start_ = static_cast<std::int64_t>(tissue.cells.total());
  last_row_ = {0.0, model().solver.axis().length_mm()};
  refuse_unknown_fields<Dim>(model(), scene_);  // before anything is written

  std::optional<double> continue_h;
  if (checkpoint) {
    resume_from(*checkpoint);
    if (model().solver.steps() > 0) continue_h = tissue.time_h;  // at 0 everything is written once more
  } else {
    write_checkpoint_file();  // first of all: killed at any later instant, --resume goes on
  }
  write_text_atomically(folder_ / "scene.toml", resolved_toml(scene_));
  series_ = std::make_unique<SeriesWriter>(
      folder_,
      SeriesMetadata{{"program", "rootsoil"},
                     {"version", ROOTSOIL_VERSION},
                     {"scene", scene_.scene.name},
                     {"dimension", std::to_string(Dim)}},
      continue_h);
  history_ = std::make_unique<HistoryWriter>(folder_ / "history.csv", history_columns<Dim>(model()), continue_h);
  for (const auto& effect : model().effects) {
    auto* probe = dynamic_cast<ProbeEffect<Dim>*>(effect.get());
    if (!probe) continue;
    std::vector<std::string> columns = ProbeEffect<Dim>::columns();
    columns.insert(columns.begin(), "time_h");
    probe_files_.push_back({probe, std::make_unique<HistoryWriter>(folder_ / ("probe_" + probe->name() + ".csv"),
                                                                   columns, continue_h)});
  }
}

template <int Dim>
void Run<Dim>::record() {
  const Tissue<Dim>& tissue = model().solver.tissue();
  series_->write(make_frame<Dim>(model(), scene_.output.fields));
  const HistoryRow row = make_history_row<Dim>(model(), last_row_, divisions());
  history_->append(row.values);
  last_row_ = {tissue.time_h, row.length_mm};
  inertia_error_ = row.inertia_error;
  inertia_error_max_ = std::max(inertia_error_max_, inertia_error_);
  momentum_residual_max_ = std::max(momentum_residual_max_, row.momentum_residual);
  for (const ProbeFile& p : probe_files_) {
    std::vector<double> values = p.probe->read(tissue).values();
    values.insert(values.begin(), tissue.time_h);
    p.file->append(values);
  }
}

/// State of another process that belongs to the checkpoint of a step. The checkpoint names it by its step.
template <int Dim>
std::filesystem::path Run<Dim>::own_file(std::int64_t step) const {
  return folder_ / fmt::format("soil_step_{:09}.state", step);
}

/// A new file under a new name: the old checkpoint keeps its own until the new checkpoint is complete.
template <int Dim>
void Run<Dim>::write_own_files() {
  for (const auto& effect : model().effects) {
    if (!effect->has_own_file()) continue;
    const std::filesystem::path path = own_file(model().solver.steps());
    effect->save_own_file(start_temporary(path, ""));
    commit_temporary(path);
  }
}

template <int Dim>
void Run<Dim>::remove_old_own_files() const {
  std::error_code trouble;  // what stays behind does no harm
  for (const auto& entry : std::filesystem::directory_iterator(folder_, trouble)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("soil_step_") && entry.path() != own_file(checkpoint_step_)) {
      std::filesystem::remove(entry.path(), trouble);
    }
  }
}

template <int Dim>
void Run<Dim>::write_checkpoint_file() {
  const Tissue<Dim>& tissue = model().solver.tissue();
  if (checkpoint_step_ == model().solver.steps()) return;  // it is there, and its own file must not be touched
  write_own_files();
  Checkpoint checkpoint;
  checkpoint.time_h = tissue.time_h;
  checkpoint.step = model().solver.steps();
  checkpoint.scene_digest = scene_digest(scene_);
  checkpoint.program_version = ROOTSOIL_VERSION;
  checkpoint.dimension = Dim;
  store_cells<Dim>(tissue.cells, checkpoint);
  model().solver.save(checkpoint.reals, checkpoint.integers);
  for (const auto& effect : model().effects) effect->save(checkpoint.reals);
  checkpoint.integers["run/cells_start"] = {cells_start_};
  checkpoint.reals["run/last_row"] = {last_row_.time_h, last_row_.length_mm};
  checkpoint.reals["run/worst"] = {inertia_error_max_, momentum_residual_max_, inertia_error_};
  write_checkpoint(folder_ / "checkpoint.h5", checkpoint);
  checkpoint_h_ = tissue.time_h;
  checkpoint_step_ = checkpoint.step;
  remove_old_own_files();
}

template <int Dim>
void Run<Dim>::resume_from(const Checkpoint& checkpoint) {
  restore_cells<Dim>(checkpoint, model().solver.tissue().cells);
  model().solver.restore(checkpoint.reals, checkpoint.integers);
  for (const auto& effect : model().effects) {
    effect->restore(checkpoint.reals);
    if (effect->has_own_file()) effect->restore_own_file(own_file(checkpoint.step));
  }
  cells_start_ = checkpoint.integers.at("run/cells_start").at(0);
  last_row_ = {checkpoint.reals.at("run/last_row").at(0), checkpoint.reals.at("run/last_row").at(1)};
  inertia_error_max_ = checkpoint.reals.at("run/worst").at(0);
  momentum_residual_max_ = checkpoint.reals.at("run/worst").at(1);
  inertia_error_ = checkpoint.reals.at("run/worst").at(2);
  checkpoint_h_ = checkpoint.time_h;
  checkpoint_step_ = checkpoint.step;
}

template <int Dim>
void Run<Dim>::write_summary(const std::string& status) const {
  const Solver<Dim>& solver = model().solver;
  const Tissue<Dim>& tissue = solver.tissue();
  nlohmann::ordered_json fields;
  for (const auto& field : tissue.cells.fields()) {
    fields.push_back({{"name", field->info().name},
                      {"unit", field->info().unit},
                      {"bytes_per_cell", field->bytes_per_cell()},
                      {"kept", field->info().storage == Storage::state ? "state" : "scratch"}});
  }
  nlohmann::ordered_json tip;
  for (int a = 0; a < 3; ++a) tip.push_back(a < Dim ? solver.axis().tip_mm()[a] : 0.0);
  const PresetRecord record = preset_record(scene_.numerics.accuracy);
  const nlohmann::ordered_json summary{
      {"program", "rootsoil"},
      {"version", ROOTSOIL_VERSION},
      {"scene", scene_.scene.name},
      {"status", status},
      {"time_h", tissue.time_h},
      {"steps", solver.steps()},
      {"cells_start", cells_start_},
      {"cells_end", tissue.cells.total()},
      {"divisions", divisions()},
      {"tip_mm", tip},
      {"length_mm", solver.axis().length_mm()},
      {"wall_s", wall_s_},
      {"wall_s_by_effect", solver.clock().seconds()},
      {"pairs", tissue.pairs.pairs.size()},
      {"pairs_per_s", wall_s_ > 0.0 ? pair_steps_ / wall_s_ : 0.0},
      {"peak_memory_mb", peak_memory_mb()},
      {"threads", omp_get_max_threads()},
      {"dt_h", {{"min", tissue.step_h}, {"mean", tissue.step_h}, {"max", tissue.step_h}}},
      {"accuracy", scene_.numerics.accuracy},
      {"inertia_error", inertia_error_},
      {"inertia_error_max", inertia_error_max_},
      {"discretisation_error", record.discretisation_error},
      {"preset_inertia_error", record.inertia_error},
      {"preset_ms_per_cell_hour", record.ms_per_cell_hour},
      {"momentum_residual", momentum_residual_max_},
      {"degenerate_cells_max", degenerate_max_},
      {"cell_file_volume_scale", built_.initial.volume_scale},
      {"active_effects", active_effects(scene_)},
      {"fields", fields}};
  write_text_atomically(folder_ / "summary.json", summary.dump(2) + "\n");
}

template <int Dim>
ExitStatus Run<Dim>::go() {
  Solver<Dim>& solver = model().solver;
  const Tissue<Dim>& tissue = solver.tissue();
  const std::int64_t total = steps_per(scene_.scene.duration_h);
  const std::int64_t per_frame = steps_per(scene_.output.every_h);
  const std::int64_t per_checkpoint = steps_per(scene_.output.checkpoint_every_h);
  const std::int64_t until = options_.until_h ? std::min(total, steps_per(*options_.until_h)) : total;
  const ClosedFormFlow theory = closed_form_flow<Dim>(scene_, solver.axis().length_mm());
  log_.info("{}: {} cells, {:.4g} h in {} steps of {:.4g} h, {} threads", scene_.scene.name, tissue.cells.total(),
            scene_.scene.duration_h, total, tissue.step_h, omp_get_max_threads());
  if (theory.tip_speed_mm_h > 0.0) {
    log_.info("closed form: tip speed {:.4f} mm/h, peak strain rate {:.3f} /h", theory.tip_speed_mm_h,
              theory.peak_rate_per_h);
  }
  if (built_.initial.volume_scale != 1.0) {
    log_.info("volumes of the measured ellipsoids times {:.3f}, so that they fill the tissue",
              built_.initial.volume_scale);
  }
  if (options_.resume) log_.info("resumed at {:.4g} h", tissue.time_h);

  const Interruption interruption;
  Progress progress(options_.quiet, scene_.scene.duration_h);
  const auto start = std::chrono::steady_clock::now();
  const auto measure_wall = [&] {
    wall_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (solver.steps() == 0) record();
  try {
    while (solver.steps() < until && !interruption.requested()) {
      const std::int64_t done = solver.steps();
      // windows end at output times, so that where they lie does not depend on where a run was interrupted
      const std::int64_t next_mark = std::min(total, (done / per_frame + 1) * per_frame);
      const int steps = static_cast<int>(std::min<std::int64_t>(scene_.numerics.window_steps, next_mark - done));
      solver.advance_window(steps);
      steps_done_ += steps;
      pair_steps_ += static_cast<double>(steps) * static_cast<double>(tissue.pairs.pairs.size());
      if (solver.gradient_report().degenerate > degenerate_max_) {
        degenerate_max_ = solver.gradient_report().degenerate;
        log_.note("{} cells have too few neighbours for a full gradient at {:.4g} h", degenerate_max_, tissue.time_h);
      }
      for (const auto& effect : model().effects) {
        for (const std::string& note : effect->take_notes()) log_.note("{}", note);
      }
      measure_wall();
      const bool frame_due = solver.steps() % per_frame == 0 || solver.steps() == total;
      if (frame_due) record();
      // at the first window that ends on or after the time that is due
      if (solver.steps() / per_checkpoint > done / per_checkpoint || solver.steps() == total) write_checkpoint_file();
      progress.show({tissue.time_h, static_cast<std::int64_t>(tissue.cells.total()), solver.axis().length_mm(),
                     static_cast<double>(steps_done_) / std::max(wall_s_, 1e-9), inertia_error_max_,
                     wall_s_ * static_cast<double>(until - solver.steps()) / static_cast<double>(steps_done_)});
    }
  } catch (const Error& error) {
    if (error.status() != ExitStatus::unphysical && error.status() != ExitStatus::soil_failed) throw;
    progress.end();
    measure_wall();
    write_summary(error.status() == ExitStatus::unphysical ? "unphysical" : "soil failed");
    log_.error("{}\n  kept: frames until {:.5g} h and the last good checkpoint of {:.5g} h in {}", error.what(),
               series_->frames().empty() ? 0.0 : series_->frames().back().time_h, checkpoint_h_, folder_.string());
    return error.status();
  }
  progress.end();
  measure_wall();
  if (solver.steps() < total) {
    write_checkpoint_file();
    write_summary(interruption.requested() ? "interrupted" : "paused");
    log_.info("{} at {:.4g} h; checkpoint written, --resume goes on", interruption.requested() ? "interrupted" : "paused",
              tissue.time_h);
    return interruption.requested() ? ExitStatus::interrupted : ExitStatus::done;
  }
  series_->finish();
  write_summary("done");
  log_.info("done: {} cells after {} divisions, root {:.4f} mm, {:.1f} s, {:.0f} MB", tissue.cells.total(), divisions(),
            solver.axis().length_mm(), wall_s_, peak_memory_mb());
  log_.info("this run: inertia error {:.2g} % of p at the end, at most {:.2g} %; discretisation error about {:.2g} % ({})",
            100.0 * inertia_error_, 100.0 * inertia_error_max_,
            100.0 * preset_record(scene_.numerics.accuracy).discretisation_error, scene_.numerics.accuracy);
  for (const auto& effect : model().effects) {
    if (const std::string remark = effect->closing_remark(); !remark.empty()) log_.info("{}", remark);
  }
  if (scene_.output.picture) log_.info("{}", draw_picture(folder_));
  return ExitStatus::done;
}

template <int Dim>
int run_in_folder(Scene scene, const RunOptions& options, const SoilMaker& make_soil) {
  refuse_unstable_law<Dim>(scene);  // before the folder is touched
  const RunFolder folder = claim_run_folder(options.out, options.resume);
  std::optional<Checkpoint> checkpoint;
  if (options.resume) {
    checkpoint = read_checkpoint(folder.path() / "checkpoint.h5");
    // a step that the program chose stays, even where a longer duration would suggest another
    if (!scene.numerics.step_h) {
      if (const auto was = earlier_scene(folder.path())) scene.numerics.step_h = was->numerics.step_h;
    }
  }
  scene.numerics.step_h = choose_step_h<Dim>(scene);
  if (checkpoint) refuse_foreign_checkpoint(scene, *checkpoint, folder.path());
  return static_cast<int>(Run<Dim>(scene, options, folder, checkpoint, make_soil).go());
}

}  // namespace

int run_scene(const Scene& scene, const RunOptions& options, const SoilMaker& make_soil) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  return scene.scene.dimension == 2 ? run_in_folder<2>(scene, options, make_soil)
                                    : run_in_folder<3>(scene, options, make_soil);
}

}  // namespace rootsoil
