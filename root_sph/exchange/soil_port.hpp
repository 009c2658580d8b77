// SPDX-License-Identifier: MIT
// The port through which the root and a soil meet: the motion of the root's surface goes out, forces come in. It knows
// neither the tissue nor the soil; whoever implements SoilPort (YADE in another process, a half-space or a bed of
// springs in this one) is chosen when the scene is built.
//
// Vectors have three components in 2D and 3D (2D: z = 0, forces in N per mm of depth).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rootsoil {

using Vec3 = std::array<double, 3>;

/// The root's surface over one coupling interval: a sphere (2D: a disc) per marker, in the same order in every column.
/// A marker moves with constant velocity from start to end. Ids are never used again; one that was not in the interval
/// before is new, one that is missing is gone.
struct SurfaceMotion {
  std::int64_t interval = 0;  ///< counts from 0
  double time_h = 0.0;        ///< at the interval's start
  double duration_h = 0.0;
  std::vector<std::int64_t> id;
  std::vector<Vec3> start_mm;
  std::vector<Vec3> end_mm;
  std::vector<double> radius_mm;
  std::vector<Vec3> spin_per_h;  ///< angular velocity, rad/h; empty: none
};

/// What the soil answers: the mean over the interval of the force on every marker, in the motion's order.
struct SurfaceForces {
  std::vector<Vec3> mean_N;
  std::vector<double> contact_stiffness_N_mm;  ///< of each marker's contacts at the interval's end
  std::vector<Vec3> mean_torque_Nmm;      ///< about the markers' centres (friction acts on their surface); empty: none
  std::map<std::string, double> numbers;  ///< for history.csv, by column name (soil_...)
};

/// The soil at one instant, for output: grains, and the contacts that carry a force.
struct SoilSnapshot {
  std::vector<std::int64_t> id;
  std::vector<Vec3> position_mm, velocity_mm_h;
  std::vector<double> radius_mm;
  std::vector<std::int64_t> contacts;                      ///< real contacts of each grain
  std::vector<std::array<double, 6>> stress_MPa;           ///< xx yy zz yz xz xy, compression negative
  std::vector<Vec3> contact_position_mm, contact_force_N;  ///< force on the first of the two bodies
  std::vector<std::array<std::int64_t, 2>> contact_ids;    ///< of grains; -1: root, -2: wall, -3: obstacle
};

/// A soil, seen from the root. Throws SoilError when it fails; then nothing of the interval counts.
class SoilPort {
 public:
  virtual ~SoilPort() = default;
  virtual SurfaceForces advance(const SurfaceMotion& motion) = 0;
  /// The names of SurfaceForces::numbers, known before the first interval: they head columns of history.csv.
  virtual std::vector<std::string> number_names() const { return {}; }
  /// Writes the soil's state to a file of its own / takes it up again. Afterwards both go on identically, bit for bit.
  virtual void save(const std::filesystem::path& file) = 0;
  virtual void load(const std::filesystem::path& file) = 0;
  /// Grains and contacts now; a soil without grains has none.
  virtual SoilSnapshot snapshot() { return {}; }
};

}  // namespace rootsoil
