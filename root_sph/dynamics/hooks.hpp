// SPDX-License-Identifier: MIT
// Where effects take part in a run: lists of passes, filled once when the scene is built. An effect that is absent
// has no entry, so a run loops over exactly what it does.
#pragma once

#include "root_sph/dynamics/pair_loop.hpp"
#include "root_sph/dynamics/tissue.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace rootsoil {

/// Wall time by name, for the summary.
class PhaseClock {
 public:
  template <class Body>
  void measure(const std::string& name, Body&& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    seconds_[name] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  std::map<std::string, double> seconds_;
};

template <int Dim>
struct Hooks {
  template <class... Arguments>
  using Passes = std::vector<std::pair<std::string, std::function<void(Tissue<Dim>&, Arguments...)>>>;

  /// Forces of the outside, N, that cells at rest feel as well.
  struct Load {
    const Field<Dim, Vec<Dim>>* now;
    Field<Dim, Vec<Dim>>* asleep;  ///< when the cell fell asleep
  };

  Passes<> window_start;  ///< before distances and neighbours: cells may divide here
  Passes<> parameters;    ///< distances are known: set what depends on them
  Passes<> operators;     ///< gradient operators are known as well
  Passes<std::vector<Vec<Dim>>&> stiffness;  ///< add to the stability bound, N/mm along the material axes
  Passes<> step_start;
  Passes<SlipAdvance> forces;  ///< add to the forces of cells
  Passes<std::vector<char>&> busy;  ///< mark cells that must not fall asleep, now and then at a window's end
  std::vector<Load> loads;
  Passes<> window_end;         ///< pairs and deformation of the window are still there; what remains is state

  template <class... Arguments>
  static void run(const Passes<Arguments...>& passes, PhaseClock& clock, Tissue<Dim>& tissue, Arguments... arguments) {
    for (const auto& [name, pass] : passes) clock.measure(name, [&] { pass(tissue, arguments...); });
  }
};

}  // namespace rootsoil
