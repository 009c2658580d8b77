// SPDX-License-Identifier: MIT
// What the user asked for: plain, validated values. Every scene has the sections that are members here; sections of
// effects are defined in the effects' folders and kept by type. One that is absent from the scene file is absent here,
// and then the effect does not exist in the run at all.
#pragma once

#include <any>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <typeindex>
#include <vector>

#include "root_sph/core/enum_names.hpp"
#include "root_sph/dynamics/solver_options.hpp"
#include "root_sph/scene/origins.hpp"
#include "root_sph/tissue/laws/laws.hpp"

namespace rootsoil {

struct SceneSection {
  std::string name;
  int dimension = 2;
  double duration_h = 0.0;
  std::int64_t seed = 1;
  bool allow_unstable = false;
};

enum class Base { clamped, free };
template <>
inline constexpr EnumName<Base> enum_names<Base>[] = {{Base::clamped, "clamped"}, {Base::free, "free"}};

enum class TipAxis { found, plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };
template <>
inline constexpr EnumName<TipAxis> enum_names<TipAxis>[] = {
    {TipAxis::found, "auto"}, {TipAxis::plus_x, "+x"}, {TipAxis::minus_x, "-x"}, {TipAxis::plus_y, "+y"},
    {TipAxis::minus_y, "-y"}, {TipAxis::plus_z, "+z"}, {TipAxis::minus_z, "-z"}};

/// Either a capsule filled with a lattice (a rectangle or cylinder with a half disc or half sphere;
/// the base at x = 0, the tip at x = length_mm) or cells measured by microscopy.
struct RootSection {
  // lattice
  double length_mm = 0.0;
  double radius_mm = 0.0;
  double cell_size_mm = 0.0;
  double jitter = 0.0;          ///< displacement of each centre, fraction of the spacing, uniform in [-jitter, jitter]
  double size_variation = 0.0;  ///< cell volumes vary by a factor in [1 - v, 1 + v]
  double curvature_per_mm = 0.0;    ///< initial curvature of the axis, in the x-y plane
  double base_obliquity_deg = 0.0;  ///< angle of the base cut
  bool cap = true;                  ///< false: a plain rectangle or cylinder
  // microscopy
  std::string cells_file;  ///< absolute after reading; empty: a lattice
  TipAxis tip_axis = TipAxis::found;
  // both
  Base base = Base::clamped;
  std::optional<double> clamp_length_mm;  ///< absent: three cells

  bool is_lattice() const { return cells_file.empty(); }
  bool is_clamped() const { return base == Base::clamped; }
};

struct TissueSection {
  TissueLaw law = law_of<ElasticGrowth>;
  double E_axial_MPa = 0.0;
  double nu_axial = 0.06;
  double nu_radial = 0.3;
  std::optional<double> G_MPa;  ///< there after reading: E_A/(2(1+nu_A)) where the scene gives none
  double rho0_ug_mm3 = 1000.0;
};

enum class Accuracy { fast, balanced, reference };
template <>
inline constexpr EnumName<Accuracy> enum_names<Accuracy>[] = {
    {Accuracy::fast, "fast"}, {Accuracy::balanced, "balanced"}, {Accuracy::reference, "reference"}};

enum class Kernel { cell, isotropic };
template <>
inline constexpr EnumName<Kernel> enum_names<Kernel>[] = {{Kernel::cell, "cell"}, {Kernel::isotropic, "isotropic"}};

/// equilibrium: stress p and the closed form's velocity.
enum class Start { equilibrium, rest };
template <>
inline constexpr EnumName<Start> enum_names<Start>[] = {{Start::equilibrium, "equilibrium"}, {Start::rest, "rest"}};

enum class Beyond { tell, stop };
template <>
inline constexpr EnumName<Beyond> enum_names<Beyond>[] = {{Beyond::tell, "tell"}, {Beyond::stop, "stop"}};

struct NumericsSection {
  Accuracy accuracy = Accuracy::balanced;
  std::optional<double> step_h;  ///< absent: chosen from the preset, see model/model.hpp
  int window_steps = 20;         ///< with inertia: steps for which neighbours and gradients stay frozen
  Kernel kernel = Kernel::cell;
  double eta = 1.5;
  double H_bar = 2.0;
  GradientMode gradient = GradientMode::quadratic_at_surface;
  Stepper stepper = Stepper::quasi_static;
  double force_tolerance = 1e-4;  ///< quasi_static: rms force on cells over the pressure differential times their face
  InertiaMode inertia = InertiaMode::tensor;
  bool inertia_compensation = true;
  std::optional<double> mass_damping_per_h;     ///< absent: 0 with growth, twice the lowest frequency without
  std::optional<double> midline_damping_per_h;  ///< absent: 5 for a clamped root that grows and is not pushed, else 0
  double artificial_viscosity = 0.0;            ///< bulk pair viscosity (the authors' code uses 0.6-1)
  Start start = Start::equilibrium;
  double inertia_error_max = 0.05;        ///< share of the pressure differential; beyond it a run leaves its accuracy
  Beyond beyond_accuracy = Beyond::tell;  ///< what a run does then

  bool has_inertia() const { return stepper != Stepper::quasi_static; }
  /// Steps for which neighbours and gradients stay frozen.
  int steps_a_window() const { return has_inertia() ? window_steps : 1; }
};

struct OutputSection {
  double every_h = 0.0;
  std::optional<double> checkpoint_every_h;  ///< there after reading: every_h where the scene gives none
  std::vector<std::string> fields;           ///< empty: all
  bool picture = false;                      ///< draw overview.png when the run ends
};

/// What effects say about a scene that others need to know. Complete when the scene has been read.
struct SceneFacts {
  /// Lowest and highest pressure differential over the whole run, MPa.
  std::array<double, 2> pressure_MPa{0.0, 0.0};
  /// Names of the effects that push the root from outside.
  std::vector<std::string> pushed_by;
  bool can_be_arrested = false;  ///< one of them can stop its growth
  /// Between two exchanges with what is computed elsewhere, h.
  double longest_step_h = std::numeric_limits<double>::infinity();
};

/// Eq. 7 for one section: its keys that follow the pressure differential, by name.
struct Response {
  std::string section;            ///< "growth", "tissue.anisotropy"
  std::array<double, 2> p_MPa{};  ///< where the two values of each pair hold
  std::map<std::string, std::array<double, 2>> pairs;
};

class Scene {
 public:
  SceneSection scene;
  RootSection root;
  TissueSection tissue;
  NumericsSection numerics;
  OutputSection output;
  std::vector<Response> responses;
  bool has_root = true;  ///< false: read for its soil alone (rootsoil penetrometer)
  SceneFacts facts;
  std::string file;  ///< where it was read, for messages
  Origins origins;   ///< and where in it

  /// All sections of a type that an effect defines, in the file's order; for most there is at most one.
  template <class S>
  const std::vector<S>& all() const {
    static const std::vector<S> none;
    const auto found = sections_.find(typeid(S));
    return found == sections_.end() ? none : *std::any_cast<std::vector<S>>(&found->second);
  }
  template <class S>
  std::vector<S>& all() {
    std::any& list = sections_[typeid(S)];
    if (!list.has_value()) list = std::vector<S>{};
    return *std::any_cast<std::vector<S>>(&list);
  }
  /// The section, or nullptr where the scene has none.
  template <class S>
  const S* find() const {
    const std::vector<S>& list = all<S>();
    return list.empty() ? nullptr : &list.front();
  }
  template <class S>
  S* find() {
    std::vector<S>& list = all<S>();
    return list.empty() ? nullptr : &list.front();
  }

 private:
  std::map<std::type_index, std::any> sections_;
};

}  // namespace rootsoil
