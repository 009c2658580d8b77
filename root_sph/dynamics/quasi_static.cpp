// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/quasi_static.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "root_sph/core/cell_size.hpp"
#include "root_sph/dynamics/mixing.hpp"

namespace rootsoil {
namespace {

constexpr int most_iterations = 60, most_halvings = 6, most_rebuilds = 8;
constexpr int most_adaptations = 10;   // of friction to the balance
constexpr int most_after_balance = 8;  // iterations after the first within the force's tolerance
constexpr double most_strain = 0.2;    // of a pair's distance in one iteration
constexpr double short_strain = 5e-3;  // of a pair's distance in a step after which the matrix is kept
// Stability: stiffness of the softest mode over the tissue's own; displacements over a cell's size; thrust over p times
// the held cells' faces.
constexpr double least_stiffness = 1e-3, ample_stiffness = 0.5, small_move = 1e-3, first_move = 0.1;
constexpr double restless_move = 1e-2;  // that cells still want to make, over their size, under forces that balance
constexpr double least_thrust = 1e-4, much_more_thrust = 1.1;
constexpr int most_unwatched_steps = 20;
constexpr double doubtful_start = 0.2;  // imbalance
constexpr int most_escapes = 3, most_falls = 200, most_newton_iterations = 60;
constexpr double newton_accuracy = 0.1;
// Multiplications of a band's factor, where layers could serve: what costs no more than they do, and what is worth
// while where they fail.
constexpr double little_work = 2e8, most_work = 2e11;

/// MPa: what a cell's face carries. The pressure differential, or the rms of the tissue's total stress where that is
/// more: without pressure, and where something crushes the tissue.
template <int Dim>
double stress_scale(const Tissue<Dim>& tissue) {
  double square = 0.0;
  const auto& cells = tissue.cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    square += (tissue.nominal_force[i] / cells.volume[i]).squaredNorm();
  }
  const double rms = cells.size() > 0 ? std::sqrt(square / static_cast<double>(cells.size())) : 0.0;
  return std::max({std::abs(tissue.pressure_MPa), rms, 1e-9 * tissue.material.E_axial_MPa});
}

/// By how much a step changes the distance vector of a pair over its length, the most of all.
template <int Dim>
double largest_pair_strain(const Tissue<Dim>& tissue, const FreeCells& free, const Eigen::VectorXd& step) {
  const auto& cells = tissue.cells;
  const auto moved = [&](std::int32_t cell) -> Vec<Dim> {
    const std::int32_t p = free.place[cell];
    return p < 0 ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>(step.segment<Dim>(Eigen::Index{p} * Dim));
  };
  double strain2 = 0.0;
#pragma omp parallel for schedule(static) reduction(max : strain2)
  for (std::size_t k = 0; k < tissue.pairs.pairs.size(); ++k) {
    const auto [i, j] = tissue.pairs.pairs[k];
    strain2 =
        std::max(strain2, (moved(j) - moved(i)).squaredNorm() / (cells.position[j] - cells.position[i]).squaredNorm());
  }
  return std::sqrt(strain2);
}

/// Distance of the two cells of a pair that are nearest to each other.
template <int Dim>
double closest_pair_mm(const Tissue<Dim>& tissue) {
  double closest2 = std::numeric_limits<double>::infinity();
  for (const auto& [i, j] : tissue.pairs.pairs) {
    closest2 = std::min(closest2, (tissue.cells.position[j] - tissue.cells.position[i]).squaredNorm());
  }
  return std::sqrt(closest2);
}

/// How far cells move, over their size, the most of all.
template <int Dim>
double largest_move(const Eigen::VectorXd& move, const Eigen::VectorXd& sizes) {
  double largest = 0.0;
  for (Eigen::Index p = 0; p < sizes.size(); ++p) {
    largest = std::max(largest, move.segment<Dim>(p * Dim).norm() / sizes[p]);
  }
  return largest;
}

/// A direction across an axis, the same side all along a bent root.
template <int Dim>
Vec<Dim> across(const Vec<Dim>& axis) {
  if constexpr (Dim == 2) {
    return Vec<2>(-axis[1], axis[0]);
  } else {
    return axis.cross(Vec<3>(0.28, 0.64, 0.72)).normalized();  // no direction that a scene would have
  }
}

/// Whether what a cell touches is stiff enough to matter beside the tissue.
template <int Dim>
bool matters(const Tissue<Dim>& tissue, std::int32_t cell, const Mat<Dim>& contact) {
  constexpr double share = 0.05;  // of E_A through a cell
  return contact.norm() > share * tissue.material.E_axial_MPa * std::pow(tissue.cells.volume[cell], 1.0 - 2.0 / Dim);
}

/// The free cells with these ids in these places; absent: others are free.
template <int Dim>
std::optional<FreeCells> places_of(const Tissue<Dim>& tissue, const std::vector<std::int64_t>& ids) {
  const auto& cells = tissue.cells;
  if (ids.empty()) return {};
  std::vector<std::int32_t> cell_of(static_cast<std::size_t>(tissue.next_cell_id), -1);
  std::size_t number = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i]) continue;
    cell_of[static_cast<std::size_t>(cells.cell_id[i])] = static_cast<std::int32_t>(i);
    ++number;
  }
  if (number != ids.size()) return {};
  FreeCells free;
  free.place.assign(cells.size(), -1);
  for (const std::int64_t id : ids) {
    const std::int32_t i = cell_of[static_cast<std::size_t>(id)];
    if (i < 0) return {};
    free.place[i] = static_cast<std::int32_t>(free.cell.size());
    free.cell.push_back(i);
  }
  return free;
}

/// One search for a balance, with one preconditioner.
template <int Dim>
class Search {
 public:
  using Displacements = typename QuasiStatic<Dim>::Displacements;
  using Method = typename QuasiStatic<Dim>::Method;
  using Stability = typename QuasiStatic<Dim>::Stability;

  Search(const typename QuasiStatic<Dim>::Problem& problem, const FreeCells& free, Method& method, Stability& stability,
         Displacements& displacement)
      : problem_(problem),
        tissue_(problem.tissue),
        free_(free),
        method_(method),
        stability_(stability),
        displacement_(displacement),
        places_(std::ssize(free.cell)),
        x_(places_ * Dim),
        r_(places_ * Dim),
        z_(places_ * Dim),
        sizes_(places_),
        faces_(places_) {
    for (Eigen::Index p = 0; p < places_; ++p) {
      x_.segment<Dim>(p * Dim) = displacement[free.cell[p]];
      sizes_[p] = cell_size_mm<Dim>(tissue_.cells.volume[free.cell[p]]);
      faces_[p] = tissue_.cells.volume[free.cell[p]] / sizes_[p];
    }
    built_ = !method.id.empty();
    closest_pair_mm_ = closest_pair_mm<Dim>(tissue_);
  }

  /// A balance that a small push would end is left for the one that the root falls into, and one that is not found is
  /// looked for downhill.
  Balance run() {
    settle(choose_start());
    ++stability_.steps;
    for (int k = 0; std::isfinite(balance_.imbalance) && (may_buckle() || (!balance_.found && problem_.downhill));
         ++k) {
      if ((!built_ || is_old(balance_.iterations)) && !build()) break;
      stability_.thrust = thrust();
      stability_.steps = 0;
      const Mode mode = softest_mode();
      stability_.stiffness = mode.stiffness;
      balance_.stable = mode.stiffness > least_stiffness;
      const bool leave =
          balance_.found ? restless_ || !balance_.stable : problem_.downhill || mode.stiffness <= ample_stiffness;
      if (k == most_escapes || !leave) break;
      fall(mode);
      settle();
    }
    if (largest_pair_strain<Dim>(tissue_, free_, x_) > short_strain) method_.forget();
    put(x_);
    return balance_;
  }

 private:
  /// Displacements v of the free cells, the forces M v, and what stiffness is left: v.K v/v.M v.
  struct Mode {
    Eigen::VectorXd v, load;
    double stiffness = 1.0;
  };

  void put(const Eigen::VectorXd& at) {
    for (Eigen::Index p = 0; p < places_; ++p) displacement_[free_.cell[p]] = at.segment<Dim>(p * Dim);
  }

  /// r: the forces on the free cells.
  void evaluate(const Eigen::VectorXd& at) {
    put(at);
    problem_.evaluate(displacement_);
    for (Eigen::Index p = 0; p < places_; ++p) r_.segment<Dim>(p * Dim) = tissue_.force[free_.cell[p]];
  }

  void judge() {
    double square = 0.0;
    balance_.worst_imbalance = -1.0;
    const double scale = stress_scale<Dim>(tissue_);
    for (Eigen::Index p = 0; p < places_; ++p) {
      const double relative = r_.segment<Dim>(p * Dim).norm() / (scale * faces_[p]);
      square += relative * relative;
      if (!(relative <= balance_.worst_imbalance)) {
        balance_.worst_imbalance = relative;
        balance_.worst_cell = static_cast<std::size_t>(free_.cell[p]);
      }
    }
    balance_.imbalance = places_ > 0 ? std::sqrt(square / static_cast<double>(places_)) : 0.0;
  }

  /// After a sudden motion the last step's flow is a worse guess than none. True: the forces are those at x.
  bool choose_start() {
    evaluate(x_);
    judge();
    const double with_flow = balance_.imbalance;
    if (with_flow < doubtful_start) return true;
    const Eigen::VectorXd flow = std::exchange(x_, Eigen::VectorXd::Zero(x_.size()));
    evaluate(x_);
    judge();
    if (balance_.imbalance < with_flow) return true;
    x_ = flow;
    return false;
  }

  /// A new matrix, ready for use.
  bool build() {
    method_.forget();
    method_.preconditioner->assemble(tissue_, problem_.terms, free_, problem_.dt_h);
    method_.contact = touched();
    method_.dt_h = problem_.dt_h;
    fresh_ = true;
    built_ = method_.preconditioner->factor(method_.contact);
    if (!built_) return false;
    for (const std::int32_t i : free_.cell) method_.id.push_back(tissue_.cells.cell_id[i]);
    return true;
  }

  /// A matrix that was kept, and needs twice the iterations that it did.
  bool is_old(int iterations) const { return !fresh_ && iterations > 2 * method_.iterations + 1; }

  /// Stiffness of what the cell in each place touches.
  std::vector<Mat<Dim>> touched() const {
    const std::vector<Mat<Dim>> of_cells = problem_.contact();
    std::vector<Mat<Dim>> of_places;
    if (of_cells.empty()) return of_places;
    for (const std::int32_t i : free_.cell) of_places.push_back(of_cells[i]);
    return of_places;
  }

  /// What the root touches may come and go: the matrix follows. False: it cannot.
  bool follow_contact() {
    std::vector<Mat<Dim>> now = touched();
    bool same = now.size() == method_.contact.size();
    for (std::size_t p = 0; same && p < now.size(); ++p) {
      const std::int32_t i = free_.cell[p];
      same = matters(tissue_, i, now[p]) == matters(tissue_, i, method_.contact[p]);
    }
    if (same) return true;
    ++rebuilds_;
    mixing_.forget();
    method_.contact = std::move(now);
    built_ = method_.preconditioner->factor(method_.contact);
    return built_ || build();
  }

  /// A balance with the friction that belongs to it: friction is bounded by the normal forces of the balance before, so
  /// that the rest is the gradient of a convex function, until they are the same.
  void settle(bool evaluated = false) {
    iterate(evaluated);
    for (int k = 0; k < most_adaptations && balance_.found && problem_.adapt(); ++k) iterate();
  }

  /// Quasi-Newton iterations, mixed, until forces and what they still want to move are small. What moves for long under
  /// forces that are small already (a mode that has hardly any stiffness, cells that slide) ends where it moves least.
  /// \param evaluated the forces are those at x
  void iterate(bool evaluated = false) {
    mixing_.forget();
    rebuilds_ = 0;
    balance_.found = restless_ = false;
    int halvings = 0, after_balance = 0;
    double best = 0.0, least_move = 0.0;
    Eigen::VectorXd best_x, stillest_x, step;
    for (int k = 0;; ++k, ++balance_.iterations) {
      if (k > 0 || !evaluated) {
        evaluate(x_);
        judge();
      }
      if (!std::isfinite(balance_.imbalance)) return;
      const bool balanced = balance_.imbalance <= problem_.tolerance;
      balance_.found = balance_.imbalance == 0.0;
      if (balance_.found) return;
      if (k >= most_iterations || after_balance > most_after_balance) break;
      // a step that made it worse is halved, from the best so far
      if (!balanced && k > 0 && balance_.imbalance > 2.0 * best && halvings < most_halvings) {
        ++halvings;
        step *= 0.5;
        x_ = best_x + step;
        continue;
      }
      if (k == 0 || balance_.imbalance < best) {
        best = balance_.imbalance;
        best_x = x_;
        halvings = 0;
      }
      if (!built_ || is_old(k)) {
        if (!build()) return;
        method_.iterations = 0;
        mixing_.forget();
      } else if (rebuilds_ < most_rebuilds && !follow_contact()) {
        return;
      }
      method_.preconditioner->apply(r_, z_);
      if (fresh_) ++method_.iterations;
      if (balanced) {
        const double move = largest_move<Dim>(z_, sizes_);
        balance_.found = move <= problem_.tolerance;
        if (balance_.found) return;
        if (stillest_x.size() == 0 || move < least_move) {
          stillest_x = x_;
          least_move = move;
        }
      }
      if (stillest_x.size() > 0) ++after_balance;
      mixing_.improve(x_, r_, z_);
      step = z_;
      x_ += limited(step);
    }
    x_ = stillest_x.size() > 0 ? stillest_x : best_x;
    evaluate(x_);
    judge();
    balance_.found = stillest_x.size() > 0;
    restless_ = balance_.found && least_move > restless_move;
  }

  const Eigen::VectorXd& limited(Eigen::VectorXd& step) const {
    double farthest2 = 0.0;
    for (Eigen::Index p = 0; p < places_; ++p) {
      farthest2 = std::max(farthest2, step.segment<Dim>(p * Dim).squaredNorm());
    }
    if (4.0 * std::sqrt(farthest2) < most_strain * closest_pair_mm_) return step;  // no need to look at the pairs
    const double strain = largest_pair_strain<Dim>(tissue_, free_, step);
    if (strain > most_strain) step *= most_strain / strain;
    return step;
  }

  /// Force on the held base against the root's growth, N: nothing else bends a straight root.
  double thrust() const {
    const auto& cells = tissue_.cells;
    double sum = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells.clamped[i]) sum -= tissue_.force[i].dot(cells.frame[i].col(0));
    }
    return sum;
  }

  /// Whether the root is pressed, and its softest mode is to be looked at: with a new matrix, where no balance was
  /// found or cells want to move on, where it was soft, where the thrust has grown, and now and then, for the root gets
  /// longer.
  bool may_buckle() {
    const auto& cells = tissue_.cells;
    double section = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells.clamped[i]) section += std::pow(cells.volume[i], (Dim - 1.0) / Dim);
    }
    const double now = thrust();
    balance_.thrust = section > 0.0 ? now / (stress_scale<Dim>(tissue_) * section) : 0.0;
    if (balance_.thrust <= least_thrust) return false;
    return fresh_ || !balance_.found || restless_ || stability_.stiffness < ample_stiffness ||
           now > much_more_thrust * stability_.thrust || stability_.steps >= most_unwatched_steps;
  }

  /// What a load from the side does, and two steps of the power method on 1 - M^-1 K from there, whose largest
  /// eigenvalue belongs to the smallest of M^-1 K; for a column that is 1 - P/P_Euler.
  Mode softest_mode() {
    Mode mode{.v = {}, .load = Eigen::VectorXd(places_ * Dim)};
    for (Eigen::Index p = 0; p < places_; ++p) {
      mode.load.template segment<Dim>(p * Dim) = faces_[p] * across<Dim>(tissue_.cells.frame[free_.cell[p]].col(0));
    }
    method_.preconditioner->apply(mode.load, mode.v);
    const auto stiffness_over = [&](const Eigen::VectorXd& force) { return mode.v.dot(force) / mode.v.dot(mode.load); };
    for (int k = 0;; ++k) {
      const Eigen::VectorXd force = resisted(mode.v, small_move);
      mode.stiffness = stiffness_over(force);
      if (mode.stiffness > ample_stiffness || k == 2) break;
      method_.preconditioner->apply(force, z_);
      mode.v -= z_;
      mode.load -= force;
    }
    // a contact that opens or shuts is no mode: what has no stiffness has none to either side, and for larger pushes
    for (const double move : {-small_move, 10.0 * small_move, -10.0 * small_move}) {
      if (mode.stiffness > least_stiffness) break;
      mode.stiffness = stiffness_over(resisted(mode.v, move));
    }
    return mode;
  }

  /// K v, from what a small displacement along v does to the forces at x.
  Eigen::VectorXd resisted(const Eigen::VectorXd& v, double move) {
    const Eigen::VectorXd here = r_;
    const double push = move / largest_move<Dim>(v, sizes_);
    evaluate(x_ + push * v);
    Eigen::VectorXd force = (here - r_) / push;
    r_ = here;
    return force;
  }

  /// A step of Newton's method.
  struct NewtonStep {
    Eigen::VectorXd step, load, left;  ///< and M step; r - K step
    bool limited = false;              ///< it is as long as allowed
  };

  /// Conjugate gradients on K step = r, preconditioned with M, until the step is as long as allowed in the norm of M. A
  /// direction without stiffness is followed that far (Steihaug, SIAM Journal on Numerical Analysis 20, 626, 1983).
  NewtonStep newton_step(double longest) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(x_.size());
    NewtonStep newton{.step = none, .load = none, .left = r_};
    Eigen::VectorXd z, way, way_load = r_;  // M way
    method_.preconditioner->apply(r_, z);
    way = z;
    double rz = r_.dot(z);
    const double enough = newton_accuracy * newton_accuracy * rz;
    for (int k = 0; k < most_newton_iterations && rz > enough; ++k) {
      const Eigen::VectorXd force = resisted(way, small_move);
      const double curvature = way.dot(force), ww = way.dot(way_load), sw = way.dot(newton.load),
                   room = longest * longest - newton.step.dot(newton.load);
      double share = rz / curvature;
      newton.limited = curvature <= 0.0 || share * (2.0 * sw + share * ww) >= room;
      if (newton.limited) share = (-sw + std::sqrt(sw * sw + ww * room)) / ww;
      newton.step += share * way;
      newton.load += share * way_load;
      newton.left -= share * force;
      if (newton.limited) break;
      method_.preconditioner->apply(newton.left, z);
      const double before = std::exchange(rz, newton.left.dot(z));
      way = z + rz / before * way;
      way_load = newton.left + rz / before * way_load;
    }
    return newton;
  }

  /// Downhill to a balance that is stable, from one that is not or where none was found: Newton's steps, as long as
  /// what they gain is what they promise. Forces are all but the gradient of an energy, so a step gains the mean of the
  /// forces at its ends times its way.
  void fall(const Mode& mode) {
    const Eigen::VectorXd push = first_move / largest_move<Dim>(mode.v, sizes_) * mode.v;
    double trusted = first_move / largest_move<Dim>(mode.v, sizes_) * std::sqrt(mode.v.dot(mode.load));
    if (balance_.found && !restless_) x_ += mode.load.dot(x_) < 0.0 ? Eigen::VectorXd(-push) : push;
    evaluate(x_);
    bool moved = true;
    for (int k = 0; k < most_falls; ++k, ++balance_.iterations) {
      if (moved && !build()) return;
      const Eigen::VectorXd from = x_, force = r_;
      const NewtonStep newton = newton_step(trusted);
      if (newton.step.isZero(0.0)) return;  // nothing pulls
      // A straight step stretches what it turns: M mends that, and leaves how far the step goes.
      evaluate(from + newton.step);
      const Eigen::VectorXd stretched = r_ - newton.left;
      method_.preconditioner->apply(stretched, z_);
      const Eigen::VectorXd step =
          newton.step + z_ - newton.step.dot(stretched) / newton.step.dot(newton.load) * newton.step;
      const double promised = 0.5 * (force + newton.left).dot(newton.step);
      double gained = -promised;
      if (largest_pair_strain<Dim>(tissue_, free_, step) <= most_strain) {
        evaluate(from + step);
        gained = 0.5 * (force + r_).dot(step);
      }
      moved = gained > 0.1 * promised;
      x_ = moved ? Eigen::VectorXd(from + step) : from;
      if (!moved) r_ = force;
      if (!(gained >= 0.25 * promised)) {
        trusted *= 0.25;
      } else if (gained > 0.75 * promised && newton.limited) {
        trusted *= 2.0;
      }
      if (moved && !newton.limited && largest_move<Dim>(step, sizes_) <= problem_.tolerance) return;
    }
  }

  const typename QuasiStatic<Dim>::Problem& problem_;
  const Tissue<Dim>& tissue_;
  const FreeCells& free_;
  Method& method_;
  Stability& stability_;
  Displacements& displacement_;
  Eigen::Index places_;
  Eigen::VectorXd x_, r_, z_, sizes_, faces_;
  Mixing mixing_;
  int rebuilds_ = 0;
  double closest_pair_mm_;
  bool built_ = false, fresh_ = false;  ///< there is a matrix; it is of this search
  bool restless_ = false;               ///< forces balance, and cells want to move on
  Balance balance_;
};

}  // namespace

template <int Dim>
Balance QuasiStatic<Dim>::solve(const Problem& problem, Displacements& displacement) {
  if constexpr (Dim == 2) {
    return search_with(band_, problem, displacement);
  } else {
    const double work = band_work<Dim>(problem.tissue.pairs, order_free_cells<Dim>(problem.tissue.cells));
    if (work < little_work) return search_with(band_, problem, displacement);
    const Displacements guess = displacement;
    const Balance balance = search_with(layers_, problem, displacement);
    if (balance.found || work >= most_work) return balance;
    displacement = guess;
    const Balance with_band = search_with(band_, problem, displacement);
    band_.forget();
    return with_band;
  }
}

template <int Dim>
Balance QuasiStatic<Dim>::search_with(Method& method, const Problem& problem, Displacements& displacement) {
  const std::optional<FreeCells> known =
      method.dt_h == problem.dt_h ? places_of<Dim>(problem.tissue, method.id) : std::nullopt;
  if (!known) method.forget();
  const FreeCells free = known ? *known : order_free_cells<Dim>(problem.tissue.cells);
  return Search<Dim>(problem, free, method, stability_, displacement).run();
}

template <int Dim>
void QuasiStatic<Dim>::save(std::map<std::string, std::vector<double>>& reals,
                            std::map<std::string, std::vector<std::int64_t>>& integers) const {
  for (const auto& [name, method] : {std::pair{"band", &band_}, std::pair{"layers", &layers_}}) {
    const std::string at = fmt::format("balance/{}/", name);
    integers[at + "places"] = method->id;
    if (method->id.empty()) continue;
    std::vector<double>& contact = reals[at + "contact_N_mm"];
    for (const Mat<Dim>& block : method->contact) contact.insert(contact.end(), block.data(), block.data() + Dim * Dim);
    integers[at + "iterations"] = {method->iterations};
    reals[at + "dt_h"] = {method->dt_h};
    reals[at + "matrix"] = method->preconditioner->save();
  }
  reals["balance/stability"] = {stability_.stiffness, stability_.thrust};
  integers["balance/unwatched_steps"] = {stability_.steps};
}

template <int Dim>
void QuasiStatic<Dim>::restore(const std::map<std::string, std::vector<double>>& reals,
                               const std::map<std::string, std::vector<std::int64_t>>& integers) {
  for (const auto& [name, method] : {std::pair{"band", &band_}, std::pair{"layers", &layers_}}) {
    const std::string at = fmt::format("balance/{}/", name);
    method->id = integers.at(at + "places");
    if (method->id.empty()) continue;
    const std::vector<double>& contact = reals.at(at + "contact_N_mm");
    method->contact.clear();
    for (std::size_t k = 0; k < contact.size(); k += Dim * Dim) {
      method->contact.push_back(Eigen::Map<const Mat<Dim>>(contact.data() + k));
    }
    method->iterations = integers.at(at + "iterations").at(0);
    method->dt_h = reals.at(at + "dt_h").at(0);
    method->preconditioner->restore(reals.at(at + "matrix"));
    ROOTSOIL_ASSERT(method->preconditioner->factor(method->contact));
  }
  stability_ = {reals.at("balance/stability").at(0), reals.at("balance/stability").at(1),
                integers.at("balance/unwatched_steps").at(0)};
}

template class QuasiStatic<2>;
template class QuasiStatic<3>;

}  // namespace rootsoil
