// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/gradient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <vector>

#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Cloud;
using test::Random;

constexpr std::array corrected_modes{GradientMode::linear, GradientMode::quadratic, GradientMode::quadratic_at_surface};

/// Irregular blocks with free edges on all sides: cells moved by 0.3 spacings, sizes varying, some elongated.
template <int Dim>
std::vector<Cloud<Dim>> irregular_blocks() {
  std::vector<Cloud<Dim>> blocks;
  std::array<int, Dim> counts;
  counts.fill(Dim == 2 ? 12 : 6);
  counts[0] = Dim == 2 ? 20 : 9;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    blocks.push_back(test::lattice<Dim>(counts, 0.01, random, 0.3, 0.3));
    // the same tissue stretched four-fold along an oblique direction, its cells with it
    Cloud<Dim> stretched = test::lattice<Dim>(counts, 0.01, random, 0.25, 0.2);
    const Mat<Dim> axes = random.rotation<Dim>();
    Vec<Dim> stretch = Vec<Dim>::Ones();
    stretch[0] = 4.0;
    const Mat<Dim> f = axes * stretch.asDiagonal() * axes.transpose();
    for (std::size_t i = 0; i < stretched.size(); ++i) {
      stretched.position[i] = f * stretched.position[i];
      stretched.shape[i] = f.inverse().transpose() * stretched.shape[i] * f.inverse();
      stretched.volume[i] *= 4.0;
    }
    blocks.push_back(stretched);
  }
  return blocks;
}

template <int Dim>
std::vector<Mat<Dim>> gradients_of(const Cloud<Dim>& cloud, GradientMode mode, double eta,
                                   const std::function<Vec<Dim>(const Vec<Dim>&)>& field, GradientReport& report) {
  Tissue<Dim> tissue;
  test::fill<Dim>(tissue, cloud);
  report = test::build_operators<Dim>(tissue, eta, mode);
  for (std::size_t i = 0; i < cloud.size(); ++i) tissue.cells.velocity[i] = field(cloud.position[i]);
  compute_velocity_gradients<Dim>(tissue);
  return tissue.velocity_gradient.values();
}

template <class Dimension>
class Gradient : public testing::Test {};
TYPED_TEST_SUITE(Gradient, test::BothDimensions, test::DimensionName);

TYPED_TEST(Gradient, IsExactForLinearFieldsUpToFreeEdges) {
  constexpr int dim = TypeParam::value;
  Random random(4);
  std::vector<Mat<dim>> fields{random.matrix<Mat<dim>>(), random.matrix<Mat<dim>>()};
  Mat<dim> shear = Mat<dim>::Zero(), spin = Mat<dim>::Zero();
  shear(0, 1) = 1.0;
  spin(0, dim - 1) = 1.0;
  spin(dim - 1, 0) = -1.0;
  fields.push_back(shear);
  fields.push_back(shear.transpose());
  fields.push_back(spin);
  for (const Cloud<dim>& cloud : irregular_blocks<dim>()) {
    for (const GradientMode mode : corrected_modes) {
      for (const Mat<dim>& exact : fields) {
        const Vec<dim> offset = random.matrix<Vec<dim>>();
        GradientReport report;
        const auto found = gradients_of<dim>(
            cloud, mode, 1.5, [&](const Vec<dim>& x) { return Vec<dim>(offset + exact * x); }, report);
        EXPECT_EQ(report.degenerate, 0);
        double worst = 0.0;
        for (const Mat<dim>& gradient : found) worst = std::max(worst, (gradient - exact).norm());
        EXPECT_LT(worst, 1e-10 * exact.norm()) << "mode " << static_cast<int>(mode);
      }
    }
  }
}

TYPED_TEST(Gradient, OfAConstantFieldIsZeroInEveryMode) {
  constexpr int dim = TypeParam::value;
  for (const GradientMode mode : {GradientMode::plain, GradientMode::linear, GradientMode::quadratic_at_surface}) {
    GradientReport report;
    const auto found = gradients_of<dim>(
        irregular_blocks<dim>()[0], mode, 1.5, [](const Vec<dim>&) { return Vec<dim>(Vec<dim>::Constant(0.3)); },
        report);
    for (const Mat<dim>& gradient : found) EXPECT_EQ(gradient, Mat<dim>(Mat<dim>::Zero()));
  }
}

/// Not all of it: the ridge that keeps the fit well-conditioned leaves a part.
TYPED_TEST(Gradient, OfTheQuadraticModeFollowsQuadraticFields) {
  constexpr int dim = TypeParam::value;
  Random random(5);
  for (const Cloud<dim>& cloud : irregular_blocks<dim>()) {
    const Mat<dim> linear = random.matrix<Mat<dim>>();
    std::array<Mat<dim>, dim> second;  // u_a = x^T second_a x, of the size of the linear part across the block
    for (Mat<dim>& m : second) m = 10.0 * random.matrix<Mat<dim>>();
    const auto field = [&](const Vec<dim>& x) {
      Vec<dim> u = linear * x;
      for (int a = 0; a < dim; ++a) u[a] += x.dot(second[a] * x);
      return u;
    };
    const auto mean_square_error = [&](GradientMode mode) {
      GradientReport report;
      // a wide reach, so that corner cells have neighbours enough for a full quadratic fit
      const auto found = gradients_of<dim>(cloud, mode, 2.5, field, report);
      EXPECT_EQ(report.quadratic, mode == GradientMode::quadratic ? static_cast<std::int64_t>(cloud.size()) : 0);
      double sum = 0.0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        Mat<dim> exact = linear;
        for (int a = 0; a < dim; ++a) {
          exact.row(a) += ((second[a] + second[a].transpose()) * cloud.position[i]).transpose();
        }
        sum += (found[i] - exact).squaredNorm();
      }
      return sum;
    };
    const double left = std::sqrt(mean_square_error(GradientMode::quadratic) / mean_square_error(GradientMode::linear));
    EXPECT_LT(left, 0.4);
    std::cout << "  error, of the linear fit's   " << left << '\n';
  }
}

TYPED_TEST(Gradient, UsesTheQuadraticFitAtSurfacesOnly) {
  constexpr int dim = TypeParam::value;
  Random random(6);
  std::array<int, dim> counts;
  counts.fill(dim == 2 ? 14 : 9);
  const Cloud<dim> cloud = test::lattice<dim>(counts, 0.01, random);
  const auto field = [](const Vec<dim>& x) { return Vec<dim>(x[0] * x[0] * Vec<dim>::UnitX()); };
  GradientReport linear, surface, everywhere;
  const auto crude = gradients_of<dim>(cloud, GradientMode::linear, 1.5, field, linear);
  const auto found = gradients_of<dim>(cloud, GradientMode::quadratic_at_surface, 1.5, field, surface);
  gradients_of<dim>(cloud, GradientMode::quadratic, 1.5, field, everywhere);
  EXPECT_EQ(linear.quadratic, 0);
  EXPECT_GT(surface.quadratic, 0);
  EXPECT_LT(surface.quadratic, everywhere.quadratic);
  // the middle of a face sees most of the quadratic field, although its neighbours are all on one side
  const double face = 0.5 * (counts[0] - 1) * 0.01;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec<dim>& x = cloud.position[i];
    const bool middle = (x.template tail<dim - 1>().cwiseAbs().array() < 0.006).all();
    if (!middle || x[0] < face - 1e-9) continue;
    EXPECT_LT(std::abs(found[i](0, 0) - 2.0 * x[0]), 0.5 * std::abs(crude[i](0, 0) - 2.0 * x[0]));
  }
}

/// Two rows do not know the curvature across them; waves of a few per cent of the spacing must not decide it. Without a
/// ridge they amplify what is not smooth 5.6-fold (docs/decisions/0017).
TEST(QuadraticFit, OfTwoWavyRowsInventsNoCurvature) {
  constexpr double spacing_mm = 0.01;
  Cloud<2> rows;
  for (int k = 0; k < 30; ++k) {
    const double width = spacing_mm * (1.0 + 0.1 * std::sin(0.9 * k));
    for (const double side : {-0.5, 0.5}) {
      rows.add({spacing_mm * k, side * width}, Vec<2>::Constant(spacing_mm), Mat<2>::Identity());
    }
  }
  const auto amplification = [&](GradientMode mode) {
    Random random(11);
    GradientReport report;
    const auto found = gradients_of<2>(
        rows, mode, 1.5, [&](const Vec<2>&) { return Vec<2>(random.uniform(-1, 1), random.uniform(-1, 1)); }, report);
    double sum = 0.0;
    for (const Mat<2>& gradient : found) sum += gradient.squaredNorm();
    return std::sqrt(sum);
  };
  const double ratio = amplification(GradientMode::quadratic) / amplification(GradientMode::linear);
  std::cout << "  amplification, of the linear fit's   " << ratio << '\n';
  EXPECT_LT(ratio, 2.0);
}

TYPED_TEST(Gradient, OfALineOfCellsIsExactAlongItAndZeroAcross) {
  constexpr int dim = TypeParam::value;
  Cloud<dim> line;
  const Vec<dim> along = Vec<dim>::Ones().normalized();
  for (int k = 0; k < 12; ++k) line.add(0.01 * k * along, Vec<dim>::Constant(0.01), Mat<dim>::Identity());
  const Mat<dim> exact = Random(7).matrix<Mat<dim>>();
  for (const GradientMode mode : corrected_modes) {
    GradientReport report;
    const auto found = gradients_of<dim>(
        line, mode, 1.5, [&](const Vec<dim>& x) { return Vec<dim>(exact * x); }, report);
    EXPECT_EQ(report.degenerate, 12);
    for (const Mat<dim>& gradient : found) {
      EXPECT_LT((gradient - exact * along * along.transpose()).norm(), 1e-12);
    }
  }
}

TYPED_TEST(Gradient, OfALoneCellIsZero) {
  constexpr int dim = TypeParam::value;
  Cloud<dim> one;
  one.add(Vec<dim>::Zero(), Vec<dim>::Constant(0.01), Mat<dim>::Identity());
  GradientReport report;
  const auto found = gradients_of<dim>(
      one, GradientMode::quadratic_at_surface, 1.5, [](const Vec<dim>&) { return Vec<dim>(Vec<dim>::Ones()); }, report);
  EXPECT_EQ(report.degenerate, 1);
  EXPECT_EQ(found[0], Mat<dim>(Mat<dim>::Zero()));
}

}  // namespace
}  // namespace rootsoil
