// SPDX-License-Identifier: MIT
#include "root_sph/effects/obstacle/obstacle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

constexpr double half_extent = 0.005, modulus = 200.0, friction = 0.3;

template <class Dimension>
class Contact : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;
  const Vec<Dim> normal = Random(1).matrix<Vec<Dim>>().normalized();
  /// Any unit vector along the surface.
  const Vec<Dim> tangent = [this] {
    const Vec<Dim> v = Random(2).matrix<Vec<Dim>>();
    return Vec<Dim>((v - v.dot(normal) * normal).normalized());
  }();
  const double volume = std::pow(0.01, Dim);
  /// N/mm: section V/(2 h) times E_c/(2 h).
  const double stiffness = volume / (2.0 * half_extent) * modulus / (2.0 * half_extent);
  Vec<Dim> slip_mm = Vec<Dim>::Zero();

  Vec<Dim> force(double distance_mm, double mu = friction) {
    return contact_force<Dim>({distance_mm, normal}, half_extent, volume, mu, modulus, slip_mm);
  }
};
TYPED_TEST_SUITE(Contact, test::BothDimensions, test::DimensionName);

TYPED_TEST(Contact, PushesWithTheRelativeIndentation) {
  constexpr int dim = TypeParam::value;
  for (const double depth : {1e-6, 0.001, 0.004}) {
    const Vec<dim> f = this->force(half_extent - depth);
    // the depth is a difference of lengths of 5e-3 mm: 1e-18 mm of rounding
    EXPECT_LT((f - this->stiffness * depth * this->normal).norm(), 1e-17 * this->stiffness);
  }
}

TYPED_TEST(Contact, DoesNotPullAndForgetsSlipOutOfContact) {
  constexpr int dim = TypeParam::value;
  for (const double distance : {half_extent, 0.006, 1.0}) {
    this->slip_mm = 1e-4 * this->tangent;
    EXPECT_EQ(this->force(distance), Vec<dim>(Vec<dim>::Zero()));
    EXPECT_EQ(this->slip_mm, Vec<dim>(Vec<dim>::Zero()));
  }
}

TYPED_TEST(Contact, SticksElasticallyBelowTheFrictionLimit) {
  constexpr int dim = TypeParam::value;
  constexpr double depth = 0.001;
  const Vec<dim> slip = 0.99 * friction * depth * this->tangent;
  this->slip_mm = slip;
  const Vec<dim> f = this->force(half_extent - depth);
  EXPECT_LT((f - this->stiffness * (depth * this->normal - slip)).norm(), 1e-14 * f.norm());
  EXPECT_LT((this->slip_mm - slip).norm(), 1e-18);
}

TYPED_TEST(Contact, SlidesAtMuTimesTheNormalForce) {
  constexpr int dim = TypeParam::value;
  constexpr double depth = 0.001;
  for (const double beyond : {1.01, 2.0, 100.0}) {
    this->slip_mm = beyond * friction * depth * this->tangent;
    const Vec<dim> f = this->force(half_extent - depth);
    const double pressed = this->stiffness * depth;
    EXPECT_NEAR(f.dot(this->normal), pressed, 1e-14 * pressed);
    EXPECT_NEAR(f.dot(this->tangent), -friction * pressed, 1e-14 * pressed);
    // what slid is forgotten: turning back unloads at once
    EXPECT_LT((this->slip_mm - friction * depth * this->tangent).norm(), 1e-17);
  }
}

TYPED_TEST(Contact, WithoutFrictionHasNoTangentialForce) {
  constexpr int dim = TypeParam::value;
  this->slip_mm = 1e-3 * this->tangent;
  const Vec<dim> f = this->force(0.004, 0.0);
  EXPECT_LT((f - f.dot(this->normal) * this->normal).norm(), 1e-16);
  EXPECT_GT(f.norm(), 0.0);
}

TYPED_TEST(Contact, IgnoresMotionAlongTheNormal) {
  constexpr int dim = TypeParam::value;
  this->slip_mm = 1e-3 * this->normal;
  const Vec<dim> f = this->force(0.004);
  EXPECT_LT((f - this->stiffness * 0.001 * this->normal).norm(), 1e-14 * f.norm());
  EXPECT_LT(this->slip_mm.norm(), 1e-18);
}

/// A small block whose lowest layer touches the plane x_1 = 0, and a solver with this obstacle.
template <int Dim>
struct BlockOnAPlane {
  Solver<Dim> solver{SolverOptions{}};
  ObstacleEffect<Dim> obstacle;
  static constexpr double depth = 0.001;

  BlockOnAPlane() : obstacle(solver, {"floor", Plane<Dim>{Vec<Dim>::Zero(), Vec<Dim>::Unit(1)}, friction, modulus}) {
    std::array<int, Dim> counts;
    counts.fill(3);
    counts[1] = 20;
    Random random(3);
    test::Cloud<Dim> block = test::lattice<Dim>(counts, 0.01, random);
    // the lowest centres lie half a cell less the depth above the plane
    for (Vec<Dim>& x : block.position) x[1] += 0.5 * 19 * 0.01 + half_extent - depth;
    test::fill<Dim>(solver.tissue(), block);
  }
  Tissue<Dim>& tissue() { return solver.tissue(); }
  void find() {
    std::vector<Vec<Dim>> stiffness(tissue().cells.size(), Vec<Dim>::Zero());
    for (auto& [name, pass] : solver.hooks().operators) pass(tissue());
    for (auto& [name, pass] : solver.hooks().stiffness) pass(tissue(), stiffness);
    added_stiffness = stiffness;
  }
  void push(SlipAdvance advance) {
    for (Vec<Dim>& f : tissue().force.values()) f.setZero();
    for (auto& [name, pass] : solver.hooks().forces) pass(tissue(), advance);
  }
  bool touches(std::size_t i) { return tissue().cells.position[i][1] < 0.009; }
  std::vector<Vec<Dim>> added_stiffness;
};

template <class Dimension>
class Obstacle : public testing::Test {};
TYPED_TEST_SUITE(Obstacle, test::BothDimensions, test::DimensionName);

TYPED_TEST(Obstacle, PushesTheCellsThatTouchItAndReportsTheSum) {
  constexpr int dim = TypeParam::value;
  BlockOnAPlane<dim> block;
  block.find();
  block.push({1e-3, 1e-3});
  const double k = std::pow(0.01, dim) * modulus / (4.0 * half_extent * half_extent);
  Vec<dim> sum = Vec<dim>::Zero();
  for (std::size_t i = 0; i < block.tissue().cells.size(); ++i) {
    const Vec<dim> expected = (block.touches(i) ? k * block.depth : 0.0) * Vec<dim>::Unit(1);
    EXPECT_LT((block.tissue().force[i] - expected).norm(), 1e-12 * k * block.depth);
    sum += expected;
  }
  EXPECT_GT(sum.norm(), 0.0);
  EXPECT_LT((block.obstacle.contact_force_N() - sum).norm(), 1e-12 * sum.norm());
}

TYPED_TEST(Obstacle, AddsItsStiffnessToTheStabilityBoundOfNearCellsOnly) {
  constexpr int dim = TypeParam::value;
  BlockOnAPlane<dim> block;
  block.find();
  const double k = std::pow(0.01, dim) * modulus / (4.0 * half_extent * half_extent);
  for (std::size_t i = 0; i < block.added_stiffness.size(); ++i) {
    const double height = block.tissue().cells.position[i][1];
    if (height > 0.009 && height < 0.05) continue;  // near enough to touch within the window, or not
    const double expected = height < 0.009 ? k : 0.0;
    EXPECT_LT((block.added_stiffness[i] - Vec<dim>::Constant(expected)).norm(), 1e-12 * k);
  }
}

TYPED_TEST(Obstacle, AccumulatesSlipOnlyInStepsThatCount) {
  constexpr int dim = TypeParam::value;
  BlockOnAPlane<dim> block;
  for (Vec<dim>& u : block.tissue().cells.velocity.values()) u = 0.1 * Vec<dim>::Unit(0);
  block.find();
  const double k = std::pow(0.01, dim) * modulus / (4.0 * half_extent * half_extent);
  const auto drag = [&](SlipAdvance advance) {
    block.push(advance);
    const auto i =
        std::min_element(block.tissue().cells.position.values().begin(), block.tissue().cells.position.values().end(),
                         [](const Vec<dim>& a, const Vec<dim>& b) { return a[1] < b[1]; }) -
        block.tissue().cells.position.values().begin();
    return block.tissue().force[static_cast<std::size_t>(i)][0];
  };
  // 1e-3 h at 0.1 mm/h are 1e-4 mm; the limit is 0.3 of the depth, 3e-4 mm
  EXPECT_NEAR(drag({1e-3, 1e-3}), -k * 1e-4, 1e-12 * k);
  EXPECT_NEAR(drag({0.5e-3, 0.0}), -k * 1.5e-4, 1e-12 * k);
  EXPECT_NEAR(drag({1e-3, 1e-3}), -k * 2e-4, 1e-12 * k);
  EXPECT_NEAR(drag({5e-3, 5e-3}), -k * 3e-4, 1e-12 * k);
}

TYPED_TEST(Obstacle, WritesOneColumnForAllObstacles) {
  constexpr int dim = TypeParam::value;
  BlockOnAPlane<dim> block;
  ObstacleEffect<dim> second(block.solver,
                             {"again", Plane<dim>{Vec<dim>::Zero(), Vec<dim>::Unit(1)}, friction, modulus});
  block.find();
  block.push({1e-3, 1e-3});
  std::vector<FrameColumn> columns;
  block.obstacle.add_columns(block.tissue(), columns);
  second.add_columns(block.tissue(), columns);
  ASSERT_EQ(columns.size(), 1u);
  EXPECT_EQ(columns[0].components, 3);
  const auto& values = std::get<std::vector<double>>(columns[0].values);
  ASSERT_EQ(values.size(), 3 * block.tissue().cells.size());
  for (std::size_t i = 0; i < block.tissue().cells.size(); ++i) {
    EXPECT_NEAR(values[3 * i + 1], block.tissue().force[i][1], 1e-15);
  }
}

}  // namespace
}  // namespace rootsoil
