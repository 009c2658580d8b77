// SPDX-License-Identifier: MIT
// The root as a line: distance from the tip along a bent root, and how fast the tissue flows along it.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Keeps cells.distance_to_tip, and the flow profile v(s) = integral of the axial strain rate from the tip.
///
/// s is anchored anew in every window to a midline through the tissue, since advected distances drift (errors near
/// the tip are amplified by the stretch, -6 % after 20 h): the centroids of slices of equal s are joined by a line,
/// and a cell's distance is that of its projection. In a straight root this is x_tip - x.
template <int Dim>
class RootAxis {
 public:
  /// distance_to_tip must hold a first estimate, good enough to sort cells into slices.
  void start(Tissue<Dim>& tissue);
  /// New distances from the present positions.
  void anchor(Tissue<Dim>& tissue);
  /// Updates the flow profile from the axial strains of the window that ends; smoothed over 0.1 h.
  /// \param distance_mm of each cell from the tip in the middle of the window
  void measure_flow(const Tissue<Dim>& tissue, std::span<const double> distance_mm, double window_h);
  /// Sets the profile, e.g. from the closed form: flow_mm_h[k] at s = k bin_mm().
  void set_flow(std::vector<double> flow_mm_h) { flow_mm_h_ = std::move(flow_mm_h); }

  double bin_mm() const { return bin_mm_; }
  double length_mm() const { return length_mm_; }                     ///< tip to base along the root
  double moving_length_mm() const { return length_mm_ - still_mm_; }  ///< tip to where the cells that move end
  /// Length of the part next to the base whose cells do not move and are not asked for their place.
  void set_still_length(double length_mm) { still_mm_ = length_mm; }
  const Vec<Dim>& tip_mm() const { return tip_mm_; }  ///< the point s = 0
  const std::vector<double>& flow() const { return flow_mm_h_; }
  double flow_mm_h(double s_mm) const;          ///< v(s)
  double strain_rate_per_h(double s_mm) const;  ///< dv/ds
  /// Axial acceleration of the tissue in steady growth above a held base, mm/h^2: e(L) v(L) - e(s) v(s).
  double steady_acceleration(double s_mm) const;

  /// State for a checkpoint: bin, length, still length, tip, flow.
  std::vector<double> save() const;
  void restore(const std::vector<double>& saved);

 private:
  double bin_mm_ = 0.0;
  double length_mm_ = 0.0;
  double still_mm_ = 0.0;
  Vec<Dim> tip_mm_ = Vec<Dim>::Zero();
  std::vector<double> flow_mm_h_;
};

/// Of a root with this section, mm: in 2D, where a volume is an area, the section is the diameter.
template <int Dim>
double diameter_of(double section) {
  return Dim == 2 ? section : std::sqrt(4.0 * section / std::numbers::pi);
}

/// Mean cross-section of the tissue that the base does not hold, mm^(Dim-1).
template <int Dim>
double mean_section(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis);

/// By how much inertia changes the axial stress, on the mean over some windows: their impulses beyond what prescribed
/// accelerations explain, summed along the root. Thrust lasts and adds up; the chatter of contacts, to and fro, does
/// not.
template <int Dim>
class InertiaImpulse {
 public:
  /// The window that has just ended.
  void add_window(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis, double window_h);
  /// max over s of |mean unbalanced axial force between the tip and s| / (p x cross-section), relative; 0 before the
  /// first window and without a pressure differential.
  double error(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis) const;

  /// State for a checkpoint: duration (h), then the impulses of the axis' bins (N h).
  std::vector<double> save() const;
  void restore(const std::vector<double>& saved);

 private:
  double duration_h_ = 0.0;
  std::vector<double> impulse_N_h_;
};

/// That of one window.
template <int Dim>
double inertia_error(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis, double window_h) {
  InertiaImpulse<Dim> impulse;
  impulse.add_window(tissue, axis, window_h);
  return impulse.error(tissue, axis);
}

extern template class RootAxis<2>;
extern template class RootAxis<3>;
extern template class InertiaImpulse<2>;
extern template class InertiaImpulse<3>;

}  // namespace rootsoil
