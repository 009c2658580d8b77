// SPDX-License-Identifier: MIT
// The neighbour search against brute force over generated clouds, and what the parallel loops rely on.
#include "root_sph/neighbours/pair_list.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/kernels/wendland.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Cloud;
using test::Random;

template <int Dim>
std::vector<Mat<Dim>> metrics_of(const Cloud<Dim>& cloud) {
  std::vector<Mat<Dim>> metrics;
  for (const Mat<Dim>& shape : cloud.shape) metrics.push_back(cell_metric<Dim>(shape, 1.5));
  return metrics;
}

template <int Dim>
Cloud<Dim> uniform(Random& random, int cells, const Vec<Dim>& extent, const Vec<Dim>& lengths, double most_scale) {
  Cloud<Dim> cloud;
  for (int k = 0; k < cells; ++k) {
    const Vec<Dim> x = random.matrix<Vec<Dim>>().cwiseProduct(extent);
    cloud.add(x, random.uniform(1.0, most_scale) * lengths, random.rotation<Dim>());
  }
  return cloud;
}

template <int Dim>
std::map<std::string, Cloud<Dim>> clouds(std::uint64_t seed) {
  Random random(seed);
  std::map<std::string, Cloud<Dim>> all;
  const Vec<Dim> ones = Vec<Dim>::Ones();
  Vec<Dim> slender = 0.05 * ones, root_like = ones;
  slender[0] = 1.0;  // 20:1
  root_like[0] = 15.0;
  all["uniform"] = uniform<Dim>(random, 500, ones, 0.1 * ones, 1.0);
  all["sizes varying ten-fold"] = uniform<Dim>(random, 500, 2.0 * ones, 0.03 * ones, 10.0);
  all["elongated, in all directions"] = uniform<Dim>(random, 400, ones, (Dim == 2 ? 0.3 : 0.8) * slender, 2.0);
  all["root, long along x"] = uniform<Dim>(random, 600, root_like, 0.3 * ones, 1.5);
  Vec<Dim> upright = ones;
  upright[Dim - 1] = 15.0;
  all["root, long along the last axis"] = uniform<Dim>(random, 600, upright, 0.3 * ones, 1.5);
  std::array<int, Dim> counts;
  counts.fill(Dim == 2 ? 20 : 8);
  // partners of a lattice with eta = 1.5 lie at 3 spacings: a spacing of 0.1 puts them there up to rounding
  all["lattice, jittered"] = test::lattice<Dim>(counts, 0.1, random, 0.3, 0.4);
  all["lattice"] = test::lattice<Dim>(counts, 0.11, random, 0.0, 0.0);
  Cloud<Dim> clusters;
  for (int c = 0; c < 6; ++c) {
    const Vec<Dim> centre = 1000.0 * random.matrix<Vec<Dim>>();
    for (int k = 0; k < 60; ++k) {
      clusters.add(centre + 0.3 * random.matrix<Vec<Dim>>(), 0.08 * ones, random.rotation<Dim>());
    }
  }
  all["clusters, far apart"] = clusters;
  Cloud<Dim> line;
  for (int k = 0; k < 200; ++k) line.add(0.1 * k * Vec<Dim>::UnitX(), 0.09 * ones, Mat<Dim>::Identity());
  all["line of cells"] = line;
  Cloud<Dim> oblique;
  for (int k = 0; k < 200; ++k) oblique.add(0.1 * k * ones.normalized(), 0.09 * ones, Mat<Dim>::Identity());
  all["oblique line of cells"] = oblique;
  Cloud<Dim> coincident;
  for (int k = 0; k < 2; ++k) coincident.add(0.3 * ones, 0.1 * ones, Mat<Dim>::Identity());
  all["two coincident cells"] = coincident;
  Cloud<Dim> one;
  one.add(-2.0 * ones, 0.1 * ones, Mat<Dim>::Identity());
  all["one cell"] = one;
  all["no cell"] = {};
  return all;
}

template <int Dim>
std::vector<std::pair<std::int32_t, std::int32_t>> brute_force(const std::vector<Vec<Dim>>& positions,
                                                               const std::vector<Mat<Dim>>& metrics) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t j = i + 1; j < positions.size(); ++j) {
      const Vec<Dim> r = positions[j] - positions[i];
      if (std::sqrt(0.5 * (r.dot(metrics[i] * r) + r.dot(metrics[j] * r))) < kernel_support) {
        pairs.emplace_back(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
      }
    }
  }
  return pairs;
}

std::vector<std::pair<std::int32_t, std::int32_t>> as_vector(const PairList& list) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (const auto& [i, j] : list.pairs) pairs.emplace_back(i, j);
  return pairs;
}

template <class Dimension>
class Neighbours : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;

  /// Calls body(positions, metrics) for every cloud, in the order it was made and in the order for storage.
  template <class Body>
  static void for_each_cloud(Body&& body) {
    for (const std::uint64_t seed : {11, 12, 13}) {
      for (const auto& [name, cloud] : clouds<Dim>(seed)) {
        SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
        const std::vector<Mat<Dim>> metrics = metrics_of<Dim>(cloud);
        body(cloud.position, metrics);
        std::vector<Vec<Dim>> sorted_positions;
        std::vector<Mat<Dim>> sorted_metrics;
        for (const std::int64_t old : spatial_order<Dim>(cloud.position, metrics)) {
          sorted_positions.push_back(cloud.position[static_cast<std::size_t>(old)]);
          sorted_metrics.push_back(metrics[static_cast<std::size_t>(old)]);
        }
        body(sorted_positions, sorted_metrics);
      }
    }
  }
};
TYPED_TEST_SUITE(Neighbours, test::BothDimensions, test::DimensionName);

TYPED_TEST(Neighbours, AreThoseOfBruteForceInItsOrder) {
  constexpr int dim = TypeParam::value;
  this->for_each_cloud([](const std::vector<Vec<dim>>& positions, const std::vector<Mat<dim>>& metrics) {
    EXPECT_EQ(as_vector(find_pairs<dim>(positions, metrics)), brute_force<dim>(positions, metrics));
  });
}

TYPED_TEST(Neighbours, CloudsOfTheseTestsHavePairs) {
  constexpr int dim = TypeParam::value;
  for (const auto& [name, cloud] : clouds<dim>(11)) {
    if (cloud.size() < 2) continue;
    EXPECT_GE(find_pairs<dim>(cloud.position, metrics_of<dim>(cloud)).pairs.size(), cloud.size() / 2) << name;
  }
}

TYPED_TEST(Neighbours, RowsAndCountsBelongToThePairs) {
  constexpr int dim = TypeParam::value;
  this->for_each_cloud([](const std::vector<Vec<dim>>& positions, const std::vector<Mat<dim>>& metrics) {
    const PairList list = find_pairs<dim>(positions, metrics);
    ASSERT_EQ(list.row.size(), positions.size() + 1);
    ASSERT_EQ(list.neighbours.size(), positions.size());
    EXPECT_EQ(list.row.front(), 0);
    EXPECT_EQ(list.row.back(), std::ssize(list.pairs));
    std::vector<std::int32_t> count(positions.size(), 0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::int64_t k = list.row[i]; k < list.row[i + 1]; ++k) {
        const Pair pair = list.pairs[static_cast<std::size_t>(k)];
        ASSERT_EQ(pair.i, static_cast<std::int32_t>(i));
        ++count[static_cast<std::size_t>(pair.i)];
        ++count[static_cast<std::size_t>(pair.j)];
      }
    }
    EXPECT_EQ(list.neighbours, count);
  });
}

TYPED_TEST(Neighbours, PairsOfABlockTouchOnlyItsCellsAndThoseOfTheNext) {
  constexpr int dim = TypeParam::value;
  this->for_each_cloud([](const std::vector<Vec<dim>>& positions, const std::vector<Mat<dim>>& metrics) {
    const PairList list = find_pairs<dim>(positions, metrics);
    std::int64_t cell = 0, pair = 0;
    for (std::size_t b = 0; b < list.blocks.size(); ++b) {
      const PairBlock& block = list.blocks[b];
      // blocks follow one another without gap or overlap, in cells and in pairs
      EXPECT_EQ(block.first_cell, cell);
      EXPECT_EQ(block.first_pair, pair);
      ASSERT_GT(block.last_cell, block.first_cell);
      cell = block.last_cell;
      pair = block.last_pair;
      const std::int64_t reach = b + 1 < list.blocks.size() ? list.blocks[b + 1].last_cell : block.last_cell;
      for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
        const Pair p = list.pairs[static_cast<std::size_t>(k)];
        ASSERT_TRUE(p.i >= block.first_cell && p.i < block.last_cell);
        ASSERT_TRUE(p.j > p.i && p.j < reach);
      }
    }
    EXPECT_EQ(cell, std::ssize(positions));
    EXPECT_EQ(pair, std::ssize(list.pairs));
  });
}

TYPED_TEST(Neighbours, EveryBlockIsVisitedOnce) {
  constexpr int dim = TypeParam::value;
  Random random(5);
  const Cloud<dim> cloud = clouds<dim>(11).at("root, long along x");
  const std::vector<Mat<dim>> metrics = metrics_of<dim>(cloud);
  const PairList list = find_pairs<dim>(cloud.position, metrics);
  std::vector<int> visits(list.pairs.size(), 0);
  for_each_block(list, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) ++visits[static_cast<std::size_t>(k)];
  });
  EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ssize(visits));
}

TYPED_TEST(Neighbours, SpatialOrderIsAPermutationThatMakesManyBlocks) {
  constexpr int dim = TypeParam::value;
  for (const auto& [name, cloud] : clouds<dim>(14)) {
    std::vector<std::int64_t> order = spatial_order<dim>(cloud.position, metrics_of<dim>(cloud));
    std::sort(order.begin(), order.end());
    std::vector<std::int64_t> all(cloud.size());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all) << name;
  }
  // a long root in this order can be worked on in parallel; in the order of its making it is one or two blocks
  for (const char* name : {"root, long along x", "root, long along the last axis"}) {
    const Cloud<dim> root = clouds<dim>(14).at(name);
    const std::vector<Mat<dim>> metrics = metrics_of<dim>(root);
    std::vector<Vec<dim>> positions;
    std::vector<Mat<dim>> sorted;
    for (const std::int64_t old : spatial_order<dim>(root.position, metrics)) {
      positions.push_back(root.position[static_cast<std::size_t>(old)]);
      sorted.push_back(metrics[static_cast<std::size_t>(old)]);
    }
    EXPECT_GE(find_pairs<dim>(positions, sorted).blocks.size(), 4u) << name;
  }
}

TYPED_TEST(Neighbours, AreTheSameForAnyNumberOfThreads) {
  constexpr int dim = TypeParam::value;
  const int before = omp_get_max_threads();
  for (const auto& [name, cloud] : clouds<dim>(15)) {
    const std::vector<Mat<dim>> metrics = metrics_of<dim>(cloud);
    omp_set_num_threads(1);
    const PairList one = find_pairs<dim>(cloud.position, metrics);
    for (const int threads : {2, 3}) {
      omp_set_num_threads(threads);
      const PairList many = find_pairs<dim>(cloud.position, metrics);
      EXPECT_EQ(as_vector(one), as_vector(many)) << name;
      EXPECT_EQ(one.row, many.row) << name;
      EXPECT_EQ(one.neighbours, many.neighbours) << name;
      EXPECT_EQ(one.blocks.size(), many.blocks.size()) << name;
    }
  }
  omp_set_num_threads(before);
}

TYPED_TEST(Neighbours, SumsOverPairsAreBitIdenticalForAnyNumberOfThreads) {
  constexpr int dim = TypeParam::value;
  const int before = omp_get_max_threads();
  const Cloud<dim> cloud = clouds<dim>(16).at("line of cells");
  const PairList list = find_pairs<dim>(cloud.position, metrics_of<dim>(cloud));
  ASSERT_GE(list.blocks.size(), 4u);
  std::vector<double> value(list.pairs.size());
  Random random(17);
  for (double& v : value) v = random.uniform(-1.0, 1.0);
  std::vector<std::vector<double>> sums;
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    std::vector<double>& sum = sums.emplace_back(cloud.size(), 0.0);
    for_each_block(list, [&](const PairBlock& block) {
      for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
        sum[static_cast<std::size_t>(list.pairs[static_cast<std::size_t>(k)].i)] += value[static_cast<std::size_t>(k)];
        sum[static_cast<std::size_t>(list.pairs[static_cast<std::size_t>(k)].j)] -= value[static_cast<std::size_t>(k)];
      }
    });
  }
  omp_set_num_threads(before);
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
}

}  // namespace
}  // namespace rootsoil
