// SPDX-License-Identifier: MIT
// What an effect is before any scene: how a scene file calls for it, what it does, how it is built. Each effect's
// folder defines one; effects/table.cpp lists them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/effects/effect.hpp"
#include "root_sph/exchange/soil_recipe.hpp"
#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// A pressure differential, and what of it the tissue perceives: what responds to pressure (Eq. 7) follows the latter.
struct Pressures {
  double differential_MPa, perceived_MPa;
  Pressures(double p_MPa) : Pressures(p_MPa, p_MPa) {}  ///< nothing pushes
  Pressures(double p_MPa, double felt_MPa) : differential_MPa(p_MPa), perceived_MPa(felt_MPa) {}
  template <int Dim>
  explicit Pressures(const Tissue<Dim>& now) : Pressures(now.pressure_MPa, now.perceived_MPa()) {}
};

/// The root as it would grow with nothing in its way, by the closed form.
struct FreeGrowth {
  std::function<double(double s_mm, const Pressures& p)> axial_rate_per_h;  ///< at a distance from the tip
  /// Axial compression that stops growth.
  std::function<double(const Pressures& p)> arrest_stress_MPa = [](const Pressures& p) { return p.differential_MPa; };
  double fastest_tip_speed_mm_h = 0.0;  ///< that the root can reach in the scene
};

/// Makes the soil of a scene, told about the root. The program hands it in, since root_sph knows no soil.
using SoilMaker = std::function<std::unique_ptr<SoilPort>(const Scene&, const SoilStart&)>;

/// What a run offers to the effects that it builds.
struct Services {
  SoilMaker make_soil = {};   ///< none: what needs a soil is left out (rootsoil check)
  std::string soil_log = {};  ///< file for what the soil's process says
  std::function<void(const std::string&)> say = {};
};

template <int Dim>
using EffectList = std::vector<std::unique_ptr<Effect<Dim>>>;

/// What an effect has at hand when it is built.
template <int Dim>
struct Assembly {
  static constexpr int dimension = Dim;
  const Scene& scene;
  Solver<Dim>& solver;
  EffectList<Dim>& effects;
  const FreeGrowth& free_growth;
  const Services& services;

  /// Constructs an effect; the solver comes first among its arguments.
  template <class E, class... Arguments>
  E& add(Arguments&&... arguments) {
    auto effect = std::make_unique<E>(solver, std::forward<Arguments>(arguments)...);
    E& added = *effect;
    effects.push_back(std::move(effect));
    return added;
  }
};

/// One function for two and three dimensions: `[](auto assembly) { ... }`.
struct BuildEffect {
  std::function<void(Assembly<2>)> in_2d;
  std::function<void(Assembly<3>)> in_3d;

  template <class Build>
  requires std::is_invocable_v<Build, Assembly<2>> BuildEffect(Build build) : in_2d(build), in_3d(build) {}

  template <int Dim>
  void operator()(Assembly<Dim> assembly) const {
    if constexpr (Dim == 2) {
      in_2d(assembly);
    } else {
      in_3d(assembly);
    }
  }
};

/// One function for two and three dimensions: `[](const Scene&, const auto& tissue, const FreeGrowth&) { ... }`.
struct CheckStart {
  std::function<void(const Scene&, const Tissue<2>&, const FreeGrowth&)> in_2d;
  std::function<void(const Scene&, const Tissue<3>&, const FreeGrowth&)> in_3d;

  CheckStart() = default;
  template <class Check>
  requires std::is_invocable_v < Check, const Scene&, const Tissue<2>
  &, const FreeGrowth& > CheckStart(Check check) : in_2d(check), in_3d(check) {}

  template <int Dim>
  void operator()(const Scene& scene, const Tissue<Dim>& tissue, const FreeGrowth& growth) const {
    if constexpr (Dim == 2) {
      if (in_2d) in_2d(scene, tissue, growth);
    } else {
      if (in_3d) in_3d(scene, tissue, growth);
    }
  }
};

/// Whether an effect exerts forces from outside: momentum is theirs, and nothing may damp what they do.
enum class Push {
  none,
  steady,  ///< weight
  arrest,  ///< can stop the root's growth: what inertia adds to the force must stay small
};

struct EffectSpec {
  std::string name;            ///< "growth"
  std::string called_by;       ///< what in the scene file calls for it: "[growth]"
  std::string what;            ///< one sentence
  std::string exact;           ///< the exact answer that it is tested against
  std::string pair_term = {};  ///< what it adds to the pair loop
  Push push = Push::none;
  std::vector<SectionSpec> sections = {};  ///< that it adds to the scene file's language
  std::function<bool(const Scene&)> called_for;
  BuildEffect build;
  CheckStart check_start = {};  ///< InputError where it can't begin with these cells; before a run touches its folder
};

}  // namespace rootsoil
