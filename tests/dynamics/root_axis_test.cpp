// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/root_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

constexpr double size = 0.01;

template <int Dim>
std::array<int, Dim> root_counts(int along, int across) {
  std::array<int, Dim> counts;
  counts.fill(across);
  counts[0] = along;
  return counts;
}

template <int Dim>
void straight_root(Tissue<Dim>& tissue, int along, int across) {
  Random random(1);
  test::fill<Dim>(tissue, test::lattice<Dim>(root_counts<Dim>(along, across), size, random));
}

template <class Dimension>
class Axis : public testing::Test {};
TYPED_TEST_SUITE(Axis, test::BothDimensions, test::DimensionName);

TYPED_TEST(Axis, OfAStraightRootMeasuresTheDistanceFromTheTip) {
  constexpr int dim = TypeParam::value;
  Random random(2);
  for (const bool turned : {false, true}) {
    Tissue<dim> tissue;
    straight_root<dim>(tissue, 80, 6);
    auto& cells = tissue.cells;
    // s = 0 is the surface of the foremost cells
    const double tip = 0.5 * 80 * size;
    std::vector<double> exact;
    for (const Vec<dim>& x : cells.position.values()) exact.push_back(tip - x[0]);
    const Mat<dim> turn = turned ? random.rotation<dim>() : Mat<dim>(Mat<dim>::Identity());
    const Vec<dim> shift = turned ? random.matrix<Vec<dim>>() : Vec<dim>(Vec<dim>::Zero());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells.position[i] = shift + turn * cells.position[i];
      cells.frame[i] = turn;
      if (exact[i] > 0.75) cells.clamped[i] = 1;
    }
    RootAxis<dim> axis;
    axis.start(tissue);
    for (int again = 0; again < 2; ++again) {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        EXPECT_NEAR(cells.distance_to_tip[i], exact[i], 1e-9 * exact[i]) << "cell " << i;
      }
      axis.anchor(tissue);
    }
    EXPECT_LT((axis.tip_mm() - shift - tip * turn.col(0)).norm(), 1e-12);
    // from the tip to the last surface that is free
    EXPECT_NEAR(axis.length_mm(), 0.75, 1e-12);
  }
}

TYPED_TEST(Axis, OfARootShorterThanTwoSlicesIsItsMeanDirection) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, 8, 6);
  const Mat<dim> turn = Random(3).rotation<dim>();
  std::vector<double> exact;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    exact.push_back(0.04 - tissue.cells.position[i][0]);
    tissue.cells.position[i] = turn * tissue.cells.position[i];
    tissue.cells.frame[i] = turn;
  }
  RootAxis<dim> axis;
  axis.start(tissue);
  for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(tissue.cells.distance_to_tip[i], exact[i], 1e-12);
}

/// Slices narrower than the root is now would hold cells of one side only: the line zigzags, distances jump by a cell,
/// and growth, which follows them, tears the root (docs/decisions/0004).
TYPED_TEST(Axis, OfASwollenRootStaysStraight) {
  constexpr int dim = TypeParam::value;
  constexpr int along = 24;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, along, 6);
  RootAxis<dim> axis;
  axis.start(tissue);
  auto& cells = tissue.cells;
  Random random(4);
  Vec<dim> swell = Vec<dim>::Constant(3.0);
  swell[0] = 1.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells.position[i] = swell.cwiseProduct(cells.position[i]) + 0.05 * size * random.matrix<Vec<dim>>();
    cells.shape[i] = swell.cwiseInverse().asDiagonal() * cells.shape[i] * swell.cwiseInverse().asDiagonal();
    cells.volume[i] *= swell.prod();
  }
  for (int again = 0; again < 200; ++again) axis.anchor(tissue);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_NEAR(cells.distance_to_tip[i], 0.5 * along * size - cells.position[i][0], 0.1 * size) << "cell " << i;
  }
}

TYPED_TEST(Axis, OfAnArcMeasuresArcLength) {
  constexpr int dim = TypeParam::value;
  constexpr double radius = 0.8;
  constexpr int along = 120, across = 6;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, along, across);
  const double tip = 0.5 * along * size;
  std::vector<double> exact;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    Vec<dim>& x = tissue.cells.position[i];
    exact.push_back(tip - x[0]);
    const double angle = x[0] / radius, y = x[1];
    x[0] = (radius - y) * std::sin(angle);
    x[1] = radius - (radius - y) * std::cos(angle);
    tissue.cells.frame[i] = test::plane_rotation<dim>(angle);
  }
  RootAxis<dim> axis;
  axis.start(tissue);
  // the corner of the blunt end, oblique to the last chord, shifts s = 0 for all cells alike: under 1 % of the length
  double shift = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    shift += (tissue.cells.distance_to_tip[i] - exact[i]) / static_cast<double>(exact.size());
  }
  EXPECT_LT(std::abs(shift), 0.01 * along * size);
  // from cell to cell distances are those along the arc, up to chords and projections
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(tissue.cells.distance_to_tip[i] - shift, exact[i], 0.005 * along * size) << "cell " << i;
  }
  EXPECT_NEAR(axis.length_mm(), along * size, 0.01 * along * size);
  const Vec<dim> end =
      radius * (std::sin(tip / radius) * Vec<dim>::Unit(0) + (1.0 - std::cos(tip / radius)) * Vec<dim>::Unit(1));
  EXPECT_LT((axis.tip_mm() - end).norm(), 0.5 * size);
}

TYPED_TEST(Axis, FlowIsTheIntegralOfTheStrainRate) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, 80, 6);
  RootAxis<dim> axis;
  axis.start(tissue);
  constexpr double window_h = 0.02;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) tissue.axial_strain[i] = 0.3 * window_h;
  axis.measure_flow(tissue, tissue.cells.distance_to_tip.values(), window_h);
  for (double s = 0.0; s < 0.8; s += 0.037) {
    EXPECT_NEAR(axis.flow_mm_h(s), 0.3 * s, 1e-13);
    EXPECT_NEAR(axis.strain_rate_per_h(s), 0.3, 1e-12);
    EXPECT_NEAR(axis.steady_acceleration(s), 0.3 * 0.3 * (axis.length_mm() - s), 1e-12);
  }
  EXPECT_EQ(axis.flow_mm_h(-0.1), 0.0);
}

/// Cells much longer than the bins: most bins hold no cell. Read as rate 0 they would take most of the flow away.
TYPED_TEST(Axis, FillsBinsWithoutCellsFromTheirNeighbours) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  test::Cloud<dim> row;
  Vec<dim> lengths = Vec<dim>::Constant(0.02);
  lengths[0] = 0.1;
  for (int k = 0; k < 20; ++k) row.add(0.1 * k * Vec<dim>::UnitX(), lengths, Mat<dim>::Identity());
  test::fill<dim>(tissue, row);
  RootAxis<dim> axis;
  axis.start(tissue);
  ASSERT_LT(axis.bin_mm(), 0.01);
  constexpr double window_h = 0.02;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) tissue.axial_strain[i] = 0.3 * window_h;
  axis.measure_flow(tissue, tissue.cells.distance_to_tip.values(), window_h);
  for (double s = 0.0; s < 2.0; s += 0.037) EXPECT_NEAR(axis.flow_mm_h(s), 0.3 * s, 1e-12);

  // rates that fall along the root: in the gaps a straight line between the cells
  RootAxis<dim> falling;
  falling.start(tissue);
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    tissue.axial_strain[i] = (0.3 - 0.1 * tissue.cells.distance_to_tip[i]) * window_h;
  }
  falling.measure_flow(tissue, tissue.cells.distance_to_tip.values(), window_h);
  // a bin's value is that of its cell, which is off the bin's middle by up to half a bin
  const double slack = 0.1 * falling.bin_mm();
  for (double s = 0.06; s < 1.94; s += 0.037) EXPECT_NEAR(falling.strain_rate_per_h(s), 0.3 - 0.1 * s, slack);
}

TYPED_TEST(Axis, LeavesClampedCellsOutOfTheFlow) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, 80, 6);
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    tissue.cells.clamped[i] = tissue.cells.position[i][0] < -0.3;
    tissue.axial_strain[i] = tissue.cells.clamped[i] ? 0.0 : 0.3 * 0.02;
  }
  RootAxis<dim> axis;
  axis.start(tissue);
  axis.measure_flow(tissue, tissue.cells.distance_to_tip.values(), 0.02);
  EXPECT_NEAR(axis.length_mm(), 0.7, 1e-12);
  EXPECT_NEAR(axis.flow_mm_h(0.7), 0.21, 1e-12);
}

TYPED_TEST(Axis, SmoothsTheFlowOverATenthOfAnHour) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, 80, 6);
  RootAxis<dim> axis;
  axis.start(tissue);
  constexpr double window_h = 0.02;
  const auto measure = [&](double rate) {
    for (double& strain : tissue.axial_strain.values()) strain = rate * window_h;
    axis.measure_flow(tissue, tissue.cells.distance_to_tip.values(), window_h);
    return axis.flow_mm_h(0.5) / 0.5;
  };
  // the first measurement is taken whole, later ones by window/0.1 h
  EXPECT_NEAR(measure(0.3), 0.3, 1e-12);
  EXPECT_NEAR(measure(0.8), 0.3 + 0.2 * 0.5, 1e-12);
  EXPECT_NEAR(measure(0.8), 0.8 - 0.8 * 0.8 * 0.5, 1e-12);
}

TYPED_TEST(Axis, ComesBackFromItsSavedNumbers) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, 80, 6);
  RootAxis<dim> axis, restored;
  axis.start(tissue);
  axis.set_flow({0.0, 0.1, 0.3, 0.35});
  restored.restore(axis.save());
  EXPECT_EQ(restored.save(), axis.save());
  EXPECT_EQ(restored.length_mm(), axis.length_mm());
  EXPECT_EQ(restored.tip_mm(), axis.tip_mm());
  EXPECT_EQ(restored.flow(), axis.flow());
  EXPECT_EQ(restored.bin_mm(), axis.bin_mm());
  // knots of the flow are bin_mm() apart
  EXPECT_NEAR(axis.flow_mm_h(1.5 * axis.bin_mm()), 0.2, 1e-15);
  EXPECT_NEAR(axis.flow_mm_h(9.0 * axis.bin_mm()), 0.35, 1e-15);
}

TYPED_TEST(Axis, InertiaErrorIsTheLargestUnbalancedForceOverThatOfThePressure) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  tissue.need_inertia();
  straight_root<dim>(tissue, 80, 6);
  RootAxis<dim> axis;
  axis.start(tissue);
  tissue.pressure_MPa = 0.5;
  const double section = std::pow(6 * size, dim - 1);
  constexpr double window_h = 0.02, inertia = 3e-3, f = 1e-4;
  tissue.body_acceleration = &tissue.cells.template declare<Vec<dim>>(
      {"body_acceleration", "mm/h^2", "", Storage::scratch}, on_division::recomputed<dim, Vec<dim>>);
  Random random(5);
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    // +f near the tip, -f near the base: f is carried in between. Prescribed accelerations are not counted
    const double s = tissue.cells.distance_to_tip[i];
    const double unbalanced = s < size ? f : s > 79 * size ? -f : 0.0;
    tissue.inertia->inverse[i].setConstant(1.0 / inertia);
    tissue.inertia->start_velocity[i] = random.matrix<Vec<dim>>();
    (*tissue.body_acceleration)[i] = random.matrix<Vec<dim>>();
    const Vec<dim> acceleration = (*tissue.body_acceleration)[i] + unbalanced / inertia * Vec<dim>::UnitX();
    tissue.cells.velocity[i] = tissue.inertia->start_velocity[i] + window_h * acceleration;
  }
  const double carried = f * std::pow(6, dim - 1);
  EXPECT_NEAR(inertia_error<dim>(tissue, axis, window_h), carried / (0.5 * section), 1e-9);
  EXPECT_EQ(inertia_error<dim>(tissue, axis, 0.0), 0.0);
}

TYPED_TEST(Axis, OfCellsThatFlewApartIsRefusedBeforeMemoryIsTaken) {
  constexpr int dim = TypeParam::value;
  Tissue<dim> tissue;
  straight_root<dim>(tissue, 80, 6);
  auto& cells = tissue.cells;
  for (std::size_t i = 0; i < cells.size(); ++i) cells.distance_to_tip[i] = 0.4 - cells.position[i][0];
  RootAxis<dim> axis;
  axis.start(tissue);
  cells.distance_to_tip[0] = 1e9;
  EXPECT_THROW(axis.anchor(tissue), UnphysicalError);
}

}  // namespace
}  // namespace rootsoil
