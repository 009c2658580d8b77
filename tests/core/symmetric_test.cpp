// SPDX-License-Identifier: MIT
#include "root_sph/core/symmetric.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

template <class Dimension>
class Symmetric : public testing::Test {};
TYPED_TEST_SUITE(Symmetric, test::BothDimensions, test::DimensionName);

TYPED_TEST(Symmetric, EigenvaluesAscendAndBelongToTheirVectors) {
  constexpr int dim = TypeParam::value;
  test::Random random(1);
  double worst = 0.0;
  for (const double spread : {1.0, 1e-6, 0.0}) {  // to spheres, whose axes are arbitrary
    for (int repetition = 0; repetition < 100; ++repetition) {
      const Mat<dim> half = spread * random.matrix<Mat<dim>>();
      const Mat<dim> m = Mat<dim>::Identity() + half + half.transpose();
      const auto [values, vectors] = symmetric_eigen<dim>(m);
      for (int a = 1; a < dim; ++a) EXPECT_LE(values[a - 1], values[a]);
      worst = std::max(worst, (vectors.transpose() * vectors - Mat<dim>::Identity()).norm());
      worst = std::max(worst, (m * vectors - vectors * values.asDiagonal()).norm());
    }
  }
  EXPECT_LT(worst, 1e-14);
}

TYPED_TEST(Symmetric, CholeskyFactorIsLowerAndItsSquareIsTheMatrix) {
  constexpr int dim = TypeParam::value;
  const Mat<dim> any = test::Random(2).matrix<Mat<dim>>();
  const Mat<dim> m = Mat<dim>::Identity() + any * any.transpose();
  const Mat<dim> lower = cholesky_factor<dim>(m);
  EXPECT_EQ(lower(0, dim - 1), 0.0);
  EXPECT_LT((lower * lower.transpose() - m).norm(), 1e-15 * m.norm());
}

TYPED_TEST(Symmetric, IsPositiveDefiniteWhereEveryEigenvalueIs) {
  constexpr int dim = TypeParam::value;
  const Mat<dim> turn = test::Random(3).rotation<dim>();
  for (int a = 0; a < dim; ++a) {
    Vec<dim> values = Vec<dim>::Constant(2.0);
    values[a] = 1e-6;
    EXPECT_TRUE(is_positive_definite<dim>(turn * values.asDiagonal() * turn.transpose()));
    values[a] = -1e-6;
    EXPECT_FALSE(is_positive_definite<dim>(turn * values.asDiagonal() * turn.transpose()));
  }
}

}  // namespace
}  // namespace rootsoil
