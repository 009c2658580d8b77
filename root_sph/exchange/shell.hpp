// SPDX-License-Identifier: MIT
// The surface of a 3D root as a material shell: markers (spheres, a radius below the surface) joined by triangles, open
// at the base.
#pragma once

#include <array>

#include "root_sph/exchange/markers.hpp"

namespace rootsoil {

class Shell : public Markers<3> {
 public:
  using Triangle = std::array<std::int32_t, 3>;  ///< corners, counter-clockwise from outside

  /// For restore().
  explicit Shell(MarkerSize size) : Markers(size) {}
  /// Round the cells, inset by the markers' radius. InputError where the tissue is too thin for markers of this size.
  Shell(const TissueView<3>& cells, MarkerSize size);

  const std::vector<Triangle>& triangles() const { return triangle_; }

  /// Splits edges longer than largest_gap spacings, turns edges where other diagonals are shorter (Delaunay), and joins
  /// markers that came closer than half a spacing. Ids of markers that stay do not change and are never used again.
  void refine();
  /// Outward unit normals.
  std::vector<Vec<3>> normals() const;

  /// State for a checkpoint.
  void save(const std::string& prefix, std::map<std::string, std::vector<double>>& reals) const;
  void restore(const std::string& prefix, const std::map<std::string, std::vector<double>>& reals);

 private:
  /// Two triangles (or one, at the rim) that share corners a < b. opposite: the third corners.
  struct Edge {
    std::int32_t a, b;
    std::array<std::int32_t, 2> triangle{-1, -1}, opposite{-1, -1};
  };
  std::vector<Edge> edges() const;
  double length(const Edge& e) const { return (at(e.a) - at(e.b)).norm(); }
  const Vec<3>& at(std::int32_t corner) const { return position_[static_cast<std::size_t>(corner)]; }
  std::int32_t add(const Vec<3>& x);
  Vec<3> area_normal(const Triangle& t) const { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])); }
  bool split_long_edges();
  bool turn_edges();
  bool join_close_markers();

  std::vector<Triangle> triangle_;
};

}  // namespace rootsoil
