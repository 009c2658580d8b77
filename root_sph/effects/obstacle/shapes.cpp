// SPDX-License-Identifier: MIT
#include "root_sph/effects/obstacle/shapes.hpp"

namespace rootsoil {
namespace {

template <int Dim>
SurfacePoint<Dim> nearest(const Plane<Dim>& plane, const Vec<Dim>& x) {
  return {(x - plane.point_mm).dot(plane.normal), plane.normal};
}

template <int Dim>
SurfacePoint<Dim> nearest(const Ball<Dim>& ball, const Vec<Dim>& x) {
  const Vec<Dim> r = x - ball.centre_mm;
  const double length = r.norm();
  return {length - ball.radius_mm, length > 0.0 ? Vec<Dim>(r / length) : Vec<Dim>(Vec<Dim>::UnitX())};
}

template <int Dim>
SurfacePoint<Dim> nearest(const Box<Dim>& box, const Vec<Dim>& x) {
  const Vec<Dim> local = box.axes.transpose() * (x - box.centre_mm);
  const Vec<Dim> beyond = local.cwiseAbs() - box.half_size_mm;
  Vec<Dim> normal;
  double distance;
  if (beyond.maxCoeff() > 0.0) {
    // outside: nearest point of a face, an edge or a corner
    const Vec<Dim> outside = beyond.cwiseMax(0.0);
    distance = outside.norm();
    normal = outside / distance;
  } else {
    Eigen::Index face = 0;
    distance = beyond.maxCoeff(&face);
    normal = Vec<Dim>::Unit(face);
  }
  for (int a = 0; a < Dim; ++a) {
    if (local[a] < 0.0) normal[a] = -normal[a];
  }
  return {distance, box.axes * normal};
}

}  // namespace

template <int Dim>
SurfacePoint<Dim> nearest_surface(const RigidShape<Dim>& shape, const Vec<Dim>& x_mm) {
  return std::visit([&](const auto& s) { return nearest<Dim>(s, x_mm); }, shape);
}

template SurfacePoint<2> nearest_surface<2>(const RigidShape<2>&, const Vec<2>&);
template SurfacePoint<3> nearest_surface<3>(const RigidShape<3>&, const Vec<3>&);

}  // namespace rootsoil
