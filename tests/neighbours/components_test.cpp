// SPDX-License-Identifier: MIT
// What hangs together and what lies in one place, against brute force over generated clouds.
#include "root_sph/neighbours/components.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "root_sph/kernels/wendland.hpp"
#include "root_sph/neighbours/cell_grid.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Cloud;
using test::Random;
using Group = std::vector<std::size_t>;

template <class Dimension>
class Components : public testing::Test {};
TYPED_TEST_SUITE(Components, test::BothDimensions, test::DimensionName);

template <int Dim>
std::vector<Mat<Dim>> metrics_of(const Cloud<Dim>& cloud) {
  std::vector<Mat<Dim>> metrics;
  for (const Mat<Dim>& shape : cloud.shape) metrics.push_back(cell_metric<Dim>(shape, 1.0));
  return metrics;
}

template <int Dim>
Cloud<Dim> block(Random& random, int across, double jitter = 0.3) {
  std::array<int, Dim> counts;
  counts.fill(across);
  return test::lattice<Dim>(counts, 1.0, random, jitter, 0.3);
}

template <int Dim>
double distance(const Cloud<Dim>& cloud, const std::vector<Mat<Dim>>& metrics, std::size_t i, std::size_t j) {
  const Vec<Dim> r = cloud.position[j] - cloud.position[i];
  return std::sqrt(0.5 * r.dot((metrics[i] + metrics[j]) * r));
}

TYPED_TEST(Components, OfABlockAndStrays) {
  constexpr int dim = TypeParam::value;
  Random random(1);
  Cloud<dim> cloud = block<dim>(random, 6);
  const std::size_t whole = cloud.size();
  EXPECT_EQ(components(whole, find_pairs<dim>(cloud.position, metrics_of<dim>(cloud)).pairs).size(), 1u);
  EXPECT_TRUE(beyond_gap<dim>(cloud.position, metrics_of<dim>(cloud)).empty());

  // beside the block's corner, so that no plane across an axis separates them; 3 cell lengths are too far for a pair
  Vec<dim> beside = Vec<dim>::Constant(2.5 + 3.0);
  for (int k = 0; k < 2; ++k) {
    cloud.add(beside, Vec<dim>::Ones(), Mat<dim>::Identity());
    beside[0] += 1.0;
  }
  const auto groups = components(cloud.size(), find_pairs<dim>(cloud.position, metrics_of<dim>(cloud)).pairs);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].size(), whole);
  EXPECT_EQ(groups[1], (Group{whole, whole + 1}));
}

TEST(ComponentsOfPairs, ComeLargestFirstAndInRisingOrder) {
  const std::vector<Pair> pairs{{5, 6}, {0, 4}, {1, 6}, {2, 5}};
  EXPECT_EQ(components(7, pairs), (std::vector<Group>{{1, 2, 5, 6}, {0, 4}, {3}}));
  EXPECT_EQ(components(2, {}), (std::vector<Group>{{0}, {1}}));
  EXPECT_TRUE(components(0, {}).empty());
}

TYPED_TEST(Components, BeyondTheWidestGapLieTheFewer) {
  constexpr int dim = TypeParam::value;
  for (int axis = 0; axis < dim; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Random random(2);
      Cloud<dim> cloud = block<dim>(random, 5);
      for (const double away : {1e7, 10.0}) {  // in whatever order they are given
        Vec<dim> x = Vec<dim>::Zero();
        x[axis] = side * away;
        cloud.add(x, Vec<dim>::Ones(), Mat<dim>::Identity());
      }
      const std::vector<Mat<dim>> metrics = metrics_of<dim>(cloud);
      EXPECT_EQ(beyond_gap<dim>(cloud.position, metrics), Group{cloud.size() - 2});
    }
  }
}

TYPED_TEST(Components, NoPairSpansAGap) {
  constexpr int dim = TypeParam::value;
  int gaps = 0;
  for (int seed = 0; seed < 200; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    Cloud<dim> cloud;
    for (int k = 0; k < 30; ++k) {
      Vec<dim> x = random.matrix<Vec<dim>>();
      x[0] *= 40.0;
      cloud.add(x, random.uniform(0.2, 2.0) * Vec<dim>::Ones(), random.rotation<dim>());
    }
    const std::vector<Mat<dim>> metrics = metrics_of<dim>(cloud);
    const Group beyond = beyond_gap<dim>(cloud.position, metrics);
    gaps += !beyond.empty();
    EXPECT_LE(2 * beyond.size(), cloud.size());
    const auto is_beyond = [&](std::int32_t i) {
      return std::binary_search(beyond.begin(), beyond.end(), static_cast<std::size_t>(i));
    };
    for (const auto& [i, j] : find_pairs<dim>(cloud.position, metrics).pairs) EXPECT_EQ(is_beyond(i), is_beyond(j));
  }
  EXPECT_GT(gaps, 20);
}

/// Of equal cells: each is just a partner of the next, or just out of the box that holds its partners.
TYPED_TEST(Components, ARowOfPartnersHasNoGap) {
  constexpr int dim = TypeParam::value;
  const Mat<dim> metric = Mat<dim>::Identity();
  const std::vector<Mat<dim>> metrics(6, metric);
  for (const bool partners : {true, false}) {
    const double spacing = partners ? 0.99 * kernel_support : 1.01 * reach<dim>(metric)[0];
    std::vector<Vec<dim>> row;
    for (int k = 0; k < 6; ++k) row.emplace_back(k * spacing * Vec<dim>::Unit(0));
    EXPECT_EQ(find_pairs<dim>(row, metrics).pairs.size(), partners ? 5u : 0u);
    EXPECT_EQ(beyond_gap<dim>(row, metrics).empty(), partners);
  }
}

TYPED_TEST(Components, NearestOutsideIsThatOfBruteForce) {
  constexpr int dim = TypeParam::value;
  Random random(3);
  const Cloud<dim> cloud = block<dim>(random, 5);
  for (int trial = 0; trial < 20; ++trial) {
    Group group;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (random.uniform(0.0, 1.0) < 0.1) group.push_back(i);
    }
    if (group.empty()) group.push_back(0);
    const Nearest found = nearest_outside<dim>(group, cloud.position);
    double least = 1e300;
    for (const std::size_t i : group) {
      for (std::size_t j = 0; j < cloud.size(); ++j) {
        if (std::binary_search(group.begin(), group.end(), j)) continue;
        least = std::min(least, (cloud.position[j] - cloud.position[i]).norm());
      }
    }
    EXPECT_EQ(found.distance_mm, least);
    EXPECT_EQ((cloud.position[found.outside] - cloud.position[found.inside]).norm(), least);
    EXPECT_TRUE(std::binary_search(group.begin(), group.end(), found.inside));
    EXPECT_FALSE(std::binary_search(group.begin(), group.end(), found.outside));
  }
}

TYPED_TEST(Components, CloserThanFindsWhatBruteForceFinds) {
  constexpr int dim = TypeParam::value;
  Random random(4);
  Cloud<dim> cloud;
  for (int k = 0; k < 200; ++k) {
    cloud.add(3.0 * random.matrix<Vec<dim>>(), random.uniform(0.3, 2.0) * (Vec<dim>::Ones() + 2.0 * Vec<dim>::Unit(0)),
              random.rotation<dim>());
  }
  const std::vector<Mat<dim>> metrics = metrics_of<dim>(cloud);
  std::vector<std::pair<int, int>> expected, found;
  constexpr double q = 0.5;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t j = i + 1; j < cloud.size(); ++j) {
      if (distance<dim>(cloud, metrics, i, j) < q) expected.emplace_back(i, j);
    }
  }
  for (const auto& [i, j] : closer_than<dim>(q, cloud.position, metrics, 100000)) found.emplace_back(i, j);
  std::sort(found.begin(), found.end());
  EXPECT_GT(expected.size(), 20u);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(closer_than<dim>(q, cloud.position, metrics, 3).size(), 3u);
}

TYPED_TEST(Components, ManyCellsInOnePlaceCostNothing) {
  constexpr int dim = TypeParam::value;
  const std::vector<Vec<dim>> positions(1000000, Vec<dim>::Zero());
  const std::vector<Mat<dim>> metrics(positions.size(), Mat<dim>::Identity());
  EXPECT_EQ(closer_than<dim>(0.25, positions, metrics, 5).size(), 5u);
}

}  // namespace
}  // namespace rootsoil
