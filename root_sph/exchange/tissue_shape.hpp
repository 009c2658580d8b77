// SPDX-License-Identifier: MIT
// Where a cloud of cells ends: its midline and its surface, for the first surface markers.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "root_sph/exchange/kernel_cover.hpp"

namespace rootsoil {

/// Columns of the cells, one value a cell.
template <int Dim>
struct TissueView {
  std::span<const Vec<Dim>> position_mm;
  std::span<const Mat<Dim>> shape;  ///< Q, 1/mm^2
  std::span<const double> volume;
  std::span<const double> distance_to_tip_mm;
};

/// The surface is where the colour function c(x) = sum V_j W_j(x) falls to one half: for a flat surface that is where
/// the outer cells end, and irregular cells leave no holes in it.
template <int Dim>
class TissueShape {
 public:
  explicit TissueShape(const TissueView<Dim>& cells);

  struct SurfacePoint {
    Vec<Dim> position_mm, outward;
  };
  /// The first point on a ray from inside where the tissue ends; none where the ray never meets tissue.
  std::optional<SurfacePoint> surface_along(const Vec<Dim>& origin, const Vec<Dim>& direction) const;

  struct AxisPoint {
    Vec<Dim> position_mm, tipwards;
  };
  AxisPoint axis_at(double distance_to_tip_mm) const;

  double radius_mm() const { return radius_mm_; }        ///< mean, from volume and length
  double length_mm() const { return length_mm_; }        ///< largest distance of a cell from the tip
  double cell_size_mm() const { return cell_size_mm_; }  ///< median of V^(1/Dim)

 private:
  double colour(const Vec<Dim>& x) const;
  Vec<Dim> outward(const Vec<Dim>& x) const;

  TissueView<Dim> cells_;
  std::vector<Mat<Dim>> metrics_;
  std::vector<double> sqrt_det_;
  std::optional<KernelCover<Dim>> cover_;
  std::vector<double> knot_s_;  ///< rising
  std::vector<Vec<Dim>> knot_;
  double radius_mm_ = 0.0, length_mm_ = 0.0, cell_size_mm_ = 0.0;
};

/// Median of V^(1/Dim).
template <int Dim>
double median_cell_size_mm(std::span<const double> volume);

extern template class TissueShape<2>;
extern template class TissueShape<3>;

}  // namespace rootsoil
