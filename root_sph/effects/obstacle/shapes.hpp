// SPDX-License-Identifier: MIT
// Rigid shapes as signed distances. Pure functions.
#pragma once

#include <variant>

#include "root_sph/core/types.hpp"

namespace rootsoil {

/// Distance of a point from the surface (negative inside) and the outward unit normal there.
template <int Dim>
struct SurfacePoint {
  double distance_mm;
  Vec<Dim> normal;
};

template <int Dim>
struct Plane {
  Vec<Dim> point_mm, normal;
};

template <int Dim>
struct Box {
  Vec<Dim> centre_mm, half_size_mm;
  Mat<Dim> axes;  ///< columns
};

/// Disc in 2D, sphere in 3D.
template <int Dim>
struct Ball {
  Vec<Dim> centre_mm;
  double radius_mm;
};

template <int Dim>
using RigidShape = std::variant<Plane<Dim>, Box<Dim>, Ball<Dim>>;

template <int Dim>
SurfacePoint<Dim> nearest_surface(const RigidShape<Dim>& shape, const Vec<Dim>& x_mm);

}  // namespace rootsoil
