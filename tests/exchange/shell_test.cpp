// SPDX-License-Identifier: MIT
// The 3D shell: where it lies, that it stays one closed-up surface, and that its markers stay close together.
#include "root_sph/exchange/shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

constexpr double length_mm = 0.8, radius_mm = 0.15, cell_mm = 0.03, marker_mm = 0.03;
constexpr MarkerSize size{marker_mm, 0.6 * marker_mm};

/// A capsule of cells from x = 0 to the tip, turned in space.
struct Root {
  test::Cloud<3> cloud;
  std::vector<double> distance_to_tip;
  Mat<3> turn;

  explicit Root(double jitter = 0.0) {
    Random random(5);
    turn = random.rotation<3>();
    for (double x = 0.5 * cell_mm; x < length_mm; x += cell_mm) {
      for (double y = -radius_mm + 0.5 * cell_mm; y < radius_mm; y += cell_mm) {
        for (double z = -radius_mm + 0.5 * cell_mm; z < radius_mm; z += cell_mm) {
          const double beyond = std::max(0.0, x - (length_mm - radius_mm));
          if (beyond * beyond + y * y + z * z > radius_mm * radius_mm) continue;
          const Vec<3> centre = Vec<3>(x, y, z) + jitter * cell_mm * random.matrix<Vec<3>>();
          cloud.add(turn * centre, Vec<3>::Constant(cell_mm), Mat<3>::Identity());
          distance_to_tip.push_back(length_mm - x);
        }
      }
    }
  }
  TissueView<3> view() const { return {cloud.position, cloud.shape, cloud.volume, distance_to_tip}; }
};

double depth_mm(const Vec<3>& x) {
  const double beyond = std::max(0.0, x[0] - (length_mm - radius_mm));
  return radius_mm - std::sqrt(beyond * beyond + x[1] * x[1] + x[2] * x[2]);
}

/// Longest edge; fails where the triangles are no surface with one open rim, all facing outwards from the axis.
double checked_longest_edge(const Shell& shell) {
  std::map<std::pair<int, int>, int> directed;
  std::set<int> corners;
  double longest = 0.0;
  for (const Shell::Triangle& t : shell.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      EXPECT_EQ((++directed[{a, b}]), 1) << "two triangles on the same side of an edge";
      corners.insert(a);
      longest = std::max(
          longest,
          (shell.positions()[static_cast<std::size_t>(a)] - shell.positions()[static_cast<std::size_t>(b)]).norm());
    }
  }
  std::map<int, int> next_on_rim;
  int edges = 0;
  for (const auto& [edge, count] : directed) {
    const bool rim = !directed.contains({edge.second, edge.first});
    if (rim) {
      EXPECT_TRUE(next_on_rim.emplace(edge.first, edge.second).second);
    }
    edges += rim ? 2 : 1;
  }
  EXPECT_EQ(corners.size(), shell.positions().size());
  // one rim, and the shape of a cup: V - E + F = 1
  std::size_t steps = 0;
  EXPECT_FALSE(next_on_rim.empty());
  if (!next_on_rim.empty()) {
    int at = next_on_rim.begin()->first;
    do at = next_on_rim.at(at), ++steps;
    while (at != next_on_rim.begin()->first && steps <= next_on_rim.size());
  }
  EXPECT_EQ(steps, next_on_rim.size());
  EXPECT_EQ(static_cast<int>(shell.positions().size()) - edges / 2 + static_cast<int>(shell.triangles().size()), 1);
  return longest;
}

TEST(Shell, LiesARadiusBelowTheSurfaceAndIsACup) {
  for (const double jitter : {0.0, 0.15}) {
    const Root root(jitter);
    const Shell shell(root.view(), size);
    EXPECT_LE(checked_longest_edge(shell), marker_mm);
    double mean = 0.0, shallowest = 1.0, deepest = 0.0;
    for (const Vec<3>& x : shell.positions()) {
      const double depth = depth_mm(root.turn.transpose() * x);
      mean += depth / static_cast<double>(shell.positions().size());
      shallowest = std::min(shallowest, depth);
      deepest = std::max(deepest, depth);
    }
    // a lattice across a circle leaves steps
    EXPECT_NEAR(mean, marker_mm, 0.3 * cell_mm);
    EXPECT_GT(shallowest, marker_mm - 0.6 * cell_mm);
    EXPECT_LT(deepest, marker_mm + 0.9 * cell_mm);
    const std::vector<Vec<3>> normals = shell.normals();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Vec<3> x = root.turn.transpose() * shell.positions()[i], n = root.turn.transpose() * normals[i];
      EXPECT_GT(depth_mm(x) - depth_mm(x + 1e-3 * n), 0.0) << x.transpose();
    }
  }
}

TEST(Shell, StaysCloseKnitThroughAStretchAndBack) {
  Shell shell(Root().view(), size);
  const Vec<3> axis = Root().turn.col(0);
  const std::size_t first = shell.ids().size();
  std::set<std::int64_t> now(shell.ids().begin(), shell.ids().end()), ever = now;
  for (int step = 0; step < 160; ++step) {
    const double stretch = step < 80 ? 1.02 : 1.0 / 1.02;
    for (Vec<3>& x : shell.positions()) x += (stretch - 1.0) * x.dot(axis) * axis;
    shell.refine();
    const std::set<std::int64_t> next(shell.ids().begin(), shell.ids().end());
    EXPECT_EQ(next.size(), shell.ids().size());
    for (const std::int64_t id : next) EXPECT_TRUE(now.contains(id) || !ever.contains(id)) << id;
    ever.insert(next.begin(), next.end());
    now = next;
    EXPECT_LE(checked_longest_edge(shell), marker_mm) << step;
    if (step == 79) {
      EXPECT_GT(shell.ids().size(), 2 * first);
    }
  }
  EXPECT_LT(shell.ids().size(), 3 * first);
}

TEST(Shell, SaveAndRestoreGoOnAlike) {
  Shell shell(Root().view(), size);
  std::map<std::string, std::vector<double>> reals;
  shell.save("a/", reals);
  Shell other{size};
  other.restore("a/", reals);
  for (Shell* s : {&shell, &other}) {
    for (Vec<3>& x : s->positions()) x *= 1.5;
    s->refine();
  }
  EXPECT_EQ(shell.ids(), other.ids());
  EXPECT_EQ(shell.positions(), other.positions());
  EXPECT_EQ(shell.triangles(), other.triangles());
}

}  // namespace
}  // namespace rootsoil
