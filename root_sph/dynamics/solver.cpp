// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/solver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "root_sph/dynamics/motion.hpp"
#include "root_sph/dynamics/stability.hpp"
#include "root_sph/kernels/wendland.hpp"

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
Field<Dim, Vec<Dim>>& Solver<Dim>::need_body_acceleration() {
  if (!tissue_.body_acceleration) {
    tissue_.body_acceleration = &tissue_.cells.template declare<Vec<Dim>>(
        {"body_acceleration", "mm/h^2", "acceleration that is prescribed", Storage::scratch},
        on_division::recomputed<Dim, Vec<Dim>>);
  }
  return *tissue_.body_acceleration;
}

template <int Dim>
Mat<Dim> Solver<Dim>::metric(std::size_t cell) const {
  return options_.isotropic_h_mm ? isotropic_metric<Dim>(*options_.isotropic_h_mm)
                                 : cell_metric<Dim>(tissue_.cells.shape[cell], options_.eta);
}

template <int Dim>
std::vector<Mat<Dim>> Solver<Dim>::metrics() const {
  const auto& cells = tissue_.cells;
  std::vector<Mat<Dim>> metrics(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) metrics[i] = metric(i);
  return metrics;
}

/// Of the pairs, and what follows from them.
template <int Dim>
void Solver<Dim>::find_operators(const std::vector<Mat<Dim>>& metrics) {
  auto& cells = tissue_.cells;
  clock_.measure("gradient operators", [&] {
    gradient_report_ = build_gradients<Dim>(cells.active(cells.position), metrics, cells.active(cells.volume),
                                            tissue_.pairs, options_.gradient, tissue_.gradients, tissue_.kernel);
  });
  Hooks<Dim>::run(hooks_.operators, clock_, tissue_);
}

template <int Dim>
void Solver<Dim>::look() {
  const auto& cells = tissue_.cells;
  PairList kept = std::move(tissue_.pairs);  // slips belong to these
  const std::vector<Mat<Dim>> present = metrics();
  tissue_.pairs = find_pairs<Dim>(cells.active(cells.position), present);
  Hooks<Dim>::run(hooks_.loads, clock_, tissue_);
  Hooks<Dim>::run(hooks_.parameters, clock_, tissue_);
  find_operators(present);
  compute_velocity_gradients<Dim>(tissue_);
  kept.neighbours = std::move(tissue_.pairs.neighbours);
  tissue_.pairs = std::move(kept);
}

template <int Dim>
double Solver<Dim>::axial_strain_rate_per_h(std::size_t cell) const {
  if (window_h_ > 0.0) {
    if (tissue_.cells.clamped[cell]) return 0.0;
    // the mean over the window, and what the profile along the root adds from its middle to its end
    const double s = tissue_.cells.distance_to_tip[cell];
    return tissue_.axial_strain[cell] / window_h_ + axis_.strain_rate_per_h(s) -
           axis_.strain_rate_per_h(past_window_distance(s));
  }
  const Vec<Dim> axis = tissue_.cells.frame[cell].col(0);
  return axis.dot(tissue_.velocity_gradient[cell] * axis);
}

template <int Dim>
void Solver<Dim>::begin_window() {
  auto& cells = tissue_.cells;
  Hooks<Dim>::run(hooks_.loads, clock_, tissue_);
  Hooks<Dim>::run(hooks_.division, clock_, tissue_);
  Hooks<Dim>::run(hooks_.rest, clock_, tissue_);
  clock_.measure("root axis", [&] { axis_.anchor(tissue_); });

  std::vector<Mat<Dim>> present;
  PairList old_pairs;
  clock_.measure("neighbours", [&] {
    cells.permute(spatial_order<Dim>(cells.active(cells.position), metrics()));
    present = metrics();
    old_pairs = std::move(tissue_.pairs);
    tissue_.pairs = find_pairs<Dim>(cells.active(cells.position), present);
  });
  Hooks<Dim>::run(hooks_.parameters, clock_, tissue_);
  if (tissue_.body_acceleration) {
    for (Vec<Dim>& a : tissue_.body_acceleration->values()) a.setZero();
  }
  Hooks<Dim>::run(hooks_.acceleration, clock_, tissue_);
  find_operators(present);
  clock_.measure("pair terms", [&] { rebuild_pair_terms<Dim>(tissue_, old_pairs, terms_); });
  Hooks<Dim>::run(hooks_.pair_history, clock_, tissue_);
  if (tissue_.inertia) choose_inertia();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    tissue_.deformation[i].setIdentity();
    tissue_.axial_strain[i] = 0.0;
    tissue_.window_index[i] = static_cast<std::int64_t>(i);
    if (terms_.non_affine) {
      (*terms_.non_affine->start_position)[i] = cells.position[i];
      (*terms_.non_affine->start_frame)[i] = cells.frame[i];
    }
  }
}

/// As large as the step asks for: it must be stable whatever touches the root.
template <int Dim>
void Solver<Dim>::choose_inertia() {
  for (std::size_t i = 0; i < tissue_.cells.size(); ++i) {
    tissue_.inertia->start_velocity[i] = tissue_.cells.velocity[i];
  }
  std::vector<Vec<Dim>> stiffness;
  clock_.measure("stability bound", [&] { stiffness = bound_stiffness<Dim>(tissue_, terms_); });
  Hooks<Dim>::template run<std::vector<Vec<Dim>>&>(hooks_.stiffness, clock_, tissue_, stiffness);
  Hooks<Dim>::template run<std::vector<Vec<Dim>>&>(hooks_.coupling, clock_, tissue_, stiffness);
  clock_.measure("stability bound", [&] {
    set_inertia<Dim>(tissue_, terms_, stiffness, options_.inertia);
    tissue_.inertia->mass_damping_per_h =
        options_.mass_damping_per_h ? *options_.mass_damping_per_h : critical_mass_damping<Dim>(tissue_);
  });
}

template <int Dim>
void Solver<Dim>::evaluate_forces(SlipAdvance advance) {
  clock_.measure("forces", [&] { add_forces_(tissue_, terms_, advance); });
  ++effort_.force_evaluations;
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
  Hooks<Dim>::run(hooks_.surface, clock_, tissue_);
  Hooks<Dim>::run(hooks_.exchange, clock_, tissue_);
  Hooks<Dim>::run(hooks_.spacing, clock_, tissue_);
  clock_.measure("root axis", [&] {
    std::vector<double> middle(cells.distance_to_tip.values().begin(),
                               cells.distance_to_tip.values().begin() + static_cast<std::ptrdiff_t>(cells.size()));
    axis_.anchor(tissue_);  // outputs tell the distances of the window's end
    for (std::size_t i = 0; i < cells.size(); ++i) middle[i] = 0.5 * (middle[i] + cells.distance_to_tip[i]);
    axis_.measure_flow(tissue_, middle, window_h_);
  });
  Hooks<Dim>::run(hooks_.perception, clock_, tissue_);
  Hooks<Dim>::run(hooks_.watch, clock_, tissue_);
}

/// The displacement of the window at which all forces balance; the cells end there. False: there is none that can be
/// found, or the thrust changes by more than it may, and the cells are where they were.
template <int Dim>
bool Solver<Dim>::find_balance(bool downhill, double most_thrust_change) {
  auto& cells = tissue_.cells;
  const double dt = window_h_;
  const std::vector<Vec<Dim>> start(cells.position.values().begin(),
                                    cells.position.values().begin() + static_cast<std::ptrdiff_t>(cells.size())),
      velocity(cells.velocity.values().begin(),
               cells.velocity.values().begin() + static_cast<std::ptrdiff_t>(cells.size()));
  std::vector<Vec<Dim>> displacement(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    displacement[i] = cells.clamped[i] ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>(dt * velocity[i]);
  }
  const auto place = [&](const std::vector<Vec<Dim>>& d) {
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells.velocity[i] = d[i] / dt;
      cells.position[i] = start[i] + d[i];
    }
    clock_.measure("velocity gradients", [&] { compute_velocity_gradients<Dim>(tissue_); });
  };
  const auto evaluate = [&](const std::vector<Vec<Dim>>& d) {
    place(d);
    clock_.measure("material", [&] { predict_nominal_forces_(tissue_, dt); });
    evaluate_forces({dt, 0.0});
  };
  const auto contact = [&] {
    std::vector<Mat<Dim>> stiffness;
    if (hooks_.contact_stiffness.empty()) return stiffness;
    stiffness.assign(cells.size(), Mat<Dim>::Zero());
    Hooks<Dim>::template run<std::vector<Mat<Dim>>&>(hooks_.contact_stiffness, clock_, tissue_, stiffness);
    return stiffness;
  };
  const auto adapt_friction = [&] {
    bool matters = false;
    Hooks<Dim>::template run<bool&>(hooks_.friction, clock_, tissue_, matters);
    return matters;
  };
  clock_.measure("balance", [&] {
    balance_ = quasi_static_.solve(
        {tissue_, terms_, dt, options_.force_tolerance, evaluate, contact, adapt_friction, downhill}, displacement);
  });
  effort_.balance_iterations += balance_.iterations;
  if (!balance_.found || std::abs(balance_.thrust - thrust_) > most_thrust_change) {
    std::copy(start.begin(), start.end(), cells.position.values().begin());
    std::copy(velocity.begin(), velocity.end(), cells.velocity.values().begin());
    return false;
  }
  place(displacement);
  clock_.measure("material", [&] { update_material_(tissue_, dt); });
  evaluate_forces({dt, dt});
  thrust_ = balance_.thrust;
  return true;
}

/// A step without inertia, in parts where its balance cannot be found in one: halves, quarters, ... Each is a window.
/// So too where a growing root meets something that pushes back: thrust rises as fast as the tissue's stiffness lets
/// it, and strain comes at no constant rate in such a step.
template <int Dim>
void Solver<Dim>::quasi_static_step() {
  constexpr int most_halvings = 10, most_easy_halvings = 2, most_halvings_for_thrust = 4;
  constexpr double most_thrust_change = 0.1;  // of p times the section
  constexpr std::int64_t whole = std::int64_t{1} << most_halvings;
  const double step_h = tissue_.step_h, start_h = tissue_.time_h;
  std::int64_t done = 0;
  int level = 0;
  imbalance_ = 0.0;
  const bool can_meet = tissue_.material.softening && !hooks_.contact_stiffness.empty();
  while (done < whole) {
    const auto balanced = [&] {
      const bool watches = can_meet && level < most_halvings_for_thrust;
      return find_balance(level >= most_easy_halvings,
                          watches ? most_thrust_change : std::numeric_limits<double>::infinity());
    };
    const auto choose = [&] {
      tissue_.step_h = window_h_ = std::ldexp(step_h, -level);
      tissue_.time_h = start_h + step_h * static_cast<double>(done + (whole >> level)) / static_cast<double>(whole);
    };
    choose();
    begin_window();
    Hooks<Dim>::run(hooks_.step_loads, clock_, tissue_);
    while (!balanced()) {
      if (++level > most_halvings) {
        tissue_.step_h = step_h;
        const std::size_t i = balance_.worst_cell;
        const auto& x = tissue_.cells.position[i];
        throw UnphysicalError(fmt::format(
            "the tissue finds no balance at t = {:.5g} h, in steps down to {:.2g} h: after {} iterations the force on "
            "cell {} is {:.3g} of the pressure on its face (position {:.4g} mm, distance from the tip {:.4g} mm). "
            "Usual causes: nothing holds the root against a load; a slender root buckles (more cells across, or "
            "another "
            "numerics.step_h, may find the bent balance)",
            tissue_.time_h, window_h_, balance_.iterations, tissue_.cells.cell_id[i], balance_.worst_imbalance,
            fmt::join(x.data(), x.data() + Dim, ", "), tissue_.cells.distance_to_tip[i]));
      }
      choose();
      Hooks<Dim>::run(hooks_.loads, clock_, tissue_);
      Hooks<Dim>::run(hooks_.parameters, clock_, tissue_);
      Hooks<Dim>::run(hooks_.step_loads, clock_, tissue_);
      set_slip_retention<Dim>(tissue_, terms_);
    }
    end_window();
    imbalance_ = std::max(imbalance_, balance_.imbalance);
    effort_.unstable_steps += balance_.stable ? 0 : 1;
    shortest_step_h_ = std::min(shortest_step_h_, window_h_);
    done += whole >> level;
    while (level > 0 && done % (whole >> (level - 1)) == 0 && balance_.iterations < 15) --level;
  }
  tissue_.step_h = step_h;
  ++steps_;
  tissue_.time_h = step_time_h(steps_, tissue_.step_h);
}

template <int Dim>
void Solver<Dim>::advance_window(int steps) {
  if (options_.stepper == Stepper::quasi_static) {
    for (int k = 0; k < steps; ++k) quasi_static_step();
    return;
  }
  const bool predicting = options_.stepper == Stepper::predictor_corrector;
  window_h_ = steps * tissue_.step_h;
  begin_window();
  for (int k = 0; k < steps; ++k) {
    Hooks<Dim>::run(hooks_.step_loads, clock_, tissue_);
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
  reals["solver/shortest_step_h"] = {shortest_step_h_};
  reals["solver/thrust"] = {thrust_};
  if (!tissue_.inertia) quasi_static_.save(reals, integers);
  integers["solver/counters"] = {steps_,
                                 tissue_.next_cell_id,
                                 static_cast<std::int64_t>(tissue_.cells.total() - tissue_.cells.size()),
                                 effort_.balance_iterations,
                                 effort_.force_evaluations,
                                 effort_.unstable_steps};
  if (!terms_.non_affine) return;
  std::vector<std::int64_t>& index = integers["solver/slip_pairs"];
  std::vector<double>& slip = reals["solver/slip_mm"];
  for (std::size_t k = 0; k < tissue_.pairs.pairs.size(); ++k) {
    index.push_back(tissue_.pairs.pairs[k].i);
    index.push_back(tissue_.pairs.pairs[k].j);
    slip.insert(slip.end(), terms_.non_affine->slip_mm[k].data(), terms_.non_affine->slip_mm[k].data() + 2 * Dim);
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
  shortest_step_h_ = reals.at("solver/shortest_step_h").at(0);
  thrust_ = reals.at("solver/thrust").at(0);
  if (!tissue_.inertia) quasi_static_.restore(reals, integers);
  const auto& counters = integers.at("solver/counters");
  steps_ = counters.at(0);
  tissue_.next_cell_id = counters.at(1);
  tissue_.time_h = step_time_h(steps_, tissue_.step_h);
  tissue_.cells.rest(static_cast<std::size_t>(counters.at(2)));
  effort_ = {counters.at(3), counters.at(4), counters.at(5)};
  const std::size_t n = tissue_.cells.size();
  for (std::size_t i = 0; i < n; ++i) tissue_.window_index[i] = static_cast<std::int64_t>(i);
  if (!terms_.non_affine) return;

  const auto& index = integers.at("solver/slip_pairs");
  const auto& slip = reals.at("solver/slip_mm");
  const auto& frames = reals.at("solver/start_frames");
  const std::size_t count = index.size() / 2;
  ROOTSOIL_ASSERT(slip.size() == count * 2 * Dim && frames.size() == n * Dim * Dim);
  tissue_.pairs = PairList{};
  tissue_.pairs.row.assign(n + 1, 0);
  terms_.non_affine->slip_mm.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    tissue_.pairs.pairs.push_back(
        {static_cast<std::int32_t>(index[2 * k]), static_cast<std::int32_t>(index[2 * k + 1])});
    ++tissue_.pairs.row[static_cast<std::size_t>(index[2 * k]) + 1];
    terms_.non_affine->slip_mm[k] = Eigen::Map<const PairSlip<Dim>>(slip.data() + k * 2 * Dim);
  }
  for (std::size_t i = 0; i < n; ++i) {
    tissue_.pairs.row[i + 1] += tissue_.pairs.row[i];
    (*terms_.non_affine->start_frame)[i] = Eigen::Map<const Mat<Dim>>(frames.data() + i * Dim * Dim);
  }
}

template class Solver<2>;
template class Solver<3>;

}  // namespace rootsoil
