// SPDX-License-Identifier: MIT
// The 2D outline: where it lies, and that its markers stay close together however the tissue stretches.
#include "root_sph/exchange/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

constexpr double length_mm = 1.0, radius_mm = 0.1, cell_mm = 0.02, marker_mm = 0.02;
constexpr MarkerSize size{marker_mm, 0.6 * marker_mm};

/// A capsule of cells from x = 0 to the tip at x = length, bent to an arc and turned.
struct Root {
  test::Cloud<2> cloud;
  std::vector<double> distance_to_tip;
  double curvature, angle;

  explicit Root(double curvature_per_mm = 0.0, double jitter = 0.0, double turned_by = 0.0)
      : curvature(curvature_per_mm), angle(turned_by) {
    Random random(5);
    for (double x = 0.5 * cell_mm; x < length_mm; x += cell_mm) {
      for (double y = -radius_mm + 0.5 * cell_mm; y < radius_mm; y += cell_mm) {
        const double beyond = std::max(0.0, x - (length_mm - radius_mm));
        if (beyond * beyond + y * y > radius_mm * radius_mm) continue;
        const Vec<2> centre = Vec<2>(x, y) + jitter * cell_mm * random.matrix<Vec<2>>();
        cloud.add(placed(centre), Vec<2>::Constant(cell_mm), Mat<2>::Identity());
        distance_to_tip.push_back(length_mm - x);
      }
    }
  }
  Vec<2> placed(const Vec<2>& x) const {
    Vec<2> bent = x;
    if (curvature != 0.0) {
      const double r = 1.0 / curvature - x[1], turn = curvature * x[0];
      bent = {r * std::sin(turn), 1.0 / curvature - r * std::cos(turn)};
    }
    return test::plane_rotation<2>(angle) * bent;
  }
  /// The reverse of placed().
  Vec<2> straight(const Vec<2>& placed_mm) const {
    const Vec<2> x = test::plane_rotation<2>(-angle) * placed_mm;
    if (curvature == 0.0) return x;
    const Vec<2> from_centre = x - Vec<2>(0.0, 1.0 / curvature);
    const double sign = curvature > 0.0 ? 1.0 : -1.0, r = sign * from_centre.norm();
    return {std::atan2(sign * from_centre[0], -sign * from_centre[1]) / curvature, 1.0 / curvature - r};
  }
  TissueView<2> view() const { return {cloud.position, cloud.shape, cloud.volume, distance_to_tip}; }
};

/// Depth of a point below the surface of the capsule.
double depth_mm(const Vec<2>& x) {
  const double beyond = std::max(0.0, x[0] - (length_mm - radius_mm));
  return radius_mm - std::hypot(beyond, x[1]);
}

double largest_gap_mm(const Outline& outline) {
  double gap = 0.0;
  for (std::size_t i = 1; i < outline.positions().size(); ++i) {
    gap = std::max(gap, (outline.positions()[i] - outline.positions()[i - 1]).norm());
  }
  return gap;
}

TEST(Outline, LiesARadiusBelowTheSurface) {
  for (const auto& [curvature, jitter, angle] :
       {std::array{0.0, 0.0, 0.0}, std::array{0.0, 0.2, 0.7}, std::array{1.2, 0.0, 2.0}, std::array{-1.2, 0.2, -2.5}}) {
    const Root root(curvature, jitter, angle);
    const Outline outline(root.view(), size);
    double deepest = 0.0, shallowest = 1.0, mean = 0.0;
    for (const Vec<2>& x : outline.positions()) {
      const double depth = depth_mm(root.straight(x));
      deepest = std::max(deepest, depth);
      shallowest = std::min(shallowest, depth);
      mean += depth / static_cast<double>(outline.positions().size());
    }
    // the lattice leaves steps of up to a cell in the round of the tip
    EXPECT_NEAR(mean, marker_mm, 0.15 * cell_mm) << curvature << ' ' << jitter;
    EXPECT_GT(shallowest, marker_mm - 0.5 * cell_mm) << curvature << ' ' << jitter;
    EXPECT_LT(deepest, marker_mm + 0.6 * cell_mm) << curvature << ' ' << jitter;
    EXPECT_LE(largest_gap_mm(outline), size.spacing_mm * (1.0 + 1e-9));
    // from base to base
    for (const Vec<2>& end : {outline.positions().front(), outline.positions().back()}) {
      EXPECT_LT(root.straight(end)[0], 3.0 * cell_mm);
    }
    EXPECT_LT(root.straight(outline.positions().front())[1], 0.0);
    EXPECT_GT(root.straight(outline.positions().back())[1], 0.0);
    for (std::size_t i = 1; i + 1 < outline.positions().size(); ++i) {
      EXPECT_GT(depth_mm(root.straight(outline.positions()[i])) -
                    depth_mm(root.straight(outline.positions()[i] + 1e-3 * outline.normals()[i])),
                0.0);
    }
  }
}

TEST(Outline, StaysCloseKnitThroughATenfoldStretchAndBack) {
  Outline outline(Root().view(), size);
  const std::set<std::int64_t> first(outline.ids().begin(), outline.ids().end());
  std::set<std::int64_t> ever = first, now = first;
  double factor = 1.0;
  for (int step = 0; step < 460; ++step) {
    const double stretch = step < 230 ? 1.01 : 1.0 / 1.01;
    factor *= stretch;
    for (Vec<2>& x : outline.positions()) x[0] *= stretch;
    outline.refine();
    EXPECT_LE(largest_gap_mm(outline), marker_mm) << step;
    const std::set<std::int64_t> next(outline.ids().begin(), outline.ids().end());
    EXPECT_EQ(next.size(), outline.ids().size());
    for (const std::int64_t id : next) {
      // whoever is not from the step before is new
      EXPECT_TRUE(now.contains(id) || !ever.contains(id)) << id;
    }
    ever.insert(next.begin(), next.end());
    now = next;
    if (step == 229) {
      EXPECT_NEAR(factor, 9.86, 0.01);
      EXPECT_TRUE(std::includes(next.begin(), next.end(), first.begin(), first.end()));  // none is lost by stretching
    }
  }
  // a shortened line gives back most of its markers
  EXPECT_LT(outline.ids().size(), 3 * first.size());
}

TEST(Outline, NewMarkersKeepTheCurvature) {
  // a circle, stretched threefold step by step: 4-point midpoints stay on the ellipse, chords would cut it
  Outline outline(Root().view(), size);
  double x_axis = 1.0;
  const std::size_t n = outline.positions().size();
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / static_cast<double>(n - 1);
    outline.positions()[i] = 0.1 * Vec<2>(std::cos(angle), std::sin(angle));
  }
  outline.refine();
  for (int step = 0; step < 110; ++step) {
    x_axis *= 1.01;
    for (Vec<2>& x : outline.positions()) x[0] *= 1.01;
    outline.refine();
  }
  for (const Vec<2>& x : outline.positions()) {
    EXPECT_NEAR(std::hypot(x[0] / x_axis, x[1]), 0.1, 2e-4);
  }
}

TEST(Outline, SaveAndRestoreGoOnAlike) {
  Outline outline(Root().view(), size);
  for (Vec<2>& x : outline.positions()) x[0] *= 2.0;
  outline.refine();
  std::map<std::string, std::vector<double>> reals;
  outline.save("a/", reals);
  Outline other{size};
  other.restore("a/", reals);
  for (Outline* o : {&outline, &other}) {
    for (Vec<2>& x : o->positions()) x[0] *= 2.0;
    o->refine();
  }
  EXPECT_EQ(outline.ids(), other.ids());
  EXPECT_EQ(outline.positions(), other.positions());
}

TEST(Outline, RefusesMarkersThatDoNotFit) { EXPECT_THROW(Outline(Root().view(), {0.09, 0.05}), InputError); }

}  // namespace
}  // namespace rootsoil
