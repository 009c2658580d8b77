// SPDX-License-Identifier: MIT
// Anderson's mixing of the iterations of a fixed point.
#pragma once

#include <Eigen/Dense>
#include <deque>
#include <iterator>
#include <utility>

namespace rootsoil {

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
  static constexpr Eigen::Index most = 20;
  struct Step {
    Eigen::VectorXd after, z;  // differences of two iterations, of x + z and of z = M^-1 r
  };

  /// And its products with the others: dr . M^-1 dr.
  void remember(const Eigen::VectorXd& dr, Step step) {
    if (std::ssize(steps_) == most) {
      steps_.pop_front();
      gram_.topLeftCorner(most - 1, most - 1) = gram_.bottomRightCorner(most - 1, most - 1).eval();
    }
    steps_.push_back(std::move(step));
    const Eigen::Index last = std::ssize(steps_) - 1;
    for (Eigen::Index a = 0; a <= last; ++a) gram_(a, last) = gram_(last, a) = dr.dot(steps_[a].z);
  }

  std::deque<Step> steps_;
  Eigen::MatrixXd gram_ = Eigen::MatrixXd::Zero(most, most);
  Eigen::VectorXd x_, r_, z_;  ///< of the latest iteration; empty: there was none
};

}  // namespace rootsoil
