// SPDX-License-Identifier: MIT
#include "root_sph/kernels/wendland.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

template <class Dimension>
class Wendland : public testing::Test {};
TYPED_TEST_SUITE(Wendland, test::BothDimensions, test::DimensionName);

/// Integral of W over space by the midpoint rule on the box of the support r^T M r < 4.
template <int Dim>
double integral(const Mat<Dim>& metric, int points) {
  const Vec<Dim> half = kernel_support * metric.inverse().diagonal().cwiseSqrt();
  const double sqrt_det = std::sqrt(metric.determinant());
  const auto total = static_cast<long>(std::pow(points, Dim));
  double sum = 0.0;
  for (long k = 0; k < total; ++k) {
    Vec<Dim> r;
    long rest = k;
    for (int a = 0; a < Dim; ++a) {
      r[a] = half[a] * ((2.0 * static_cast<double>(rest % points) + 1.0) / points - 1.0);
      rest /= points;
    }
    sum += wendland<Dim>(std::sqrt(r.dot(metric * r)), sqrt_det);
  }
  return sum * (2.0 * half / points).prod();
}

TYPED_TEST(Wendland, IntegratesToOneInRoundAndStretchedMetrics) {
  constexpr int dim = TypeParam::value;
  Random random(1);
  Vec<dim> lengths = Vec<dim>::Constant(0.01);
  std::vector<Mat<dim>> metrics{isotropic_metric<dim>(0.02),
                                cell_metric<dim>(test::ellipsoid<dim>(lengths, Mat<dim>::Identity()), 1.5)};
  lengths[0] = 0.05;
  for (int k = 0; k < 3; ++k) {
    metrics.push_back(cell_metric<dim>(test::ellipsoid<dim>(lengths, random.rotation<dim>()), 1.3));
  }
  // W has two continuous derivatives: the midpoint rule errs by far less than 1e-4 with these numbers of points
  for (const Mat<dim>& metric : metrics) EXPECT_NEAR(integral<dim>(metric, dim == 2 ? 400 : 80), 1.0, 1e-4);
}

TYPED_TEST(Wendland, SlopeIsMinusTheDerivativeOverQ) {
  constexpr int dim = TypeParam::value;
  constexpr double h = 1e-5;  // central difference: error h^2 W''' ~ 1e-9
  for (double q = 0.05; q < 2.0; q += 0.05) {
    const double derivative = (wendland<dim>(q + h, 1.7) - wendland<dim>(q - h, 1.7)) / (2.0 * h);
    EXPECT_NEAR(wendland_slope<dim>(q, 1.7), -derivative / q, 1e-8) << "q = " << q;
  }
}

TYPED_TEST(Wendland, GradientInSpaceIsMinusSlopeTimesMetricTimesR) {
  constexpr int dim = TypeParam::value;
  Random random(2);
  Vec<dim> lengths = Vec<dim>::Constant(1.0);
  lengths[0] = 4.0;
  const Mat<dim> metric = cell_metric<dim>(test::ellipsoid<dim>(lengths, random.rotation<dim>()), 1.5);
  const double sqrt_det = std::sqrt(metric.determinant());
  const auto value = [&](const Vec<dim>& r) { return wendland<dim>(std::sqrt(r.dot(metric * r)), sqrt_det); };
  constexpr double h = 1e-5;
  for (int k = 0; k < 20; ++k) {
    const Vec<dim> r = random.matrix<Vec<dim>>();
    const Vec<dim> expected = -wendland_slope<dim>(std::sqrt(r.dot(metric * r)), sqrt_det) * (metric * r);
    for (int a = 0; a < dim; ++a) {
      const Vec<dim> step = h * Vec<dim>::Unit(a);
      EXPECT_NEAR((value(r + step) - value(r - step)) / (2.0 * h), expected[a], 1e-8);
    }
  }
}

TYPED_TEST(Wendland, VanishesAtItsSupportWithItsSlope) {
  constexpr int dim = TypeParam::value;
  for (const double q : {kernel_support, 2.0001, 3.0, 1e6}) {
    EXPECT_EQ(wendland<dim>(q, 1.0), 0.0);
    EXPECT_EQ(wendland_slope<dim>(q, 1.0), 0.0);
  }
  // and arrives there smoothly: as (2 - q)^4 and (2 - q)^3
  EXPECT_LT(wendland<dim>(kernel_support - 1e-3, 1.0), 1e-11);
  EXPECT_LT(wendland_slope<dim>(kernel_support - 1e-3, 1.0), 1e-8);
  EXPECT_GT(wendland<dim>(kernel_support - 1e-3, 1.0), 0.0);
}

TYPED_TEST(Wendland, ReachesTwiceEtaCellLengthsAlongEachAxisOfTheCell) {
  constexpr int dim = TypeParam::value;
  Random random(3);
  Vec<dim> lengths = Vec<dim>::Constant(0.01);
  lengths[0] = 0.2;
  const Mat<dim> axes = random.rotation<dim>();
  const Mat<dim> metric = cell_metric<dim>(test::ellipsoid<dim>(lengths, axes), 1.5);
  for (int a = 0; a < dim; ++a) {
    const Vec<dim> r = 2.0 * 1.5 * lengths[a] * axes.col(a);
    EXPECT_NEAR(std::sqrt(r.dot(metric * r)), kernel_support, 1e-12);
  }
}

}  // namespace
}  // namespace rootsoil
