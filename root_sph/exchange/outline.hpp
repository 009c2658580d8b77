// SPDX-License-Identifier: MIT
// The surface of a 2D root as a material polyline of markers: from the base along one flank, round the tip, and back to
// the base along the other flank. Markers are discs that lie a radius below the surface.
#pragma once

#include "root_sph/exchange/markers.hpp"

namespace rootsoil {

class Outline : public Markers<2> {
 public:
  /// For restore().
  explicit Outline(MarkerSize size) : Markers(size) {}
  /// Round the cells, inset by the markers' radius. InputError where the tissue is too thin for markers of this size.
  Outline(const TissueView<2>& cells, MarkerSize size);

  /// Inserts markers where neighbours parted (4-point midpoint) and takes out those that came too close. Ids of markers
  /// that stay do not change; ids are never used again.
  void refine();
  /// Outward unit normals.
  std::vector<Vec<2>> normals() const;
};

}  // namespace rootsoil
