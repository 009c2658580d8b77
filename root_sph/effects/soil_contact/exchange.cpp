// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/core/vec3.hpp"
#include "root_sph/exchange/under_relaxation.hpp"

namespace rootsoil {
namespace {

constexpr double pace_intervals = 3.0;  // over which a marker's mean path is taken

}  // namespace

template <int Dim>
std::vector<MarkerAnswer<Dim>> checked_answer(const SurfaceMotion& motion, const SurfaceForces& answer) {
  const std::size_t n = motion.id.size();
  const bool torques = !answer.mean_torque_Nmm.empty();
  if (answer.mean_N.size() != n || answer.contact_stiffness_N_mm.size() != n ||
      (torques && answer.mean_torque_Nmm.size() != n)) {
    throw SoilError(fmt::format("the soil answered for {} of {} surface markers at {:.5g} h", answer.mean_N.size(), n,
                                motion.time_h));
  }
  std::vector<MarkerAnswer<Dim>> checked(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec<Dim> force = shortened<Dim>(answer.mean_N[k]);
    const Spin<Dim> torque = torques ? spin_of<Dim>(answer.mean_torque_Nmm[k]) : Spin<Dim>(Spin<Dim>::Zero());
    if (!force.allFinite() || !torque.allFinite() || !std::isfinite(answer.contact_stiffness_N_mm[k])) {
      throw SoilError(
          fmt::format("the soil's force on surface marker {} is not a number at {:.5g} h (position {:.4g}, {:.4g}, "
                      "{:.4g} mm)",
                      motion.id[k], motion.time_h, motion.end_mm[k][0], motion.end_mm[k][1], motion.end_mm[k][2]));
    }
    checked[k] = {force, torque, answer.contact_stiffness_N_mm[k]};
  }
  return checked;
}

template <int Dim>
template <class Visit>
void SoilExchange<Dim>::Load::for_each_number(Visit&& visit) {
  const auto all = [&](auto& vector) {
    for (Eigen::Index k = 0; k < vector.size(); ++k) visit(vector[k]);
  };
  all(force_N);
  all(torque_Nmm);
  visit(stiffness_N_mm);
  all(residual_N);
  all(start_mm);
  all(angle);
  all(path_mm);
  all(pace_mm);
  visit(intervals);
  visit(in_soil);
}

template <int Dim>
SoilExchange<Dim>::SoilExchange(MaterialSurface<Dim> surface, std::unique_ptr<SoilPort> port,
                                ExchangeParameters parameters)
    : parameters_(std::move(parameters)),
      port_(std::move(port)),
      surface_(std::move(surface)),
      load_(surface_.ids().size()) {
  ROOTSOIL_ASSERT(port_ && parameters_.windows_per_interval >= 1);
  for (const std::string& name : port_->number_names()) numbers_[name] = std::numeric_limits<double>::quiet_NaN();
}

template <int Dim>
void SoilExchange<Dim>::begin_interval(double time_h) {
  std::unordered_map<std::int64_t, std::size_t> before;
  for (std::size_t m = 0; m < load_.size(); ++m) before[surface_.ids()[m]] = m;
  surface_.refine();
  std::vector<Load> load(surface_.ids().size());
  for (std::size_t m = 0; m < load.size(); ++m) {
    const auto known = before.find(surface_.ids()[m]);
    if (known != before.end()) load[m] = load_[known->second];
    const Vec<Dim>& x = surface_.positions()[m];
    const bool near = !parameters_.near_soil || parameters_.near_soil(three<Dim>(x));
    if (!near) load[m] = Load{};
    // an id that the soil has seen go does not come back
    if (near && known != before.end() && interval_ > 0 && load[m].in_soil == 0.0) surface_.renew(m);
    load[m].in_soil = near ? 1.0 : 0.0;
    load[m].start_mm = x;
    load[m].angle.setZero();
  }
  load_.swap(load);
  interval_start_h_ = time_h;
}

template <int Dim>
std::vector<MarkerForce<Dim>> SoilExchange<Dim>::forces() const {
  const double whole = parameters_.windows_per_interval;
  std::vector<MarkerForce<Dim>> forces;
  forces.reserve(load_.size());
  for (std::size_t m = 0; m < load_.size(); ++m) {
    const Load& load = load_[m];
    forces.push_back({load.force_N, load.torque_Nmm, load.stiffness_N_mm,
                      0.5 * load.path_mm + surface_.positions()[m] - load.start_mm,
                      (0.5 + windows_done_ / whole) * load.pace_mm, load.pace_mm / whole});
  }
  return forces;
}

template <int Dim>
void SoilExchange<Dim>::move(const std::vector<MarkerMotion<Dim>>& motion, double part) {
  ROOTSOIL_ASSERT(motion.size() == load_.size());
  for (std::size_t m = 0; m < load_.size(); ++m) {
    surface_.positions()[m] += motion[m].moved_mm;
    load_[m].angle += motion[m].turned;
  }
  windows_done_ += part;
}

template <int Dim>
std::vector<double> SoilExchange<Dim>::advance(double time_h) {
  windows_done_ = 0;
  for (std::size_t m = 0; m < load_.size(); ++m) {
    Load& load = load_[m];
    load.path_mm = surface_.positions()[m] - load.start_mm;
    load.intervals = std::min(load.intervals + 1.0, pace_intervals);
    load.pace_mm += (load.path_mm - load.pace_mm) / load.intervals;
  }
  const std::vector<std::size_t> markers = markers_in_soil();
  const SurfaceMotion told = motion(markers, time_h);
  ++interval_;
  const SurfaceForces answer = port_->advance(told);
  const std::vector<MarkerAnswer<Dim>> answers = checked_answer<Dim>(told, answer);
  std::vector<double> received_Nmm;
  for (std::size_t k = 0; k < markers.size(); ++k) {
    const Load& load = load_[markers[k]];
    received_Nmm.push_back(-(answers[k].force_N.dot(load.path_mm) + answers[k].torque_Nmm.dot(load.angle)));
  }
  take(markers, answers);
  for (auto& [name, value] : numbers_) {
    const auto given = answer.numbers.find(name);
    if (given != answer.numbers.end()) value = given->second;
  }
  return received_Nmm;
}

template <int Dim>
std::vector<std::size_t> SoilExchange<Dim>::markers_in_soil() const {
  std::vector<std::size_t> markers;
  for (std::size_t m = 0; m < load_.size(); ++m) {
    if (load_[m].in_soil != 0.0) markers.push_back(m);
  }
  return markers;
}

template <int Dim>
SurfaceMotion SoilExchange<Dim>::motion(const std::vector<std::size_t>& markers, double time_h) const {
  SurfaceMotion motion;
  motion.interval = interval_;
  motion.time_h = interval_start_h_;
  motion.duration_h = time_h - interval_start_h_;
  for (const std::size_t m : markers) {
    motion.id.push_back(surface_.ids()[m]);
    motion.start_mm.push_back(three<Dim>(load_[m].start_mm));
    motion.end_mm.push_back(three<Dim>(surface_.positions()[m]));
    motion.radius_mm.push_back(surface_.size().radius_mm);
    motion.spin_per_h.push_back(axial<Dim>(load_[m].angle / motion.duration_h));
  }
  return motion;
}

/// Without under-relaxation the factor stays 1.
template <int Dim>
void SoilExchange<Dim>::take(const std::vector<std::size_t>& markers, const std::vector<MarkerAnswer<Dim>>& answers) {
  std::vector<Vec<Dim>> residual(markers.size());
  double before_dot_change = 0.0, change_squared = 0.0, residual_squared = 0.0;
  for (std::size_t k = 0; k < markers.size(); ++k) {
    Load& load = load_[markers[k]];
    load.stiffness_N_mm = answers[k].stiffness_N_mm;
    load.torque_Nmm = answers[k].torque_Nmm;
    residual[k] = answers[k].force_N - load.force_N;
    const Vec<Dim> change = residual[k] - load.residual_N;
    before_dot_change += load.residual_N.dot(change);
    change_squared += change.squaredNorm();
    residual_squared += residual[k].squaredNorm();
  }
  if (parameters_.under_relaxation) {
    relaxation_ = aitken_factor(relaxation_, before_dot_change, change_squared, residual_squared);
  }
  for (std::size_t k = 0; k < markers.size(); ++k) {
    load_[markers[k]].force_N += relaxation_ * residual[k];
    load_[markers[k]].residual_N = residual[k];
  }
}

template <int Dim>
void SoilExchange<Dim>::save(std::map<std::string, std::vector<double>>& reals) const {
  surface_.save("soil/marker/", reals);
  std::vector<double>& load = reals["soil/marker/load"];
  for (Load l : load_) l.for_each_number([&](double& x) { load.push_back(x); });
  reals["soil/interval"] = {static_cast<double>(interval_), windows_done_, interval_start_h_, relaxation_};
  std::vector<double>& numbers = reals["soil/numbers"];
  for (const auto& [name, value] : numbers_) numbers.push_back(value);
}

template <int Dim>
void SoilExchange<Dim>::restore(const std::map<std::string, std::vector<double>>& reals) {
  surface_.restore("soil/marker/", reals);
  const std::vector<double>& loads = reals.at("soil/marker/load");
  std::size_t at = 0;
  load_.assign(surface_.ids().size(), Load{});
  for (Load& l : load_) l.for_each_number([&](double& x) { x = loads.at(at++); });
  const std::vector<double>& interval = reals.at("soil/interval");
  interval_ = static_cast<std::int64_t>(interval.at(0));
  windows_done_ = interval.at(1);
  interval_start_h_ = interval.at(2);
  relaxation_ = interval.at(3);
  at = 0;
  for (auto& [name, value] : numbers_) value = reals.at("soil/numbers").at(at++);
}

template std::vector<MarkerAnswer<2>> checked_answer<2>(const SurfaceMotion&, const SurfaceForces&);
template std::vector<MarkerAnswer<3>> checked_answer<3>(const SurfaceMotion&, const SurfaceForces&);
template class SoilExchange<2>;
template class SoilExchange<3>;

}  // namespace rootsoil
