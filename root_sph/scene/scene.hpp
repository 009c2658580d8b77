// SPDX-License-Identifier: MIT
// What the user asked for: plain, validated values. A section that is absent from the scene file is
// an empty optional here, and then the effect does not exist in the run at all.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/exchange/soil_recipe.hpp"
#include "root_sph/scene/origins.hpp"

namespace rootsoil {

struct SceneSection {
  std::string name;
  int dimension = 2;
  double duration_h = 0.0;
  std::int64_t seed = 1;
  bool allow_unstable = false;
};

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
  std::string cells_file;  ///< as found relative to the scene file
  std::string tip_axis = "+x";
  // both
  std::string base = "clamped";  ///< "clamped" | "free"
  double clamp_length_mm = 0.0;  ///< 0 = three cells
};

struct AnisotropySection {
  double E_radial_max_MPa = 0.0, x_e_mm = 0.0, s_e_per_mm = 0.0, c_e = 0.0;
};

struct TissueSection {
  std::string law = "elastic_growth";  ///< "elastic_growth" | "pressure_deviator"
  double E_axial_MPa = 0.0;
  double nu_axial = 0.06;
  double nu_radial = 0.3;
  double G_MPa = 0.0;  ///< resolved: E_A/(2(1+nu_A)) where the scene gives none
  double rho0_ug_mm3 = 1000.0;
  std::optional<AnisotropySection> anisotropy;
};

/// Piecewise linear in time, constant before the first and after the last row. One row = constant.
struct PressureSection {
  std::vector<std::array<double, 2>> table;  ///< (time_h, differential_MPa), times increasing
};

struct GrowthSection {
  double lambda0_ug_mm3_h = 0.0, x_g_mm = 0.0, s_g_mm = 0.0, c_g = 0.0;
  std::optional<double> mature_at_mm;  ///< absent: Eq. 6 to the letter, growth never ends
  double mature_width_mm = 0.1;
};

struct DivisionSection {
  double l0_mm = 0.0, c_d = 1.0, s_d_per_mm2 = 0.0, x_d_mm = 0.0;
  std::optional<double> constant_beyond_mm;
};

/// Eq. 7: a parameter that is listed here follows the pressure differential, between its value at
/// p_MPa[0] and its value at p_MPa[1], and replaces the one of [growth] or [tissue.anisotropy].
struct ResponseSection {
  struct Growth {
    std::array<double, 2> p_MPa{};
    std::optional<std::array<double, 2>> lambda0_ug_mm3_h, x_g_mm, s_g_mm, c_g;
  };
  struct Anisotropy {
    std::array<double, 2> p_MPa{};
    std::optional<std::array<double, 2>> E_radial_max_MPa, x_e_mm, s_e_per_mm, c_e;
  };
  std::optional<Growth> growth;
  std::optional<Anisotropy> anisotropy;
  bool extrapolate = true;  ///< false: theta is kept within [0, 1]
};

/// A rigid obstacle that pushes cells back by a penalty force with Coulomb friction.
struct ObstacleSection {
  std::string name;
  std::string shape;                       ///< "plane" | "box" | "disc" (2D) | "sphere" (3D)
  std::array<double, 3> position_mm{};     ///< a point of the plane, or the centre
  std::array<double, 3> normal{};          ///< plane: outward, towards the root (unit after validation)
  std::array<double, 3> half_size_mm{};    ///< box
  double angle_deg = 0.0;                  ///< box: turned about z
  double radius_mm = 0.0;                  ///< disc, sphere
  double friction = 0.3;
  double contact_modulus_MPa = 0.0;        ///< resolved: E_axial_MPa where the scene gives none
};

/// Damps and resists pair motions that no velocity gradient can see (docs/physics.md 5.4).
struct NonAffineControlSection {
  double damping = 0.5;     ///< alpha
  double stiffness = 2.0;  ///< times E_axial (docs/decisions/0009)
};

/// Mature tissue that does not move leaves all loops (effects/sleep.hpp).
struct SleepSection {
  std::optional<double> strain_rate_per_h;
  std::optional<double> mean_over_h;    ///< absent: ten windows
  std::optional<double> stress_change;  ///< over the pressure differential
};

/// A point of the tissue followed over time, or a bin at a distance from the tip.
struct ProbeSection {
  std::string name;
  std::optional<std::array<double, 3>> position_mm;           ///< the nearest cell at the start
  std::optional<std::array<double, 2>> distance_to_tip_mm;    ///< bin
};

/// The soil that the root grows through: the recipe, as the engine takes it, and what the scene adds.
struct SoilSection : SoilRecipe {
  std::optional<std::array<double, 2>> d_range_mm;  ///< as given; after validation d_min_mm and d_max_mm
  std::optional<double> d_mean_given_mm;            ///< idem
  std::optional<double> d_spread_given;
  std::int64_t soil_dimension = 0;                  ///< as given; 0: the scene's
};

/// How the root's surface and the soil exchange motion and forces.
struct SoilContactSection {
  double interval_h = 4e-3;                  ///< between two exchanges, rounded to whole windows
  std::optional<double> marker_radius_mm;    ///< absent: one cell
  double marker_spacing = 0.6;               ///< of the radius
  double map_width_cells = 1.4;
  double ramp_h = 0.2;                       ///< forces rise from nothing over this time
  bool stiffness_predictor = false;          ///< for rigid walls
  bool under_relaxation = false;             ///< Aitken's
  std::optional<double> tip_length_mm;       ///< absent: a root's diameter
};

using PenetrometerSection = Penetrometer;

struct NumericsSection {
  std::string accuracy = "balanced";  ///< preset: "fast" | "balanced" | "reference"
  std::optional<double> step_h;       ///< absent: chosen from the preset, see step_choice
  int window_steps = 20;              ///< steps for which neighbours and gradients stay frozen
  std::string kernel = "cell";        ///< "cell" | "isotropic"
  double eta = 1.5;
  double H_bar = 2.0;
  std::string gradient = "quadratic_at_surface";  ///< "plain" | "linear" | "quadratic" | "quadratic_at_surface"
  std::string stepper = "symplectic";  ///< "symplectic" | "predictor_corrector"
  std::string inertia = "tensor";      ///< "tensor" | "scalar"
  bool inertia_compensation = true;
  std::optional<double> mass_damping_per_h;  ///< absent: 0 with growth, twice the lowest frequency without
  std::optional<double> midline_damping_per_h;  ///< absent: 5 for a clamped root that grows without obstacles, else 0
  double artificial_viscosity = 0.0;         ///< bulk pair viscosity (the authors' code uses 0.6-1)
  std::string start = "equilibrium";         ///< "equilibrium": stress p and the closed form's velocity; "rest"
};

struct OutputSection {
  double every_h = 0.0;
  double checkpoint_every_h = 0.0;
  std::vector<std::string> fields;  ///< empty: all
  bool picture = false;             ///< draw overview.png when the run ends
};

struct Scene {
  SceneSection scene;
  RootSection root;
  TissueSection tissue;
  std::optional<PressureSection> pressure;
  std::optional<GrowthSection> growth;
  std::optional<DivisionSection> division;
  std::optional<ResponseSection> response;
  std::optional<NonAffineControlSection> non_affine_control;
  std::optional<SleepSection> sleep;
  std::vector<ObstacleSection> obstacles;
  std::vector<ProbeSection> probes;
  std::optional<SoilSection> soil;
  std::optional<SoilContactSection> soil_contact;  ///< there where the soil is
  std::optional<PenetrometerSection> penetrometer;
  NumericsSection numerics;
  OutputSection output;
  std::string file;  ///< where it was read, for messages
  Origins origins;   ///< and where in it
};

}  // namespace rootsoil
