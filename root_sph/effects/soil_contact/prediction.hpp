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

/// What a marker's contacts do, N and N/mm.
template <int Dim>
struct ContactResponse {
  Vec<Dim> force_N = Vec<Dim>::Zero();
  Mat<Dim> stiffness_N_mm = Mat<Dim>::Zero();  ///< - d force/d moved
};

/// Of a marker without inertia, which goes where the balance of the root puts it: after it moved by this in the window,
/// where its mean pace takes it by that. Along the force's own line contacts follow their stiffness, and never pull;
/// those that yield do so only to what goes beyond the mean pace. Across it, where nobody knows whether they stick or
/// slide, they resist that with at most the size of the force. Pure.
template <int Dim>
ContactResponse<Dim> balanced_response(const MarkerForce<Dim>& measured, const Vec<Dim>& moved_mm,
                                       const Vec<Dim>& pace_mm, bool yields);

/// Share of the forces that acts: rises from 0 to 1 over ramp_h from the run's start. Pure.
double ramp(double time_h, double ramp_h);

/// The forces of markers on cells through one window.
template <int Dim>
class WindowForces {
 public:
  WindowForces() = default;
  /// \param positions of the cells at the window's start
  /// \param share of the forces that acts
  /// \param yields what the contacts press on, where the root has no inertia
  WindowForces(SurfaceMapping<Dim> mapping, std::vector<MarkerForce<Dim>> measured, double share,
               std::span<const Vec<Dim>> positions, bool yields = true);

  const SurfaceMapping<Dim>& mapping() const { return mapping_; }
  const std::vector<Vec<Dim>>& applied_N() const { return applied_N_; }  ///< on each marker, now
  double share() const { return share_; }

  /// Row sums of the contacts for the stability bound, |phi_mi| k_m sum_j |phi_mj|, N/mm, by cell.
  std::map<std::size_t, double> stiffness() const;
  /// Sets the forces on all cells; returns, rising, the cells that have one.
  std::vector<std::size_t> spread(std::span<Vec<Dim>> force_N) const;
  /// Stiffness of the contacts for a root without inertia, each marker's spread over the rows of its cells: at least
  /// what acts on any motion of theirs. Adds to the first cells, as many as there are blocks.
  void add_stiffness(std::span<const Vec<Dim>> positions, double part, std::span<Mat<Dim>> stiffness) const;
  /// Forces of markers with contacts follow their stiffness to where the cells are now. Returns what the root did since
  /// the last call against the forces until now, N mm, one number each of these markers.
  std::vector<double> follow(std::span<const Vec<Dim>> positions);
  /// The same for a root without inertia, after a window that is this part of a whole one. Where a balance is sought,
  /// nothing is kept and nothing returned.
  std::vector<double> balance(std::span<const Vec<Dim>> positions, double part, bool keep);

  /// How the markers moved by the window's end. \param awake the cells from this one on rested
  std::vector<MarkerMotion<Dim>> motion(std::span<const Vec<Dim>> positions, std::size_t awake) const;
  /// What the root did in this motion, N mm, one number a marker, but for what follow() has told.
  std::vector<double> work_Nmm(const std::vector<MarkerMotion<Dim>>& motion) const;

 private:
  ContactResponse<Dim> response(std::size_t marker, const Vec<Dim>& moved_mm, double part) const;

  SurfaceMapping<Dim> mapping_;
  std::vector<MarkerForce<Dim>> measured_;
  double share_ = 1.0;
  bool yields_ = true;
  std::vector<Vec<Dim>> start_mm_;         ///< of the cells
  std::vector<Vec<Dim>> anchor_mm_;        ///< sum phi x of each marker, at the window's start
  std::vector<Vec<Dim>> applied_N_;        ///< share of the force on each marker
  std::vector<Vec<Dim>> applied_from_mm_;  ///< how far the marker had come in the window when it was set
  std::vector<Vec<Dim>> kept_N_;           ///< the force there, where applied_N_ is that of a balance sought
};

}  // namespace rootsoil
