// SPDX-License-Identifier: MIT
#include "root_sph/effects/obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rootsoil {
namespace {

template <int Dim>
double half_extent(const Mat<Dim>& shape, const Vec<Dim>& normal) {
  return std::sqrt(normal.dot(shape.inverse() * normal));
}

/// N/mm: pressure E_c depth/(2h) on the section V/(2h).
double contact_stiffness(double contact_modulus_MPa, double volume, double half_extent_mm) {
  return contact_modulus_MPa * volume / (4.0 * half_extent_mm * half_extent_mm);
}

}  // namespace

template <int Dim>
Vec<Dim> contact_force(const SurfacePoint<Dim>& surface, double half_extent_mm, double volume, double friction,
                       double contact_modulus_MPa, Vec<Dim>& slip_mm) {
  const double depth = half_extent_mm - surface.distance_mm;
  if (depth <= 0.0) {
    slip_mm.setZero();
    return Vec<Dim>::Zero();
  }
  const double k = contact_stiffness(contact_modulus_MPa, volume, half_extent_mm);
  const double normal = k * depth;
  slip_mm -= slip_mm.dot(surface.normal) * surface.normal;
  const double tangential = k * slip_mm.norm();
  if (tangential > friction * normal) slip_mm *= friction * normal / tangential;
  return normal * surface.normal - k * slip_mm;
}

template <int Dim>
ObstacleEffect<Dim>::ObstacleEffect(Solver<Dim>& solver, ObstacleParameters<Dim> parameters)
    : parameters_(std::move(parameters)),
      solver_(solver),
      slip_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"slip " + parameters_.name, "mm", "tangential displacement since contact began"},
          on_division::copy<Dim, Vec<Dim>>)),
      force_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"contact " + parameters_.name, "N", "force of the obstacle on the cell", Storage::scratch},
          on_division::halve<Dim, Vec<Dim>>)) {
  const std::string name = "obstacle " + parameters_.name;
  solver.hooks().stiffness.emplace_back(
      name, [this](Tissue<Dim>& t, std::vector<Vec<Dim>>& stiffness) { find_near_cells(t, stiffness); });
  solver.hooks().busy.emplace_back(name, [this](Tissue<Dim>&, std::vector<char>& busy) {
    for (const std::size_t i : near_) busy[i] = 1;
  });
  solver.hooks().forces.emplace_back(name, [this](Tissue<Dim>& t, SlipAdvance advance) { add_forces(t, advance); });
}

template <int Dim>
void ObstacleEffect<Dim>::find_near_cells(Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness) {
  auto& cells = tissue.cells;
  near_.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    force_[i].setZero();
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(parameters_.shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    // twice what the cell moves in the window at its present speed, and half a cell
    const double margin = 2.0 * solver_.window_h() * cells.velocity[i].norm() + h;
    if (surface.distance_mm > h + margin) {
      slip_[i].setZero();
      continue;
    }
    near_.push_back(i);
    stiffness[i].array() += contact_stiffness(parameters_.contact_modulus_MPa, cells.volume[i], h);
  }
}

template <int Dim>
void ObstacleEffect<Dim>::add_forces(Tissue<Dim>& tissue, SlipAdvance advance) {
  auto& cells = tissue.cells;
  for (const std::size_t i : near_) {
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(parameters_.shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    Vec<Dim> slip = slip_[i] + advance.used_h * cells.velocity[i];
    force_[i] = contact_force<Dim>(surface, h, cells.volume[i], parameters_.friction, parameters_.contact_modulus_MPa,
                                   slip);
    if (advance.kept_h > 0.0) slip_[i] = slip;
    tissue.force[i] += force_[i];
  }
}

template <int Dim>
void ObstacleEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  add_contact_force<Dim>(near_, force_, columns);
}

template <int Dim>
Vec<Dim> ObstacleEffect<Dim>::contact_force_N() const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const std::size_t i : near_) sum += force_[i];
  return sum;
}

template Vec<2> contact_force<2>(const SurfacePoint<2>&, double, double, double, double, Vec<2>&);
template Vec<3> contact_force<3>(const SurfacePoint<3>&, double, double, double, double, Vec<3>&);
template class ObstacleEffect<2>;
template class ObstacleEffect<3>;

}  // namespace rootsoil
