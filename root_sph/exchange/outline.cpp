// SPDX-License-Identifier: MIT
#include "root_sph/exchange/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rootsoil {
namespace {

/// Points at equal distances along a line, not further apart than the spacing.
std::vector<Vec<2>> resampled(const std::vector<Vec<2>>& line, double spacing_mm) {
  std::vector<double> arc(line.size(), 0.0);
  for (std::size_t k = 1; k < line.size(); ++k) arc[k] = arc[k - 1] + (line[k] - line[k - 1]).norm();
  const auto parts = static_cast<std::size_t>(std::ceil(arc.back() / spacing_mm));
  std::vector<Vec<2>> points;
  std::size_t k = 0;
  for (std::size_t i = 0; i <= parts; ++i) {
    const double at = arc.back() * static_cast<double>(i) / static_cast<double>(parts);
    while (k + 2 < line.size() && arc[k + 1] < at) ++k;
    const double part = arc[k + 1] - arc[k];
    points.push_back(line[k] + (part > 0.0 ? (at - arc[k]) / part : 0.0) * (line[k + 1] - line[k]));
  }
  return points;
}

/// Rays that sweep the surface: across the axis from the base to the root of the cap, then as a fan round the tip.
std::vector<Vec<2>> inset_line(const TissueShape<2>& shape, MarkerSize size) {
  std::vector<Vec<2>> line;
  const double step_mm = 0.25 * size.spacing_mm;
  const double cap_mm = std::min(shape.radius_mm(), 0.5 * shape.length_mm());
  const double base_mm = shape.length_mm() - shape.cell_size_mm();
  const auto across = [](const Vec<2>& tipwards) { return Vec<2>(-tipwards[1], tipwards[0]); };
  const auto add = [&](const Vec<2>& origin, const Vec<2>& direction) {
    const auto surface = shape.surface_along(origin, direction);
    if (!surface) return;
    const Vec<2> x = surface->position_mm - size.radius_mm * surface->outward;
    // rays sweep counter-clockwise; where the surface is rough, insets can fall back behind the one before
    if (line.empty() || (x - line.back()).dot(across(direction)) > 0.0) line.push_back(x);
  };
  for (double s = base_mm; s > cap_mm; s -= step_mm) {
    const auto axis = shape.axis_at(s);
    add(axis.position_mm, -across(axis.tipwards));
  }
  const auto centre = shape.axis_at(cap_mm);
  const auto parts = static_cast<int>(std::ceil(std::numbers::pi * cap_mm / step_mm));
  for (int k = 0; k <= parts; ++k) {
    const double angle = std::numbers::pi * (static_cast<double>(k) / parts - 0.5);
    add(centre.position_mm, std::cos(angle) * centre.tipwards + std::sin(angle) * across(centre.tipwards));
  }
  std::vector<double> back;
  for (double s = base_mm; s > cap_mm; s -= step_mm) back.push_back(s);
  for (auto s = back.rbegin(); s != back.rend(); ++s) {
    const auto axis = shape.axis_at(*s);
    add(axis.position_mm, across(axis.tipwards));
  }
  return line;
}

}  // namespace

Outline::Outline(const TissueView<2>& cells, MarkerSize size) : Markers(size) {
  const TissueShape<2> shape(cells);
  refuse_thin(shape);
  position_ = resampled(inset_line(shape, size), size.spacing_mm);
  for (std::size_t i = 0; i < position_.size(); ++i) id_.push_back(next_id_++);
}

void Outline::refine() {
  bool inserted = true;
  while (inserted) {
    inserted = false;
    std::vector<Vec<2>> position;
    std::vector<std::int64_t> id;
    const std::size_t n = position_.size();
    for (std::size_t i = 0; i < n; ++i) {
      position.push_back(position_[i]);
      id.push_back(id_[i]);
      if (i + 1 == n || (position_[i + 1] - position_[i]).norm() <= largest_gap * size_.spacing_mm) continue;
      Vec<2> middle = 0.5 * (position_[i] + position_[i + 1]);
      // the 4-point scheme of Dyn, Levin & Gregory 1987 keeps the curvature
      if (i > 0 && i + 2 < n) middle += (position_[i] + position_[i + 1] - position_[i - 1] - position_[i + 2]) / 16.0;
      position.push_back(middle);
      id.push_back(next_id_++);
      inserted = true;
    }
    position_.swap(position);
    id_.swap(id);
  }
  // one whose neighbours are closer than a spacing is not needed; two in a row are never taken out at once
  std::vector<Vec<2>> position;
  std::vector<std::int64_t> id;
  bool removed_last = true;  // the ends stay
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const bool crowded =
        i + 1 < position_.size() && !removed_last && (position_[i + 1] - position.back()).norm() < size_.spacing_mm;
    removed_last = crowded;
    if (crowded) continue;
    position.push_back(position_[i]);
    id.push_back(id_[i]);
  }
  position_.swap(position);
  id_.swap(id);
}

std::vector<Vec<2>> Outline::normals() const {
  std::vector<Vec<2>> normals;
  const std::size_t last = position_.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const Vec<2> along = position_[std::min(i + 1, last)] - position_[i > 0 ? i - 1 : 0];
    normals.push_back(Vec<2>(along[1], -along[0]).normalized());
  }
  return normals;
}

}  // namespace rootsoil
