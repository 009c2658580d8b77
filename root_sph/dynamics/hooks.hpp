// SPDX-License-Identifier: MIT
// Where effects take part in a run: a list of passes for every phase, filled once when the scene is built. An effect
// that is absent has no entry, so a run loops over exactly what it does. What must come before what is the order of the
// phases; passes of one phase do not depend on each other.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/dynamics/pair_loop.hpp"
#include "root_sph/dynamics/tissue.hpp"

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

  // The window's start, in this order.
  Passes<> loads;         ///< what acts from outside at this time: profiles may follow the pressure
  Passes<> division;      ///< cells may divide
  Passes<> rest;          ///< cells may fall asleep or wake; then distances and neighbours are found
  Passes<> parameters;    ///< distances are known: set what depends on them
  Passes<> acceleration;  ///< add to the prescribed acceleration of cells, which the solver has cleared
  Passes<> operators;     ///< gradient operators are known as well
  Passes<> pair_history;  ///< the pairs of this window carry what survived of the last one's
  Passes<std::vector<Vec<Dim>>&> stiffness;  ///< add to the stability bound, N/mm along the material axes
  Passes<std::vector<Vec<Dim>>&> coupling;   ///< the same for what is coupled from outside, with all else in the bound

  // Every step.
  Passes<> step_loads;
  Passes<SlipAdvance> forces;                        ///< add to the forces of cells
  Passes<std::vector<Mat<Dim>>&> contact_stiffness;  ///< without inertia: add what touches a cell now, N/mm
  Passes<bool&> friction;  ///< without inertia, at a balance: friction follows the forces; true where it matters

  // The window's end, in this order: pairs and deformation of the window are still there; what remains is state.
  Passes<> surface;     ///< what is carried along by the tissue moves
  Passes<> exchange;    ///< motion goes out and forces come in
  Passes<> spacing;     ///< cells may be moved where the tissue stays
  Passes<> perception;  ///< distances and flow are those of the end: what the root notices of the forces on it
  Passes<> watch;       ///< see what has become of it all

  template <class... Arguments>
  static void run(const Passes<Arguments...>& passes, PhaseClock& clock, Tissue<Dim>& tissue, Arguments... arguments) {
    for (const auto& entry : passes) clock.measure(entry.first, [&] { entry.second(tissue, arguments...); });
  }
};

}  // namespace rootsoil
