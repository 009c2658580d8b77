// SPDX-License-Identifier: MIT
#include "root_sph/exchange/tissue_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "root_sph/core/cell_size.hpp"
#include "root_sph/core/errors.hpp"

namespace rootsoil {

template <int Dim>
double median_cell_size_mm(std::span<const double> volume) {
  std::vector<double> sorted(volume.begin(), volume.end());
  ROOTSOIL_ASSERT(!sorted.empty());
  const auto middle = sorted.begin() + std::ssize(sorted) / 2;
  std::nth_element(sorted.begin(), middle, sorted.end());
  return cell_size_mm<Dim>(*middle);
}

template <int Dim>
TissueShape<Dim>::TissueShape(const TissueView<Dim>& cells) : cells_(cells) {
  constexpr double reach_cells = 1.5;  // smooth over irregular cells
  const std::size_t n = cells.position_mm.size();
  double volume = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    metrics_.push_back(cell_metric<Dim>(cells.shape[i], reach_cells));
    sqrt_det_.push_back(std::sqrt(metrics_.back().determinant()));
    volume += cells.volume[i];
    length_mm_ = std::max(length_mm_, cells.distance_to_tip_mm[i]);
  }
  cover_.emplace(cells.position_mm, metrics_);
  cell_size_mm_ = median_cell_size_mm<Dim>(cells.volume);
  const double section = volume / length_mm_;
  radius_mm_ = Dim == 2 ? 0.5 * section : std::sqrt(section / std::numbers::pi);

  // centroids of slices a diameter long
  const auto slices = std::max<std::size_t>(3, static_cast<std::size_t>(length_mm_ / (2.0 * radius_mm_)));
  std::vector<Vec<Dim>> centre(slices, Vec<Dim>::Zero());
  std::vector<double> s(slices, 0.0), weight(slices, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double share = std::max(0.0, cells.distance_to_tip_mm[i] / length_mm_);
    const std::size_t b = std::min(slices - 1, static_cast<std::size_t>(share * static_cast<double>(slices)));
    centre[b] += cells.volume[i] * cells.position_mm[i];
    s[b] += cells.volume[i] * cells.distance_to_tip_mm[i];
    weight[b] += cells.volume[i];
  }
  for (std::size_t b = 0; b < slices; ++b) {
    if (weight[b] <= 0.0) continue;
    knot_.push_back(centre[b] / weight[b]);
    knot_s_.push_back(s[b] / weight[b]);
  }
  ROOTSOIL_ASSERT(knot_.size() >= 2);
}

template <int Dim>
typename TissueShape<Dim>::AxisPoint TissueShape<Dim>::axis_at(double distance_to_tip_mm) const {
  const auto above = std::upper_bound(knot_s_.begin(), knot_s_.end(), distance_to_tip_mm) - knot_s_.begin();
  const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(knot_s_) - 2));
  const double t = (distance_to_tip_mm - knot_s_[k]) / (knot_s_[k + 1] - knot_s_[k]);
  return {knot_[k] + t * (knot_[k + 1] - knot_[k]), (knot_[k] - knot_[k + 1]).normalized()};
}

template <int Dim>
double TissueShape<Dim>::colour(const Vec<Dim>& x) const {
  double sum = 0.0;
  cover_->at(
      x, [&](std::size_t j, const Vec<Dim>&, double q) { sum += cells_.volume[j] * wendland<Dim>(q, sqrt_det_[j]); });
  return sum;
}

template <int Dim>
Vec<Dim> TissueShape<Dim>::outward(const Vec<Dim>& x) const {
  Vec<Dim> inward = Vec<Dim>::Zero();
  cover_->at(x, [&](std::size_t j, const Vec<Dim>& r, double q) {
    inward += cells_.volume[j] * wendland_slope<Dim>(q, sqrt_det_[j]) * (metrics_[j] * r);
  });
  return -inward.normalized();
}

template <int Dim>
std::optional<typename TissueShape<Dim>::SurfacePoint> TissueShape<Dim>::surface_along(
    const Vec<Dim>& origin, const Vec<Dim>& direction) const {
  constexpr double half = 0.5;
  const double step = 0.25 * cell_size_mm_, furthest = 10.0 * radius_mm_;
  bool inside = false;
  for (double at = 0.0; at < furthest; at += step) {
    const bool now = colour(origin + at * direction) > half;
    if (inside && !now) {
      double low = at - step, high = at;
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (low + high);
        (colour(origin + middle * direction) > half ? low : high) = middle;
      }
      const Vec<Dim> x = origin + low * direction;
      return SurfacePoint{x, outward(x)};
    }
    inside = inside || now;
  }
  return std::nullopt;
}

template double median_cell_size_mm<2>(std::span<const double>);
template double median_cell_size_mm<3>(std::span<const double>);
template class TissueShape<2>;
template class TissueShape<3>;

}  // namespace rootsoil
