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
constexpr int most_balanced = 8;  // iterations within the force's tolerance, where friction keeps cells moving
constexpr int mixed_iterations = 30;
constexpr double most_strain = 0.2;  // of a pair's distance in one iteration
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

/// Anderson's mixing: of the iterations so far, the combination whose residual is smallest in the norm of M^-1. M is
/// symmetric: differences of residuals appear in products with M^-1 only, and need not be kept.
class Mixing {
 public:
  void forget() {
    steps_.clear();
    x_.resize(0);
  }
  /// \param x, r, z unknowns, residual, M^-1 r of the latest iteration; on return z is the step to take from x
  void improve(const Eigen::VectorXd& x, const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    if (x_.size() == x.size()) remember(r - r_, {x - x_ + z - z_, z - z_});
    x_ = x;
    r_ = r;
    z_ = z;
    const auto m = static_cast<Eigen::Index>(steps_.size());
    if (m == 0) return;
    Eigen::VectorXd against(m);
    for (Eigen::Index a = 0; a < m; ++a) against[a] = steps_[a].z.dot(r);
    const Eigen::VectorXd share = gram_.topLeftCorner(m, m).completeOrthogonalDecomposition().solve(against);
    for (Eigen::Index a = 0; a < m; ++a) z -= share[a] * steps_[a].after;
  }

 private:
  struct Step {
    Eigen::VectorXd after, z;  // differences of two iterations, of x + z and of z = M^-1 r
  };

  /// And its products with the others: dr . M^-1 dr.
  void remember(const Eigen::VectorXd& dr, Step step) {
    constexpr Eigen::Index most = mixed_iterations;
    if (std::ssize(steps_) == most) {
      steps_.pop_front();
      gram_.topLeftCorner(most - 1, most - 1) = gram_.bottomRightCorner(most - 1, most - 1).eval();
    }
    steps_.push_back(std::move(step));
    const Eigen::Index last = std::ssize(steps_) - 1;
    for (Eigen::Index a = 0; a <= last; ++a) gram_(a, last) = gram_(last, a) = dr.dot(steps_[a].z);
  }

  std::deque<Step> steps_;
  Eigen::MatrixXd gram_ = Eigen::MatrixXd::Zero(mixed_iterations, mixed_iterations);
  Eigen::VectorXd x_, r_, z_;  ///< of the latest iteration; empty: there was none
};

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

/// How far cells move, over their size, the most of all.
template <int Dim>
double largest_move(const Eigen::VectorXd& move, const Eigen::VectorXd& sizes) {
  double largest = 0.0;
  for (Eigen::Index p = 0; p < sizes.size(); ++p) {
    largest = std::max(largest, move.segment<Dim>(p * Dim).norm() / sizes[p]);
  }
  return largest;
}

template <int Dim>
bool same_contacts(const std::vector<Mat<Dim>>& a, const std::vector<Mat<Dim>>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i].isZero(0.0) != b[i].isZero(0.0)) return false;
  }
  return a.size() == b.size();
}

}  // namespace

template <int Dim>
Balance QuasiStatic<Dim>::solve(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, double dt_h, double tolerance,
                                const Evaluate& evaluate, const ContactStiffness& contact,
                                Displacements& displacement) {
  if (!band_) {
    band_ = make_band_preconditioner<Dim>();
    layers_ = make_layer_preconditioner<Dim>();
  }
  const FreeCells free = order_free_cells<Dim>(tissue.cells);
  const auto attempt_with = [&](Preconditioner<Dim>& preconditioner) {
    return attempt(preconditioner, tissue, terms, free, dt_h, tolerance, evaluate, contact, displacement);
  };
  if constexpr (Dim == 2) {
    return attempt_with(*band_);
  } else {
    const double work = band_work<Dim>(tissue.pairs, free);
    if (work < little_work) return attempt_with(*band_);
    const Displacements guess = displacement;
    const Balance balance = attempt_with(*layers_);
    if (balance.found || work >= most_work) return balance;
    displacement = guess;
    return attempt_with(*band_);
  }
}

template <int Dim>
Balance QuasiStatic<Dim>::attempt(Preconditioner<Dim>& preconditioner, const Tissue<Dim>& tissue,
                                  const PairTerms<Dim>& terms, const FreeCells& free, double dt_h, double tolerance,
                                  const Evaluate& evaluate, const ContactStiffness& contact,
                                  Displacements& displacement) const {
  const auto& cells = tissue.cells;
  const auto places = static_cast<Eigen::Index>(free.cell.size());
  Balance balance;
  Eigen::VectorXd x(places * Dim), r(places * Dim), z(places * Dim), sizes(places), faces(places);
  for (Eigen::Index p = 0; p < places; ++p) {
    x.segment<Dim>(p * Dim) = displacement[free.cell[p]];
    sizes[p] = std::pow(cells.volume[free.cell[p]], 1.0 / Dim);
    faces[p] = cells.volume[free.cell[p]] / sizes[p];
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
  std::vector<Mat<Dim>> touching;
  int halvings = 0, rebuilds = 0, iterations_balanced = 0;
  double best = 0.0;
  Eigen::VectorXd best_x, step;
  for (;; ++balance.iterations) {
    evaluate_at(x);
    if (!std::isfinite(balance.imbalance)) return balance;
    const bool balanced = balance.imbalance <= tolerance;
    iterations_balanced = balanced ? iterations_balanced + 1 : 0;
    balance.found = balanced && (balance.imbalance == 0.0 || iterations_balanced > most_balanced);
    if (balance.found) return balance;
    if (balance.iterations >= most_iterations) {
      balance.found = balanced;
      return balance;
    }
    // a step that made it worse is halved, from the best so far
    if (!balanced && balance.iterations > 0 && balance.imbalance > 2.0 * best && halvings < most_halvings) {
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
    std::vector<Mat<Dim>> now = contact();
    if (balance.iterations == 0 || (rebuilds < most_rebuilds && !same_contacts<Dim>(now, touching))) {
      touching = std::move(now);
      if (!preconditioner.build(tissue, terms, free, touching, dt_h)) return balance;
      ++rebuilds;
      mixing.forget();
    }
    preconditioner.apply(r, z);
    balance.found = balanced && largest_move<Dim>(z, sizes) <= tolerance;
    if (balance.found) return balance;
    mixing.improve(x, r, z);
    step = z;
    const double strain = largest_pair_strain<Dim>(tissue, free, step);
    if (strain > most_strain) step *= most_strain / strain;
    x += step;
  }
}

template class QuasiStatic<2>;
template class QuasiStatic<3>;

}  // namespace rootsoil
