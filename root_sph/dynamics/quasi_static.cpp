// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/quasi_static.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace rootsoil {
namespace {

constexpr int most_iterations = 60, most_halvings = 6, most_rebuilds = 8;
constexpr int mixed_iterations = 12;
constexpr double most_strain = 0.2;      // of a pair's distance in one iteration
constexpr double short_strain = 5e-3;    // of a pair's distance in a step after which the matrix is kept
constexpr int most_kept_iterations = 6;  // with a matrix that was kept
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

/// Anderson's mixing: of the iterations so far, the combination whose residual is smallest in the norm of M^-1.
class Mixing {
 public:
  void forget() {
    steps_.clear();
    x_.resize(0);
  }
  /// \param x, r, z unknowns, residual, M^-1 r of the latest iteration; on return z is the step to take from x
  void improve(const Eigen::VectorXd& x, const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    if (x_.size() == x.size()) remember({x - x_, r - r_, z - z_});
    x_ = x;
    r_ = r;
    z_ = z;
    const auto m = static_cast<Eigen::Index>(steps_.size());
    if (m == 0) return;
    Eigen::VectorXd against(m);
    for (Eigen::Index a = 0; a < m; ++a) against[a] = steps_[a].r.dot(z);
    const Eigen::VectorXd share = gram_.topLeftCorner(m, m).completeOrthogonalDecomposition().solve(against);
    for (Eigen::Index a = 0; a < m; ++a) z -= share[a] * (steps_[a].x + steps_[a].z);
  }

 private:
  struct Step {
    Eigen::VectorXd x, r, z;  // differences of two iterations
  };

  /// And its products with the others: dr . M^-1 dr, made symmetric.
  void remember(Step step) {
    constexpr Eigen::Index most = mixed_iterations;
    if (std::ssize(steps_) == most) {
      steps_.pop_front();
      gram_.topLeftCorner(most - 1, most - 1) = gram_.bottomRightCorner(most - 1, most - 1).eval();
    }
    steps_.push_back(std::move(step));
    const Eigen::Index last = std::ssize(steps_) - 1;
    for (Eigen::Index a = 0; a <= last; ++a) {
      gram_(a, last) = gram_(last, a) = 0.5 * (steps_[a].r.dot(steps_[last].z) + steps_[last].r.dot(steps_[a].z));
    }
  }

  std::deque<Step> steps_;
  Eigen::MatrixXd gram_ = Eigen::MatrixXd::Zero(mixed_iterations, mixed_iterations);
  Eigen::VectorXd x_, r_, z_;  ///< of the latest iteration; empty: there was none
};

/// Of each place, 1 where what the cell touches is stiff enough to matter beside the tissue.
template <int Dim>
std::vector<std::int64_t> touched_places(const Tissue<Dim>& tissue, const FreeCells& free,
                                         const std::vector<Mat<Dim>>& contact) {
  constexpr double share = 0.05;  // of E_A through a cell
  std::vector<std::int64_t> touched(free.cell.size(), 0);
  for (std::size_t p = 0; p < touched.size() && !contact.empty(); ++p) {
    const std::int32_t i = free.cell[p];
    const double stiffness = tissue.material.E_axial_MPa * std::pow(tissue.cells.volume[i], 1.0 - 2.0 / Dim);
    touched[p] = contact[i].norm() > share * stiffness;
  }
  return touched;
}

/// Largest squared strain of a pair in a displacement of the free cells.
template <int Dim>
double largest_strain2(const Tissue<Dim>& tissue, const FreeCells& free, const Eigen::VectorXd& d) {
  const auto moved = [&](std::int32_t cell) -> Vec<Dim> {
    const std::int32_t p = free.place[cell];
    return p < 0 ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>(d.segment<Dim>(Eigen::Index{p} * Dim));
  };
  double strain2 = 0.0;
  for (const auto& [i, j] : tissue.pairs.pairs) {
    const Vec<Dim> apart = tissue.cells.position[j] - tissue.cells.position[i];
    strain2 = std::max(strain2, (moved(j) - moved(i)).squaredNorm() / apart.squaredNorm());
  }
  return strain2;
}

}  // namespace

template <int Dim>
Balance QuasiStatic<Dim>::solve(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, double dt_h, double tolerance,
                                const Evaluate& evaluate, const ContactStiffness& contact,
                                Displacements& displacement) {
  const std::optional<FreeCells> known = kept_places(tissue, dt_h);
  if (!known) kept_ = {};
  const FreeCells free = known ? *known : order_free_cells<Dim>(tissue.cells);
  const auto attempt_with = [&](Preconditioner<Dim>& preconditioner, Kept* matrix) {
    return attempt(preconditioner, matrix, tissue, terms, free, dt_h, tolerance, evaluate, contact, displacement);
  };
  if constexpr (Dim == 2) {
    return attempt_with(*band_, &kept_);
  } else {
    const double work = band_work<Dim>(tissue.pairs, free);
    if (work < little_work) return attempt_with(*band_, &kept_);
    const Displacements guess = displacement;
    const Balance balance = attempt_with(*layers_, nullptr);
    if (balance.found || work >= most_work) return balance;
    displacement = guess;
    return attempt_with(*band_, nullptr);
  }
}

/// The free cells in the order of the kept matrix; absent: it serves no more.
template <int Dim>
std::optional<FreeCells> QuasiStatic<Dim>::kept_places(const Tissue<Dim>& tissue, double dt_h) const {
  const auto& cells = tissue.cells;
  if (kept_.id.empty() || kept_.dt_h != dt_h) return {};
  std::vector<std::int32_t> cell_of(static_cast<std::size_t>(tissue.next_cell_id), -1);
  std::size_t number = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i]) continue;
    cell_of[static_cast<std::size_t>(cells.cell_id[i])] = static_cast<std::int32_t>(i);
    ++number;
  }
  if (number != kept_.id.size()) return {};
  FreeCells free;
  free.place.assign(cells.size(), -1);
  for (const std::int64_t id : kept_.id) {
    const std::int32_t i = cell_of[static_cast<std::size_t>(id)];
    if (i < 0) return {};
    free.place[i] = static_cast<std::int32_t>(free.cell.size());
    free.cell.push_back(i);
  }
  return free;
}

template <int Dim>
void QuasiStatic<Dim>::save(std::map<std::string, std::vector<double>>& reals,
                            std::map<std::string, std::vector<std::int64_t>>& integers) const {
  integers["balance/places"] = kept_.id;
  integers["balance/touched"] = kept_.is_touched;
  reals["balance/dt_h"] = {kept_.dt_h};
  reals["balance/matrix"] = kept_.id.empty() ? std::vector<double>{} : band_->save();
}

template <int Dim>
void QuasiStatic<Dim>::restore(const std::map<std::string, std::vector<double>>& reals,
                               const std::map<std::string, std::vector<std::int64_t>>& integers) {
  kept_ = {integers.at("balance/places"), integers.at("balance/touched"), reals.at("balance/dt_h").at(0)};
  if (!kept_.id.empty()) band_->restore(reals.at("balance/matrix"));
}

template <int Dim>
Balance QuasiStatic<Dim>::attempt(Preconditioner<Dim>& preconditioner, Kept* matrix, const Tissue<Dim>& tissue,
                                  const PairTerms<Dim>& terms, const FreeCells& free, double dt_h, double tolerance,
                                  const Evaluate& evaluate, const ContactStiffness& contact,
                                  Displacements& displacement) const {
  const auto& cells = tissue.cells;
  const auto places = static_cast<Eigen::Index>(free.cell.size());
  Balance balance;
  Eigen::VectorXd x(places * Dim), r(places * Dim), z(places * Dim), faces(places);
  for (Eigen::Index p = 0; p < places; ++p) {
    x.segment<Dim>(p * Dim) = displacement[free.cell[p]];
    faces[p] = std::pow(cells.volume[free.cell[p]], (Dim - 1.0) / Dim);
  }
  const auto evaluate_at = [&](const Eigen::VectorXd& at) {
    for (Eigen::Index p = 0; p < places; ++p) displacement[free.cell[p]] = at.segment<Dim>(p * Dim);
    evaluate(displacement);
    double square = 0.0;
    balance.worst_imbalance = -1.0;
    const double scale = stress_scale<Dim>(tissue);
    for (Eigen::Index p = 0; p < places; ++p) {
      const Vec<Dim>& f = tissue.force[free.cell[p]];
      r.segment<Dim>(p * Dim) = f;
      const double relative = f.norm() / (scale * faces[p]);
      square += relative * relative;
      if (!(relative <= balance.worst_imbalance)) {
        balance.worst_imbalance = relative;
        balance.worst_cell = static_cast<std::size_t>(free.cell[p]);
      }
    }
    balance.imbalance = places > 0 ? std::sqrt(square / static_cast<double>(places)) : 0.0;
  };

  Mixing mixing;
  std::vector<std::int64_t> touched;
  bool built = matrix != nullptr && !matrix->id.empty(), fresh = false;
  if (built) touched = matrix->is_touched;
  int halvings = 0, rebuilds = 0;
  double best = 0.0;
  Eigen::VectorXd best_x, step;
  for (;; ++balance.iterations) {
    evaluate_at(x);
    if (!std::isfinite(balance.imbalance)) return balance;
    if (balance.imbalance <= tolerance) {
      balance.found = true;
      if (matrix && largest_strain2<Dim>(tissue, free, x) > short_strain * short_strain) *matrix = {};
      return balance;
    }
    if (balance.iterations >= most_iterations) return balance;
    // a step that made it worse is halved, from the best so far
    if (balance.iterations > 0 && balance.imbalance > 2.0 * best && halvings < most_halvings) {
      ++halvings;
      step *= 0.5;
      x = best_x + step;
      continue;
    }
    if (balance.iterations == 0 || balance.imbalance < best) {
      best = balance.imbalance;
      best_x = x;
      halvings = 0;
    }
    const std::vector<Mat<Dim>> touching = contact();
    std::vector<std::int64_t> now = touched_places<Dim>(tissue, free, touching);
    const bool too_old = !fresh && balance.iterations >= most_kept_iterations;
    if (!built || too_old || (rebuilds < most_rebuilds && now != touched)) {
      touched = std::move(now);
      if (matrix) *matrix = {};
      if (!preconditioner.build(tissue, terms, free, touching, dt_h)) return balance;
      if (matrix) {
        for (const std::int32_t i : free.cell) matrix->id.push_back(cells.cell_id[i]);
        matrix->is_touched = touched;
        matrix->dt_h = dt_h;
      }
      built = fresh = true;
      ++rebuilds;
      mixing.forget();
    }
    preconditioner.apply(r, z);
    mixing.improve(x, r, z);
    step = z;
    const double strain2 = largest_strain2<Dim>(tissue, free, step);
    if (strain2 > most_strain * most_strain) step *= most_strain / std::sqrt(strain2);
    x += step;
  }
}

template class QuasiStatic<2>;
template class QuasiStatic<3>;

}  // namespace rootsoil
