// SPDX-License-Identifier: MIT
// The surface of a 2D root as a material polyline of markers: from the base along one flank, round the tip, and back to
// the base along the other flank. Markers are discs that lie a radius below the surface.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "root_sph/exchange/tissue_shape.hpp"

namespace rootsoil {

/// What markers of a surface are made to.
struct MarkerSize {
  double radius_mm = 0.0;
  double spacing_mm = 0.0;  ///< wanted; gaps stay below 1.5 of it
};

/// Largest gap between neighbours in units of the spacing; beyond it a marker is inserted.
inline constexpr double largest_gap = 1.5;

class Outline {
 public:
  /// For restore().
  explicit Outline(MarkerSize size) : size_(size) {}
  /// Round the cells, inset by the markers' radius. InputError where the tissue is too thin for markers of this size.
  Outline(const TissueView<2>& cells, MarkerSize size);

  const std::vector<Vec<2>>& positions() const { return position_; }
  std::vector<Vec<2>>& positions() { return position_; }
  const std::vector<std::int64_t>& ids() const { return id_; }
  const MarkerSize& size() const { return size_; }

  /// Inserts markers where neighbours parted (4-point midpoint) and takes out those that came too close. Ids of markers
  /// that stay do not change; ids are never used again.
  void refine();
  /// A new id for a marker that comes back to where the soil is.
  void renew(std::size_t marker) { id_[marker] = next_id_++; }
  /// Outward unit normals.
  std::vector<Vec<2>> normals() const;

  /// State for a checkpoint.
  void save(const std::string& prefix, std::map<std::string, std::vector<double>>& reals) const;
  void restore(const std::string& prefix, const std::map<std::string, std::vector<double>>& reals);

 private:
  MarkerSize size_;
  std::vector<Vec<2>> position_;
  std::vector<std::int64_t> id_;
  std::int64_t next_id_ = 0;
};

}  // namespace rootsoil
