// SPDX-License-Identifier: MIT
// What soil the user asked for: plain, validated values. Nothing here knows which engine moves the grains.
//
// Units: mm, h, MPa, N; densities in N h^2/mm^4. In 2D the soil is one layer of spheres in the plane z = 0.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "root_sph/core/enum_names.hpp"
#include "root_sph/exchange/soil_port.hpp"

namespace rootsoil {

enum class SoilShape { box, plate, stone, clump, gap };
template <>
inline constexpr EnumName<SoilShape> enum_names<SoilShape>[] = {{SoilShape::box, "box"},
                                                                {SoilShape::plate, "plate"},
                                                                {SoilShape::stone, "stone"},
                                                                {SoilShape::clump, "clump"},
                                                                {SoilShape::gap, "gap"}};

/// mixed: servo, but the wall that the root grows towards is fixed.
enum class SoilWalls { rigid, servo, mixed };
template <>
inline constexpr EnumName<SoilWalls> enum_names<SoilWalls>[] = {
    {SoilWalls::rigid, "rigid"}, {SoilWalls::servo, "servo"}, {SoilWalls::mixed, "mixed"}};

enum class ContactLaw { linear, hertz_mindlin, cohesive };
template <>
inline constexpr EnumName<ContactLaw> enum_names<ContactLaw>[] = {
    {ContactLaw::linear, "linear"}, {ContactLaw::hertz_mindlin, "hertz_mindlin"}, {ContactLaw::cohesive, "cohesive"}};

/// A rigid body inside the soil; the root and the grains both meet it. A gap is a place without grains.
struct SoilObstacle {
  std::string name;
  SoilShape shape = SoilShape::box;
  Vec3 position_mm{};         ///< centre
  Vec3 half_size_mm{};        ///< box, gap: half the sides (2D: z is filled in)
  double length_mm = 0.0;     ///< plate: its side; 3D: both sides
  double thickness_mm = 0.1;  ///< plate
  double angle_deg = 0.0;     ///< box, plate, gap, clump: turned about z
  double radius_mm = 0.0;     ///< stone; clump: radius that encloses its three balls
  bool movable = false;       ///< stone, clump: pushed aside like a grain
};

/// A grain that the user lists.
struct SoilGrain {
  Vec3 centre_mm{};
  double radius_mm = 0.0;
};

struct SoilRecipe {
  int dimension = 2;
  // box
  Vec3 box_from_mm{}, box_to_mm{};
  SoilWalls walls = SoilWalls::mixed;
  double confining_pressure_MPa = 0.0;
  // grains
  double d_min_mm = 0.0, d_max_mm = 0.0;   ///< diameters, evenly spread in between
  double d_mean_mm = 0.0, d_spread = 0.0;  ///< instead: mean and relative half-width; after validation both are set
  std::string grains_file;                 ///< instead of packing: CSV x_mm, y_mm, z_mm, radius_mm
  std::vector<SoilGrain> grains;           ///< of grains_file
  ContactLaw contact_law = ContactLaw::linear;
  double E_MPa = 0.0;
  double poisson = 0.3;        ///< linear, cohesive: tangential over normal stiffness; hertz_mindlin: Poisson's ratio
  double friction_deg = 30.0;  ///< grain on grain
  double root_friction_deg = 20.0;         ///< root on grain: the smaller of the two angles holds
  double rolling = 0.0;                    ///< rolling moment over normal force x radius
  double cohesion_MPa = 0.0;               ///< of bonds between grains that touch at the start
  std::optional<double> density_N_h2_mm4;  ///< absent: from inertial_number_max
  double inertial_number_max = 0.01;
  // packing
  std::optional<double> porosity;  ///< absent: what compaction_friction_deg gives
  double compaction_friction_deg = 2.0;
  std::int64_t seed = 1;
  // running
  double step_safety = 0.5;  ///< substep over the grains' P-wave step
  double damping = 0.3;      ///< YADE's local damping of the grains
  std::int64_t threads = 1;  ///< more than one: results are no longer bit-identical
  std::vector<SoilObstacle> obstacles;

  /// 2D: depth of the layer, by which forces are divided to give N per mm of depth. 3D: 1.
  double layer_mm() const { return dimension == 2 ? d_mean_mm : 1.0; }
};

/// A probe that is pushed into the soil in the root's place, at a constant rate.
struct Penetrometer {
  double diameter_mm = 0.0;
  double cone_angle_deg = 180.0;  ///< full angle of the tip; 180: round
  double rate_mm_h = 0.0;
  double depth_mm = 0.0;                  ///< at the end
  std::optional<double> average_from_mm;  ///< Q is the mean from this depth on; absent: the last millimetre
  std::optional<double> friction_deg;     ///< absent: root_friction_deg
  std::int64_t seeds = 3;
  std::optional<double> interval_h;  ///< between two readings; absent: a hundredth of the diameter's time
  std::optional<double> turgor_MPa;  ///< for the paper's p = turgor - Q/4
};

/// What a soil must know about the root before the first interval.
struct SoilStart {
  double root_speed_mm_h = 0.0;   ///< expected; sets the grains' density where the recipe gives none
  double root_diameter_mm = 0.0;  ///< idem
  std::vector<Vec3> body_mm;      ///< balls that fill the root (its cells): where no grain can be
  std::vector<double> body_radius_mm;
  std::string log_file;                              ///< for what the soil's process says; empty: kept in memory
  std::function<void(const std::string&)> progress;  ///< long preparations say how far they are
};

/// Grain density for which shearing at root_speed/root_diameter has the inertial number I = rate d sqrt(rho/P).
inline double quasi_static_density_N_h2_mm4(const SoilRecipe& recipe, double speed_mm_h, double diameter_mm) {
  const double rate_per_h = speed_mm_h / diameter_mm;
  const double root = recipe.inertial_number_max / (rate_per_h * recipe.d_mean_mm);
  return recipe.confining_pressure_MPa * root * root;
}

/// As the recipe gives it, or derived: infinite, or not a number, where nothing is expected to move.
inline double expected_density_N_h2_mm4(const SoilRecipe& recipe, double speed_mm_h, double diameter_mm) {
  return recipe.density_N_h2_mm4.value_or(quasi_static_density_N_h2_mm4(recipe, speed_mm_h, diameter_mm));
}

/// Makes the soil of a recipe: a penetrometer needs one a seed.
using SoilPortFactory = std::function<std::unique_ptr<SoilPort>(const SoilRecipe&, const SoilStart&)>;

}  // namespace rootsoil
