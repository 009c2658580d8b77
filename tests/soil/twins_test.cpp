// SPDX-License-Identifier: MIT
// The soils in this process: their laws, and that a saved one goes on alike.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "soil_coupling/twins/half_space.hpp"
#include "soil_coupling/twins/spring_bed.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil::twins {
namespace {

constexpr double radius_mm = 0.02, k = 100.0, mu = 0.4;

/// One marker that goes from a to b.
SurfaceMotion path(const Vec3& a, const Vec3& b, std::int64_t id = 7, double spin_per_h = 0.0) {
  SurfaceMotion motion;
  motion.duration_h = 1e-3;
  motion.id = {id};
  motion.start_mm = {a};
  motion.end_mm = {b};
  motion.radius_mm = {radius_mm};
  motion.spin_per_h = {{0.0, 0.0, spin_per_h}};
  return motion;
}

/// The half-space x > 1.
HalfSpaceParameters wall(double friction = 0.0) {
  HalfSpaceParameters p;
  p.point_mm = {1.0, 0.0, 0.0};
  p.outward = {-1.0, 0.0, 0.0};
  p.stiffness_N_mm = k;
  p.friction = friction;
  return p;
}

TEST(HalfSpace, PushesBackWithTheMeanOverlap) {
  HalfSpace soil(wall());
  // overlaps rise from 0 to 0.004 mm
  const SurfaceForces f = soil.advance(path({0.98, 0, 0}, {0.984, 0, 0}));
  EXPECT_NEAR(f.mean_N[0][0], -k * 0.002, 1e-13);
  EXPECT_EQ(f.mean_N[0][1], 0.0);
  EXPECT_EQ(f.contact_stiffness_N_mm[0], k);
  const SurfaceForces away = soil.advance(path({0.97, 0, 0}, {0.96, 0, 0}));
  EXPECT_EQ(away.mean_N[0], Vec3{});
  EXPECT_EQ(away.contact_stiffness_N_mm[0], 0.0);
}

TEST(HalfSpace, SticksThenSlides) {
  HalfSpace soil(wall(mu));
  soil.advance(path({0.98, 0, 0}, {0.985, 0, 0}));
  double y = 0.0;
  for (int step = 0; step < 40; ++step) {
    const double before = y;
    y += 1e-4;
    const SurfaceForces f = soil.advance(path({0.985, before, 0}, {0.985, y, 0}));
    const double middle = 0.5 * (before + y);
    const double friction = std::min(k * (middle + 0.5e-5), mu * k * 0.005);
    EXPECT_NEAR(f.mean_N[0][1], -friction, 1e-5 * k) << step;
    EXPECT_NEAR(f.mean_N[0][0], -k * 0.005, 1e-12);
    // the force acts on the marker's skin, a radius off its centre
    EXPECT_NEAR(f.mean_torque_Nmm[0][2], radius_mm * f.mean_N[0][1], 1e-13);
  }
}

TEST(HalfSpace, ARollingMarkerDoesNotSlide) {
  HalfSpace soil(wall(mu));
  // the skin stands still where vy + spin r = 0
  const double spin = -0.1 / radius_mm;
  const SurfaceForces f = soil.advance(path({0.985, 0.0, 0}, {0.985, 1e-4, 0}, 7, spin));
  EXPECT_NEAR(f.mean_N[0][1], 0.0, 1e-12);
  HalfSpace same(wall(mu));
  EXPECT_LT(same.advance(path({0.985, 0.0, 0}, {0.985, 1e-4, 0})).mean_N[0][1], -1e-3);
}

TEST(HalfSpace, RemembersTheSlipByIdWhoeverElseComesAndGoes) {
  HalfSpace alone(wall(mu)), crowded(wall(mu));
  test::Random random(1);
  SurfaceForces a, b;
  for (int step = 0; step < 20; ++step) {
    const Vec3 from{0.985, 1e-5 * step, 0}, to{0.985, 1e-5 * (step + 1), 0};
    a = alone.advance(path(from, to));
    SurfaceMotion many = path(from, to);
    for (int other = 0; other < step % 4; ++other) {  // in front of it and with new ids
      many.id.insert(many.id.begin(), 1000 + 10 * step + other);
      const Vec3 x{random.uniform(0.97, 0.99), random.uniform(-1, 1), 0};
      many.start_mm.insert(many.start_mm.begin(), x);
      many.end_mm.insert(many.end_mm.begin(), x);
      many.radius_mm.push_back(radius_mm);
      many.spin_per_h.push_back({});
    }
    b = crowded.advance(many);
    EXPECT_EQ(a.mean_N.back(), b.mean_N.back());
  }
  EXPECT_LT(a.mean_N[0][1], 0.0);
}

TEST(HalfSpace, StandsOnItsSpring) {
  // k sum (depth - X)+ = K X, against a scan
  const std::vector<double> depths{0.01, -0.02, 0.004, 0.03, 0.0021};
  for (const double backing : {1.0, 30.0, 1e4}) {
    const double x = balanced_retreat(depths, k, backing);
    double sum = 0.0;
    for (const double d : depths) sum += std::max(0.0, d - x);
    EXPECT_NEAR(k * sum, backing * x, 1e-12 * backing);
    EXPECT_GT(x, 0.0);
  }
  EXPECT_EQ(balanced_retreat(depths, k, 0.0), 0.0);
  EXPECT_EQ(balanced_retreat({-1.0}, k, 1.0), 0.0);
}

TEST(SpringBed, HoldsWhereItWasEntered) {
  SpringBed bed({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0, 20.0, 0.0});
  EXPECT_EQ(bed.advance(path({0.8, 0.3, 0}, {0.9, 0.3, 0})).mean_N[0], Vec3{});
  bed.advance(path({1.0, 0.3, 0}, {1.0, 0.3, 0}));
  const SurfaceForces f = bed.advance(path({1.02, 0.31, 0}, {1.02, 0.31, 0}));
  EXPECT_NEAR(f.mean_N[0][0], -5.0 * 0.02, 1e-13);
  EXPECT_NEAR(f.mean_N[0][1], -20.0 * 0.01, 1e-13);
  EXPECT_EQ(f.contact_stiffness_N_mm[0], 20.0);
}

TEST(SpringBed, BreaksForGood) {
  SpringBed bed({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5.0, 20.0, 0.05});
  bed.advance(path({1.0, 0, 0}, {1.0, 0, 0}));
  EXPECT_LT(bed.advance(path({1.049, 0, 0}, {1.049, 0, 0})).mean_N[0][0], -0.2);
  EXPECT_EQ(bed.advance(path({1.051, 0, 0}, {1.051, 0, 0})).mean_N[0][0], 0.0);
  const SurfaceForces f = bed.advance(path({1.01, 0, 0}, {1.01, 0, 0}));
  EXPECT_EQ(f.mean_N[0][0], 0.0);
  EXPECT_EQ(f.numbers.at("soil_broken"), 1.0);
}

/// Runs a soil over random paths; saves it half-way into a file that a fresh one goes on from.
template <class Soil, class Parameters>
void expect_same_after_load(const Parameters& parameters) {
  const test::TemporaryFolder folder;
  Soil soil(parameters), other(parameters);
  test::Random random(3);
  std::vector<Vec3> at(10, Vec3{0.985, 0.0, 0.0});
  for (int step = 0; step < 40; ++step) {
    SurfaceMotion motion = path({}, {});
    motion.id.clear();
    motion.start_mm = at;
    for (std::size_t m = 0; m < at.size(); ++m) {
      motion.id.push_back(static_cast<std::int64_t>(m));
      for (double& x : at[m]) x += random.uniform(-1e-3, 1.1e-3);
    }
    motion.end_mm = at;
    motion.radius_mm.assign(at.size(), radius_mm);
    motion.spin_per_h.assign(at.size(), {0, 0, 1.0});
    const SurfaceForces f = soil.advance(motion);
    if (step == 19) {
      soil.save(folder.path() / "soil");
      other.load(folder.path() / "soil");
    }
    if (step < 20) continue;
    const SurfaceForces g = other.advance(motion);
    EXPECT_EQ(f.mean_N, g.mean_N);
    EXPECT_EQ(f.numbers, g.numbers);
  }
  EXPECT_THROW(other.load(folder.path() / "none"), FileError);
}

TEST(HalfSpace, GoesOnBitForBitFromAFile) {
  HalfSpaceParameters p = wall(mu);
  p.backing_N_mm = 50.0;
  expect_same_after_load<HalfSpace>(p);
}

TEST(SpringBed, GoesOnBitForBitFromAFile) {
  expect_same_after_load<SpringBed>(SpringBedParameters{{0.98, 0, 0}, {1, 0, 0}, 5.0, 20.0, 0.01});
}

TEST(SpringBed, RefusesTheStateOfAnotherSoil) {
  const test::TemporaryFolder folder;
  HalfSpace(wall()).save(folder.path() / "soil");
  SpringBed bed({});
  EXPECT_THROW(bed.load(folder.path() / "soil"), FileError);
}

}  // namespace
}  // namespace rootsoil::twins
