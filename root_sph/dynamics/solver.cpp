// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/solver.hpp"

#include "root_sph/dynamics/motion.hpp"
#include "root_sph/kernels/wendland.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace rootsoil {

double step_time_h(std::int64_t steps, double step_h) {
  constexpr double digits = 1e12;
  return std::round(static_cast<double>(steps) * step_h * digits) / digits;
}

template <int Dim>
void Solver<Dim>::prepare() {
  update_material_ = choose_material_loop<Dim>(tissue_.material, MaterialStep::advance);
  predict_nominal_forces_ = choose_material_loop<Dim>(tissue_.material, MaterialStep::predict);
  add_forces_ = choose_force_loop<Dim>(terms_, tissue_.material.softening != nullptr);
  // no window before the first one
  for (std::int64_t& index : tissue_.window_index.values()) index = -1;
}

template <int Dim>
void Solver<Dim>::begin_window() {
  auto& cells = tissue_.cells;
  Hooks<Dim>::run(hooks_.window_start, clock_, tissue_);
  clock_.measure("root axis", [&] { axis_.anchor(tissue_); });

  std::vector<Mat<Dim>> metrics(cells.size());
  const auto fill_metrics = [&] {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      metrics[i] = options_.isotropic_h_mm ? isotropic_metric<Dim>(*options_.isotropic_h_mm)
                                           : cell_metric<Dim>(cells.shape[i], options_.eta);
    }
  };
  PairList old_pairs;
  clock_.measure("neighbours", [&] {
    fill_metrics();
    cells.permute(spatial_order<Dim>(cells.active(cells.position), metrics));
    fill_metrics();
    old_pairs = std::move(tissue_.pairs);
    tissue_.pairs = find_pairs<Dim>(cells.active(cells.position), metrics);
  });
  Hooks<Dim>::run(hooks_.parameters, clock_, tissue_);
  clock_.measure("gradient operators", [&] {
    gradient_report_ = build_gradients<Dim>(cells.active(cells.position), metrics, cells.active(cells.volume), tissue_.pairs,
                                            options_.gradient, tissue_.gradients, tissue_.kernel);
  });
  Hooks<Dim>::run(hooks_.operators, clock_, tissue_);
  clock_.measure("pair terms", [&] { rebuild_pair_terms<Dim>(tissue_, old_pairs, terms_); });
  std::vector<Vec<Dim>> stiffness;
  clock_.measure("stability bound", [&] { stiffness = bound_stiffness<Dim>(tissue_, terms_); });
  Hooks<Dim>::template run<std::vector<Vec<Dim>>&>(hooks_.stiffness, clock_, tissue_, stiffness);
  clock_.measure("stability bound", [&] {
    set_inertia<Dim>(tissue_, terms_, stiffness, options_.inertia);
    tissue_.mass_damping_per_h =
        options_.mass_damping_per_h ? *options_.mass_damping_per_h : critical_mass_damping<Dim>(tissue_);
  });

  for (std::size_t i = 0; i < cells.size(); ++i) {
    tissue_.deformation[i].setIdentity();
    tissue_.axial_strain[i] = 0.0;
    tissue_.start_velocity[i] = cells.velocity[i];
    tissue_.window_index[i] = static_cast<std::int64_t>(i);
    if (terms_.non_affine) {
      (*terms_.non_affine->start_position)[i] = cells.position[i];
      (*terms_.non_affine->start_frame)[i] = cells.frame[i];
    }
  }
}

template <int Dim>
void Solver<Dim>::evaluate_forces(SlipAdvance advance) {
  clock_.measure("forces", [&] { add_forces_(tissue_, terms_, advance); });
  Hooks<Dim>::run(hooks_.forces, clock_, tissue_, advance);
}

template <int Dim>
void Solver<Dim>::symplectic_step() {
  const double dt = tissue_.step_h;
  auto& cells = tissue_.cells;
  clock_.measure("velocity gradients", [&] { compute_velocity_gradients<Dim>(tissue_); });
  clock_.measure("material", [&] { update_material_(tissue_, dt); });
  evaluate_forces({dt, dt});
  clock_.measure("motion", [&] {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells.velocity[i] = advanced_velocity<Dim>(tissue_, i, cells.velocity[i], dt);
      cells.position[i] += dt * cells.velocity[i];
    }
  });
}

/// The paper's 4.4, with stress and density corrected by the mean velocity as positions are, (u^n + u^{n+1})/2, in
/// place of u^{n+1/2}: stable for w dt <= 2, where 4.4 to the letter is never (docs/decisions/0008).
template <int Dim>
void Solver<Dim>::predictor_corrector_step() {
  const double dt = tissue_.step_h, half = 0.5 * dt;
  auto& cells = tissue_.cells;
  std::vector<Vec<Dim>>& kept = step_velocity_;
  kept.resize(cells.size());
  const auto measure_gradients = [&] {
    clock_.measure("velocity gradients", [&] { compute_velocity_gradients<Dim>(tissue_); });
  };

  measure_gradients();
  clock_.measure("material", [&] { update_nominal_forces<Dim>(tissue_); });
  evaluate_forces({dt, dt});  // slips lie half a step ahead of the rest
  clock_.measure("motion", [&] {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < cells.size(); ++i) {
      kept[i] = cells.velocity[i];
      cells.position[i] += half * kept[i];
      cells.velocity[i] = advanced_velocity<Dim>(tissue_, i, kept[i], half);
    }
  });
  clock_.measure("material", [&] { predict_nominal_forces_(tissue_, half); });

  if (terms_.non_affine) measure_gradients();
  evaluate_forces({0.0, 0.0});
  clock_.measure("motion", [&] {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Vec<Dim> after = advanced_velocity<Dim>(tissue_, i, kept[i], dt);
      cells.position[i] += half * after;
      cells.velocity[i] = 0.5 * (kept[i] + after);
      kept[i] = after;
    }
  });
  measure_gradients();
  clock_.measure("material", [&] { update_material_(tissue_, dt); });
  std::swap_ranges(kept.begin(), kept.end(), cells.velocity.values().begin());
}

template <int Dim>
void Solver<Dim>::end_window() {
  auto& cells = tissue_.cells;
  check_physical();
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells.shape[i] = deformed_shape<Dim>(cells.shape[i], tissue_.deformation[i]);
  }
  Hooks<Dim>::run(hooks_.window_end, clock_, tissue_);
  clock_.measure("root axis", [&] { axis_.measure_flow(tissue_, window_h_); });
}

template <int Dim>
void Solver<Dim>::advance_window(int steps) {
  const bool predicting = options_.stepper == Stepper::predictor_corrector;
  window_h_ = steps * tissue_.step_h;
  begin_window();
  for (int k = 0; k < steps; ++k) {
    Hooks<Dim>::run(hooks_.step_start, clock_, tissue_);
    predicting ? predictor_corrector_step() : symplectic_step();
    ++steps_;
    tissue_.time_h = step_time_h(steps_, tissue_.step_h);
  }
  if (predicting) evaluate_forces({0.0, 0.0});  // contact forces and the momentum residual of the window's end
  end_window();
}

/// A cell that inverts, tears away or is no longer a number ends the run: nothing is deleted or repaired.
template <int Dim>
void Solver<Dim>::check_physical() const {
  const auto& cells = tissue_.cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double stretch = tissue_.deformation[i].determinant();
    const char* what = nullptr;
    if (!cells.position[i].allFinite() || !cells.velocity[i].allFinite() || !cells.stress[i].allFinite()) {
      what = "is no longer a number";
    } else if (!(stretch > 0.5 && stretch < 2.0) || !(cells.volume[i] > 0.0)) {
      what = "changed its volume by more than a factor of two within a window";
    }
    if (!what) continue;
    const auto& x = cells.position[i];
    throw UnphysicalError(fmt::format(
        "the tissue broke at t = {:.5g} h: cell {} {} (position {:.4g} mm, distance from the tip {:.4g} mm, "
        "{} neighbours). Usual causes: a step too large for the growth rate, a law that is not hyperbolic, a pressure "
        "step of the size of the modulus",
        tissue_.time_h, cells.cell_id[i], what, fmt::join(x.data(), x.data() + Dim, ", "), cells.distance_to_tip[i],
        tissue_.pairs.neighbours[i]));
  }
}

template <int Dim>
void Solver<Dim>::save(std::map<std::string, std::vector<double>>& reals,
                       std::map<std::string, std::vector<std::int64_t>>& integers) const {
  reals["solver/axis"] = axis_.save();
  integers["solver/counters"] = {steps_, tissue_.next_cell_id,
                                 static_cast<std::int64_t>(tissue_.cells.total() - tissue_.cells.size())};
  if (!terms_.non_affine) return;
  std::vector<std::int64_t>& index = integers["solver/slip_pairs"];
  std::vector<double>& slip = reals["solver/slip_mm"];
  for (std::size_t k = 0; k < tissue_.pairs.pairs.size(); ++k) {
    index.push_back(tissue_.pairs.pairs[k].i);
    index.push_back(tissue_.pairs.pairs[k].j);
    slip.insert(slip.end(), terms_.non_affine->slip_mm[k].data(), terms_.non_affine->slip_mm[k].data() + Dim);
  }
  std::vector<double>& frames = reals["solver/start_frames"];
  for (std::size_t i = 0; i < tissue_.cells.size(); ++i) {
    const Mat<Dim>& f = (*terms_.non_affine->start_frame)[i];
    frames.insert(frames.end(), f.data(), f.data() + Dim * Dim);
  }
}

template <int Dim>
void Solver<Dim>::restore(const std::map<std::string, std::vector<double>>& reals,
                          const std::map<std::string, std::vector<std::int64_t>>& integers) {
  axis_.restore(reals.at("solver/axis"));
  steps_ = integers.at("solver/counters").at(0);
  tissue_.next_cell_id = integers.at("solver/counters").at(1);
  tissue_.time_h = step_time_h(steps_, tissue_.step_h);
  tissue_.cells.rest(static_cast<std::size_t>(integers.at("solver/counters").at(2)));
  const std::size_t n = tissue_.cells.size();
  for (std::size_t i = 0; i < n; ++i) tissue_.window_index[i] = static_cast<std::int64_t>(i);
  if (!terms_.non_affine) return;

  const auto& index = integers.at("solver/slip_pairs");
  const auto& slip = reals.at("solver/slip_mm");
  const auto& frames = reals.at("solver/start_frames");
  const std::size_t count = index.size() / 2;
  ROOTSOIL_ASSERT(slip.size() == count * Dim && frames.size() == n * Dim * Dim);
  tissue_.pairs = PairList{};
  tissue_.pairs.row.assign(n + 1, 0);
  terms_.non_affine->slip_mm.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    tissue_.pairs.pairs.push_back({static_cast<std::int32_t>(index[2 * k]), static_cast<std::int32_t>(index[2 * k + 1])});
    ++tissue_.pairs.row[static_cast<std::size_t>(index[2 * k]) + 1];
    terms_.non_affine->slip_mm[k] = Eigen::Map<const Vec<Dim>>(slip.data() + k * Dim);
  }
  for (std::size_t i = 0; i < n; ++i) {
    tissue_.pairs.row[i + 1] += tissue_.pairs.row[i];
    (*terms_.non_affine->start_frame)[i] = Eigen::Map<const Mat<Dim>>(frames.data() + i * Dim * Dim);
  }
}

template class Solver<2>;
template class Solver<3>;

}  // namespace rootsoil
