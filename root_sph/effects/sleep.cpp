// SPDX-License-Identifier: MIT
#include "root_sph/effects/sleep.hpp"

#include "root_sph/kernels/wendland.hpp"
#include "root_sph/neighbours/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace rootsoil {
namespace {

constexpr double worth_it = 0.05;  // of the cells: fewer stay awake until there are more
constexpr double margin_reaches = 2.0;  // held cells next to moving ones need all their partners, as far as a kernel reaches

/// Mean face of a cell, mm^(Dim-1).
template <int Dim>
double face(double volume) {
  return std::pow(volume, (Dim - 1.0) / Dim);
}

}  // namespace

template <int Dim>
SleepEffect<Dim>::SleepEffect(Solver<Dim>& solver, SleepParameters parameters)
    : solver_(solver),
      parameters_(parameters),
      looked_at_(solver.tissue().cells.template declare<Vec<Dim>>({"looked_at", "mm", "place at the latest look for cells that do not move"},
                                                                  on_division::copy<Dim, Vec<Dim>>)),
      strain_(solver.tissue().cells.template declare<double>({"strain_since_look", "1", "along the root, since then"},
                                                             on_division::copy<Dim, double>)),
      stress_asleep_(solver.tissue().cells.template declare<double>(
          {"stress_asleep", "MPa", "axial stress when the cell fell asleep"}, on_division::copy<Dim, double>)) {
  solver.tissue().neighbours_at_rest = &solver.tissue().cells.template declare<std::int64_t>(
      {"neighbours_at_rest", "1", "neighbours when the cell went to rest"}, on_division::copy<Dim, std::int64_t>);
  Hooks<Dim>& hooks = solver.hooks();
  // decided at a window's end, where the strains are; done at the next one's start, from state alone
  hooks.window_start.emplace_back("sleep", [this](Tissue<Dim>& t) {
    if (wake_wanted_) wake(t);
    if (asleep_beyond_mm_ > 0.0) fall_asleep(t);
  });
  hooks.parameters.emplace_back("sleep", [this](Tissue<Dim>& t) {
    const double grown = solver_.axis().length_mm() - length_mm_;
    length_mm_ = solver_.axis().length_mm();
    for (std::size_t i = t.cells.size(); i < t.cells.total(); ++i) t.cells.distance_to_tip[i] += grown;
  });
  hooks.stiffness.emplace_back("sleep", [this](Tissue<Dim>& t, std::vector<Vec<Dim>>&) { give_slips_back(t); });
  hooks.window_end.emplace_back("sleep", [this](Tissue<Dim>& t) {
    watch(t);
    for (std::size_t i = 0; i < t.cells.size(); ++i) strain_[i] += t.axial_strain[i];
    if (!wake_wanted_ && windows_++ % parameters_.windows_between_looks == 0) look(t);
  });
}

template <int Dim>
bool SleepEffect<Dim>::moves(const Tissue<Dim>& tissue, std::size_t i) const {
  if (tissue.cells.clamped[i] != hold::none) return false;
  const double strain = parameters_.strain_rate_per_h * (tissue.time_h - looked_h_);
  return std::abs(strain_[i]) > strain ||
         (tissue.cells.position[i] - looked_at_[i]).norm() > strain * solver_.axis().length_mm();
}

/// Where the part that does not move begins, and whether it is worth while.
template <int Dim>
void SleepEffect<Dim>::look(Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  const auto& options = solver_.options();
  std::vector<char> busy(cells.size(), windows_ == 1);  // the first look only takes note
  for (const auto& [name, mark] : solver_.hooks().busy) mark(tissue, busy);
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
    reach_mm = std::max(reach_mm, reach<Dim>(options.isotropic_h_mm ? isotropic_metric<Dim>(*options.isotropic_h_mm)
                                                                    : cell_metric<Dim>(cells.shape[i], options.eta))
                                      .maxCoeff());
  }
  const double asleep_beyond_mm = moving_mm + 0.5 * reach_mm;
  const double rest_beyond_mm = asleep_beyond_mm + margin_reaches * reach_mm;
  std::int64_t resting = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.distance_to_tip[i] <= rest_beyond_mm) continue;
    ++resting;
    (*tissue.neighbours_at_rest)[i] = tissue.pairs.neighbours[i];
  }
  for (const auto& load : solver_.hooks().loads) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells.clamped[i] != hold::asleep) (*load.asleep)[i] = (*load.now)[i];
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
    if (s > asleep_beyond_mm_ && cells.clamped[i] == hold::none) {
      cells.clamped[i] = hold::asleep;
      stress_asleep_[i] = cells.stress[i][0];
    }
    if (cells.clamped[i] == hold::none) {
      const Vec<Dim> axis = cells.frame[i].col(0);
      awake_end_mm = std::max(awake_end_mm, s + std::sqrt(axis.dot(cells.shape[i].inverse() * axis)));
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
    tissue.inverse_inertia[i].setZero();
  }
  length_mm_ = solver_.axis().length_mm();
  solver_.axis().set_resting_length(length_mm_ - awake_end_mm);
  pressure_MPa_ = tissue.pressure_MPa;
}

/// What pairs carry is kept while one of their cells rests. The tissue does not turn meanwhile.
template <int Dim>
void SleepEffect<Dim>::keep_slips(const Tissue<Dim>& tissue, const std::vector<char>& goes_to_rest) {
  const auto& control = solver_.pair_terms().non_affine;
  if (!control) return;
  std::vector<std::int64_t> cell_of(tissue.pairs.row.size(), -1);  // of the window before
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    if (tissue.window_index[i] >= 0) cell_of[static_cast<std::size_t>(tissue.window_index[i])] = static_cast<std::int64_t>(i);
  }
  for (std::size_t k = 0; k < tissue.pairs.pairs.size(); ++k) {
    const std::int64_t i = cell_of[static_cast<std::size_t>(tissue.pairs.pairs[k].i)],
                       j = cell_of[static_cast<std::size_t>(tissue.pairs.pairs[k].j)];
    if (i < 0 || j < 0 || !(goes_to_rest[static_cast<std::size_t>(i)] || goes_to_rest[static_cast<std::size_t>(j)])) continue;
    const std::int64_t a = tissue.cells.cell_id[static_cast<std::size_t>(i)],
                       b = tissue.cells.cell_id[static_cast<std::size_t>(j)];
    slips_.push_back(a < b ? RestingSlip{a, b, control->slip_mm[k]} : RestingSlip{b, a, -control->slip_mm[k]});
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
                                        RestingSlip{std::min(a, b), std::max(a, b), Vec<Dim>::Zero()}, before);
    if (found == slips_.end() || found->first_id != std::min(a, b) || found->second_id != std::max(a, b)) continue;
    control->slip_mm[k] = a < b ? found->slip_mm : Vec<Dim>(-found->slip_mm);
  }
  slips_.clear();
}

template <int Dim>
void SleepEffect<Dim>::wake(Tissue<Dim>& tissue) {
  auto& cells = tissue.cells;
  cells.wake();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i] == hold::asleep) cells.clamped[i] = hold::none;
  }
  solver_.axis().set_resting_length(0.0);
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
  wake_wanted_ = std::abs(tissue.pressure_MPa - pressure_MPa_) > most;
  for (std::size_t i = 0; i < cells.size() && !wake_wanted_; ++i) {
    wake_wanted_ = cells.clamped[i] == hold::asleep &&
                   std::abs(cells.stress[i][0] - stress_asleep_[i]) > most;
  }
  for (const auto& load : solver_.hooks().loads) {
    for (std::size_t i = 0; i < cells.total() && !wake_wanted_; ++i) {
      wake_wanted_ = cells.clamped[i] == hold::asleep &&
                     ((*load.now)[i] - (*load.asleep)[i]).norm() > most * face<Dim>(cells.volume[i]);
    }
  }
}

template <int Dim>
std::vector<std::pair<std::string, double>> SleepEffect<Dim>::history() const {
  const auto& cells = solver_.tissue().cells;
  return {{"cells_at_rest", static_cast<double>(cells.total() - cells.size())}, {"times_woken", static_cast<double>(woken_)}};
}

namespace {

/// What is computed anew in every window stays, for cells at rest, as it was when they fell asleep: for outputs and energies.
/// Calls visit(key, numbers of the cells at rest) for every such column.
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
  reals["sleep/state"] = {static_cast<double>(windows_), looked_h_, asleep_beyond_mm_, rest_beyond_mm_, length_mm_, pressure_MPa_,
                          wake_wanted_ ? 1.0 : 0.0,      static_cast<double>(woken_)};
  std::vector<double>& slips = reals["sleep/slips"];
  for (const RestingSlip& s : slips_) {
    slips.push_back(static_cast<double>(s.first_id));
    slips.push_back(static_cast<double>(s.second_id));
    slips.insert(slips.end(), s.slip_mm.data(), s.slip_mm.data() + Dim);
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
  const std::vector<double>& slips = reals.at("sleep/slips");
  slips_.clear();
  for (std::size_t k = 0; k + Dim + 2 <= slips.size(); k += Dim + 2) {
    slips_.push_back({static_cast<std::int64_t>(slips[k]), static_cast<std::int64_t>(slips[k + 1]),
                      Eigen::Map<const Vec<Dim>>(slips.data() + k + 2)});
  }
}

template class SleepEffect<2>;
template class SleepEffect<3>;

}  // namespace rootsoil
