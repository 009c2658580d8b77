// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/bookkeeping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "root_sph/core/vec3.hpp"

namespace rootsoil {
namespace {

/// Of the two columns of pairs, the one.
std::vector<std::int64_t> member(const std::vector<std::array<std::int64_t, 2>>& pairs, std::size_t which) {
  std::vector<std::int64_t> ids;
  ids.reserve(pairs.size());
  for (const auto& pair : pairs) ids.push_back(pair[which]);
  return ids;
}

}  // namespace

double thrust_within_N(std::span<const MarkerThrust> thrust, double within_mm) {
  double sum = 0.0;
  for (const MarkerThrust& t : thrust) {
    if (t.distance_to_tip_mm <= within_mm) sum += t.thrust_N;
  }
  return sum;
}

double expected_tip_speed_mm_h(std::span<const MarkerThrust> thrust, const RootSize& root,
                               const std::function<double(double s_mm)>& axial_rate_per_h) {
  if (!(root.arrest_N > 0.0)) return 0.0;
  const auto bins = static_cast<std::size_t>(std::ceil(root.length_mm / root.bin_mm));
  std::vector<double> in_bin(bins, 0.0);
  for (const MarkerThrust& t : thrust) {
    const double s = std::max(0.0, t.distance_to_tip_mm);
    in_bin[std::min(bins - 1, static_cast<std::size_t>(s / root.bin_mm))] += t.thrust_N;
  }
  const double width = root.length_mm / static_cast<double>(bins);
  double speed = 0.0, sum = 0.0;
  for (std::size_t b = 0; b < bins; ++b) {
    sum += in_bin[b];
    const double rate = axial_rate_per_h((static_cast<double>(b) + 0.5) * width);
    speed += width * rate * std::max(0.0, 1.0 - sum / root.arrest_N);
  }
  return speed;
}

void SoilBooks::root_did(std::span<const double> work_Nmm) {
  for (const double work : work_Nmm) root_work_Nmm_ += work;
}

void SoilBooks::soil_received(std::span<const double> work_Nmm) {
  for (const double work : work_Nmm) soil_work_Nmm_ += work;
}

void SoilBooks::expect(double tip_speed_mm_h, double window_h, double time_h, double length_mm) {
  if (from_h_ < 0.0) {
    from_h_ = time_h;
    from_mm_ = length_mm;
  }
  expected_path_mm_ += window_h * tip_speed_mm_h;
}

std::string SoilBooks::closing_remark(double time_h, double length_mm) const {
  const double hours = time_h - from_h_;
  if (from_h_ < 0.0 || hours <= 0.0) return "";
  const double measured = (length_mm - from_mm_) / hours;
  constexpr double late = 0.1;  // forces that build up are felt an interval late: some per cent
  const double apart = soil_work_Nmm_ > 0.0 ? 1.0 - root_work_Nmm_ / soil_work_Nmm_ : 0.0;
  return fmt::format(
      "soil: tip speed {:.4f} mm/h; from the soil's forces it should be {:.4f} mm/h, V0 (1 - F/(p (1 - "
      "nu_A) W)) along the root; work of the root {:.4g} N mm, received by the soil {:.4g} N mm{}",
      measured, expected_path_mm_ / hours, root_work_Nmm_, soil_work_Nmm_,
      std::abs(apart) > late ? fmt::format(", {:.0f} % apart: root and soil do not feel the same forces, exchange them "
                                           "more often (soil.contact.interval_h) or run for longer",
                                           100.0 * std::abs(apart))
                             : std::string());
}

void SoilBooks::save(std::map<std::string, std::vector<double>>& reals) const {
  reals["soil/sums"] = {root_work_Nmm_, soil_work_Nmm_, expected_path_mm_, from_h_, from_mm_};
}

void SoilBooks::restore(const std::map<std::string, std::vector<double>>& reals) {
  const std::vector<double>& sums = reals.at("soil/sums");
  std::size_t at = 0;
  for (double* x : {&root_work_Nmm_, &soil_work_Nmm_, &expected_path_mm_, &from_h_, &from_mm_}) *x = sums.at(at++);
}

void EnergyCheck::root_did(std::span<const double> work_Nmm) {
  for (const double work : work_Nmm) excess_Nmm_ -= work;
}

std::optional<std::string> EnergyCheck::soil_received(std::span<const double> work_Nmm, double share, double interval_h,
                                                      double time_h, double growth_power_Nmm_h) {
  for (const double work : work_Nmm) excess_Nmm_ += share * work;
  done_ += 1.0;
  if (done_ < intervals) return {};
  const double excess_Nmm = std::exchange(excess_Nmm_, 0.0), hours = std::exchange(done_, 0.0) * interval_h;
  const double ratio = excess_Nmm / (growth_power_Nmm_h * hours);
  if (!(growth_power_Nmm_h > 0.0 && ratio > std::max(allowed, 2.0 * worst_))) return {};
  worst_ = ratio;
  return fmt::format(
      "the coupling pumps energy: in the {:.3g} h before {:.4g} h the soil received {:.3g} N mm more than the root "
      "did, {:.2g} of the arresting force times the free speed ({:.2g} are allowed); forces held for the interval of "
      "{:.3g} h swing against stiff contacts, so take a shorter soil.contact.interval_h (and numerics.window_steps), "
      "or against rigid walls soil.contact.stiffness_predictor",
      hours, time_h, excess_Nmm, ratio, allowed, interval_h);
}

void EnergyCheck::save(std::map<std::string, std::vector<double>>& reals) const {
  reals["soil/energy_check"] = {excess_Nmm_, done_, worst_};
}

void EnergyCheck::restore(const std::map<std::string, std::vector<double>>& reals) {
  const std::vector<double>& state = reals.at("soil/energy_check");
  excess_Nmm_ = state.at(0);
  done_ = state.at(1);
  worst_ = state.at(2);
}

std::vector<std::pair<std::string, double>> soil_history(const MarkerTotals& totals, const SoilBooks& books,
                                                         const std::map<std::string, double>& numbers) {
  std::vector<std::pair<std::string, double>> row{
      {"soil_markers", static_cast<double>(totals.markers)},
      {"soil_contacts", static_cast<double>(totals.in_touch)},
      {"soil_tip_force_N", totals.tip_thrust_N},
      {"soil_tip_resistance_MPa", totals.tip_thrust_N / totals.section},  // what a penetrometer's Q is for the root
      {"soil_axial_force_N", totals.thrust_N},
      {"soil_load_N", totals.load_N},
      {"soil_root_work_Nmm", books.root_work_Nmm()},
      {"soil_received_work_Nmm", books.soil_work_Nmm()},
      {"soil_expected_tip_speed_mm_h", totals.expected_tip_speed_mm_h}};
  row.insert(row.end(), numbers.begin(), numbers.end());
  return row;
}

FrameTable marker_table(MarkerSnapshot markers) {
  std::vector<double> radius(markers.id.size(), markers.radius_mm);
  return {"markers",
          {{"position", "mm", "centre of the surface marker", 3, flat(markers.position_mm)},
           {"radius", "mm", "radius of the marker; it touches the tissue's surface from within", 1, std::move(radius)},
           {"force", "N", "of the soil on the marker, mean over the latest interval", 3, flat(markers.force_N)},
           {"contact_stiffness", "N/mm", "of the marker's contacts", 1, std::move(markers.stiffness_N_mm)},
           {"marker_id", "1", "unique number of the marker", 1, std::move(markers.id)}}};
}

std::vector<FrameTable> soil_tables(SoilSnapshot soil) {
  if (soil.id.empty()) return {};
  for (auto& s : soil.stress_MPa) std::rotate(s.begin() + 3, s.end() - 1, s.end());  // frames: xx yy zz xy yz xz
  constexpr const char* who = "grain_id of the body; -1 root, -2 wall, -3 obstacle";
  return {{"grains",
           {{"position", "mm", "centre of the grain", 3, flat(soil.position_mm)},
            {"radius", "mm", "radius of the grain", 1, std::move(soil.radius_mm)},
            {"velocity", "mm/h", "velocity of the grain", 3, flat(soil.velocity_mm_h)},
            {"contacts", "1", "bodies that the grain touches", 1, std::move(soil.contacts)},
            {"stress", "MPa", "mean stress in the grain, tension positive", 6, flat(soil.stress_MPa)},
            {"grain_id", "1", "unique number of the grain", 1, std::move(soil.id)}}},
          {"soil_contacts",
           {{"position", "mm", "where two bodies touch", 3, flat(soil.contact_position_mm)},
            {"force", "N", "on the first body (2D: per mm of depth)", 3, flat(soil.contact_force_N)},
            {"first_id", "1", who, 1, member(soil.contact_ids, 0)},
            {"second_id", "1", who, 1, member(soil.contact_ids, 1)}}}};
}

}  // namespace rootsoil
