// SPDX-License-Identifier: MIT
// What the soil's last answer means for the cells in the window that comes: forces and stiffness.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "root_sph/effects/soil_contact/marker_force.hpp"
#include "root_sph/exchange/surface_mapping.hpp"

namespace rootsoil {

/// Force of a contact after its marker moved by this from where the force was measured: its size follows the stiffness
/// along its own line, never pulls, and grows at most fourfold. Pure.
template <int Dim>
Vec<Dim> predicted_force(const Vec<Dim>& force_N, double stiffness_N_mm, const Vec<Dim>& moved_mm);

/// Share of the forces that acts: rises from 0 to 1 over ramp_h from the run's start. Pure.
double ramp(double time_h, double ramp_h);

/// The forces of markers on cells through one window.
template <int Dim>
class WindowForces {
 public:
  WindowForces() = default;
  /// \param positions of the cells at the window's start
  /// \param share of the forces that acts
  WindowForces(SurfaceMapping<Dim> mapping, std::vector<MarkerForce<Dim>> measured, double share,
               std::span<const Vec<Dim>> positions);

  const SurfaceMapping<Dim>& mapping() const { return mapping_; }
  const std::vector<Vec<Dim>>& applied_N() const { return applied_N_; }  ///< on each marker, now
  double share() const { return share_; }

  /// Row sums of the contacts for the stability bound, |phi_mi| k_m sum_j |phi_mj|, N/mm, by cell.
  std::map<std::size_t, double> stiffness() const;
  /// Sets the forces on all cells; returns, rising, the cells that have one.
  std::vector<std::size_t> spread(std::span<Vec<Dim>> force_N) const;
  /// Forces of markers with contacts follow their stiffness to where the cells are now. Returns what the root did since
  /// the last call against the forces until now, N mm, one number each of these markers.
  std::vector<double> follow(std::span<const Vec<Dim>> positions);

  /// How the markers moved by the window's end. \param awake the cells from this one on rested
  std::vector<MarkerMotion<Dim>> motion(std::span<const Vec<Dim>> positions, std::size_t awake) const;
  /// What the root did in this motion, N mm, one number a marker, but for what follow() has told.
  std::vector<double> work_Nmm(const std::vector<MarkerMotion<Dim>>& motion) const;

 private:
  SurfaceMapping<Dim> mapping_;
  std::vector<MarkerForce<Dim>> measured_;
  double share_ = 1.0;
  std::vector<Vec<Dim>> start_mm_;         ///< of the cells
  std::vector<Vec<Dim>> anchor_mm_;        ///< sum phi x of each marker, at the window's start
  std::vector<Vec<Dim>> applied_N_;        ///< share of the force on each marker
  std::vector<Vec<Dim>> applied_from_mm_;  ///< how far the marker had come in the window when it was set
};

}  // namespace rootsoil
