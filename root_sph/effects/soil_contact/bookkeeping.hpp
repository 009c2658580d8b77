// SPDX-License-Identifier: MIT
// What a run tells of root and soil: work, thrust, the speed that the forces allow, columns and tables.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/exchange/soil_port.hpp"
#include "root_sph/io/frame.hpp"

namespace rootsoil {
/// The root as far as the check knows it.
struct RootSize {
  double length_mm = 0.0;
  double bin_mm = 0.0;    ///< resolution of profiles along it
  double arrest_N = 0.0;  ///< thrust that stops its growth, p (1 - nu_A) W
};

/// Axial force of the soil on one marker, compression positive.
struct MarkerThrust {
  double distance_to_tip_mm = 0.0;
  double thrust_N = 0.0;
};

/// On the part of the root within a distance of the tip. Pure.
double thrust_within_N(std::span<const MarkerThrust> thrust, double within_mm);

/// Integral of rate(s) (1 - thrust(s)/(p (1 - nu_A) W)): what the tip speed should be without inertia. With all force
/// at the tip this is V0 (1 - F/(p (1 - nu_A) W)). Pure.
double expected_tip_speed_mm_h(std::span<const MarkerThrust> thrust, const RootSize& root,
                               const std::function<double(double s_mm)>& axial_rate_per_h);

/// Sums over the run. Work comes as one number a marker and is added in this order.
class SoilBooks {
 public:
  void root_did(std::span<const double> work_Nmm);
  void soil_received(std::span<const double> work_Nmm);
  /// A window ends in which the tip should have grown at this speed; the first one marks where the comparison begins.
  void expect(double tip_speed_mm_h, double window_h, double time_h, double length_mm);

  double root_work_Nmm() const { return root_work_Nmm_; }
  double soil_work_Nmm() const { return soil_work_Nmm_; }
  /// Speed and work, now; empty before there is something to compare.
  std::string closing_remark(double time_h, double length_mm) const;

  void save(std::map<std::string, std::vector<double>>& reals) const;
  void restore(const std::map<std::string, std::vector<double>>& reals);

 private:
  double root_work_Nmm_ = 0.0, soil_work_Nmm_ = 0.0;
  double expected_path_mm_ = 0.0, from_h_ = -1.0, from_mm_ = 0.0;
};

/// Sees whether forces that are held through an interval pump energy. Root and soil feel forces an interval apart; what
/// the soil receives beyond what the root did comes from nowhere. It is small where the soil yields, whatever the
/// contacts' stiffness, and grows without end where the root swings against rigid walls (docs/decisions/0018).
class EnergyCheck {
 public:
  static constexpr int intervals = 25;     ///< looked at together
  static constexpr double allowed = 0.05;  ///< of the arresting force times the free speed

  void root_did(std::span<const double> work_Nmm);
  /// An interval of this length ended. \param share of the soil's forces that acted on the root
  /// \param growth_power_Nmm_h arresting force times free speed
  /// Returns what to tell the user, the first time, and when it got twice as bad.
  std::optional<std::string> soil_received(std::span<const double> work_Nmm, double share, double interval_h,
                                           double time_h, double growth_power_Nmm_h);

  void save(std::map<std::string, std::vector<double>>& reals) const;
  void restore(const std::map<std::string, std::vector<double>>& reals);

 private:
  double excess_Nmm_ = 0.0;  ///< soil's less root's, of the intervals looked at now
  double done_ = 0.0;        ///< so many
  double worst_ = 0.0;       ///< excess over growth's, the largest that was reported
};

/// What history.csv tells of the markers.
struct MarkerTotals {
  std::size_t markers = 0, in_touch = 0;
  double load_N = 0.0;  ///< sum of the magnitudes
  double tip_thrust_N = 0.0, thrust_N = 0.0;
  double section = 0.0;  ///< of the root, mm^2 (2D: mm)
  double expected_tip_speed_mm_h = 0.0;
};

/// Columns of history.csv: the root's, then the soil's own.
std::vector<std::pair<std::string, double>> soil_history(const MarkerTotals& totals, const SoilBooks& books,
                                                         const std::map<std::string, double>& numbers);

/// Surface markers, for the frames.
struct MarkerSnapshot {
  std::vector<std::int64_t> id;
  std::vector<Vec3> position_mm, force_N;
  std::vector<double> stiffness_N_mm;
  double radius_mm = 0.0;
};
FrameTable marker_table(MarkerSnapshot markers);

/// Grains and contacts of a soil, for the frames; a soil without grains has none.
std::vector<FrameTable> soil_tables(SoilSnapshot soil);

}  // namespace rootsoil
