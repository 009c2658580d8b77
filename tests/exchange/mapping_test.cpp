// SPDX-License-Identifier: MIT
// Motion from cells to markers, forces from markers to cells, over generated clouds.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "root_sph/exchange/surface_mapping.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Cloud;
using test::Random;

/// Irregular cells of which some are ten times as long as wide, and markers in them, at their rim and off it.
template <int Dim>
struct Case {
  Cloud<Dim> cloud;
  std::vector<Vec<Dim>> markers;
  SurfaceMapping<Dim> mapping;

  explicit Case(std::uint64_t seed) {
    Random random(seed);
    std::array<int, Dim> counts;
    counts.fill(Dim == 2 ? 12 : 7);
    const double stretch = random.uniform(1.0, 10.0);
    const Cloud<Dim> plain = test::lattice<Dim>(counts, 0.02, random, 0.3, 0.4);
    const Mat<Dim> turn = random.rotation<Dim>();
    for (std::size_t i = 0; i < plain.size(); ++i) {
      Vec<Dim> x = plain.position[i], lengths = Vec<Dim>::Constant(2.0 / std::sqrt(plain.shape[i](0, 0)));
      x[0] *= stretch;
      lengths[0] *= stretch;
      cloud.add(turn * x + Vec<Dim>::Constant(0.3), lengths, turn);
    }
    const double half = 0.5 * counts[0] * 0.02;
    for (int m = 0; m < 60; ++m) {
      Vec<Dim> x = half * random.matrix<Vec<Dim>>();
      if (m % 3 == 0) x *= 1.1 * half / x.cwiseAbs().maxCoeff();  // at the rim
      x[0] *= stretch;
      markers.push_back(turn * x + Vec<Dim>::Constant(0.3));
    }
    markers.push_back(Vec<Dim>::Constant(0.3) + 3.0 * stretch * half * turn.col(0));  // far off the tissue
    mapping = SurfaceMapping<Dim>(markers, cloud.position, cloud.shape, random.uniform(1.2, 1.6));
  }
};

template <class Dimension>
class Mapping : public testing::Test {
 protected:
  static constexpr std::uint64_t seeds = 20;
};
TYPED_TEST_SUITE(Mapping, test::BothDimensions, test::DimensionName);

TYPED_TEST(Mapping, LinearMotionIsReproduced) {
  constexpr int dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= this->seeds; ++seed) {
    const Case<dim> c(seed);
    Random random(1000 + seed);
    const Mat<dim> gradient = random.matrix<Mat<dim>>();
    const Vec<dim> constant = random.matrix<Vec<dim>>();
    const auto field = [&](const Vec<dim>& x) -> Vec<dim> { return gradient * x + constant; };
    std::vector<Vec<dim>> u;
    for (const Vec<dim>& x : c.cloud.position) u.push_back(field(x));
    Spin<dim> spin = Spin<dim>::Zero();
    for (int a = 0; a < dim; ++a) spin += 0.5 * cross<dim>(Vec<dim>::Unit(a), gradient.col(a));
    for (std::size_t m = 0; m < c.markers.size(); ++m) {
      double size = 0.0, size_per_mm = 0.0;
      for (const auto& s : c.mapping.shares(m)) {
        size += std::abs(s.weight) * u[static_cast<std::size_t>(s.cell)].norm();
        size_per_mm += s.gradient.norm() * u[static_cast<std::size_t>(s.cell)].norm();
      }
      EXPECT_LT((c.mapping.interpolate(m, u) - field(c.markers[m])).norm(), 1e-12 * size) << seed << " marker " << m;
      EXPECT_LT((c.mapping.half_curl(m, u) - spin).norm(), 1e-12 * size_per_mm) << seed << " marker " << m;
    }
  }
}

TYPED_TEST(Mapping, ForceTorqueAndPowerAreKept) {
  constexpr int dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= this->seeds; ++seed) {
    const Case<dim> c(seed);
    Random random(2000 + seed);
    std::vector<Vec<dim>> f(c.cloud.size(), Vec<dim>::Zero()), u;
    for (std::size_t j = 0; j < c.cloud.size(); ++j) u.push_back(random.matrix<Vec<dim>>());
    Vec<dim> force = Vec<dim>::Zero();
    Spin<dim> torque = Spin<dim>::Zero();
    double power = 0.0;
    for (std::size_t m = 0; m < c.markers.size(); ++m) {
      const Vec<dim> F = random.matrix<Vec<dim>>();
      const Spin<dim> T = 0.02 * random.matrix<Spin<dim>>();  // a force at a cell's distance
      c.mapping.spread(m, F, T, f);
      force += F;
      torque += cross<dim>(c.markers[m], F) + T;
      power += F.dot(c.mapping.interpolate(m, u)) + T.dot(c.mapping.half_curl(m, u));
    }
    double size = 0.0, arm = 0.0, power_size = 0.0;
    for (std::size_t j = 0; j < c.cloud.size(); ++j) {
      force -= f[j];
      torque -= cross<dim>(c.cloud.position[j], f[j]);
      power -= f[j].dot(u[j]);
      size += f[j].norm();
      arm += c.cloud.position[j].norm() * f[j].norm();
      power_size += f[j].norm() * u[j].norm();
    }
    EXPECT_LT(force.norm(), 1e-12 * size) << "seed " << seed;
    EXPECT_LT(torque.norm(), 1e-12 * arm) << "seed " << seed;
    EXPECT_LT(std::abs(power), 1e-12 * power_size) << "seed " << seed;
  }
}

TYPED_TEST(Mapping, AMarkerOffTheTissueIsWidenedAndCounted) {
  const Case<TypeParam::value> c(1);
  EXPECT_GE(c.mapping.widened(), 1);
  EXPECT_LT(c.mapping.widened(), static_cast<std::int64_t>(c.markers.size()) / 4);
}

TYPED_TEST(Mapping, ForcesActOnFewCellsNearTheMarker) {
  constexpr int dim = TypeParam::value;
  std::array<int, dim> counts;
  counts.fill(11);
  Random random(1);
  const Cloud<dim> cloud = test::lattice<dim>(counts, 0.02, random);
  const std::vector<Vec<dim>> marker{Vec<dim>::Constant(0.005)};
  const SurfaceMapping<dim> mapping(marker, cloud.position, cloud.shape, 1.4);
  for (const auto& share : mapping.shares(0)) {
    EXPECT_LE((cloud.position[static_cast<std::size_t>(share.cell)] - marker[0]).norm(), 2.0 * 1.4 * 0.02 + 1e-12);
  }
  EXPECT_GE(mapping.shares(0).size(), std::size_t{dim + 2});
}

TYPED_TEST(Mapping, CellsOnALineKeepTheForce) {
  constexpr int dim = TypeParam::value;
  for (const int count : {1, 2, 5}) {
    Cloud<dim> cloud;
    for (int k = 0; k < count; ++k) {
      cloud.add(0.02 * k * Vec<dim>::Unit(0), Vec<dim>::Constant(0.02), Mat<dim>::Identity());
    }
    const std::vector<Vec<dim>> marker{Vec<dim>::Constant(0.01)};
    const SurfaceMapping<dim> mapping(marker, cloud.position, cloud.shape, 1.4);
    std::vector<Vec<dim>> f(cloud.size(), Vec<dim>::Zero());
    const Vec<dim> force = Random(3).matrix<Vec<dim>>();
    mapping.spread(0, force, Spin<dim>::Zero(), f);
    Vec<dim> sum = Vec<dim>::Zero();
    for (const Vec<dim>& x : f) sum += x;
    EXPECT_LT((sum - force).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace rootsoil
