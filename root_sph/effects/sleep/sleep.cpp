// SPDX-License-Identifier: MIT
#include "root_sph/effects/sleep/sleep.hpp"

#include <algorithm>
#include <cmath>

#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/neighbours/cell_grid.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

constexpr double worth_it = 0.05;  // of the cells: fewer stay awake until there are more
constexpr double margin_reaches =
    2.0;  // held cells next to moving ones need all their partners, as far as a kernel reaches

/// Grains push a root to and fro: there it rests only in the mean, and waking at every push would leave no rest.
void complete_sleep(Scene& scene) {
  if (!scene.root.is_clamped()) {
    scene.origins.fail("sleep", "a root with a free base has no part that must stay where it is", {}, {},
                       "take [sleep] out, or set root.base = \"clamped\"");
  }
  SleepSection& section = *scene.find<SleepSection>();
  const bool in_soil = scene.origins.has("soil");
  if (!section.strain_rate_per_h) section.strain_rate_per_h = in_soil ? 5e-3 : 1e-4;
  if (!section.mean_over_h && in_soil) section.mean_over_h = 0.1;
  if (!section.stress_change) section.stress_change = in_soil ? 0.3 : 0.05;
}

// clang-format off
SectionSpec sleep_section() {
  using namespace sections;
  using Sl = SleepSection;
  return section<Sl>("sleep", optional,
                     "Mature tissue that does not move is left out of the computation until something moves it.", {
    key(&Sl::strain_rate_per_h, "strain_rate_per_h", "1/h", above(0),
        "Tissue that strains no faster, from the base on, falls asleep.", "docs/decisions/0014")
        .defaults_to("1e-4; with [soil] 5e-3"),
    key(&Sl::mean_over_h, "mean_over_h", "h", above(0).up_to(1e4, seconds),
        "Time over which that is averaged: grains push to and fro.", "docs/decisions/0014")
        .defaults_to("two steps; with inertia ten windows, with [soil] 0.1"),
    key(&Sl::stress_change, "stress_change", "-", above(0),
        "Change of axial stress beside the sleeping tissue, or of the soil's force on a cell's face, that wakes it, over "
        "the pressure differential.", "docs/decisions/0014")
        .defaults_to("0.05; with [soil] 0.3"),
  }).completed_by(complete_sleep);
}
// clang-format on

/// Mean face of a cell, mm^(Dim-1).
template <int Dim>
double face(double volume) {
  return std::pow(volume, (Dim - 1.0) / Dim);
}

}  // namespace

template <int Dim>
SleepEffect<Dim>::SleepEffect(Solver<Dim>& solver, SleepParameters parameters, const EffectList<Dim>& effects)
    : solver_(solver),
      parameters_(parameters),
      effects_(effects),
      asleep_(solver.tissue().cells.template declare<std::int64_t>({"asleep", "1", "1 until the root wakes"},
                                                                   on_division::copy<Dim, std::int64_t>)),
      neighbours_at_rest_(solver.tissue().cells.template declare<std::int64_t>(
          {"neighbours_at_rest", "1", "neighbours when the cell went to rest"}, on_division::copy<Dim, std::int64_t>)),
      looked_at_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"looked_at", "mm", "place at the latest look for cells that do not move"},
          on_division::copy<Dim, Vec<Dim>>)),
      strain_(solver.tissue().cells.template declare<double>({"strain_since_look", "1", "along the root, since then"},
                                                             on_division::copy<Dim, double>)),
      stress_asleep_(solver.tissue().cells.template declare<double>(
          {"stress_asleep", "MPa", "axial stress when the cell fell asleep"}, on_division::copy<Dim, double>)) {
  solver.tissue().asleep = &asleep_;
  Hooks<Dim>& hooks = solver.hooks();
  // decided at a window's end, where the strains are; done at the next one's start, from state alone
  hooks.rest.emplace_back("sleep", [this](Tissue<Dim>& t) {
    if (wake_wanted_) wake(t);
    if (asleep_beyond_mm_ > 0.0) fall_asleep(t);
  });
  // whenever the axis has been anchored anew
  hooks.parameters.emplace_back("sleep", [this](Tissue<Dim>& t) { carry_resting(t); });
  hooks.pair_history.emplace_back("sleep", [this](Tissue<Dim>& t) { give_slips_back(t); });
  hooks.watch.emplace_back("sleep", [this](Tissue<Dim>& t) {
    carry_resting(t);
    watch(t);
    for (std::size_t i = 0; i < t.cells.size(); ++i) strain_[i] += t.axial_strain[i];
    if (!wake_wanted_ && windows_++ % parameters_.windows_between_looks == 0) look(t);
  });
}

template <int Dim>
void SleepEffect<Dim>::prepare() {
  for (const auto& effect : effects_) {
    const Field<Dim, Vec<Dim>>* force = effect->lasting_force();
    if (!force) continue;
    loads_.push_back({force, &solver_.tissue().cells.template declare<Vec<Dim>>(
                                 {force->info().name + " asleep", "N", force->info().meaning + " when it fell asleep"},
                                 on_division::halve<Dim, Vec<Dim>>)});
  }
}

/// The tip has moved away from the cells at rest by as much as the root has grown.
template <int Dim>
void SleepEffect<Dim>::carry_resting(Tissue<Dim>& tissue) {
  auto& cells = tissue.cells;
  const double grown = solver_.axis().length_mm() - length_mm_;
  length_mm_ = solver_.axis().length_mm();
  for (std::size_t i = cells.size(); i < cells.total(); ++i) cells.distance_to_tip[i] += grown;
}

template <int Dim>
bool SleepEffect<Dim>::moves(const Tissue<Dim>& tissue, std::size_t i) const {
  if (tissue.cells.clamped[i]) return false;
  const double strain = parameters_.strain_rate_per_h * (tissue.time_h - looked_h_);
  return std::abs(strain_[i]) > strain ||
         (tissue.cells.position[i] - looked_at_[i]).norm() > strain * solver_.axis().length_mm();
}

/// Where the part that does not move begins, and whether it is worth while.
template <int Dim>
void SleepEffect<Dim>::look(Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  std::vector<char> busy(cells.size(), windows_ == 1);  // the first look only takes note
  for (const auto& effect : effects_) effect->keep_awake(busy);
  double moving_mm = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (busy[i] || moves(tissue, i)) moving_mm = std::max(moving_mm, cells.distance_to_tip[i]);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    looked_at_[i] = cells.position[i];
    strain_[i] = 0.0;
  }
  looked_h_ = tissue.time_h;
  double reach_mm = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.distance_to_tip[i] < moving_mm) continue;
    reach_mm = std::max(reach_mm, reach<Dim>(solver_.metric(i)).maxCoeff());
  }
  const double asleep_beyond_mm = moving_mm + 0.5 * reach_mm;
  const double rest_beyond_mm = asleep_beyond_mm + margin_reaches * reach_mm;
  std::int64_t resting = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.distance_to_tip[i] <= rest_beyond_mm) continue;
    ++resting;
    neighbours_at_rest_[i] = tissue.pairs.neighbours[i];
  }
  for (const auto& load : loads_) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!asleep_[i]) (*load.asleep)[i] = (*load.now)[i];
    }
  }
  if (static_cast<double>(resting) < worth_it * static_cast<double>(cells.size())) return;
  asleep_beyond_mm_ = asleep_beyond_mm;
  rest_beyond_mm_ = rest_beyond_mm;
}

template <int Dim>
void SleepEffect<Dim>::fall_asleep(Tissue<Dim>& tissue) {
  auto& cells = tissue.cells;
  double awake_end_mm = 0.0;
  std::vector<char> goes_to_rest(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double s = cells.distance_to_tip[i];
    goes_to_rest[i] = s > rest_beyond_mm_;
    if (s > asleep_beyond_mm_ && !cells.clamped[i]) {
      cells.clamped[i] = asleep_[i] = 1;
      stress_asleep_[i] = cells.stress[i][0];
    }
    if (!cells.clamped[i]) {
      awake_end_mm = std::max(awake_end_mm, s + half_extent<Dim>(cells.shape[i], cells.frame[i].col(0)));
    } else {
      cells.velocity[i].setZero();
    }
  }
  asleep_beyond_mm_ = 0.0;
  keep_slips(tissue, goes_to_rest);
  std::vector<std::int64_t> order;
  for (const char late : {0, 1}) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (goes_to_rest[i] == late) order.push_back(static_cast<std::int64_t>(i));
    }
  }
  const auto resting = static_cast<std::size_t>(std::count(goes_to_rest.begin(), goes_to_rest.end(), 1));
  cells.permute(order);
  cells.rest(resting);
  for (std::size_t i = cells.size(); i < cells.size() + resting; ++i) {  // what outputs and energies read of them
    tissue.window_index[i] = -1;
    tissue.axial_strain[i] = 0.0;
    tissue.force[i].setZero();
    tissue.velocity_gradient[i].setZero();
    if (tissue.inertia) tissue.inertia->inverse[i].setZero();
  }
  solver_.axis().set_still_length(length_mm_ - awake_end_mm);
  pressure_MPa_ = tissue.pressure_MPa;
  perceived_MPa_ = tissue.perceived_MPa();
}

/// What pairs carry is kept while one of their cells rests. The tissue does not turn meanwhile.
template <int Dim>
void SleepEffect<Dim>::keep_slips(const Tissue<Dim>& tissue, const std::vector<char>& goes_to_rest) {
  const auto& control = solver_.pair_terms().non_affine;
  if (!control) return;
  std::vector<std::int64_t> cell_of(tissue.pairs.row.size(), -1);  // of the window before
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    if (tissue.window_index[i] >= 0)
      cell_of[static_cast<std::size_t>(tissue.window_index[i])] = static_cast<std::int64_t>(i);
  }
  for (std::size_t k = 0; k < tissue.pairs.pairs.size(); ++k) {
    const std::int64_t i = cell_of[static_cast<std::size_t>(tissue.pairs.pairs[k].i)],
                       j = cell_of[static_cast<std::size_t>(tissue.pairs.pairs[k].j)];
    if (i < 0 || j < 0 || !(goes_to_rest[static_cast<std::size_t>(i)] || goes_to_rest[static_cast<std::size_t>(j)]))
      continue;
    const std::int64_t a = tissue.cells.cell_id[static_cast<std::size_t>(i)],
                       b = tissue.cells.cell_id[static_cast<std::size_t>(j)];
    slips_.push_back(a < b ? RestingSlip{a, b, control->slip_mm[k]}
                           : RestingSlip{b, a, reversed<Dim>(control->slip_mm[k])});
  }
}

template <int Dim>
void SleepEffect<Dim>::give_slips_back(const Tissue<Dim>& tissue) {
  if (!slips_wanted_) return;
  slips_wanted_ = false;
  const auto before = [](const RestingSlip& x, const RestingSlip& y) {
    return std::pair(x.first_id, x.second_id) < std::pair(y.first_id, y.second_id);
  };
  std::sort(slips_.begin(), slips_.end(), before);
  auto& control = solver_.pair_terms().non_affine;
  for (std::size_t k = 0; control && k < tissue.pairs.pairs.size(); ++k) {
    const auto [i, j] = tissue.pairs.pairs[k];
    const std::int64_t a = tissue.cells.cell_id[static_cast<std::size_t>(i)],
                       b = tissue.cells.cell_id[static_cast<std::size_t>(j)];
    const auto found = std::lower_bound(slips_.begin(), slips_.end(),
                                        RestingSlip{std::min(a, b), std::max(a, b), PairSlip<Dim>::Zero()}, before);
    if (found == slips_.end() || found->first_id != std::min(a, b) || found->second_id != std::max(a, b)) continue;
    control->slip_mm[k] = a < b ? found->slip_mm : reversed<Dim>(found->slip_mm);
  }
  slips_.clear();
}

template <int Dim>
void SleepEffect<Dim>::wake(Tissue<Dim>& tissue) {
  auto& cells = tissue.cells;
  cells.wake();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (asleep_[i]) cells.clamped[i] = asleep_[i] = 0;
  }
  solver_.axis().set_still_length(0.0);
  wake_wanted_ = false;
  slips_wanted_ = true;
  windows_ = 0;  // the next look comes when the tissue has had time to move
  ++woken_;
}

template <int Dim>
void SleepEffect<Dim>::watch(const Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  if (cells.size() == cells.total()) return;
  const double scale = std::max(std::abs(tissue.pressure_MPa), std::abs(pressure_MPa_));
  const double most = parameters_.stress_change * scale;
  wake_wanted_ =
      std::max(std::abs(tissue.pressure_MPa - pressure_MPa_), std::abs(tissue.perceived_MPa() - perceived_MPa_)) > most;
  for (std::size_t i = 0; i < cells.size() && !wake_wanted_; ++i) {
    wake_wanted_ = asleep_[i] && std::abs(cells.stress[i][0] - stress_asleep_[i]) > most;
  }
  for (const auto& load : loads_) {
    for (std::size_t i = 0; i < cells.total() && !wake_wanted_; ++i) {
      wake_wanted_ = asleep_[i] && ((*load.now)[i] - (*load.asleep)[i]).norm() > most * face<Dim>(cells.volume[i]);
    }
  }
}

template <int Dim>
void SleepEffect<Dim>::add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const {
  columns.push_back({"asleep", "1", "1 where the cell is asleep", 1, asleep_.values()});
  auto& neighbours = std::get<std::vector<std::int64_t>>(find_column(columns, "neighbours")->values);
  for (std::size_t i = tissue.cells.size(); i < tissue.cells.total(); ++i) neighbours[i] = neighbours_at_rest_[i];
}

template <int Dim>
std::vector<std::pair<std::string, double>> SleepEffect<Dim>::history() const {
  const auto& cells = solver_.tissue().cells;
  return {{"cells_at_rest", static_cast<double>(cells.total() - cells.size())},
          {"times_woken", static_cast<double>(woken_)}};
}

namespace {

/// What is computed anew in every window stays, for cells at rest, as it was when they fell asleep: for outputs and
/// energies. Calls visit(key, numbers of the cells at rest) for every such column.
template <int Dim, class Visit>
void for_each_scratch(const ParticleStore<Dim>& cells, Visit&& visit) {
  for (const auto& field : cells.fields()) {
    if (field->info().storage != Storage::scratch) continue;
    const auto first = cells.size() * static_cast<std::size_t>(field->components());
    const std::string key = "sleep/scratch/" + field->info().name;
    field->is_integer() ? visit(key, field->integers().subspan(first)) : visit(key, field->reals().subspan(first));
  }
}

}  // namespace

template <int Dim>
void SleepEffect<Dim>::save(NamedReals& reals) const {
  for_each_scratch<Dim>(solver_.tissue().cells, [&](const std::string& key, auto numbers) {
    reals[key].assign(numbers.begin(), numbers.end());
  });
  reals["sleep/state"] = {static_cast<double>(windows_),
                          looked_h_,
                          asleep_beyond_mm_,
                          rest_beyond_mm_,
                          length_mm_,
                          pressure_MPa_,
                          wake_wanted_ ? 1.0 : 0.0,
                          static_cast<double>(woken_),
                          perceived_MPa_};
  std::vector<double>& slips = reals["sleep/slips"];
  for (const RestingSlip& s : slips_) {
    slips.push_back(static_cast<double>(s.first_id));
    slips.push_back(static_cast<double>(s.second_id));
    slips.insert(slips.end(), s.slip_mm.data(), s.slip_mm.data() + 2 * Dim);
  }
}

template <int Dim>
void SleepEffect<Dim>::restore(const NamedReals& reals) {
  for_each_scratch<Dim>(solver_.tissue().cells, [&](const std::string& key, auto numbers) {
    const std::vector<double>& saved = reals.at(key);
    ROOTSOIL_ASSERT(saved.size() == numbers.size());
    std::transform(saved.begin(), saved.end(), numbers.begin(),
                   [](double x) { return static_cast<typename decltype(numbers)::element_type>(x); });
  });
  const std::vector<double>& state = reals.at("sleep/state");
  windows_ = static_cast<std::int64_t>(state.at(0));
  looked_h_ = state.at(1);
  asleep_beyond_mm_ = state.at(2);
  rest_beyond_mm_ = state.at(3);
  length_mm_ = state.at(4);
  pressure_MPa_ = state.at(5);
  wake_wanted_ = state.at(6) != 0.0;
  woken_ = static_cast<std::int64_t>(state.at(7));
  perceived_MPa_ = state.at(8);
  const std::vector<double>& slips = reals.at("sleep/slips");
  slips_.clear();
  constexpr std::size_t length = 2 + 2 * Dim;
  for (std::size_t k = 0; k + length <= slips.size(); k += length) {
    slips_.push_back({static_cast<std::int64_t>(slips[k]), static_cast<std::int64_t>(slips[k + 1]),
                      Eigen::Map<const PairSlip<Dim>>(slips.data() + k + 2)});
  }
}

EffectSpec sleep_effect() {
  return {.name = "sleep",
          .called_by = "[sleep]",
          .what = "mature tissue that does not move is left out until something moves it",
          .exact = "the same root with and without",
          .sections = {sleep_section()},
          .called_for = [](const Scene& scene) { return scene.find<SleepSection>() != nullptr; },
          .build =
              [](auto assembly) {
                const Scene& scene = assembly.scene;
                const SleepSection& section = *scene.find<SleepSection>();
                SleepParameters parameters{.strain_rate_per_h = *section.strain_rate_per_h,
                                           .stress_change = *section.stress_change};
                // waves that inertia carries are averaged out
                if (!scene.numerics.has_inertia()) parameters.windows_between_looks = 2;
                if (section.mean_over_h) {
                  const double window_h = scene.numerics.steps_a_window() * assembly.solver.options().step_h;
                  parameters.windows_between_looks =
                      std::max<std::int64_t>(1, std::llround(*section.mean_over_h / window_h));
                }
                assembly.template add<SleepEffect<assembly.dimension>>(parameters, assembly.effects);
              }};
}

template class SleepEffect<2>;
template class SleepEffect<3>;

}  // namespace rootsoil
