// SPDX-License-Identifier: MIT
// What the stepping in time leaves of the balance of forces: a run's own error beside that of its cells' size.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "root_sph/dynamics/solver.hpp"

namespace rootsoil {

/// Over the windows since the latest row of history.csv.
///
/// With inertia, what inertia adds to the axial stress, over p: the mean, since contacts chatter. Without, what the
/// solver of the balance left, the largest: rms over cells of |force|/(p x face of the cell).
template <int Dim>
class Unbalanced {
 public:
  explicit Unbalanced(const Solver<Dim>& solver) : solver_(solver) {}

  bool has_inertia() const { return solver_.tissue().inertia.has_value(); }
  /// Of its column of history.csv, and the beginning of its names in summary.json.
  std::string name() const { return has_inertia() ? "inertia_error" : "force_imbalance"; }
  /// In a sentence.
  std::string what() const { return has_inertia() ? "inertia error" : "force imbalance"; }

  void add_window() {
    if (has_inertia()) {
      impulse_.add_window(solver_.tissue(), solver_.axis(), solver_.window_h());
    } else {
      imbalance_ = std::max(imbalance_, solver_.imbalance());
    }
  }
  double error() const { return has_inertia() ? impulse_.error(solver_.tissue(), solver_.axis()) : imbalance_; }
  /// From here on.
  void begin() {
    impulse_ = {};
    imbalance_ = 0.0;
  }

  std::vector<double> save() const { return has_inertia() ? impulse_.save() : std::vector<double>{imbalance_}; }
  void restore(const std::vector<double>& saved) {
    has_inertia() ? impulse_.restore(saved) : static_cast<void>(imbalance_ = saved.at(0));
  }

 private:
  const Solver<Dim>& solver_;
  InertiaImpulse<Dim> impulse_;
  double imbalance_ = 0.0;
};

}  // namespace rootsoil
