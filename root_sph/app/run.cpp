// SPDX-License-Identifier: MIT
// The only run loop.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "root_sph/app/accuracy.hpp"
#include "root_sph/app/cell_file_json.hpp"
#include "root_sph/app/commands.hpp"
#include "root_sph/app/picture.hpp"
#include "root_sph/app/progress.hpp"
#include "root_sph/app/recorder.hpp"
#include "root_sph/app/resume.hpp"
#include "root_sph/app/run_log.hpp"
#include "root_sph/app/unbalanced.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/core/interruption.hpp"
#include "root_sph/core/version.hpp"
#include "root_sph/effects/growth/growth.hpp"
#include "root_sph/effects/soil_contact/soil_section.hpp"
#include "root_sph/io/checkpoint.hpp"
#include "root_sph/io/files.hpp"
#include "root_sph/io/history.hpp"
#include "root_sph/io/series.hpp"
#include "root_sph/model/model.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/scene/write_scene.hpp"

namespace rootsoil {
namespace {

/// Of this program. What getrusage says is at least what whoever started it had: Linux keeps that over exec.
double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Of this process and its children that have ended.
double processor_time_s() {
  const auto seconds = [](int who) {
    rusage usage{};
    getrusage(who, &usage);
    const auto of = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return of(usage.ru_utime) + of(usage.ru_stime);
  };
  return seconds(RUSAGE_SELF) + seconds(RUSAGE_CHILDREN);
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
  std::vector<AccuracyMeasure> accuracy_measures() const;
  std::string judge_accuracy();
  void record_where_it_stops();
  double kept_until_h() const;
  void miss(const std::string& file, const char* holds, std::optional<double> continue_h);
  void draw();
  void write_checkpoint_file();
  void resume_from(const Checkpoint& checkpoint);
  std::filesystem::path state_file(const Effect<Dim>& effect, std::int64_t step) const;
  void write_state_files();
  void remove_old_state_files() const;
  void write_summary(const std::string& status) const;
  std::int64_t steps_per(double interval_h) const {
    return std::max<std::int64_t>(1, std::llround(interval_h / model().solver.tissue().step_h));
  }
  std::int64_t steps_at_the_end() const { return steps_per(scene_.scene.duration_h); }
  /// Of this session.
  std::int64_t last_step() const {
    const std::int64_t total = steps_at_the_end();
    const bool pauses = options_.until_h && *options_.until_h < scene_.scene.duration_h;
    return pauses ? std::min(total, steps_per(*options_.until_h)) : total;
  }
  Model<Dim>& model() { return *model_; }
  const Model<Dim>& model() const { return *model_; }
  std::int64_t divisions() const {
    return static_cast<std::int64_t>(model().solver.tissue().cells.total()) - cells_start_;
  }

  Scene scene_;
  std::string digest_;  ///< at the start: a file that the scene names may change or go while the run lasts
  const RunOptions& options_;
  std::filesystem::path folder_;
  RunLog log_;
  std::unique_ptr<Model<Dim>> model_;
  std::unique_ptr<SeriesWriter> series_;
  std::unique_ptr<HistoryWriter> history_;
  struct OwnTable {
    const Effect<Dim>* effect;
    std::unique_ptr<HistoryWriter> file;
  };
  std::vector<OwnTable> own_tables_;

  std::int64_t cells_start_ = 0;
  LengthMark last_row_;
  Unbalanced<Dim> unbalanced_;
  double unbalanced_error_ = 0.0;  ///< of the latest row
  AccuracyWatch accuracy_;
  double unbalanced_max_ = 0.0, momentum_residual_max_ = 0.0;
  std::int64_t degenerate_max_ = 0;
  double pair_steps_ = 0.0;
  std::int64_t steps_done_ = 0;  ///< in this session
  double wall_s_ = 0.0;
  double cpu_start_s_ = 0.0;  ///< before the first step
  double checkpoint_h_ = 0.0;
  std::int64_t checkpoint_step_ = -1;
};

template <int Dim>
Run<Dim>::Run(const Scene& scene, const RunOptions& options, const RunFolder& folder,
              const std::optional<Checkpoint>& checkpoint, const SoilMaker& make_soil)
    : scene_(scene),
      digest_(scene_digest(scene)),
      options_(options),
      folder_(folder.path()),
      log_(folder.path() / "run.log", options.quiet),
      model_(build_model<Dim>(scene, {.make_soil = make_soil,
                                      .soil_log = (folder_ / "soil.log").string(),
                                      .say = [this](const std::string& text) { log_.info("{}", text); }})),
      unbalanced_(model_->solver) {
  const Tissue<Dim>& tissue = model().solver.tissue();
  cells_start_ = static_cast<std::int64_t>(tissue.cells.total());
  last_row_ = {0.0, model().solver.axis().length_mm()};
  refuse_unknown_fields<Dim>(model(), scene_);  // before anything is written

  std::optional<double> continue_h;
  if (checkpoint) {
    resume_from(*checkpoint);
    // at 0 everything is written once more
    if (model().solver.steps() > 0) continue_h = kept_until_h();
  } else {
    write_checkpoint_file();  // first of all: killed at any later instant, --resume goes on
  }
  write_text_atomically(folder_ / "scene.toml", resolved_toml(language(), scene_));
  miss("run.h5", "frames", continue_h);
  miss("history.csv", "rows", continue_h);
  series_ = std::make_unique<SeriesWriter>(folder_,
                                           SeriesMetadata{{"program", "rootsoil"},
                                                          {"version", program_version},
                                                          {"scene", scene_.scene.name},
                                                          {"dimension", std::to_string(Dim)}},
                                           continue_h);
  history_ = std::make_unique<HistoryWriter>(folder_ / "history.csv", history_columns<Dim>(model(), unbalanced_.name()),
                                             continue_h);
  for (const auto& effect : model().effects) {
    std::optional<SideTable> table = effect->side_table();
    if (!table) continue;
    table->columns.insert(table->columns.begin(), "time_h");
    miss(table->file_name, "rows", continue_h);
    own_tables_.push_back(
        {effect.get(), std::make_unique<HistoryWriter>(folder_ / table->file_name, table->columns, continue_h)});
  }
}

template <int Dim>
void Run<Dim>::record() {
  const Tissue<Dim>& tissue = model().solver.tissue();
  series_->write(make_frame<Dim>(model(), scene_));
  unbalanced_error_ = unbalanced_.error();
  unbalanced_.begin();
  const HistoryRow row = make_history_row<Dim>(model(), last_row_, divisions(), unbalanced_error_);
  history_->append(row.values);
  last_row_ = {tissue.time_h, row.length_mm};
  unbalanced_max_ = std::max(unbalanced_max_, unbalanced_error_);
  momentum_residual_max_ = std::max(momentum_residual_max_, row.momentum_residual);
  for (const OwnTable& table : own_tables_) {
    std::vector<double> values = table.effect->side_row();
    values.insert(values.begin(), tissue.time_h);
    table.file->append(values);
  }
}

template <int Dim>
std::vector<AccuracyMeasure> Run<Dim>::accuracy_measures() const {
  // a root without growth moves while it settles, and is judged by where it comes to rest
  const bool counts = scene_.find<GrowthSection>() || model().solver.steps() == steps_at_the_end();
  std::vector<AccuracyMeasure> measures;
  if (unbalanced_.has_inertia()) {
    measures.push_back({unbalanced_.name(), counts ? unbalanced_error_ : std::nan(""),
                        scene_.numerics.inertia_error_max,
                        "take a smaller numerics.step_h, or numerics.stepper = \"quasi_static\""});
  }
  for (const auto& effect : model().effects) {
    for (AccuracyMeasure& measure : effect->accuracy()) measures.push_back(std::move(measure));
  }
  return measures;
}

/// What to say where the row is the first outside the stated accuracy; otherwise empty. UnphysicalError where the scene
/// wants the run to stop then.
template <int Dim>
std::string Run<Dim>::judge_accuracy() {
  const bool was_outside = accuracy_.is_outside();
  accuracy_.judge(model().solver.tissue().time_h, accuracy_measures());
  if (was_outside || !accuracy_.is_outside()) return {};
  std::string complaint = fmt::format("outside the stated accuracy: {}", fmt::join(accuracy_.complaints(), "; "));
  if (scene_.numerics.beyond_accuracy == Beyond::stop) throw UnphysicalError("the run is " + complaint);
  return complaint;
}

/// A last frame where a run pauses, for whoever looks at it. It is written after the checkpoint, whose state has not
/// seen it, and goes when the run goes on: a resumed run has the frames of one that never paused.
template <int Dim>
void Run<Dim>::record_where_it_stops() {
  const bool has_one = !series_->frames().empty() && series_->frames().back().step == model().solver.steps();
  // a session without a window of its own has only the state, not what a frame says of the latest window
  if (steps_done_ > 0 && !has_one) record();
}

/// Until when frames and rows of the checkpoint's run stay: to the checkpoint, or where the run goes on from there, to
/// the last output time before it.
template <int Dim>
double Run<Dim>::kept_until_h() const {
  const Tissue<Dim>& tissue = model().solver.tissue();
  const std::int64_t done = model().solver.steps(), per_frame = steps_per(scene_.output.every_h);
  return done < last_step() ? step_time_h(done / per_frame * per_frame, tissue.step_h) : tissue.time_h;
}

/// State of another process that belongs to the checkpoint of a step. The checkpoint names it by its step.
template <int Dim>
std::filesystem::path Run<Dim>::state_file(const Effect<Dim>& effect, std::int64_t step) const {
  return folder_ / fmt::format("{}_step_{:09}.state", effect.state_file_name(), step);
}

/// A new file under a new name: the old checkpoint keeps its own until the new checkpoint is complete.
template <int Dim>
void Run<Dim>::write_state_files() {
  for (const auto& effect : model().effects) {
    if (effect->state_file_name().empty()) continue;
    const std::filesystem::path path = state_file(*effect, model().solver.steps());
    effect->save_state_file(start_temporary(path, ""));
    commit_temporary(path);
  }
}

template <int Dim>
void Run<Dim>::remove_old_state_files() const {
  std::error_code trouble;  // what stays behind does no harm
  for (const auto& effect : model().effects) {
    if (effect->state_file_name().empty()) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, trouble)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(effect->state_file_name() + "_step_") &&
          entry.path() != state_file(*effect, checkpoint_step_)) {
        std::filesystem::remove(entry.path(), trouble);
      }
    }
  }
}

template <int Dim>
void Run<Dim>::draw() {
  if (!scene_.output.picture) return;
  const Picture picture = draw_picture(folder_, options_.quiet);
  picture.drawn ? log_.info("{}", picture.what_happened) : log_.warning("{}", picture.what_happened);
}

/// What a run that goes on finds no longer in its folder, and so lacks at its end.
template <int Dim>
void Run<Dim>::miss(const std::string& file, const char* holds, std::optional<double> continue_h) {
  if (!continue_h || std::filesystem::exists(folder_ / file)) return;
  log_.warning("{} is gone from {}: its {} until {:.4g} h will be missing", file, folder_.string(), holds, *continue_h);
}

template <int Dim>
void Run<Dim>::write_checkpoint_file() {
  const Tissue<Dim>& tissue = model().solver.tissue();
  if (checkpoint_step_ == model().solver.steps()) return;  // it is there, and its own file must not be touched
  write_state_files();
  Checkpoint checkpoint;
  checkpoint.time_h = tissue.time_h;
  checkpoint.step = model().solver.steps();
  checkpoint.scene_digest = digest_;
  checkpoint.program_version = program_version;
  checkpoint.dimension = Dim;
  store_cells<Dim>(tissue.cells, checkpoint);
  model().solver.save(checkpoint.reals, checkpoint.integers);
  for (const auto& effect : model().effects) effect->save(checkpoint.reals);
  checkpoint.integers["run/cells_start"] = {cells_start_};
  checkpoint.reals["run/last_row"] = {last_row_.time_h, last_row_.length_mm};
  checkpoint.reals["run/worst"] = {unbalanced_max_, momentum_residual_max_, unbalanced_error_};
  checkpoint.reals["run/unbalanced"] = unbalanced_.save();
  checkpoint.reals["run/accuracy"] = accuracy_.save();
  write_checkpoint(folder_ / "checkpoint.h5", std::move(checkpoint));
  checkpoint_h_ = tissue.time_h;
  checkpoint_step_ = model().solver.steps();
  remove_old_state_files();
}

template <int Dim>
void Run<Dim>::resume_from(const Checkpoint& checkpoint) {
  restore_cells<Dim>(checkpoint, model().solver.tissue().cells);
  model().solver.restore(checkpoint.reals, checkpoint.integers);
  for (const auto& effect : model().effects) {
    effect->restore(checkpoint.reals);
    if (!effect->state_file_name().empty()) effect->restore_state_file(state_file(*effect, checkpoint.step));
  }
  cells_start_ = checkpoint.integers.at("run/cells_start").at(0);
  last_row_ = {checkpoint.reals.at("run/last_row").at(0), checkpoint.reals.at("run/last_row").at(1)};
  unbalanced_max_ = checkpoint.reals.at("run/worst").at(0);
  momentum_residual_max_ = checkpoint.reals.at("run/worst").at(1);
  unbalanced_error_ = checkpoint.reals.at("run/worst").at(2);
  unbalanced_.restore(checkpoint.reals.at("run/unbalanced"));
  accuracy_.restore(checkpoint.reals.at("run/accuracy"), accuracy_measures());
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
  nlohmann::ordered_json lattice;
  if (const auto& fit = model().initial.lattice) {
    lattice = lattice_numbers(*fit, scene_.root, model().initial.volume, Dim);
  }
  nlohmann::ordered_json summary{
      {"program", "rootsoil"},
      {"version", program_version},
      {"scene", scene_.scene.name},
      {"status", status},
      {"time_h", tissue.time_h},
      {"stepper", name_of(scene_.numerics.stepper)},
      {"steps", solver.steps()},
      {"balance_iterations", solver.effort().balance_iterations},
      {"force_evaluations", solver.effort().force_evaluations},
      {"unstable_steps", solver.effort().unstable_steps},
      {"cells_start", cells_start_},
      {"cells_end", tissue.cells.total()},
      {"divisions", divisions()},
      {"tip_mm", tip},
      {"length_mm", solver.axis().length_mm()},
      {"wall_s", wall_s_},
      {"cpu_s", processor_time_s()},
      {"cpu_start_s", cpu_start_s_},
      {"wall_s_by_effect", solver.clock().seconds()},
      {"pairs", tissue.pairs.pairs.size()},
      {"pairs_per_s", wall_s_ > 0.0 ? pair_steps_ / wall_s_ : 0.0},
      {"peak_memory_mb", peak_memory_mb()},
      {"threads", omp_get_max_threads()},
      {"dt_h", {{"min", solver.shortest_step_h()}, {"mean", tissue.step_h}, {"max", tissue.step_h}}},
      {"accuracy", name_of(scene_.numerics.accuracy)},
      {unbalanced_.name(), unbalanced_error_},
      {unbalanced_.name() + "_max", unbalanced_max_},
      {"discretisation_error", discretisation_error(scene_.numerics, model().initial.across)},
      {"cells_across", model().initial.across},
      {"stated_accuracy", accuracy_.summary()},
      {"momentum_residual", momentum_residual_max_},
      {"degenerate_cells_max", degenerate_max_},
      {"cell_file_volume_scale", model().initial.volume_scale},
      {"cell_file", model().initial.measured ? measured_numbers(*model().initial.measured) : nlohmann::ordered_json()},
      {"lattice", lattice},
      {"active_effects", active_effects(scene_)},
      {"fields", fields}};
  if (unbalanced_.has_inertia()) {
    const PresetRecord record = preset_record(scene_.numerics.accuracy);
    summary["preset_inertia_error"] = record.inertia_error;
    summary["preset_ms_per_cell_hour"] = record.ms_per_cell_hour;
  }
  write_text_atomically(folder_ / "summary.json", summary.dump(2) + "\n");
}

template <int Dim>
ExitStatus Run<Dim>::go() {
  Solver<Dim>& solver = model().solver;
  const Tissue<Dim>& tissue = solver.tissue();
  const std::int64_t total = steps_at_the_end(), until = last_step();
  const std::int64_t per_frame = steps_per(scene_.output.every_h);
  const std::int64_t per_checkpoint = steps_per(*scene_.output.checkpoint_every_h);
  const ClosedFormFlow theory = closed_form_flow<Dim>(scene_, solver.axis().length_mm(), Pressures(tissue));
  log_.info("{}: {} cells, {:.4g} h in {} steps of {:.4g} h, {} threads", scene_.scene.name, tissue.cells.total(),
            scene_.scene.duration_h, total, tissue.step_h, omp_get_max_threads());
  if (theory.tip_speed_mm_h > 0.0) {
    log_.info("closed form: tip speed {:.4f} mm/h, peak strain rate {:.3f} /h", theory.tip_speed_mm_h,
              theory.peak_rate_per_h);
  }
  if (const auto& measured = model().initial.measured) {
    for (const std::string& line : describe(*measured)) log_.info("cell file: {}", line);
  }
  if (const auto& fit = model().initial.lattice;
      fit && differs_from_asked(*fit, scene_.root, model().initial.volume, Dim)) {
    log_.info("lattice: {}", describe_lattice(*fit, scene_.root, model().initial.volume, Dim));
  }
  if (options_.resume) log_.info("resumed at {:.4g} h", tissue.time_h);

  const Interruption interruption;
  Progress progress(options_.quiet, scene_.scene.duration_h);
  cpu_start_s_ = processor_time_s();
  const auto start = std::chrono::steady_clock::now();
  const auto measure_wall = [&] {
    wall_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  try {
    if (solver.steps() == 0) {
      solver.look();
      record();
    }
    while (solver.steps() < until && !interruption.requested()) {
      const std::int64_t done = solver.steps();
      // windows end at output times, so that where they lie does not depend on where a run was interrupted
      const std::int64_t next_mark = std::min(total, (done / per_frame + 1) * per_frame);
      const int steps = static_cast<int>(std::min<std::int64_t>(scene_.numerics.steps_a_window(), next_mark - done));
      solver.advance_window(steps);
      unbalanced_.add_window();
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
      if (frame_due) {
        record();
        if (const std::string complaint = judge_accuracy(); !complaint.empty()) {
          progress.end();
          log_.warning("{}", complaint);
        }
      }
      // at the first window that ends on or after the time that is due
      if (solver.steps() / per_checkpoint > done / per_checkpoint || solver.steps() == total) write_checkpoint_file();
      progress.show({tissue.time_h, static_cast<std::int64_t>(tissue.cells.total()), solver.axis().length_mm(),
                     static_cast<double>(steps_done_) / std::max(wall_s_, 1e-9), unbalanced_.what(), unbalanced_max_,
                     wall_s_ * static_cast<double>(until - solver.steps()) / static_cast<double>(steps_done_)});
    }
  } catch (const Error& error) {
    if (error.status() != ExitStatus::unphysical && error.status() != ExitStatus::soil_failed) throw;
    progress.end();
    measure_wall();
    const bool inaccurate = scene_.numerics.beyond_accuracy == Beyond::stop && accuracy_.is_outside();
    write_summary(error.status() == ExitStatus::soil_failed ? "soil failed"
                  : inaccurate                              ? "stopped, outside its stated accuracy"
                                                            : "unphysical");
    log_.error("{}\n  kept: frames until {:.5g} h and the last good checkpoint of {:.5g} h in {}", error.what(),
               series_->frames().empty() ? 0.0 : series_->frames().back().time_h, checkpoint_h_, folder_.string());
    return error.status();
  }
  progress.end();
  measure_wall();
  if (solver.steps() < total) {
    const bool interrupted = interruption.requested();
    write_checkpoint_file();
    record_where_it_stops();
    write_summary(interrupted ? "interrupted" : "paused");
    log_.info("{} at {:.4g} h; checkpoint written, --resume goes on", interrupted ? "interrupted" : "paused",
              tissue.time_h);
    if (interrupted) return ExitStatus::interrupted;  // whoever stops a run does not wait for a picture
    draw();
    return ExitStatus::done;
  }
  series_->finish();
  const std::string status = accuracy_.is_outside() ? "done, outside its stated accuracy" : "done";
  write_summary(status);
  log_.info("{}: {} cells after {} divisions, root {:.4f} mm, {:.1f} s, {:.0f} MB", status, tissue.cells.total(),
            divisions(), solver.axis().length_mm(), wall_s_, peak_memory_mb());
  log_.info(
      "this run: {} {:.2g} % of p at the end, at most {:.2g} %; discretisation error about {:.2g} % ({}, "
      "{:.3g} cells across)",
      unbalanced_.what(), 100.0 * unbalanced_error_, 100.0 * unbalanced_max_,
      100.0 * discretisation_error(scene_.numerics, model().initial.across), name_of(scene_.numerics.accuracy),
      model().initial.across);
  if (is_coarser_than_measured(model().initial.across)) log_.warning("{}", coarser_than_measured);
  if (const std::int64_t unstable = solver.effort().unstable_steps; unstable > 0) {
    log_.warning(
        "{} steps ended in a balance that a small push would end, and none was found beside it: the root may have "
        "buckled there (numerics.step_h: shorter steps)",
        unstable);
  }
  for (const std::string& complaint : accuracy_.complaints()) log_.warning("{}", complaint);
  for (const auto& effect : model().effects) {
    if (const std::string remark = effect->closing_remark(); !remark.empty()) log_.info("{}", remark);
  }
  draw();
  return ExitStatus::done;
}

template <int Dim>
int run_in_folder(Scene scene, const RunOptions& options, const SoilMaker& make_soil) {
  refuse_unstable_law<Dim>(scene);  // before the folder is touched
  if (scene.find<SoilContactSection>() && !make_soil) {
    scene.origins.fail("soil", "this program has no engine that moves soil", {}, {}, "take [soil] out");
  }
  if (!options.resume) {
    refuse_unfit_cells<Dim>(scene);
    static_cast<void>(choose_step_h<Dim>(scene));  // refuses one that can't be counted
  }
  const RunFolder folder = claim_run_folder(options.out, options.resume);
  std::optional<Checkpoint> checkpoint;
  if (options.resume) {
    checkpoint = read_checkpoint(folder.path() / "checkpoint.h5");
    // a step that the program chose stays, even where a longer duration would suggest another
    if (!scene.numerics.step_h) scene.numerics.step_h = earlier_step_h(folder.path());
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
