// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "root_sph/core/errors.hpp"

namespace rootsoil {

template <int Dim>
Vec<Dim> predicted_force(const Vec<Dim>& force_N, double stiffness_N_mm, const Vec<Dim>& moved_mm) {
  constexpr double most = 4.0;
  const double size = force_N.norm();
  if (size <= 0.0) return force_N;
  const double grown = size - stiffness_N_mm * moved_mm.dot(force_N) / size;
  return force_N * (std::clamp(grown, 0.0, most * size) / size);
}

template <int Dim>
ContactResponse<Dim> balanced_response(const MarkerForce<Dim>& measured, const Vec<Dim>& moved_mm,
                                       const Vec<Dim>& pace_mm, bool yields) {
  const double size = measured.force_N.norm(), k = measured.stiffness_N_mm;
  if (size <= 0.0) return {};
  const Vec<Dim> line = measured.force_N / size, way_mm = measured.moved_mm + moved_mm,
                 beyond_mm = way_mm - measured.expected_mm - pace_mm;
  const Mat<Dim> along = line * line.transpose(), across = Mat<Dim>::Identity() - along;
  ContactResponse<Dim> response;
  const double grown = size - k * (yields ? beyond_mm : way_mm).dot(line);
  if (grown > 0.0) {
    response.force_N = grown * line;
    response.stiffness_N_mm = k * along;
  }
  const Vec<Dim> held = -k * (across * beyond_mm);
  const double holding = held.norm();
  if (holding <= size) response.stiffness_N_mm += k * across;
  response.force_N += holding <= size ? held : Vec<Dim>(size / holding * held);
  return response;
}

double ramp(double time_h, double ramp_h) { return ramp_h > 0.0 ? std::clamp(time_h / ramp_h, 0.0, 1.0) : 1.0; }

template <int Dim>
WindowForces<Dim>::WindowForces(SurfaceMapping<Dim> mapping, std::vector<MarkerForce<Dim>> measured, double share,
                                std::span<const Vec<Dim>> positions, bool yields)
    : mapping_(std::move(mapping)),
      measured_(std::move(measured)),
      share_(share),
      yields_(yields),
      start_mm_(positions.begin(), positions.end()),
      applied_from_mm_(measured_.size(), Vec<Dim>::Zero()) {
  ROOTSOIL_ASSERT(mapping_.markers() == measured_.size());
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    anchor_mm_.push_back(mapping_.interpolate(m, positions));
    applied_N_.push_back(share_ * measured_[m].force_N);
  }
}

template <int Dim>
std::map<std::size_t, double> WindowForces<Dim>::stiffness() const {
  std::map<std::size_t, double> rows;
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    if (measured_[m].stiffness_N_mm <= 0.0) continue;
    double sum = 0.0;
    for (const auto& s : mapping_.shares(m)) sum += std::abs(s.weight);
    for (const auto& s : mapping_.shares(m)) {
      rows[static_cast<std::size_t>(s.cell)] += share_ * measured_[m].stiffness_N_mm * sum * std::abs(s.weight);
    }
  }
  return rows;
}

template <int Dim>
std::vector<std::size_t> WindowForces<Dim>::spread(std::span<Vec<Dim>> force_N) const {
  std::vector<std::size_t> loaded;
  for (Vec<Dim>& f : force_N) f.setZero();
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    const Spin<Dim> torque = share_ * measured_[m].torque_Nmm;
    if (applied_N_[m].isZero(0.0) && torque.isZero(0.0)) continue;
    mapping_.spread(m, applied_N_[m], torque, force_N);
    for (const auto& s : mapping_.shares(m)) loaded.push_back(static_cast<std::size_t>(s.cell));
  }
  std::sort(loaded.begin(), loaded.end());
  loaded.erase(std::unique(loaded.begin(), loaded.end()), loaded.end());
  return loaded;
}

template <int Dim>
std::vector<double> WindowForces<Dim>::follow(std::span<const Vec<Dim>> positions) {
  std::vector<double> work_Nmm;
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    const MarkerForce<Dim>& measured = measured_[m];
    if (measured.stiffness_N_mm <= 0.0) continue;
    const Vec<Dim> moved = mapping_.interpolate(m, positions) - anchor_mm_[m];
    work_Nmm.push_back(-applied_N_[m].dot(moved - applied_from_mm_[m]));
    applied_from_mm_[m] = moved;
    applied_N_[m] = share_ * predicted_force<Dim>(measured.force_N, measured.stiffness_N_mm, measured.moved_mm + moved);
  }
  return work_Nmm;
}

template <int Dim>
ContactResponse<Dim> WindowForces<Dim>::response(std::size_t marker, const Vec<Dim>& moved_mm, double part) const {
  ContactResponse<Dim> whole =
      balanced_response<Dim>(measured_[marker], moved_mm, part * measured_[marker].pace_mm, yields_);
  return {share_ * whole.force_N, share_ * whole.stiffness_N_mm};
}

template <int Dim>
std::vector<double> WindowForces<Dim>::balance(std::span<const Vec<Dim>> positions, double part, bool keep) {
  std::vector<double> work_Nmm;
  for (std::size_t m = kept_N_.size(); m < measured_.size(); ++m) {
    kept_N_.push_back(share_ *
                      balanced_response<Dim>(measured_[m], Vec<Dim>::Zero(), Vec<Dim>::Zero(), yields_).force_N);
  }
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    if (measured_[m].stiffness_N_mm <= 0.0) continue;
    const Vec<Dim> moved = mapping_.interpolate(m, positions) - anchor_mm_[m];
    applied_N_[m] = response(m, moved, part).force_N;
    if (!keep) continue;
    // the force changes all the way
    work_Nmm.push_back(-0.5 * (kept_N_[m] + applied_N_[m]).dot(moved - applied_from_mm_[m]));
    applied_from_mm_[m] = moved;
    kept_N_[m] = applied_N_[m];
  }
  return work_Nmm;
}

template <int Dim>
void WindowForces<Dim>::add_stiffness(std::span<const Vec<Dim>> positions, double part,
                                      std::span<Mat<Dim>> stiffness) const {
  for (std::size_t m = 0; m < measured_.size(); ++m) {
    if (measured_[m].stiffness_N_mm <= 0.0) continue;
    const Vec<Dim> moved = mapping_.interpolate(m, positions) - anchor_mm_[m];
    const Mat<Dim> k = response(m, moved, part).stiffness_N_mm;
    double sum = 0.0;
    for (const auto& s : mapping_.shares(m)) sum += std::abs(s.weight);
    for (const auto& s : mapping_.shares(m)) {
      if (static_cast<std::size_t>(s.cell) < stiffness.size()) stiffness[s.cell] += sum * std::abs(s.weight) * k;
    }
  }
}

template <int Dim>
std::vector<MarkerMotion<Dim>> WindowForces<Dim>::motion(std::span<const Vec<Dim>> positions, std::size_t awake) const {
  std::vector<Vec<Dim>> moved_cells(positions.size(), Vec<Dim>::Zero());
  for (std::size_t i = 0; i < awake; ++i) moved_cells[i] = positions[i] - start_mm_[i];
  std::vector<MarkerMotion<Dim>> motion(measured_.size());
  for (std::size_t m = 0; m < motion.size(); ++m) {
    motion[m] = {mapping_.interpolate(m, moved_cells), mapping_.half_curl(m, moved_cells)};
  }
  return motion;
}

template <int Dim>
std::vector<double> WindowForces<Dim>::work_Nmm(const std::vector<MarkerMotion<Dim>>& motion) const {
  std::vector<double> work_Nmm(motion.size());
  for (std::size_t m = 0; m < motion.size(); ++m) {
    work_Nmm[m] = -(applied_N_[m].dot(motion[m].moved_mm - applied_from_mm_[m]) +
                    share_ * measured_[m].torque_Nmm.dot(motion[m].turned));
  }
  return work_Nmm;
}

template Vec<2> predicted_force<2>(const Vec<2>&, double, const Vec<2>&);
template Vec<3> predicted_force<3>(const Vec<3>&, double, const Vec<3>&);
template ContactResponse<2> balanced_response<2>(const MarkerForce<2>&, const Vec<2>&, const Vec<2>&, bool);
template ContactResponse<3> balanced_response<3>(const MarkerForce<3>&, const Vec<3>&, const Vec<3>&, bool);
template class WindowForces<2>;
template class WindowForces<3>;

}  // namespace rootsoil
