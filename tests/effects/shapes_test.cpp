// SPDX-License-Identifier: MIT
// Signed distances against points sampled on the surfaces.
#include "root_sph/effects/obstacle/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

template <int Dim>
struct Sampled {
  RigidShape<Dim> shape;
  std::vector<Vec<Dim>> surface;  ///< no point of the surface is further than `spacing` from one of these
  double spacing;
  bool (*inside)(const RigidShape<Dim>&, const Vec<Dim>&);
};

template <int Dim>
Sampled<Dim> sampled_plane(Random& random) {
  const Mat<Dim> axes = random.rotation<Dim>();
  const Plane<Dim> plane{0.2 * random.matrix<Vec<Dim>>(), axes.col(0)};
  Sampled<Dim> s{plane, {}, 0.05, [](const RigidShape<Dim>& shape, const Vec<Dim>& x) {
                   const auto& p = std::get<Plane<Dim>>(shape);
                   return (x - p.point_mm).dot(p.normal) < 0.0;
                 }};
  constexpr int half = Dim == 2 ? 100 : 60;
  for (int i = -half; i <= half; ++i) {
    for (int j = Dim == 2 ? 0 : -half; j <= (Dim == 2 ? 0 : half); ++j) {
      Vec<Dim> x = plane.point_mm + 0.05 * i * axes.col(1);
      if constexpr (Dim == 3) x += 0.05 * j * axes.col(2);
      s.surface.push_back(x);
    }
  }
  return s;
}

template <int Dim>
Sampled<Dim> sampled_ball(Random& random) {
  const Ball<Dim> ball{0.2 * random.matrix<Vec<Dim>>(), 0.5};
  Sampled<Dim> s{ball, {}, 0.05, [](const RigidShape<Dim>& shape, const Vec<Dim>& x) {
                   const auto& b = std::get<Ball<Dim>>(shape);
                   return (x - b.centre_mm).norm() < b.radius_mm;
                 }};
  for (int k = 0; k < 20000; ++k) {
    Vec<Dim> direction = random.matrix<Vec<Dim>>();
    if (direction.norm() > 0.1) s.surface.push_back(ball.centre_mm + 0.5 * direction.normalized());
  }
  return s;
}

template <int Dim>
Sampled<Dim> sampled_box(Random& random) {
  Box<Dim> box{0.2 * random.matrix<Vec<Dim>>(), Vec<Dim>::Constant(0.3), random.rotation<Dim>()};
  box.half_size_mm[0] = 0.6;
  Sampled<Dim> s{box, {}, 0.05, [](const RigidShape<Dim>& shape, const Vec<Dim>& x) {
                   const auto& b = std::get<Box<Dim>>(shape);
                   const Vec<Dim> local = (b.axes.transpose() * (x - b.centre_mm)).cwiseAbs();
                   return (local.array() < b.half_size_mm.array()).all();
                 }};
  constexpr int n = 40;
  for (int face = 0; face < Dim; ++face) {
    for (int i = -n; i <= n; ++i) {
      for (int j = Dim == 2 ? 0 : -n; j <= (Dim == 2 ? 0 : n); ++j) {
        for (const double side : {-1.0, 1.0}) {
          Vec<Dim> local;
          local[face] = side;
          local[(face + 1) % Dim] = double(i) / n;
          if constexpr (Dim == 3) local[(face + 2) % Dim] = double(j) / n;
          s.surface.push_back(box.centre_mm + box.axes * local.cwiseProduct(box.half_size_mm));
        }
      }
    }
  }
  return s;
}

template <class Dimension>
class Shapes : public testing::Test {};
TYPED_TEST_SUITE(Shapes, test::BothDimensions, test::DimensionName);

TYPED_TEST(Shapes, HaveTheDistancesAndNormalsOfTheirSampledSurfaces) {
  constexpr int dim = TypeParam::value;
  Random random(1);
  for (const Sampled<dim>& sampled :
       {sampled_plane<dim>(random), sampled_ball<dim>(random), sampled_box<dim>(random)}) {
    SCOPED_TRACE(sampled.shape.index());
    for (int trial = 0; trial < 100; ++trial) {
      const Vec<dim> x = random.matrix<Vec<dim>>();
      const SurfacePoint<dim> point = nearest_surface<dim>(sampled.shape, x);
      double nearest = 1e300;
      for (const Vec<dim>& y : sampled.surface) nearest = std::min(nearest, (y - x).norm());
      // the surface is nowhere nearer, and a sample is within its spacing of the nearest point
      EXPECT_LE(std::abs(point.distance_mm), nearest + 1e-12);
      EXPECT_GE(std::abs(point.distance_mm), nearest - sampled.spacing);
      EXPECT_EQ(point.distance_mm < 0.0, sampled.inside(sampled.shape, x));
      EXPECT_NEAR(point.normal.norm(), 1.0, 1e-14);
      // along the normal lies the surface
      const Vec<dim> foot = x - point.distance_mm * point.normal;
      EXPECT_NEAR(nearest_surface<dim>(sampled.shape, foot).distance_mm, 0.0, 1e-12);
      double from_foot = 1e300;
      for (const Vec<dim>& y : sampled.surface) from_foot = std::min(from_foot, (y - foot).norm());
      EXPECT_LE(from_foot, sampled.spacing);
    }
  }
}

TYPED_TEST(Shapes, NormalsAreTheGradientsOfDistances) {
  constexpr int dim = TypeParam::value;
  Random random(2);
  constexpr double h = 1e-6;
  for (const Sampled<dim>& sampled :
       {sampled_plane<dim>(random), sampled_ball<dim>(random), sampled_box<dim>(random)}) {
    int smooth = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const Vec<dim> x = random.matrix<Vec<dim>>();
      const SurfacePoint<dim> point = nearest_surface<dim>(sampled.shape, x);
      Vec<dim> gradient;
      for (int a = 0; a < dim; ++a) {
        const Vec<dim> step = h * Vec<dim>::Unit(a);
        gradient[a] = (nearest_surface<dim>(sampled.shape, x + step).distance_mm -
                       nearest_surface<dim>(sampled.shape, x - step).distance_mm) /
                      (2.0 * h);
      }
      // on a ridge inside a box the distance has no gradient; random points hardly ever lie there
      smooth += (gradient - point.normal).norm() < 1e-5;
    }
    EXPECT_GE(smooth, 99) << sampled.shape.index();
  }
}

TYPED_TEST(Shapes, AtTheCentreOfABallANormalIsChosen) {
  constexpr int dim = TypeParam::value;
  const SurfacePoint<dim> point = nearest_surface<dim>(Ball<dim>{Vec<dim>::Ones(), 0.5}, Vec<dim>::Ones());
  EXPECT_EQ(point.distance_mm, -0.5);
  EXPECT_EQ(point.normal.norm(), 1.0);
}

}  // namespace
}  // namespace rootsoil
