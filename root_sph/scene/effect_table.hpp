// SPDX-License-Identifier: MIT
// The one table of effects: what each is called, which section calls for it, what it does, how it is added.
#pragma once

#include "root_sph/effects/effect.hpp"
#include "root_sph/profiles/root_profiles.hpp"
#include "root_sph/scene/scene.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace rootsoil {

/// A solver with the effects that its scene calls for, and nothing else.
template <int Dim>
struct Model {
  explicit Model(const SolverOptions& options) : solver(options) {}
  Solver<Dim> solver;
  std::vector<std::unique_ptr<Effect<Dim>>> effects;
};

struct EffectEntry {
  const char* name;
  const char* section;  ///< the section of the scene file that calls for it
  const char* what;
  const char* pair_term;  ///< what it adds to the pair loop, or ""
  bool (*called_for)(const Scene&);
  void (*add_2d)(const Scene&, Model<2>&);
  void (*add_3d)(const Scene&, Model<3>&);
};

std::span<const EffectEntry> effect_table();

/// Names of the effects that the scene calls for, in the table's order.
std::vector<std::string> active_effects(const Scene& scene);

// Profiles at a pressure differential (Eq. 6, with Eq. 7 where the scene has a response).
RadialModulusProfile radial_modulus_profile(const Scene& scene, double p_MPa);
SofteningProfile softening_profile(const Scene& scene, double p_MPa);
DivisionThresholdProfile division_profile(const Scene& scene);
ElasticConstants elastic_constants(const Scene& scene);
/// numerics.midline_damping_per_h, or what suits the scene.
double midline_damping_per_h(const Scene& scene);
double initial_pressure_MPa(const Scene& scene);

}  // namespace rootsoil
