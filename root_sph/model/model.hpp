// SPDX-License-Identifier: MIT
// Scene -> model: the solver, its cells at time 0 and the effects that the scene calls for.
#pragma once

#include <memory>

#include "root_sph/effects/table.hpp"
#include "root_sph/model/initial_cells.hpp"
#include "root_sph/model/theory.hpp"

namespace rootsoil {

/// A solver with the effects that its scene calls for, and nothing else.
template <int Dim>
struct Model {
  explicit Model(const SolverOptions& options) : solver(options) {}
  Solver<Dim> solver;
  EffectList<Dim> effects;
  InitialReport initial;
};

/// Throws InputError where the law loses hyperbolicity anywhere on the root and the scene does not allow it.
template <int Dim>
void refuse_unstable_law(const Scene& scene);

/// The step, h: numerics.step_h, or chosen for the accuracy wanted (docs/decisions/0004). A divisor of the output
/// interval, so that frames fall on steps.
template <int Dim>
double choose_step_h(const Scene& scene);

/// \param services what the run offers; without a soil, an effect that needs one is left out
template <int Dim>
std::unique_ptr<Model<Dim>> build_model(const Scene& scene, const Services& services = {});

}  // namespace rootsoil
