// SPDX-License-Identifier: MIT
// The penetrometer: a rigid rod that is pushed into the soil at a constant rate. It meets the soil through the same
// port as a root does, as a string of balls along x whose envelope is the rod.
#pragma once

#include <filesystem>
#include <vector>

#include "root_sph/exchange/soil_recipe.hpp"

namespace rootsoil {

/// The rod's balls: centres on its axis, as distances behind its foremost point, and radii. The first `tip` of them
/// make up the cone, the shoulder included.
struct Rod {
  std::vector<double> behind_mm, radius_mm;
  std::size_t tip = 0;
};

/// Balls t behind the apex of a cone of half angle a have the radius t sin a; the apex is rounded off by a ball of a
/// tenth of the radius, and the shoulder runs into the shaft without an edge. Neighbours are closer than a fifth of
/// their radius, so that grains slide as on a smooth rod.
Rod make_rod(const Penetrometer& probe, double length_mm);

struct PenetrometerReading {
  std::int64_t seed = 0;
  double depth_mm = 0.0;       ///< of the foremost point, at the interval's middle
  double Q_MPa = 0.0;          ///< axial force on the tip over the rod's section
  double shaft_force_N = 0.0;  ///< axial, on the rest (2D: per mm)
  double inertial_number = 0.0;
  double overlap_max = 0.0;
};

struct PenetrometerResult {
  std::vector<PenetrometerReading> readings;  ///< by seed, then depth
  std::vector<double> Q_of_seed_MPa;          ///< mean from average_from_mm on
  double Q_MPa = 0.0;                         ///< mean over the seeds
  double Q_deviation_MPa = 0.0;               ///< standard deviation over the seeds; 0 with one seed
  double Q_fluctuation_MPa = 0.0;             ///< standard deviation along the way, mean over the seeds
  double inertial_number = 0.0;
  bool interrupted = false;  ///< there are readings, but no means of the last seed
};

/// Thrown by whoever hears of the progress, to stop.
struct Interrupted {};

/// Pushes the probe into one sample for each seed. `progress` is called at every interval and while samples are made;
/// when it throws Interrupted, the result holds what was read so far.
PenetrometerResult penetrate(const SoilRecipe& recipe, const Penetrometer& probe, const SoilPortFactory& make_soil,
                             const std::function<void(const std::string&)>& progress = {});

/// The command: pushes, writes penetrometer.csv and penetrometer.json into the folder, prints what was found.
/// InputError where the folder holds results already.
int run_penetrometer(const SoilRecipe& recipe, const Penetrometer& probe, const std::filesystem::path& folder,
                     bool quiet);

}  // namespace rootsoil
